"""Do two texts say the same, their numbers to the last digit that they show?"""

from __future__ import annotations

import re
from itertools import zip_longest

_NUMBER = re.compile(r"(?<![\w.])([+\u2212-]?)(\d+(?:\.\d+)?)(?:·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?")
_RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


def other_numbers(old: str, new: str) -> list[str]:
    """Return the lines that differ: in their words, or in a number by more than a unit of its last digit.

    The rounding of a number may differ from machine to machine by that unit, and no more.
    """
    pairs = enumerate(zip_longest(old.splitlines(), new.splitlines(), fillvalue=""), start=1)
    return [f"line {number}: {before!r} is now {after!r}" for number, (before, after) in pairs if not _same(before, after)]


def _same(before: str, after: str) -> bool:
    if before == after:
        return True
    if _NUMBER.sub("0", before) != _NUMBER.sub("0", after):
        return False
    pairs = zip(_NUMBER.finditer(before), _NUMBER.finditer(after), strict=True)
    return all(_near(*map(_value, pair)) for pair in pairs)


def _value(found: re.Match[str]) -> tuple[float, float]:
    """Return a number and a unit of its last digit."""
    sign, mantissa, power = found.groups()
    scale = 10.0 ** int((power or "⁰").translate(_RAISED))
    last = 10.0 ** -len(mantissa.partition(".")[2])
    return (-1.0 if sign in ("-", "\u2212") else 1.0) * float(mantissa) * scale, last * scale


def _near(one: tuple[float, float], other: tuple[float, float]) -> bool:
    return abs(one[0] - other[0]) <= 1.01 * max(one[1], other[1])
