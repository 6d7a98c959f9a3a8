"""The text of a case with other values at some of its keys.

All else that stands there, comments too, remains.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping
from typing import Any

import tomli_w

from vibroimpact.cases.reader import parse_case
from vibroimpact.cases.sections.keys import with_values
from vibroimpact.cases.sections.left_out import without_inapplicable

_HEADER = re.compile(r"^\s*\[")
_BARE = re.compile(r"[\w-]+", re.ASCII)


def changed_text(text: str, changes: Mapping[str, Any]) -> str:
    r"""Return the text of a case with other values.

    Keys that do not apply after the changes are left out, as `load_case` leaves them out. Where a
    value stands in a way that is not `key = value` below the header of its section, the
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
    table = parse_case(text)
    kept, dropped = without_inapplicable(table, changes)
    changed = with_values(kept, changes, "set")
    lines = text.split("\n")
    for dotted_key in dropped:
        section, _, key = dotted_key.rpartition(".")
        _remove(lines, section, key)
    for name, value in changed.items():
        old_value = table.get(name)
        if isinstance(value, dict) and isinstance(old_value, dict | None):
            for key, inner in value.items():
                if old_value is None or key not in old_value or old_value[key] != inner:
                    _write(lines, name, key, inner)
        elif name not in table or old_value != value:
            _write(lines, "", name, value)
    new_text = "\n".join(lines)
    if _table(new_text) == changed:
        return new_text
    # in some other notation of TOML; its comments are lost
    return tomli_w.dumps(changed)


def _write(lines: list[str], section: str, key: str, value: Any) -> None:
    """Write a value at a key of a section into the lines of a case, in place."""
    start = _section_start(lines, section)
    end = _section_end(lines, start)
    new_line = f"{_key(key)} = {_inline(value)}"
    assignment = _assignment(lines, start, end, key)
    if assignment is not None:
        first, last = assignment
        lines[first:last] = [new_line + _comment(lines[first])]
        return
    # a new key is above the blank lines at the end of the section
    while end > start and not lines[end - 1].strip():
        end -= 1
    lines.insert(end, new_line)


def _remove(lines: list[str], section: str, key: str) -> None:
    """Remove a key of a section from the lines of a case, in place, if it is `key = value`."""
    start = _section_start(lines, section)
    assignment = _assignment(lines, start, _section_end(lines, start), key)
    if assignment is not None:
        first, last = assignment
        del lines[first:last]


def _assignment(lines: list[str], start: int, end: int, key: str) -> tuple[int, int] | None:
    """Return the first line of a value, and the one after its last; None if it is not there."""
    assignment = re.compile(rf"^\s*{re.escape(_key(key))}\s*=")
    for first in range(start, end):
        if assignment.match(lines[first]):
            return first, _value_end(lines, first, end)
    return None


def _section_end(lines: list[str], start: int) -> int:
    """Return the index of the line after a section that begins at one."""
    end = start
    while end < len(lines) and not _HEADER.match(lines[end]):
        end += 1
    return end


def _section_start(lines: list[str], section: str) -> int:
    """Return the index of the first line of a section below its header, which is added if need be.

    "" are the keys above all sections.
    """
    if not section:
        return 0
    header = re.compile(rf"^\s*\[\s*{re.escape(section)}\s*\]")
    for number, line in enumerate(lines):
        if header.match(line):
            return number + 1
    while lines and not lines[-1].strip():
        lines.pop()
    lines += ["", f"[{section}]"]
    return len(lines)


def _value_end(lines: list[str], first: int, end: int) -> int:
    """Return the index of the line after a value, which may go over several lines."""
    for last in range(first + 1, end + 1):
        if _table("\n".join(lines[first:last])) is not None:
            return last
    return first + 1


def _comment(line: str) -> str:
    """Return the comment at the end of a line, with the blanks before it; "" without one."""
    for hash_sign in re.finditer(r"\s*#", line):
        # one within a text leaves no valid TOML before it
        if _table(line[: hash_sign.start()]) is not None:
            return line[hash_sign.start() :]
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
        items = ", ".join(f"{_key(name)} = {_inline(inner)}" for name, inner in value.items())
        return f"{{ {items} }}" if items else "{}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_inline, value))}]"
    return tomli_w.dumps({"a": value}).removeprefix("a = ").rstrip("\n")
