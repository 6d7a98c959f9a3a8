"""A document with arrays in one block of bytes, as pages and the live page read it: a header in
JSON, and the arrays after it.

The first four bytes are the length of the header (unsigned, little-endian). The header is the
document, where an array is replaced by `{"$": [type, offset, length]}`: `f4`, `f8` or `i4`, the
offset in bytes from the end of the header, and the number of values; an array of several dimensions
has its number of columns as a fourth entry. Evenly spaced values are `{"$": ["even", first, step,
length]}`. Header and arrays are padded to eight bytes. A long list of texts is `["texts", offset,
bytes]`, itself in JSON. An array or such a list that occurs several times is stored once.
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
"""Texts from which on a list of them is kept apart, as the points of several charts may
have the same.
"""

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
    blocks: list[bytes] = []
    known: dict[int, dict[str, Any]] = {}
    lists: dict[tuple[str, ...], dict[str, Any]] = {}
    kept: list[Any] = []  # an array must live as long as its identity is used
    end = 0

    def added(block: bytes) -> int:
        """Add a block of bytes, and return where it begins."""
        nonlocal end
        first = end
        blocks.append(block + bytes(-len(block) % _ALIGNED))
        end += len(blocks[-1])
        return first

    def stored(array: NDArray[Any]) -> dict[str, Any]:
        if id(array) not in known:
            kept.append(array)
            even = _even(array)
            if even is None:
                data = _narrowed(array)
                shape = [array.size] if array.ndim == 1 else [array.size, array.shape[-1]]
                known[id(array)] = {"$": [data.dtype.str[1:], added(data.tobytes()), *shape]}
            else:
                known[id(array)] = {"$": ["even", *even, array.size]}
        return known[id(array)]

    def texts(found: tuple[str, ...]) -> dict[str, Any]:
        if found not in lists:
            block = json.dumps(found, ensure_ascii=False, separators=(",", ":")).encode()
            lists[found] = {"$": ["texts", added(block), len(block)]}
        return lists[found]

    def plain(part: Any) -> Any:
        if isinstance(part, np.ndarray):
            return stored(part)
        if isinstance(part, dict):
            return {key: plain(value) for key, value in part.items()}
        if isinstance(part, list | tuple):
            if len(part) >= _LONG and all(isinstance(one, str) for one in part):
                return texts(tuple(part))
            return [plain(one) for one in part]
        if isinstance(part, np.generic):
            part = part.item()
        return None if isinstance(part, float) and not math.isfinite(part) else part

    header = json.dumps(
        plain(document), ensure_ascii=False, separators=(",", ":"), allow_nan=False
    ).encode()
    header += b" " * (-(len(header) + 4) % _ALIGNED)
    return struct.pack("<I", len(header)) + header + b"".join(blocks)


def unpack(block: bytes) -> Any:
    """Return the document that `pack` returned as bytes; an array of more than two dimensions has
    its last one as columns.

    Raises
    ------
    ValueError
        If the bytes are damaged.

    Examples
    --------
    >>> found = unpack(pack({"time": np.linspace(0.0, 1.0, 5), "force": np.array([0.0, 2.5])}))
    >>> found["time"].tolist(), found["force"].tolist()
    ([0.0, 0.25, 0.5, 0.75, 1.0], [0.0, 2.5])
    """
    try:
        return _unpacked(block)
    except (struct.error, KeyError, TypeError, IndexError, OverflowError) as error:
        raise ValueError(f"the chart is damaged ({error})") from None


def _unpacked(block: bytes) -> Any:
    (length,) = struct.unpack_from("<I", block)
    begin = struct.calcsize("<I") + length
    known: dict[str, Any] = {}

    def array(kind: str, first: float, second: float, *more: int) -> Any:
        if kind == "texts":
            return parse_json(block[begin + int(first) : begin + int(first) + int(second)])
        if kind == "even":
            if more[0] > _MOST_STEPS:
                raise ValueError("the chart is damaged")
            return np.asarray(first + second * np.arange(more[0]))
        values = np.frombuffer(block, f"<{kind}", count=int(second), offset=begin + int(first))
        return values.reshape(-1, *more) if more and len(values) else values

    def filled(part: Any) -> Any:
        if isinstance(part, list):
            return [filled(one) for one in part]
        if not isinstance(part, dict):
            return part
        if not isinstance(part.get("$"), list):
            return {key: filled(value) for key, value in part.items()}
        key = json.dumps(part["$"])
        if key not in known:
            known[key] = array(*part["$"])
        return known[key]  # what was stored once is one array again

    return filled(parse_json(block[struct.calcsize("<I") : begin]))


def _even(array: NDArray[Any]) -> tuple[float, float] | None:
    """Return the first value and the step of evenly spaced values; None if they are not."""
    if array.ndim != 1 or len(array) < 3 or array.dtype.kind != "f" or not np.isfinite(array).all():
        return None
    first, step = float(array[0]), float(array[-1] - array[0]) / (len(array) - 1)
    if (
        not (math.isfinite(step) and step)
        or abs(float(array[1] - array[0]) - step) > _EVEN * abs(step) * 1e3
    ):
        return None
    off = np.abs(array - (first + step * np.arange(len(array))))
    return (
        (first, step)
        if float(off.max()) <= max(_EVEN * abs(step), 1e-15 * abs(float(array[-1])))
        else None
    )


def _narrowed(array: NDArray[Any]) -> NDArray[Any]:
    """Return an array in the shortest type that keeps its values apart."""
    if array.dtype.kind in "iub":
        return np.ascontiguousarray(array, dtype="<i4")
    single = np.ascontiguousarray(array, dtype="<f4")
    is_row = array.ndim == 1 and array.dtype == np.float64 and bool(np.isfinite(array).all())
    steps = np.diff(array) if is_row else np.empty(0)
    ascends = len(steps) > 0 and bool((steps >= 0.0).all())
    # ascending values are places, whose differences are looked at: of these a thousandth must be
    # kept
    fine = ascends and float(np.abs(single - array).max()) > 1e-3 * float(
        steps[steps > 0.0].min(initial=np.inf)
    )
    return np.ascontiguousarray(array, dtype="<f8") if fine else single
