"""JSON text: as the command line prints it for other programs, and as files hold it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any


def json_text(document: Mapping[str, Any]) -> str:
    r"""Return a document as JSON text in printable ASCII.

    A number that is not finite becomes null, as JSON has none.

    Parameters
    ----------
    document : mapping
        Texts, numbers, and nested mappings and sequences of them.

    Examples
    --------
    >>> print(json_text({"name": "größe", "restitution": [0.1, float("nan")]}))
    {
      "name": "gr\u00f6\u00dfe",
      "restitution": [
        0.1,
        null
      ]
    }
    """
    # the one control character that JSON leaves as it is: a terminal should not get it
    return json.dumps(_finite(document), indent=2, allow_nan=False).replace("\x7f", r"\u007f")


def json_file_text(table: Mapping[str, Any]) -> str:
    """Return a table as the text of a JSON file, whose numbers are finite.

    A key of a mapping, a row of a table and a list of numbers are a line each.

    Examples
    --------
    >>> print(json_file_text({"speeds": [1.0, 2.0], "rows": [{"a": 1}, {"a": 2}]}), end="")
    {
      "speeds": [1.0, 2.0],
      "rows": [
        {"a": 1},
        {"a": 2}
      ]
    }
    """
    return f"{_lines_of(table, 0)}\n"


def _finite(value: Any) -> Any:
    """Return a value with None in place of each number that is not finite."""
    if isinstance(value, Mapping):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _lines_of(value: Any, depth: int) -> str:
    """Return JSON with a key of a mapping, a row of a table and a list of numbers a line each."""
    if isinstance(value, Mapping) and value:
        lines = [f"{json.dumps(key)}: {_lines_of(item, depth + 1)}" for key, item in value.items()]
        brackets = "{}"
    elif isinstance(value, (list, tuple)) and _holds_rows(value):
        lines = [json.dumps(row, allow_nan=False) for row in value]
        brackets = "[]"
    else:
        return json.dumps(value, allow_nan=False)
    margin = "\n" + "  " * depth
    content = ("," + margin + "  ").join(lines)
    return f"{brackets[0]}{margin}  {content}{margin}{brackets[1]}"


def _holds_rows(values: Sequence[Any]) -> bool:
    """Does a list hold mappings or lists?"""
    return any(isinstance(value, (Mapping, list, tuple)) for value in values)
