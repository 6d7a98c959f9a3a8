"""Functions that are compiled, and for which numba is loaded, when they are first called."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cached_property, update_wrapper
from typing import Any

from vibroimpact.compiler.marks import DEFERRED

INTERPRETING = ContextVar("INTERPRETING", default=False)
"""Are functions of the core that Python calls run as they are written?"""


@contextmanager
def interpreted() -> Iterator[None]:
    """Run functions of the core as plain Python, where loading numba would take longer."""
    token = INTERPRETING.set(True)
    try:
        yield
    finally:
        INTERPRETING.reset(token)


class DeferredFunction:
    """A function of the core in place of the compiled one.

    Parameters
    ----------
    function : callable
        The Python function.
    why_not : callable
        Returns why nothing is compiled, or "".
    """

    def __init__(
        self,
        function: Callable[..., Any],
        why_not: Callable[[], str],
    ) -> None:
        update_wrapper(self, function)
        self.py_func = function
        self._why_not = why_not
        DEFERRED.append(self)

    @cached_property
    def compiled(self) -> Any:
        """The compiled function, as Python calls it; the Python function if numba does not load."""
        if self._why_not():
            return self.py_func
        from vibroimpact.compiler.functions import compiled_function

        return compiled_function(self.py_func, self._signature)

    @cached_property
    def signature_text(self) -> str:
        """The signature, with all that it says of named tuples."""
        from vibroimpact.compiler.types import text_of

        return text_of(self._signature)

    @cached_property
    def _signature(self) -> Any:
        """Numba's signature."""
        from vibroimpact.compiler.types import signature_of

        return signature_of(self.py_func)

    @cached_property
    def inner(self) -> Any:
        """The function as compiled code calls it."""
        from vibroimpact.compiler.functions import CompiledFunction

        return CompiledFunction(self.py_func, self._signature, inner=True)

    @property
    # what numba asks for where a function that it compiles calls this one
    def _numba_type_(self) -> Any:
        return self.inner._numba_type_

    def __call__(self, *arguments: Any) -> Any:
        """Compile the function, unless that was done, and call it."""
        if INTERPRETING.get():
            return self.py_func(*arguments)
        return self.compiled(*arguments)

    def __reduce__(self) -> str:
        return self.py_func.__qualname__  # pickled by its name, as Python's functions are
