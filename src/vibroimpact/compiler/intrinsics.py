"""Functions that numba inserts as machine instructions."""

from __future__ import annotations

from typing import Any

from numba.core import cgutils
from numba.extending import intrinsic

from vibroimpact.compiler import types


def _function_of_address(kind: Any) -> Any:
    """Return an intrinsic function that makes a function value of a kind from an address."""

    @intrinsic  # type: ignore[untyped-decorator]
    def of_address(typing_context: Any, address: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            pointer = builder.inttoptr(arguments[0], cgutils.voidptr_t)
            value = cgutils.create_struct_proxy(kind)(context, builder)
            value.jit_addr = pointer
            value.c_addr = pointer  # not called where there is the other
            return value._getvalue()

        return kind(types.integer), generate

    return of_address


force_of_address = _function_of_address(types.force)
energies_of_address = _function_of_address(types.energies)
levels_of_address = _function_of_address(types.levels)
compressed_of_address = _function_of_address(types.compressed)
