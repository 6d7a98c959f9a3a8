"""Texts of quantities: a number and a unit, and what a text is without the commas in its number."""

from __future__ import annotations

import re

_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*((?:1/)?[^\d\s.+-].*)?")

_COMMA = re.compile(r"\s*[+-]?\d+,\d")
_THOUSANDS = re.compile(r"\s*[+-]?[1-9]\d{0,2}(,\d{3})+(?!\d)")
_LONGEST = 80  # characters of a quantity


def number_and_unit(text: str) -> tuple[float, str] | None:
    """Return the number and the unit of a text; None if it does not begin with a number.

    The unit is "" if there is none. Neither is checked.

    Examples
    --------
    >>> number_and_unit("25 mm"), number_and_unit("0.3"), number_and_unit("mm")
    ((25.0, 'mm'), (0.3, ''), None)
    """
    if len(text) > _LONGEST or has_comma(text):
        return None
    match = _QUANTITY.fullmatch(text)
    if match is None:
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
    may_be_thousands = _THOUSANDS.match(text) is not None
    with_point = text.replace(",", ".", 1).strip()
    quantity = number_and_unit(with_point)
    if quantity is not None and "," not in quantity[1]:
        remedy = f"write a point: {_as_wanted(with_point, quantity, unit)}"
        if may_be_thousands:
            remedy += ", or leave the comma out if it separates thousands"
        return remedy
    without_commas = text.replace(",", "").strip()
    quantity = number_and_unit(without_commas)
    if quantity is not None and may_be_thousands:
        return f"leave the commas out: {_as_wanted(without_commas, quantity, unit)}"
    return "write one number, with a point before its decimals"


def _as_wanted(text: str, quantity: tuple[float, str], wanted_unit: str | None) -> str:
    """Return the text of a quantity as it may be given where a unit is wanted."""
    number, unit = quantity
    if wanted_unit == "":
        return f"{number:.15g}"
    if unit:
        return f'"{text}"'
    return f'"{text} {wanted_unit or "UNIT"}"'
