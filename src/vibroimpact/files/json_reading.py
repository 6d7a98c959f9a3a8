"""JSON that is read: bounded in size, in its number of values and in depth.

Its text can be written again.
"""

from __future__ import annotations

import json
import re
from os import PathLike
from typing import Any

from vibroimpact.errors import InputError
from vibroimpact.files.reading import FileKind, read_bytes

JSON_TABLE = FileKind("it is a table in JSON", 200_000_000, "larger files are not read")
"""Requirements on a JSON file of a result folder."""

DEEPEST = 100
"""Levels of tables and lists that are read."""

_MOST_VALUES = 5_000_000  # they take 70 bytes of memory each, and 3 bytes of the file
_SEPARATORS = (b",", b":", b"[", b"{")
_SURROGATE = re.compile(rb"\\u[dD][89a-fA-F]")


def parse_json(data: bytes, what: str = "it") -> Any:
    """Return what UTF-8 bytes of JSON say.

    Parameters
    ----------
    data : bytes
        The text.
    what : str
        What it is, for messages.

    Raises
    ------
    InputError
        If they are not JSON, hold text that can't be written, or too many values, or tables and
        lists too deep in one another.

    Examples
    --------
    >>> parse_json(b'{"restitution": [0.5, null]}')
    {'restitution': [0.5, None]}
    >>> parse_json(b"[" * 1000)
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: it has tables and lists more than 100 deep in one another
    """
    if sum(map(data.count, _SEPARATORS)) > _MOST_VALUES:
        raise InputError(f"{what} has more than {_MOST_VALUES:,} values and keys")
    try:
        content = json.loads(data.decode("utf-8-sig"), parse_constant=_refuse)
        if _SURROGATE.search(data):
            # half of a surrogate pair is no text, and can't be written
            json.dumps(content, ensure_ascii=False).encode()
    except RecursionError:
        raise _too_deep(what) from None
    except ValueError:
        raise InputError(f"{what} is not JSON") from None
    # the tables and lists of a level, from the outermost inwards
    level: list[Any] = [[content]]
    for _ in range(DEEPEST + 1):
        inner_level: list[Any] = []
        for table in level:
            values = table.values() if isinstance(table, dict) else table
            inner_level += [value for value in values if isinstance(value, (dict, list))]
        level = inner_level
    if level:
        raise _too_deep(what)
    return content


def read_json_table(path: str | PathLike[str], kind: FileKind = JSON_TABLE) -> dict[str, Any]:
    """Return the table in a JSON file.

    Raises
    ------
    InputError
        If it can't be read, is too large, or is not a table in JSON; the message does not include
        the path.
    """
    content = parse_json(read_bytes(path, kind))
    if not isinstance(content, dict):
        raise InputError("it holds no table")
    return content


def _too_deep(what: str) -> InputError:
    return InputError(f"{what} has tables and lists more than {DEEPEST} deep in one another")


def _refuse(constant: str) -> float:
    raise ValueError(constant)
