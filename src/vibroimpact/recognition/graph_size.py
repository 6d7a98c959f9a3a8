"""What a model's file would take in memory once it is parsed, estimated from its bytes: a
table of two bytes becomes one of eighty.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from vibroimpact.errors import InputError

_MOST_PARTS = 200_000
"""Tables of a graph, down to the attributes of its nodes."""

_MOST_OTHER_BYTES = 4_000_000
"""Bytes beside lists of numbers and of short texts, which grow little."""

_GRAPH = 7
_NODE = 1
_ATTRIBUTE = 5
"""Numbers of the fields of the format: the graph of a model, a node of a graph, an
attribute of a node.
"""

_LISTS = re.compile(
    rb"(?:\x3d.{4}|\x40[\x80-\xff]{0,9}[\x00-\x7f]|\x4a\x0aBRANCH_LEQ|\x4a\x04LEAF)+", re.DOTALL
)
"""Elements of the lists of an attribute: real numbers, whole numbers, and the modes of
the nodes of trees.
"""


def check_size(data: bytes) -> None:
    """Raise InputError if the bytes of an ONNX model would grow beyond some hundred
    megabytes as they are parsed, or are cut short.
    """
    parts = 0
    lists = 0
    for graph in _fields(data, 0, len(data), _GRAPH):
        for node in _fields(data, *graph, _NODE):
            for start, end in _fields(data, *node, _ATTRIBUTE):
                lists += sum(
                    match.end() - match.start() for match in _LISTS.finditer(data, start, end)
                )
                parts += 1
            parts += 1
            if parts > _MOST_PARTS:
                raise InputError(
                    f"the graph has more than {_MOST_PARTS:,} nodes and attributes; no "
                    "model of this program has so many"
                )
    if len(data) - lists > _MOST_OTHER_BYTES:
        raise InputError(
            f"the graph has more than {_MOST_OTHER_BYTES // 1_000_000} MB beside its "
            "numbers; no model of this program has so much"
        )


def _fields(data: bytes, start: int, end: int, wanted: int) -> Iterator[tuple[int, int]]:
    """Yield the places of the tables in the fields of one number, of the fields from
    `start` to `end`.
    """
    place = start
    for _ in range(_MOST_PARTS):
        if place >= end:
            return
        tag, place = _whole_number(data, place)
        kind = tag & 7
        if kind == 2:
            length, place = _whole_number(data, place)
            if place + length > end:
                raise _cut_short()
            if tag >> 3 == wanted:
                yield place, place + length
            place += length
        elif kind == 0:
            _, place = _whole_number(data, place)
        elif kind in (1, 5):
            place += 8 if kind == 1 else 4
        else:
            raise _cut_short()
    raise InputError(
        f"the graph has a table of {_MOST_PARTS:,} fields or more; no model of this "
        "program has so many"
    )


def _whole_number(data: bytes, place: int) -> tuple[int, int]:
    """Return the whole number at a place, of seven bits a byte, and the place after it."""
    number = 0
    for shift in range(0, 70, 7):
        if place >= len(data):
            raise _cut_short()
        byte = data[place]
        place += 1
        number |= (byte & 0x7F) << shift
        if byte < 0x80:
            return number, place
    raise _cut_short()


def _cut_short() -> InputError:
    return InputError("the graph is damaged: it is no model in ONNX")
