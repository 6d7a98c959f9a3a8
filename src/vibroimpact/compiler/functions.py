"""Compiled functions of the core, and the forces of laws as function values. Loading this module loads numba."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from numba import njit, objmode
from numba.core.errors import NumbaError
from numba.extending import overload

from vibroimpact.compiler import types
from vibroimpact.compiler.code_cache import CodeCache
from vibroimpact.compiler.digest import NotDigestible, digest
from vibroimpact.compiler.forces import interpreted_force
from vibroimpact.compiler.marks import SCALAR
from vibroimpact.errors import SlowLawWarning

OPTIONS = {"error_model": "numpy"}
"""Division by zero gives infinity, as in NumPy; no `fastmath`, so that sums do not depend on the compiler."""

REPLACED: dict[Any, Callable[..., Any]] = {}
"""The functions that compiled code calls, by those in whose place it does."""

_FORCES: dict[Any, Any] = {}


def compiled_function(function: Any, signature: Callable[[Any], Any]) -> Any:
    """Compile a function for one signature, or take its code from the disk."""
    return _compile(function, signature(types))


def compiled_force(law_class: type[Any]) -> Any:
    """Return the force of a law as a function value, compiled once a process."""
    source = interpreted_force(law_class)
    if source not in _FORCES:
        _FORCES[source] = _compiled_or_called(source, law_class)
    return _FORCES[source]


def _compiled_or_called(source: Callable[..., Any], law_class: type[Any]) -> Any:
    signature = types.force.signature
    if law_class.scalar_forces is not None:
        try:
            return _compile(source, signature)
        except NumbaError as error:
            reason = str(error).splitlines()[0]
    else:
        reason = "it has no force of floats, `scalar_forces`"
    name = getattr(law_class, "name", law_class.__name__)
    warnings.warn(SlowLawWarning(f"the law {name} is not compiled: {reason}; each of its forces takes longer"), stacklevel=4)
    return _compile(_calling(source), signature, nogil=False)


def _calling(source: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that compiled code calls, and which calls Python."""

    def force(delta, delta_dot, approach_speed, coefficients):  # type: ignore[no-untyped-def]
        with objmode(static="float64", dissipative="float64"):
            static, dissipative = source(delta, delta_dot, approach_speed, coefficients)
        return static, dissipative

    return force


def _compile(function: Callable[..., Any], signature: Any, nogil: bool = True) -> Any:
    register_scalars()
    dispatcher = njit(**OPTIONS, nogil=nogil)(function)
    with suppress(NotDigestible):  # it is then compiled in each process
        dispatcher._cache = CodeCache(function.__name__, digest(function, REPLACED))
    dispatcher.compile(signature)
    dispatcher.disable_compile()
    return dispatcher


def register_scalars() -> None:
    """Tell numba of the functions that were marked since the last time."""
    while len(REPLACED) < len(SCALAR):
        function, of_floats = SCALAR[len(REPLACED)]
        REPLACED[function] = of_floats or function
        overload(function, jit_options=OPTIONS, strict=False)(_replacing(REPLACED[function]))


def _replacing(body: Callable[..., Any]) -> Callable[..., Any]:
    def replacement(*arguments: Any) -> Callable[..., Any]:
        return body

    return replacement
