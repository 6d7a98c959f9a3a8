"""A compact list of records: 8 bytes a number, where a small array takes 120."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any, Generic, NamedTuple, TypeVar, overload

import numpy as np

from vibroimpact.arrays import Floats

Item = TypeVar("Item")

# last records that are kept unpacked: packing those of a short run would take a tenth of its time
_UNPACKED = 32


class PackedList(Sequence[Item], Generic[Item]):
    """List of records of dataclasses, lists, tuples and arrays, which it stores packed.

    All but the last ones are rebuilt on access.

    Numbers are restored exactly (integers up to 2^53).

    Parameters
    ----------
    *shared : type
        Dataclasses that many records share; their instances are kept by reference.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass
    ... class Point:
    ...     name: str
    ...     place: np.ndarray
    >>> points = PackedList[Point]()
    >>> points.append(Point("a", np.array([1.0, 2.0])))
    >>> len(points), points[0]
    (1, Point(name='a', place=array([1., 2.])))
    """

    def __init__(self, *shared: type) -> None:
        self._shared = shared
        self._numbers, self._starts = array("d"), array("q", [0])
        self._forms: list[_Form] = []
        self._known: dict[_Form, _Form] = {}  # equal forms are stored once
        self._last: list[Item] = []

    def append(self, item: Item) -> None:
        """Add a record at the end."""
        self._last.append(item)
        if len(self._last) > _UNPACKED:
            form = self._split(self._last.pop(0))
            self._forms.append(self._known.setdefault(form, form))
            self._starts.append(len(self._numbers))

    def __len__(self) -> int:
        return len(self._forms) + len(self._last)

    @overload
    def __getitem__(self, index: int) -> Item: ...

    @overload
    def __getitem__(self, index: slice) -> list[Item]: ...

    def __getitem__(self, index: int | slice) -> Item | list[Item]:
        if isinstance(index, slice):
            return [self[number] for number in range(*index.indices(len(self)))]
        number = range(len(self))[index]
        if number >= len(self._forms):
            return self._last[number - len(self._forms)]
        numbers = np.frombuffer(self._numbers[self._starts[number] : self._starts[number + 1]])
        item: Item = _Reader(numbers).joined(self._forms[number])
        return item

    def _split(self, value: Any) -> _Form:
        """Append the numbers of a value to the buffer, and return its structure."""
        if isinstance(value, np.ndarray):
            self._numbers.frombytes(value.astype(np.float64).tobytes())
            return _Array(value.dtype.str, value.shape, value.size)
        if type(value) is float:
            self._numbers.append(value)
            return _FLOAT
        if isinstance(value, (list, tuple)):
            return _Row(type(value), tuple([self._split(part) for part in value]))
        if is_dataclass(value) and not isinstance(value, (type, *self._shared)):
            kind: Any = type(value)
            return _Record(
                kind, tuple([self._split(getattr(value, name)) for name in _names(kind)])
            )
        return _Same(value)


class _Array(NamedTuple):
    kind: str
    shape: tuple[int, ...]
    size: int


class _Row(NamedTuple):
    kind: type
    parts: tuple[_Form, ...]


class _Record(NamedTuple):
    kind: type
    parts: tuple[_Form, ...]


class _Same:
    """A value kept by reference; equal only to the same object."""

    def __init__(self, value: object) -> None:
        self.value = value

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self.value is other.value

    def __hash__(self) -> int:
        return id(self.value)


_FLOAT = _Same(float)
_Form = _Array | _Row | _Record | _Same


class _Reader:
    """Rebuilds values from their structures and the buffer, in the order of packing."""

    def __init__(self, numbers: Floats) -> None:
        self.numbers, self.at = numbers, 0

    def joined(self, form: _Form) -> Any:
        """Return the value with a given structure."""
        if isinstance(form, _Array):
            self.at += form.size
            return self.numbers[self.at - form.size : self.at].astype(form.kind).reshape(form.shape)
        if form is _FLOAT:
            self.at += 1
            return float(self.numbers[self.at - 1])
        if isinstance(form, _Same):
            return form.value
        if isinstance(form, _Row):
            return form.kind([self.joined(part) for part in form.parts])
        made: Any = object.__new__(form.kind)  # without __init__: the values were validated before
        for name, part in zip(_names(form.kind), form.parts, strict=True):
            object.__setattr__(made, name, self.joined(part))
        return made


@cache
def _names(kind: Any) -> tuple[str, ...]:
    return tuple(item.name for item in fields(kind))
