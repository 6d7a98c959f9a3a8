"""A document with arrays in one block of bytes, as pages and the live page read it.

It is a header in JSON, and the arrays after it. The first four bytes are the length of the header
(unsigned, little-endian). The header is the document, where an array is replaced by `{"$": [type,
offset, length]}`: `f4`, `f8` or `i4`, the offset in bytes from the end of the header, and the
number of values; an array of several dimensions has its number of columns as a fourth entry. `p4`
and `p8` are `f4` and `f8` by planes: the first bytes of all values, then the second ones, and so
on, which compresses to three quarters and less. Evenly spaced values are `{"$": ["even", first,
step, length]}`. Header and arrays are padded to eight bytes. A long list of texts is `["texts",
offset, bytes]`, itself in JSON. An array or such a list that occurs several times is stored once.
"""

from __future__ import annotations

import json
import math
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.files.json_reading import parse_json

_ALIGNED = 8
_LONG = 32
"""Texts from which on a list of them is kept apart.

The points of several charts may have the same.
"""

_PLANES = {"p4": "f4", "p8": "f8"}
"""Types of arrays by planes, and the types of their values."""

_MANY = 500
"""Values from which on an array is stored by planes."""

_MOST_STEPS = 100_000_000
"""Evenly spaced values of one array."""

_EVEN = 1e-9
"""Largest deviation of evenly spaced values from equal steps, in steps."""


def pack(document: Any) -> bytes:
    """Return a document of dictionaries, lists, texts, numbers and arrays as bytes.

    Values that single precision can't tell apart, such as the times of a contact late in a run, are
    stored in double precision, all others in single precision. NaN outside of arrays is null.

    Examples
    --------
    >>> block = pack({"time": np.linspace(0.0, 1.0, 5), "force": np.array([0.0, 2.5])})
    >>> length = int.from_bytes(block[:4], "little")
    >>> json.loads(block[4 : 4 + length])
    {'time': {'$': ['even', 0.0, 0.25, 5]}, 'force': {'$': ['f4', 0, 2]}}
    """
    return _Packing().packed(document)


class _Packing:
    """A document while it is packed: the blocks after the header, and what is stored in them."""

    def __init__(self) -> None:
        self.blocks: list[bytes] = []
        self.end = 0
        # references by the identity of an array, which must live as long as that is used
        self.arrays: dict[int, tuple[NDArray[Any], dict[str, Any]]] = {}
        self.texts: dict[tuple[str, ...], dict[str, Any]] = {}

    def packed(self, document: Any) -> bytes:
        """Return a document as bytes."""
        header = json.dumps(
            self._plain(document), ensure_ascii=False, separators=(",", ":"), allow_nan=False
        ).encode()
        header += b" " * (-(len(header) + 4) % _ALIGNED)
        return struct.pack("<I", len(header)) + header + b"".join(self.blocks)

    def _plain(self, part: Any) -> Any:
        """Return a part of the document with references in place of arrays and long lists."""
        if isinstance(part, np.ndarray):
            return self._array(part)
        if isinstance(part, dict):
            return {key: self._plain(value) for key, value in part.items()}
        if isinstance(part, list | tuple):
            if len(part) >= _LONG and all(isinstance(item, str) for item in part):
                return self._text_list(tuple(part))
            return [self._plain(item) for item in part]
        if isinstance(part, np.generic):
            part = part.item()
        if isinstance(part, float) and not math.isfinite(part):
            return None  # JSON has no such numbers
        return part

    def _array(self, array: NDArray[Any]) -> dict[str, Any]:
        """Return the reference to an array, which is stored if it is new."""
        if id(array) not in self.arrays:
            even = _even(array)
            if even is None:
                data = _narrowed(array)
                kind = data.dtype.str[1:]
                block = data.tobytes()
                if array.size >= _MANY and kind in _PLANES.values():
                    size = data.itemsize
                    kind = f"p{size}"
                    by_value = np.frombuffer(block, dtype=np.uint8).reshape(-1, size)
                    block = by_value.T.tobytes()
                entry = [kind, self._add(block), array.size]
                if array.ndim > 1:
                    entry.append(array.shape[-1])
            else:
                first, step = even
                entry = ["even", first, step, array.size]
            self.arrays[id(array)] = (array, {"$": entry})
        _, reference = self.arrays[id(array)]
        return reference

    def _text_list(self, texts: tuple[str, ...]) -> dict[str, Any]:
        """Return the reference to a list of texts, which is stored if it is new."""
        if texts not in self.texts:
            block = json.dumps(texts, ensure_ascii=False, separators=(",", ":")).encode()
            self.texts[texts] = {"$": ["texts", self._add(block), len(block)]}
        return self.texts[texts]

    def _add(self, block: bytes) -> int:
        """Add a block of bytes, and return where it begins."""
        start = self.end
        padded = block + bytes(-len(block) % _ALIGNED)
        self.blocks.append(padded)
        self.end += len(padded)
        return start


def unpack(block: bytes) -> Any:
    """Return the document that `pack` returned as bytes.

    An array of more than two dimensions has its last one as columns.

    Raises
    ------
    ValueError
        If the bytes are damaged.

    Examples
    --------
    >>> document = unpack(pack({"time": np.linspace(0.0, 1.0, 5), "force": np.array([0.0, 2.5])}))
    >>> document["time"].tolist(), document["force"].tolist()
    ([0.0, 0.25, 0.5, 0.75, 1.0], [0.0, 2.5])
    """
    try:
        return _unpacked(block)
    except (struct.error, KeyError, TypeError, IndexError, OverflowError) as error:
        raise ValueError(f"the chart is damaged ({error})") from None


def _unpacked(block: bytes) -> Any:
    (header_length,) = struct.unpack_from("<I", block)
    header_start = struct.calcsize("<I")
    data_start = header_start + header_length
    known: dict[str, Any] = {}

    def filled(part: Any) -> Any:
        """Return a part of the document with arrays and lists in place of references."""
        if isinstance(part, list):
            return [filled(item) for item in part]
        if not isinstance(part, dict):
            return part
        if not isinstance(part.get("$"), list):
            return {key: filled(value) for key, value in part.items()}
        key = json.dumps(part["$"])
        if key not in known:
            known[key] = _stored(block, data_start, *part["$"])
        return known[key]  # what was stored once is one array again

    return filled(parse_json(block[header_start:data_start]))


def _stored(
    block: bytes, data_start: int, kind: str, first: float, second: float, *more: int
) -> Any:
    """Return the array or the list of texts that a reference stands for.

    The numbers of a reference are those of its kind: offset and length, or first value and step.
    """
    if kind == "even":
        if more[0] > _MOST_STEPS:
            raise ValueError("the chart is damaged")
        return np.asarray(first + second * np.arange(more[0]))
    start = data_start + int(first)
    length = int(second)
    if kind == "texts":
        return parse_json(block[start : start + length])
    if kind in _PLANES:
        size = int(kind[1:])
        planes = np.frombuffer(block, np.uint8, count=size * length, offset=start)
        block = planes.reshape(size, length).T.tobytes()
        kind = _PLANES[kind]
        start = 0
    values = np.frombuffer(block, f"<{kind}", count=length, offset=start)
    if more and len(values):
        return values.reshape(-1, *more)
    return values


def _even(array: NDArray[Any]) -> tuple[float, float] | None:
    """Return the first value and the step of evenly spaced values; None if they are not."""
    if array.ndim != 1 or len(array) < 3:
        return None
    if array.dtype.kind != "f" or not np.isfinite(array).all():
        return None
    first = float(array[0])
    step = float(array[-1] - array[0]) / (len(array) - 1)
    if not math.isfinite(step) or not step:
        return None
    # most arrays differ at the first step already
    if abs(float(array[1] - array[0]) - step) > _EVEN * abs(step) * 1e3:
        return None
    even = first + step * np.arange(len(array))
    deviation = float(np.abs(array - even).max())
    rounding = 1e-15 * abs(float(array[-1]))
    if deviation <= max(_EVEN * abs(step), rounding):
        return first, step
    return None


def _narrowed(array: NDArray[Any]) -> NDArray[Any]:
    """Return an array in the shortest type that keeps its values apart."""
    if array.dtype.kind in "iub":
        return np.ascontiguousarray(array, dtype="<i4")
    single = np.ascontiguousarray(array, dtype="<f4")
    if array.ndim != 1 or array.dtype != np.float64 or not np.isfinite(array).all():
        return single
    # ascending values are positions, whose differences are looked at: of these a thousandth must be
    # kept
    steps = np.diff(array)
    if len(steps) == 0 or not (steps >= 0.0).all():
        return single
    smallest_step = float(steps[steps > 0.0].min(initial=np.inf))
    if float(np.abs(single - array).max()) > 1e-3 * smallest_step:
        return np.ascontiguousarray(array, dtype="<f8")
    return single
