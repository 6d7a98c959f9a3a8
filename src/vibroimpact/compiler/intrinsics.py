"""Functions that numba inserts as machine instructions."""

from __future__ import annotations

from typing import Any

from numba.core import cgutils
from numba.extending import intrinsic

from vibroimpact.compiler import types


@intrinsic  # type: ignore[untyped-decorator]
def force_of_address(typing_context: Any, address: Any) -> Any:
    """Return the function value at an address."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pointer = builder.inttoptr(arguments[0], cgutils.voidptr_t)
        value = cgutils.create_struct_proxy(types.force)(context, builder)
        value.jit_addr = pointer
        value.c_addr = pointer  # not called where there is the other
        return value._getvalue()

    return types.force(types.integer), generate
