"""Named tuples that compiled functions lend each other.

Numba hands a tuple over element by element: one with the arrays of a drop takes a thousand
arguments, and the references of each array are counted at every call. To compile that took most of
all time. Here a function gets the address of the tuple, and reads of it what it uses when it
begins. Whoever lends holds the tuple until the call has ended.

From Python a tuple is packed into bytes as compiled code lays it out. Parts of its arrays must not
be returned, since compiled code does not know who holds them.
"""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Callable
from operator import attrgetter
from typing import Any, NoReturn

import numpy as np
from llvmlite import ir
from numba import _helperlib
from numba.core import cgutils, types
from numba.core.datamodel import models
from numba.core.imputils import impl_ret_borrowed
from numba.core.typeconv import Conversion
from numba.core.types.containers import BaseNamedTuple
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import NativeValue, lower_cast, lower_getattr_generic, register_model, unbox

_WORD = 8  # bytes
_ALIGNED = "0q"  # in a format of `struct`: what follows begins where eight bytes may

_FORMATS = {types.float64: "d", types.int64: "q", types.boolean: "?"}
"""Formats of numbers in `struct`, by their types."""

_DTYPES = {
    types.float64: np.dtype(np.float64).num,
    types.int64: np.dtype(np.int64).num,
    types.boolean: np.dtype(np.bool_).num,
    types.complex128: np.dtype(np.complex128).num,
}
"""NumPy's numbers of the types of elements."""

# writes what numba keeps of an array to an address
_describe = ctypes.PYFUNCTYPE(ctypes.c_int, ctypes.py_object, ctypes.c_void_p)(
    _helperlib.c_helpers["adapt_ndarray"]  # type: ignore[attr-defined]
)


class Lent(types.Type):
    """The type of a named tuple that is lent; `kind`: that of the tuple."""

    def __init__(self, kind: Any) -> None:
        self.kind = kind
        super().__init__(name=f"lent {kind.name}")

    @property
    def key(self) -> Any:
        """What tells it from others."""
        return self.kind

    def __unliteral__(self) -> Any:
        """Return what it is as a member of another tuple: the tuple itself."""
        return self.kind

    def can_convert_from(self, context: Any, other: Any) -> Any:
        """Return how a tuple becomes one that is lent."""
        return Conversion.safe if other == self.kind else None

    def can_convert_to(self, context: Any, other: Any) -> Any:
        """Return how it becomes a tuple of one's own."""
        return Conversion.safe if other == self.kind else None

    def unify(self, context: Any, other: Any) -> Any:
        """Return the type of what is either this or the tuple."""
        return self.kind if other == self.kind else None


def has_arrays(kind: Any) -> bool:
    """Is a type that of a named tuple with arrays?"""
    if not isinstance(kind, BaseNamedTuple):
        return False
    return any(isinstance(member, types.Array) or has_arrays(member) for member in kind.types)


def lent_to(signature: Any) -> Any:
    """Return the signature of a function to which tuples with arrays are lent."""
    arguments = []
    for kind in signature.args:
        argument = Lent(kind) if has_arrays(kind) else kind
        arguments.append(argument)
    return signature.return_type(*arguments)


@register_model(Lent)
class _LentModel(models.PrimitiveModel):  # type: ignore[misc]
    """It is the address of the tuple."""

    def __init__(self, manager: Any, lent: Lent) -> None:
        super().__init__(manager, lent, manager[lent.kind].get_value_type().as_pointer())


@infer_getattr
class _LentAttributes(AttributeTemplate):  # type: ignore[misc]
    key = Lent

    def generic_resolve(self, lent: Lent, name: str) -> Any:
        """Return the type of a member."""
        kind = lent.kind
        if name not in kind.fields:
            return None
        return _member(kind, kind.fields.index(name))


def _member(kind: Any, index: int) -> Any:
    """Return the type of a member of a lent tuple: tuples with arrays are lent, too."""
    member = kind.types[index]
    return Lent(member) if has_arrays(member) else member


@lower_getattr_generic(Lent)  # type: ignore[untyped-decorator]
def _read_member(context: Any, builder: Any, lent: Lent, pointer: Any, name: str) -> Any:
    """Read a member of a lent tuple, at the start of the function if that was handed to it.

    There the compiler knows that nothing has been written since, and keeps what it has read.
    """
    index = lent.kind.fields.index(name)
    member = _member(lent.kind, index)
    if _is_known_at_start(builder, pointer):
        with builder.goto_entry_block():
            value = _load(builder, pointer, index, member)
    else:
        value = _load(builder, pointer, index, member)
    return impl_ret_borrowed(context, builder, member, value)


def _load(builder: Any, pointer: Any, index: int, member: Any) -> Any:
    address = cgutils.gep_inbounds(builder, pointer, 0, index)
    if isinstance(member, Lent):
        return address
    return builder.load(address)


def _is_known_at_start(builder: Any, pointer: Any) -> bool:
    """Is an address an argument of the function, or was it made of one at the start?"""
    if isinstance(pointer, ir.Argument):
        return True
    is_made_at_start = getattr(pointer, "parent", None) is builder.function.entry_basic_block
    return isinstance(pointer, ir.GEPInstr) and is_made_at_start


@lower_cast(BaseNamedTuple, Lent)  # type: ignore[untyped-decorator]
def _lend(context: Any, builder: Any, kind: Any, lent: Lent, value: Any) -> Any:
    """Lend a tuple: its value is written to the stack."""
    with builder.goto_entry_block():
        pointer = builder.alloca(value.type)
    builder.store(value, pointer)
    return pointer


@lower_cast(Lent, BaseNamedTuple)  # type: ignore[untyped-decorator]
def _take(context: Any, builder: Any, lent: Lent, kind: Any, pointer: Any) -> Any:
    """Make a tuple of one's own from one that is lent."""
    return builder.load(pointer)


@unbox(Lent)  # type: ignore[untyped-decorator]
def _from_address(lent: Lent, number: Any, c: Any) -> Any:
    """Take the address of a packed tuple from Python."""
    pointer = c.pyapi.long_as_voidptr(number)
    pointer = c.builder.bitcast(pointer, c.context.get_value_type(lent))
    return NativeValue(pointer, is_error=cgutils.is_not_null(c.builder, c.pyapi.err_occurred()))


class Packing:
    """How a named tuple is laid out in memory.

    Parameters
    ----------
    kind : numba's type
        That of the tuple.
    """

    def __init__(self, kind: Any) -> None:
        self._format = "@"
        self._numbers: list[str] = []
        self._arrays: list[str] = []
        self._offsets: list[int] = []
        self._kinds: list[tuple[int, int, bool]] = []
        self._append(kind, "")
        self._struct = struct.Struct(self._format)
        self._numbers_of = _getter(self._numbers)
        self._arrays_of = _getter(self._arrays)
        self._packed_for_good: dict[int, tuple[Any, np.ndarray[Any, Any]]] = {}

    def _append(self, kind: Any, name: str) -> None:
        """Append a type to the format. Tuples and arrays are aligned as eight bytes are."""
        if isinstance(kind, types.Array):
            self._format += _ALIGNED
            self._offsets.append(struct.calcsize(self._format))
            self._kinds.append((_DTYPES[kind.dtype], kind.ndim, True))
            self._arrays.append(name)
            self._format += f"{_WORD * (5 + 2 * kind.ndim)}x"
        elif isinstance(kind, BaseNamedTuple):
            self._format += _ALIGNED
            for field, member in zip(kind.fields, kind.types, strict=True):
                path = f"{name}.{field}" if name else field
                self._append(member, path)
            self._format += _ALIGNED
        else:
            self._numbers.append(name)
            self._format += _FORMATS[kind]

    def pack(self, values: Any) -> np.ndarray[Any, Any]:
        """Return the bytes of a tuple, which must be kept with it as long as these are used.

        A tuple that says that it `is_constant` is packed once and kept for good.
        """
        if id(values) in self._packed_for_good:
            return self._packed_for_good[id(values)][1]
        content = bytearray(self._struct.pack(*self._numbers_of(values)))
        packed = np.frombuffer(content, dtype=np.uint8)
        arrays = self._arrays_of(values)
        if list(map(_kind_of, arrays)) != self._kinds:  # compiled code would not notice
            self._refuse(arrays)
        start = address_of(packed)
        for array, offset in zip(arrays, self._offsets, strict=True):
            _describe(array, start + offset)
        if getattr(values, "is_constant", False):
            self._packed_for_good[id(values)] = (values, packed)
        return packed

    def _refuse(self, arrays: tuple[np.ndarray[Any, Any], ...]) -> NoReturn:
        for name, array, kind in zip(self._arrays, arrays, self._kinds, strict=True):
            if _kind_of(array) != kind:
                shape = f"an array of {array.dtype} of shape {array.shape}"
                raise TypeError(f"{name} cannot be {shape}, or one with gaps")
        raise AssertionError("all arrays are as they should be")


# the number of the elements' type, the dimensions, and whether there are no gaps
_kind_of = attrgetter("dtype.num", "ndim", "flags.c_contiguous")


def _getter(names: list[str]) -> Callable[[Any], tuple[Any, ...]]:
    """Return a function that takes members, and members of members, from a tuple."""
    if not names:
        return lambda values: ()
    if len(names) == 1:
        take = attrgetter(*names)
        return lambda values: (take(values),)
    return attrgetter(*names)


def address_of(array: np.ndarray[Any, Any]) -> int:
    """Return the address of the elements of an array."""
    return int(array.__array_interface__["data"][0])
