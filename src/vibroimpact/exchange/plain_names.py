"""Names of sensors as files, groups and columns can be called."""

from __future__ import annotations

import re
from collections.abc import Iterable

_LONGEST = 60
"""Letters of a name; some file systems take 143 of a file's, with what stands before and behind it."""

_DEVICES = re.compile(r"(?:con|prn|aux|nul|(?:com|lpt)\d)", re.IGNORECASE)
"""What Windows takes for a device, whatever the ending."""


def plain_names(names: Iterable[str]) -> dict[str, str]:
    """Return for each name one that can be a file's and a group's: letters, digits and a few signs, not too long, and no two alike.

    Examples
    --------
    >>> plain_names(["a1", "left/upper", "left upper"])
    {'a1': 'a1', 'left/upper': 'left_upper', 'left upper': 'left_upper_2'}
    >>> plain_names(["..", "con", "-o"])
    {'..': 'sensor', 'con': 'con_', '-o': 'o'}
    """
    found: dict[str, str] = {}
    taken: set[str] = set()
    again: dict[str, int] = {}
    for name in names:
        plain = re.sub(r"[^\w-]+", "_", name, flags=re.ASCII).lstrip("_-")[:_LONGEST].rstrip("_") or "sensor"
        if _DEVICES.fullmatch(plain):
            plain += "_"
        tried = plain
        while tried.lower() in taken:
            again[plain] = again.get(plain, 1) + 1
            tried = f"{plain}_{again[plain]}"
        taken.add(tried.lower())
        found[name] = tried
    return found
