"""The functions of a contact law as C functions, which compiled code calls by their addresses. Loading this module loads numba.

One compiled core thus serves all laws, and takes a law as numbers: a function as an argument would cost some 30 us a call from Python.
"""

from __future__ import annotations

import ctypes
import inspect
import math
import warnings
from collections.abc import Callable
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import carray, njit
from numba.core.ccallback import CFunc
from numba.core.errors import NumbaError
from numba.extending import intrinsic

from vibroimpact.arrays import Integers
from vibroimpact.compiler import functions, types
from vibroimpact.compiler.code_cache import CodeCache
from vibroimpact.compiler.digest import NotDigestible, digest
from vibroimpact.compiler.forces import MOST_COEFFICIENTS, python_functions
from vibroimpact.errors import SlowLawWarning


class Kind(NamedTuple):
    """A kind of function of laws: its name, how many numbers it takes before the coefficients, and how many it writes."""

    name: str
    taken: int
    written: int


KINDS = (Kind("forces", 3, 2), Kind("energies", 1, 2), Kind("levels", 0, 5), Kind("compressed", 1, MOST_COEFFICIENTS))
"""The kinds in the order of `law_addresses`."""

_KEPT: dict[Any, Any] = {}
"""The C functions of this process, by the Python functions that they were made from."""

_ADDRESSES: dict[type[Any], Integers] = {}


def _evaluation(kind: Kind) -> Any:
    """Return a function of compiled code that calls a C function of a kind: address, numbers, coefficients, and where to write."""
    taken = kind.taken

    def evaluate(typing, address, *arguments):  # type: ignore[no-untyped-def]
        signature = types.void(types.integer, *[types.real] * taken, *arguments[taken:])

        def generate(context, builder, signature, values):  # type: ignore[no-untyped-def]
            number = ir.DoubleType()
            pointers = [number.as_pointer()] * 2
            c_type = ir.FunctionType(ir.VoidType(), [number] * taken + pointers)
            function = builder.inttoptr(values[0], c_type.as_pointer())
            last = range(1 + taken, 3 + taken)
            arrays = [context.make_array(signature.args[index])(context, builder, values[index]).data for index in last]
            builder.call(function, [*values[1 : 1 + taken], *arrays])
            return context.get_dummy_value()

        return signature, generate

    names = ["typing", "address", *[f"number_{index}" for index in range(taken)], "coefficients", "written"]
    evaluate.__name__ = f"evaluate_{kind.name}"
    evaluate.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        [inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD) for name in names]
    )
    return intrinsic(evaluate)


evaluate = _evaluation(KINDS[0])
"""Write the static and the dissipative force: address, indentation, rate, approach speed, coefficients, forces (2,)."""

evaluate_energies = _evaluation(KINDS[1])
"""Write the elastic energy and the plastic work: address, indentation, coefficients, energies (2,)."""

evaluate_levels = _evaluation(KINDS[2])
"""Write levels of touch, of release and of memory, and two breakpoints: address, coefficients, levels (5,)."""

evaluate_compressed = _evaluation(KINDS[3])
"""Write the coefficients after compression: address, deepest indentation, coefficients, changed coefficients, both whole."""


def law_addresses(law_class: type[Any]) -> Integers:
    """Return the addresses of forces, energies, levels and compressed coefficients of a law (4,).

    They are those of compiled code, or of a call of Python where the law can't be compiled.
    """
    if law_class not in _ADDRESSES:
        _ADDRESSES[law_class] = _new_addresses(law_class)
    return _ADDRESSES[law_class].copy()


def _new_addresses(law_class: type[Any]) -> Integers:
    missing = law_class.missing_functions()
    reason = f"it has no {_listed(missing)}" if missing else ""
    addresses = np.empty(len(KINDS), dtype=np.int64)
    for index, (kind, source) in enumerate(zip(KINDS, python_functions(law_class), strict=True)):
        if source not in _KEPT:
            try:
                _KEPT[source] = _called(source, kind) if missing else _compiled(source, kind)
            except NumbaError as error:
                reason = reason or str(error).splitlines()[0]
                _KEPT[source] = _called(source, kind)
        addresses[index] = _address(_KEPT[source])
    if reason:
        name = getattr(law_class, "name", law_class.__name__)
        warnings.warn(SlowLawWarning(f"the law {name} is not compiled: {reason}; each of its forces takes longer"), stacklevel=4)
    return addresses


def force_address(law_class: type[Any]) -> int:
    """Return the address of the force of a law."""
    return int(law_addresses(law_class)[0])


def _listed(names: list[str]) -> str:
    quoted = [f"`{name}`" for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"


def _address(function: Any) -> int:
    address = function.address if isinstance(function, CFunc) else ctypes.cast(function, ctypes.c_void_p).value
    return int(address or 0)


def _called(source: Callable[..., Any], kind: Kind) -> Any:
    """Return a C function that calls Python; where that fails, it leaves NaN."""
    arrays = [ctypes.POINTER(ctypes.c_double * size) for size in (MOST_COEFFICIENTS, kind.written)]
    failed = (math.nan,) * kind.written

    def call(*arguments: Any) -> None:
        coefficients = arguments[-2].contents
        written = arguments[-1].contents
        written[:] = failed
        if kind.name == "compressed":
            source(*arguments[:-2], coefficients, written)
        else:
            written[:] = source(*arguments[:-2], coefficients)

    return ctypes.CFUNCTYPE(None, *[ctypes.c_double] * kind.taken, *arrays)(call)


def _compiled(source: Callable[..., Any], kind: Kind) -> Any:
    functions.register_scalars()
    function = _WRAPPERS[kind.name](njit(**functions.OPTIONS)(source))
    signature = types.void(*[types.real] * kind.taken, types.pointer, types.pointer)
    compiled: Any = CFunc(function, (signature.args, signature.return_type), {}, dict(functions.OPTIONS))
    with suppress(NotDigestible):  # it is then compiled in each process
        compiled._cache = CodeCache(kind.name, digest(function, functions.REPLACED))
    compiled.compile()
    return compiled


def _forces_in_c(inner: Callable[..., Any]) -> Callable[..., Any]:
    most = MOST_COEFFICIENTS

    def forces(delta, delta_dot, approach_speed, coefficients, written):  # type: ignore[no-untyped-def]
        static, dissipative = inner(delta, delta_dot, approach_speed, carray(coefficients, (most,)))
        both = carray(written, (2,))
        both[0] = static
        both[1] = dissipative

    return forces


def _energies_in_c(inner: Callable[..., Any]) -> Callable[..., Any]:
    most = MOST_COEFFICIENTS

    def energies(delta, coefficients, written):  # type: ignore[no-untyped-def]
        elastic, plastic = inner(delta, carray(coefficients, (most,)))
        both = carray(written, (2,))
        both[0] = elastic
        both[1] = plastic

    return energies


def _levels_in_c(inner: Callable[..., Any]) -> Callable[..., Any]:
    most = MOST_COEFFICIENTS

    def levels(coefficients, written):  # type: ignore[no-untyped-def]
        touch, release, memory, first, second = inner(carray(coefficients, (most,)))
        five = carray(written, (5,))
        five[0] = touch
        five[1] = release
        five[2] = memory
        five[3] = first
        five[4] = second

    return levels


def _compressed_in_c(inner: Callable[..., Any]) -> Callable[..., Any]:
    most = MOST_COEFFICIENTS

    def compressed(deepest, coefficients, written):  # type: ignore[no-untyped-def]
        inner(deepest, carray(coefficients, (most,)), carray(written, (most,)))

    return compressed


_WRAPPERS: dict[str, Callable[..., Any]] = {
    "forces": _forces_in_c,
    "energies": _energies_in_c,
    "levels": _levels_in_c,
    "compressed": _compressed_in_c,
}
