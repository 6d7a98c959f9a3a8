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
    for the report, or the signals as CSV, of the case computed last in full.

It is told documents with arrays, as `vibroimpact.charts.pack` writes them, each with its `type` and
the `number` asked:

`welcome`
    first of all: shipped cases, laws with their parameters, materials, colours, and the `longest`
    message that is taken [bytes];
`opened`
    the table of a case, and what of it this page leaves out;
`progress`
    what is being computed, and the part that is done;
`state`
    charts, the plate in motion, tables, the resolved case, the case as TOML; in full detail also
    warnings and signals;
`files`
    each a name, a kind and a text;
`fault`
    the lines of a message, as the command line gives them;
`cancelled`
    that it was given up.
"""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

from vibroimpact.errors import InputError
from vibroimpact.files.json_reading import parse_json
from vibroimpact.quoting import quoted

LONGEST = 200_000
"""Largest size of a message from a window [bytes]."""

Detail = Literal["draft", "full"]

_KEYS = {
    "open": {"source", "text"},
    "case": {"case", "detail", "charts"},
    "cancel": set[str](),
    "report": set[str](),
    "signals": set[str](),
}
_TYPES: dict[str, type] = {"source": str, "text": str, "case": dict, "detail": str, "charts": list}
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
    signals
    """
    block = text
    if isinstance(block, str):
        # halves of a pair of code points, which JavaScript may send, are no UTF-8
        block = block.encode("utf-8", "surrogatepass")
    if len(block) > LONGEST:
        raise InputError(f"the message has {len(block)} bytes; {LONGEST} are the most")
    content = parse_json(block, "the message")
    kind = None
    if isinstance(content, dict):
        kind = content.pop("type", None)
    if not isinstance(kind, str) or kind not in _KEYS:
        raise InputError(f"a message is a table with a type: {', '.join(_KEYS)}")
    number = content.pop("number", 0)
    # not True or False, and what a double of the browser holds exactly
    if type(number) is not int or not 0 <= number < 2**53:
        raise InputError(f"{quoted(number)} is not the number of a message")
    if kind == "case":
        content.setdefault("detail", "full")
    _check_content(kind, content)
    return Message(kind, number, content)


def _check_content(kind: str, content: dict[str, Any]) -> None:
    for key, value in content.items():
        if key not in _KEYS[kind]:
            raise InputError(f"a message of type {kind} has no {quoted(key)}")
        if not isinstance(value, _TYPES[key]):
            raise InputError(f"{key} of a message must be {_NAMES_OF_TYPES[_TYPES[key]]}")
    if kind == "open" and len(content) != 1:
        raise InputError("a message of type open has either a source or a text")
    if kind == "case" and ("case" not in content or content["detail"] not in ("draft", "full")):
        raise InputError('a message of type case has a case, and "draft" or "full" as detail')
