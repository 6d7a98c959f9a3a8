"""The force of a contact law as a C function, which compiled code calls by its address. Loading this module loads numba.

One compiled core thus serves all laws, and takes a law as a number: a function as an argument would cost some 30 us a call from Python.
"""

from __future__ import annotations

import ctypes
import warnings
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from llvmlite import ir
from numba import carray, njit
from numba.core.ccallback import CFunc
from numba.core.errors import NumbaError
from numba.extending import intrinsic

from vibroimpact.compiler import functions, types
from vibroimpact.compiler.code_cache import CodeCache
from vibroimpact.compiler.digest import NotDigestible, digest
from vibroimpact.compiler.forces import MOST_COEFFICIENTS, interpreted_force
from vibroimpact.errors import SlowLawWarning

_SIGNATURE = types.void(types.real, types.real, types.real, types.pointer, types.pointer)
_CALLBACK = ctypes.CFUNCTYPE(None, *[ctypes.c_double] * 3, *[ctypes.POINTER(ctypes.c_double)] * 2)

_KEPT: dict[Any, Any] = {}
"""The C functions of this process, by the Python functions that they were made from."""


@intrinsic
def evaluate(typing, law, delta, delta_dot, approach_speed, coefficients, forces):  # type: ignore[no-untyped-def]
    """Write the static and the dissipative force of the law at an address into `forces`."""
    signature = types.void(types.integer, types.real, types.real, types.real, coefficients, forces)

    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        number = ir.DoubleType()
        pointer = number.as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [number, number, number, pointer, pointer])
        function = builder.inttoptr(arguments[0], kind.as_pointer())
        arrays = [context.make_array(signature.args[index])(context, builder, arguments[index]).data for index in (4, 5)]
        builder.call(function, [*arguments[1:4], *arrays])
        return context.get_dummy_value()

    return signature, generate


def force_address(law_class: type[Any]) -> int:
    """Return the address of the force of a law: of compiled code, or of a call of Python where the law can't be compiled."""
    source = interpreted_force(law_class)
    if source not in _KEPT:
        _KEPT[source] = _compiled_or_called(source, law_class)
    kept = _KEPT[source]
    address = kept.address if isinstance(kept, CFunc) else ctypes.cast(kept, ctypes.c_void_p).value
    return int(address or 0)


def _compiled_or_called(source: Callable[..., Any], law_class: type[Any]) -> Any:
    if law_class.scalar_forces is not None:
        try:
            return _compiled(source)
        except NumbaError as error:
            reason = str(error).splitlines()[0]
    else:
        reason = "it has no force of floats, `scalar_forces`"
    name = getattr(law_class, "name", law_class.__name__)
    warnings.warn(SlowLawWarning(f"the law {name} is not compiled: {reason}; each of its forces takes longer"), stacklevel=4)

    def call(delta, delta_dot, approach_speed, coefficients, forces):  # type: ignore[no-untyped-def]
        forces[0], forces[1] = source(delta, delta_dot, approach_speed, coefficients)

    return _CALLBACK(call)


def _compiled(source: Callable[..., Any]) -> Any:
    functions.register_scalars()
    inner = njit(**functions.OPTIONS)(source)
    most = MOST_COEFFICIENTS

    def force(delta, delta_dot, approach_speed, coefficients, forces):  # type: ignore[no-untyped-def]
        static, dissipative = inner(delta, delta_dot, approach_speed, carray(coefficients, (most,)))
        both = carray(forces, (2,))
        both[0] = static
        both[1] = dissipative

    found: Any = CFunc(force, (_SIGNATURE.args, _SIGNATURE.return_type), {}, dict(functions.OPTIONS))
    with suppress(NotDigestible):  # it is then compiled in each process
        found._cache = CodeCache(source.__name__, digest(force, functions.REPLACED))
    found.compile()
    return found
