"""The protocol of the live page: what a window asks, and what it is told.

It knows nothing of how messages travel. A window sends texts of JSON with a `type`:

`{"type": "open", "number": 1, "source": "paper:type3"}`
    for the table of a shipped case, or `"text"` in place of `"source"` for that of the text of a
    TOML file;
`{"type": "case", "number": 2, "case": {...}, "detail": "draft", "charts": ["position"]}`
    to compute a case, a table as TOML has it; `"draft"` while it is being changed, `"full"` when it
    stays; with the names of the charts that are looked at, or without them for all;
`{"type": "cancel", "number": 2}`
    to give up the case that is being computed, and the one that waits; reports and signals come
    nevertheless;
`{"type": "report", "number": 2}`, `{"type": "signals", "number": 2}`
    for the report, or the signals as CSV, of the case computed last in full;
`{"type": "export", "number": 2, "format": "lammps"}`
    for it in the format of another program, as by `vibroimpact export`;
`{"type": "figure", "number": 2, "chart": "force", "format": "svg"}`
    for one of its charts as a figure;
`{"type": "overlay", "number": 2}`
    for the measurement that was opened, over what was computed of it;
`{"type": "forget", "number": 2}`
    to close the measurement.

A measurement is opened by a message of bytes: a zero, a line of JSON such as
`{"type": "measurement", "number": 3, "name": "a1.csv"}`, and the content of the file. It is
answered as a message of type `overlay`.

It is told documents with arrays, as `vibroimpact.charts.pack` writes them, each with its `type` and
the `number` asked:

`welcome`
    first of all: shipped cases, laws with their parameters, materials, colours, formats of exports,
    and the `longest` message and `longest_file` that are taken [bytes];
`opened`
    the table of a case, and what of it this page leaves out;
`progress`
    what is being computed, and the part that is done;
`state`
    charts, the plate in motion, tables, the resolved case, the case as TOML; in full detail also
    warnings and signals;
`files`
    each a name, a kind and a text, or `bytes`; and `notes` on what a format can't hold;
`overlay`
    the charts, tables and notes of a measurement over what was computed;
`fault`
    the lines of a message, as the command line gives them;
`cancelled`
    that it was given up.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

from vibroimpact.errors import InputError
from vibroimpact.files.json_reading import parse_json
from vibroimpact.quoting import quoted, shortened

LONGEST = 200_000
"""Largest size of a message from a window that is a text [bytes]."""

LONGEST_FILE = 16_000_000
"""Largest size of a file with a measurement [bytes]."""

_LONGEST_LINE = 2000
"""Largest size of the line ahead of it [bytes]."""

LONGEST_OF_ALL = LONGEST_FILE + _LONGEST_LINE
"""Largest size of any message [bytes]."""

Detail = Literal["draft", "full"]

_KEYS = {
    "open": {"source", "text"},
    "case": {"case", "detail", "charts"},
    "cancel": set[str](),
    "report": set[str](),
    "signals": set[str](),
    "export": {"format"},
    "figure": {"chart", "format"},
    "overlay": set[str](),
    "forget": set[str](),
}
_KEYS_OF_FILES = {"measurement": {"name"}}
_NEEDED = {"export": {"format"}, "figure": {"chart", "format"}, "measurement": {"name"}}
_TYPES: dict[str, type] = {
    "source": str,
    "text": str,
    "case": dict,
    "detail": str,
    "charts": list,
    "chart": str,
    "format": str,
    "name": str,
}
_NAMES_OF_TYPES: dict[type, str] = {str: "a text", dict: "a table", list: "a list"}


class Message(NamedTuple):
    """A message of a window: its type, its number, and what else it has."""

    type: str
    number: int
    content: dict[str, Any]


def read_message(text: str | bytes) -> Message:
    """Return a message.

    Raises
    ------
    InputError
        If it is not one of the protocol.

    Examples
    --------
    >>> read_message('{"type": "open", "number": 1, "source": "paper:type3"}').content
    {'source': 'paper:type3'}
    >>> read_message("[]")
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: a message is a table with a type: open, case, cancel, report,
    signals, export, figure, overlay, forget
    >>> message = read_message(b'\\0{"type": "measurement", "name": "a1.csv"}\\ntime [s],force [N]')
    >>> message.content["name"], message.content["data"]
    ('a1.csv', b'time [s],force [N]')
    """
    if isinstance(text, bytes) and text.startswith(b"\0"):
        return _read_file(text)
    block = text
    if isinstance(block, str):
        # halves of a pair of code points, which JavaScript may send, are no UTF-8
        block = block.encode("utf-8", "surrogatepass")
    if len(block) > LONGEST:
        raise InputError(f"the message has {len(block)} bytes; {LONGEST} are the most")
    return _message_of(block, _KEYS)


def _read_file(block: bytes) -> Message:
    """Return a message that brings a file."""
    line, _, data = block[1:].partition(b"\n")
    if len(line) > _LONGEST_LINE:
        raise InputError("the line ahead of a file is too long")
    message = _message_of(line, _KEYS_OF_FILES)
    name = message.content["name"].replace("\\", "/").rpartition("/")[2]
    if len(data) > LONGEST_FILE:
        raise InputError(
            f"{shortened(name, 80)}: the file has {len(data)} bytes, more than the {LONGEST_FILE} "
            "of the live page; keep the part with the impacts, or use: vibroimpact correlate"
        )
    return message._replace(content={"name": name, "data": data})


def _message_of(block: bytes, keys: Mapping[str, set[str]]) -> Message:
    """Return the message of a table in JSON, with the keys that each type has."""
    content = parse_json(block, "the message")
    kind = None
    if isinstance(content, dict):
        kind = content.pop("type", None)
    if not isinstance(kind, str) or kind not in keys:
        raise InputError(f"a message is a table with a type: {', '.join(keys)}")
    number = content.pop("number", 0)
    # not True or False, and what a double of the browser holds exactly
    if type(number) is not int or not 0 <= number < 2**53:
        raise InputError(f"{quoted(number)} is not the number of a message")
    if kind == "case":
        content.setdefault("detail", "full")
    _check_content(kind, content, keys[kind])
    return Message(kind, number, content)


def _check_content(kind: str, content: dict[str, Any], keys: set[str]) -> None:
    for key in sorted(_NEEDED.get(kind, set())):
        if key not in content:
            raise InputError(f"a message of type {kind} has a {key}")
    for key, value in content.items():
        if key not in keys:
            raise InputError(f"a message of type {kind} has no {quoted(key)}")
        if not isinstance(value, _TYPES[key]):
            raise InputError(f"{key} of a message must be {_NAMES_OF_TYPES[_TYPES[key]]}")
    if kind == "open" and len(content) != 1:
        raise InputError("a message of type open has either a source or a text")
    if kind == "case" and ("case" not in content or content["detail"] not in ("draft", "full")):
        raise InputError('a message of type case has a case, and "draft" or "full" as detail')
