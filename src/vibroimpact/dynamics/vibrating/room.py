"""Room for what the core writes, in named tuples of arrays: more of it, or only what is written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np

_Room = TypeVar("_Room", bound=NamedTuple)


def with_more_room(room: _Room) -> _Room:
    """Return what is written with room for twice as much.

    All arrays grow along their first axis, but `written`, which counts.
    """
    arrays: dict[str, Any] = {}
    for name, values in room._asdict().items():
        grown = values
        if name != "written":
            grown = np.concatenate([values, np.empty_like(values)])
        arrays[name] = grown
    return room._replace(**arrays)


def written_of(room: _Room, counted: Mapping[int, Sequence[str]], others: int) -> _Room:
    """Return copies of what is written, without the room behind it.

    Parameters
    ----------
    room : named tuple of arrays
        The room; `written` counts.
    counted : mapping of int to sequence of str
        The places of `written`, each with the arrays that it counts the entries of.
    others : int
        The place that counts those of all other arrays.
    """
    place_of = {name: place for place, names in counted.items() for name in names}
    arrays: dict[str, Any] = {}
    for name, values in room._asdict().items():
        kept = values
        if name != "written":
            kept = values[: room.written[place_of.get(name, others)]]  # type: ignore[attr-defined]
        arrays[name] = kept.copy()
    return room._replace(**arrays)
