"""Names of sensors as files, groups and columns can be called."""

from __future__ import annotations

import re


def plain_names(names: list[str]) -> dict[str, str]:
    """Return for each name one that can be a file's and a group's: letters, digits and a few signs, and no two alike.

    Examples
    --------
    >>> plain_names(["a1", "left/upper", "left upper"])
    {'a1': 'a1', 'left/upper': 'left_upper', 'left upper': 'left_upper_2'}
    """
    found: dict[str, str] = {}
    for name in names:
        plain = re.sub(r"[^\w-]+", "_", name, flags=re.ASCII).strip("_") or "sensor"
        number, tried = 1, plain
        while tried.lower() in {taken.lower() for taken in found.values()}:
            number += 1
            tried = f"{plain}_{number}"
        found[name] = tried
    return found
