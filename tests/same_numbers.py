"""Do two texts say the same, their numbers to the last digit that they show?"""

from __future__ import annotations

import re
from itertools import zip_longest

_NUMBER = re.compile(r"(?<![\w.])([+\u2212-]?)(\d+(?:\.\d+)?)(?:·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)|e([+-]?\d+))?")
_RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
_COUNTS = 1000  # whole numbers below it count or name something, and are exact


def other_numbers(old: str, new: str) -> list[str]:
    """Return the lines that differ: in their words, or in a number by more than a unit of its last
    digit.

    The rounding of a number may differ from machine to machine by that unit, and no more; a number
    of fewer digits is another one.
    """
    pairs = enumerate(zip_longest(old.splitlines(), new.splitlines(), fillvalue=""), start=1)
    return [
        f"line {number}: {before!r} is now {after!r}"
        for number, (before, after) in pairs
        if not _same(before, after)
    ]


def _same(before: str, after: str) -> bool:
    if before == after:
        return True
    if _NUMBER.sub("0", before) != _NUMBER.sub("0", after):
        return False
    pairs = zip(_NUMBER.finditer(before), _NUMBER.finditer(after), strict=True)
    return all(one[0] == other[0] or _near(one, other) for one, other in pairs)


def _near(one: re.Match[str], other: re.Match[str]) -> bool:
    (value, last, digits), (other_value, other_last, other_digits) = _value(one), _value(other)
    if "." not in one[2] + other[2] and max(abs(value), abs(other_value)) < _COUNTS:
        return False
    # 9.99 may round to 10.0, of as many digits; else the last digit must stand in the same place
    return (
        digits == other_digits
        and last <= 10.01 * other_last
        and other_last <= 10.01 * last
        and abs(value - other_value) <= 1.01 * last
    )


def _value(found: re.Match[str]) -> tuple[float, float, int]:
    """Return a number, a unit of its last digit, and how many digits it shows."""
    sign, mantissa, raised, plain = found.groups()
    scale = 10.0 ** int(raised.translate(_RAISED) if raised else plain or 0)
    last = 10.0 ** -len(mantissa.partition(".")[2])
    shown = len(mantissa.replace(".", "").lstrip("0"))
    return (-1.0 if sign in ("-", "\u2212") else 1.0) * float(mantissa) * scale, last * scale, shown
