"""Texts of quantities: a number and a unit, and what a text is without the commas in its number."""

from __future__ import annotations

import re

_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*((?:1/)?[^\d\s.+-].*)?")

_COMMA = re.compile(r"\s*[+-]?\d+,\d")
_THOUSANDS = re.compile(r"\s*[+-]?[1-9]\d{0,2}(,\d{3})+(?!\d)")
_LONGEST = 80  # characters of a quantity


def number_and_unit(text: str) -> tuple[float, str] | None:
    """Return the number and the unit of a text, "" for no unit, neither of which is checked; None
    if it does not begin with a number.

    Examples
    --------
    >>> number_and_unit("25 mm"), number_and_unit("0.3"), number_and_unit("mm")
    ((25.0, 'mm'), (0.3, ''), None)
    """
    match = _QUANTITY.fullmatch(text) if len(text) <= _LONGEST else None
    if match is None or has_comma(text):
        return None
    return float(match[1]), (match[2] or "").strip()


def has_comma(text: str) -> bool:
    """Return whether a text of a quantity begins with a number that has a comma.

    Examples
    --------
    >>> has_comma("1,5 mm"), has_comma("1.5 mm")
    (True, False)
    """
    return len(text) <= _LONGEST and _COMMA.match(text) is not None


def comma_remedy(text: str, unit: str | None) -> str:
    """Return how a number with commas is written without them.

    Parameters
    ----------
    text : str
        The text of the quantity.
    unit : str or None
        The wanted unit; "" if none is wanted, None if any is.

    Examples
    --------
    >>> comma_remedy("1,5", "m"), comma_remedy("1,234,567 mm", "m")
    ('write a point: "1.5 m"', 'leave the commas out: "1234567 mm"')
    """
    pointed, joined = text.replace(",", ".", 1).strip(), text.replace(",", "").strip()
    with_point, without = number_and_unit(pointed), number_and_unit(joined)
    groups = _THOUSANDS.match(text) is not None
    if with_point is not None and "," not in with_point[1]:
        thousands = ", or leave the comma out if it separates thousands" if groups else ""
        return f"write a point: {_rewritten(pointed, *with_point, unit)}{thousands}"
    if without is not None and groups:
        return f"leave the commas out: {_rewritten(joined, *without, unit)}"
    return "write one number, with a point before its decimals"


def _rewritten(text: str, number: float, given: str, wanted: str | None) -> str:
    """Return a text with a number as it may be given where a unit is wanted."""
    if wanted == "":
        return f"{number:.15g}"
    return f'"{text}"' if given else f'"{text} {wanted or "UNIT"}"'
