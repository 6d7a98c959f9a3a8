"""Compiled functions: each is compiled, or taken from the disk, when it is first called.

Loading this module loads numba.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from functools import cached_property
from importlib import import_module
from inspect import signature
from secrets import randbits
from typing import Any

from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import CPUDispatcher
from numba.core.typing.templates import Signature
from numba.extending import overload

from vibroimpact.compiler import function_values, intrinsics
from vibroimpact.compiler.code_cache import CodeCache
from vibroimpact.compiler.code_store import compiling_alone
from vibroimpact.compiler.digest import Digest, NotDigestible
from vibroimpact.compiler.lending import Lent, Packing, address_of, lent_to
from vibroimpact.compiler.marks import DEFERRED, SCALAR
from vibroimpact.compiler.notice import say_how_long, say_trouble
from vibroimpact.compiler.numba_ways import BITS, compiling_as
from vibroimpact.compiler.symbols import call_by_symbol, is_large
from vibroimpact.compiler.types import text_of

_OPTIONS = {"error_model": "numpy"}
"""Division by zero gives infinity; without `fastmath` sums do not depend on the compiler."""

_SECONDS = 4e-4
"""Time to compile a byte of Python's code [s]."""

_REPLACED: dict[Any, Callable[..., Any]] = {}
"""The functions that compiled code calls, by those in whose place it does."""


class CompiledFunction(CPUDispatcher):  # type: ignore[misc]
    """A function with one signature, compiled at its first call.

    It is also compiled when a function that calls it is. A function whose code is on the disk holds
    that of its callees too, so these are then neither compiled nor loaded.

    Parameters
    ----------
    function : callable
        The Python function.
    types : signature
        Numba's types of its arguments and of what it returns.
    nogil : bool, default True
        Release the interpreter's lock in calls from Python.
    inner : bool, default False
        Only compiled code calls it: no code is made that takes the arguments of Python apart, which
        takes a quarter of all time to compile.
    """

    is_busy = False
    """Is a function being compiled? Those that it calls are compiled meanwhile."""
    _cache: Any

    def __init__(
        self,
        function: Callable[..., Any],
        types: Signature,
        nogil: bool = True,
        inner: bool = False,
    ) -> None:
        options = {
            "nopython": True,
            "boundscheck": None,
            "nogil": nogil,
            "no_cfunc_wrapper": inner,
            "no_cpython_wrapper": inner,
            **_OPTIONS,
        }
        super().__init__(function, targetoptions=options)
        self._types = lent_to(types) if inner else types  # compiled code lends it its tuples
        self._is_inner = inner
        self._is_ready = False

    def ready(self) -> None:
        """Compile the function, or load its code, unless that was done."""
        if self._is_ready:
            return
        with global_compiler_lock:
            if self._is_ready or self.is_compiling:
                return
            if self.is_on_disk() or CompiledFunction.is_busy:
                self._make_ready()
                return
            CompiledFunction.is_busy = True
            try:
                with self._alone():
                    say_how_long(_seconds)
                    self._make_ready()
            finally:
                CompiledFunction.is_busy = False
            if self.is_kept and self._cache.trouble:
                say_trouble(self._cache.trouble)

    def _make_ready(self) -> None:
        with compiling_as(self._own_number()):
            self.compile(self._types)  # or load
        self.disable_compile()
        self._is_ready = True
        if self._is_inner and self.is_kept and is_large(self._cache.size):
            (result,) = self.overloads.values()
            call_by_symbol(self, result)

    def _own_number(self) -> int:
        """Return the number of this function.

        It is that of its code: code finds it by a name with this number in any process.
        """
        if self.is_kept:
            return int(self._cache.number)
        return randbits(BITS)

    @property
    def signature_text(self) -> str:
        """The signature, with all that it says of named tuples."""
        return text_of(self._types)

    @property
    def is_kept(self) -> bool:
        """Is the code kept on the disk? Not if it depends on something of unknown content."""
        return isinstance(self._cache, CodeCache)

    def is_on_disk(self) -> bool:
        """Is the code on the disk? From now on numba asks for it there."""
        _register()
        if not self.is_kept:
            try:
                digest = Digest(self.py_func, _REPLACED)
            except NotDigestible:  # it is then compiled in each process
                return False
            text = f"{digest.text} {self.signature_text} {self.targetoptions}"
            self._cache = CodeCache(
                self.py_func.__name__, text, is_own=digest.is_own, is_inner=self._is_inner
            )
        return bool(self._cache.has_code(self.targetctx))

    def _alone(self) -> Any:
        if self.is_kept:
            return compiling_alone(self._cache.folder(self.targetctx))
        return nullcontext()

    def address(self) -> int:
        """Return the address of the machine code, which is valid as long as this object exists."""
        self.ready()
        (result,) = self.overloads.values()
        return int(result.library.get_pointer_to_function(result.fndesc.llvm_func_name))

    # numba's hooks: the first call from Python, a call or a use as function value in a function
    # that is being compiled

    def _compile_for_args(self, *arguments: Any, **keywords: Any) -> Any:
        if self._is_ready:
            return super()._compile_for_args(*arguments, **keywords)
        self.ready()
        return self  # which numba calls, and finds the compiled code

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Return numba's template of a call, for the one signature."""
        self.ready()
        return super().get_call_template(args, kws)

    def get_compile_result(self, sig: Any) -> Any:
        """Return numba's compiled function."""
        self.ready()
        return super().get_compile_result(sig)

    def get_function_type(self) -> Any:
        """Return numba's type as a function value."""
        self.ready()
        return super().get_function_type()

    def __reduce__(self) -> Any:
        return _compiled_named, (self.py_func.__module__, self.py_func.__qualname__, self._is_inner)


class LendingFunction(CompiledFunction):
    """A function with one signature to which Python lends some of its arguments."""

    @cached_property
    def _packings(self) -> list[Packing | None]:
        """How its arguments are packed that are lent to it."""
        packings: list[Packing | None] = []
        for kind in self._types.args:
            packing = Packing(kind.kind) if isinstance(kind, Lent) else None
            packings.append(packing)
        return packings

    @cached_property
    def _entry(self) -> Any:
        """What Python calls, with the addresses of packed arguments."""
        self.ready()
        (result,) = self.overloads.values()
        return result.entry_point

    def __call__(self, *arguments: Any) -> Any:
        """Call it; it is compiled the first time."""
        passed = list(arguments)
        kept = []  # as long as the call lasts
        for number, packing in enumerate(self._packings):
            if packing is not None:
                packed = packing.pack(arguments[number])
                kept.append(packed)
                passed[number] = address_of(packed)
        return self._entry(*passed)


def compiled_function(function: Callable[..., Any], types: Signature) -> CompiledFunction:
    """Return a function as Python calls it, compiled at its first call.

    The parameters are those of `CompiledFunction`.
    """
    if any(isinstance(kind, Lent) for kind in types.args):
        return LendingFunction(function, types)
    return CompiledFunction(function, types)


def _compiled_named(module: str, name: str, inner: bool) -> Any:
    """Return the compiled function with a name in a module; inner: as compiled code calls it."""
    function: Any = import_module(module)
    for attribute in name.split("."):
        function = getattr(function, attribute)
    return function.inner if inner else function.compiled


def _seconds() -> float:
    """Return about how long it takes to compile all that is not on the disk [s]."""
    missing = [
        function
        for function in DEFERRED
        if not (function.inner.is_on_disk() or function.compiled.is_on_disk())
    ]
    return _SECONDS * sum(len(function.py_func.__code__.co_code) for function in missing)


def _register() -> None:
    """Tell numba of the functions that were marked since the last time."""
    if not _REPLACED:
        _register_intrinsics()
    for function, of_floats in SCALAR:
        if function in _REPLACED:
            continue
        body = of_floats or function
        _REPLACED[function] = body
        overload(function, jit_options=_OPTIONS, strict=False)(_replacing(body))


def _register_intrinsics() -> None:
    """Tell numba which functions it inserts as machine instructions."""
    for kind in function_values.ALL_FUNCTIONS:
        at_address = getattr(function_values, f"{kind}_at")
        of_address = getattr(intrinsics, f"{kind}_of_address")
        _REPLACED[at_address] = getattr(of_address, "_defn", at_address)
        overload(at_address)(_inserting(of_address))
    multiply = function_values.multiply_row
    _REPLACED[multiply] = getattr(intrinsics.product_of_rows, "_defn", multiply)
    overload(multiply)(_multiplying)


def _inserting(of_address: Any) -> Callable[..., Any]:
    def replacement(address):  # type: ignore[no-untyped-def]  # numba compares the signatures, with annotations
        return lambda address: of_address(address)

    return replacement


def _multiplying(room, values, matrices, matrix, width, columns, product):  # type: ignore[no-untyped-def]
    return lambda room, values, matrices, matrix, width, columns, product: (
        intrinsics.product_of_rows(room, values, matrices, matrix, width, columns, product)
    )


def _replacing(body: Callable[..., Any]) -> Callable[..., Any]:
    def replacement(*arguments: Any) -> Callable[..., Any]:
        return body

    replacement.__signature__ = signature(body)  # type: ignore[attr-defined]
    return replacement
