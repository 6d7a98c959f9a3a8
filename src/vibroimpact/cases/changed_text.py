"""The text of a case with other values at some of its keys: all else that stands there,
comments too, remains.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping
from typing import Any

import tomli_w

from vibroimpact.cases.keys import with_values
from vibroimpact.cases.reader import parse_case

_HEADER = re.compile(r"^\s*\[")
_BARE = re.compile(r"[\w-]+", re.ASCII)


def changed_text(text: str, changes: Mapping[str, Any]) -> str:
    r"""Return the text of a case with other values.

    Where a value stands in a way that is not `key = value` below the header of its section, the
    case is written anew, without comments.

    Parameters
    ----------
    text : str
        The text.
    changes : mapping
        The values by dotted key.

    Raises
    ------
    InputError
        If the text is not TOML, or there is nothing at a key to be changed.

    Examples
    --------
    >>> print(
    ...     changed_text(
    ...         '[plate]\nsize = ["1 m", "1 m", "8 mm"]  # steel',
    ...         {"plate.size.thickness": "9 mm", "drop.speed": 2.0},
    ...     )
    ... )
    [plate]
    size = ["1 m", "1 m", "9 mm"]  # steel
    <BLANKLINE>
    [drop]
    speed = 2.0
    """
    before = parse_case(text)
    wanted = with_values(before, changes, "set")
    lines = text.split("\n")
    for name, value in wanted.items():
        known = before.get(name)
        if isinstance(value, dict) and isinstance(known, dict | None):
            for key, inner in value.items():
                if known is None or key not in known or known[key] != inner:
                    _write(lines, name, key, inner)
        elif name not in before or known != value:
            _write(lines, "", name, value)
    found = "\n".join(lines)
    return found if _table(found) == wanted else tomli_w.dumps(wanted)


def _write(lines: list[str], section: str, key: str, value: Any) -> None:
    """Write a value at a key of a section into the lines of a case, in place."""
    header = re.compile(rf"^\s*\[\s*{re.escape(section)}\s*\]")
    start = (
        0
        if not section
        else next((number + 1 for number, line in enumerate(lines) if header.match(line)), None)
    )
    if start is None:
        while lines and not lines[-1].strip():
            lines.pop()
        lines += ["", f"[{section}]"]
        start = len(lines)
    end = next(
        (number for number in range(start, len(lines)) if _HEADER.match(lines[number])), len(lines)
    )
    line, own = f"{_key(key)} = {_inline(value)}", re.compile(rf"^\s*{re.escape(_key(key))}\s*=")
    for first in range(start, end):
        if own.match(lines[first]):
            last = next(
                (
                    last
                    for last in range(first + 1, end + 1)
                    if _table("\n".join(lines[first:last])) is not None
                ),
                first + 1,
            )
            lines[first:last] = [line + _comment(lines[first])]
            return
    while end > start and not lines[end - 1].strip():
        end -= 1
    lines.insert(end, line)


def _comment(line: str) -> str:
    """Return the comment at the end of a line, with the blanks before it; "" without one."""
    for found in re.finditer(r"\s*#", line):
        if _table(line[: found.start()]) is not None:
            return line[found.start() :]
    return ""


def _table(text: str) -> dict[str, Any] | None:
    """Return what a text of TOML says; None if it is none."""
    try:
        return tomllib.loads(text)
    except ValueError:
        return None


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else json.dumps(name)


def _inline(value: Any) -> str:
    """Return a value as TOML in one line.

    Examples
    --------
    >>> print(_inline({"type": "patches", "spacing": ["40 cm", 0.3]}))
    { type = "patches", spacing = ["40 cm", 0.3] }
    """
    if isinstance(value, dict):
        return (
            "{ "
            + ", ".join(f"{_key(name)} = {_inline(inner)}" for name, inner in value.items())
            + " }"
            if value
            else "{}"
        )
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_inline, value))}]"
    return tomli_w.dumps({"a": value}).removeprefix("a = ").rstrip("\n")
