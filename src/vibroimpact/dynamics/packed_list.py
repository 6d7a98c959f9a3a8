"""A growing list of records whose numbers lie in one buffer: there a number takes 8 bytes, and as an array by itself 120."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any, Generic, NamedTuple, TypeVar, overload

import numpy as np

from vibroimpact.arrays import Floats

Item = TypeVar("Item")

_UNPACKED = 32  # records at the end that are kept as they are: to pack the few of a short run takes a tenth of its time


class PackedList(Sequence[Item], Generic[Item]):
    """Records that are made of dataclasses, lists, tuples and arrays of numbers, each made anew when it is asked for but for the last ones.

    The numbers are those that were put in, to the last digit (whole ones up to 2^53).

    Parameters
    ----------
    *shared : type
        Dataclasses that many records refer to: these are kept as they are.

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
        self._known: dict[_Form, _Form] = {}  # forms that are equal are one
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
        """Put the numbers of a value into the buffer; return what else it is."""
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
            return _Record(kind, tuple([self._split(getattr(value, name)) for name in _names(kind)]))
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
    """A value that is kept as it is; equal to another only if that is the same object."""

    def __init__(self, value: object) -> None:
        self.value = value

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self.value is other.value

    def __hash__(self) -> int:
        return id(self.value)


_FLOAT = _Same(float)
_Form = _Array | _Row | _Record | _Same


class _Reader:
    """Makes values of their forms and of numbers, in the order in which they were split."""

    def __init__(self, numbers: Floats) -> None:
        self.numbers, self.at = numbers, 0

    def joined(self, form: _Form) -> Any:
        """Return the value of a form."""
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
        made: Any = object.__new__(form.kind)  # what was checked once is not checked again
        for name, part in zip(_names(form.kind), form.parts, strict=True):
            object.__setattr__(made, name, self.joined(part))
        return made


@cache
def _names(kind: Any) -> tuple[str, ...]:
    return tuple(item.name for item in fields(kind))
