"""JSON text for other programs, as the command line prints it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
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


def _finite(value: Any) -> Any:
    """Return a value with None in place of each number that is not finite."""
    if isinstance(value, Mapping):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
