"""Numbers in the cells of a table, as programs and languages write them.

They may have a decimal comma, be grouped, missing, or over the range.
"""

from __future__ import annotations

import re
from math import inf, nan

_MISSING = {
    "",
    "-",
    "--",
    "na",
    "n/a",
    "#n/a",
    "#nv",
    "null",
    "none",
    "nan(ind)",
    "-nan(ind)",
    "1.#qnan",
    "-1.#qnan",
    "1.#ind",
    "-1.#ind",
}
"""What programs write in place of a number that is missing, beside nan."""

_OVER = {"∞": inf, "+∞": inf, "-∞": -inf, "\u2212∞": -inf, "1.#inf": inf, "-1.#inf": -inf}
"""What oscilloscopes write where a sample is over the range of the channel."""

SCPI = {9.9e37: inf, -9.9e37: -inf, 9.91e37: nan}
"""Numbers by which instruments state that a sample is over the range, or missing (SCPI)."""

_GROUPED_POINTS = re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})+,\d+")
_GROUPED_COMMAS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+\.\d+")
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")
_EITHER = re.compile(r"[+-]?[1-9]\d{0,2}[.,]\d{3}")


def number_in(text: str, delimiter: str | None) -> float:
    """Return the number in a cell; nan where it is missing, infinite where it is over the range.

    Parameters
    ----------
    text : str
        The cell.
    delimiter : str or None
        What separates the fields of the table: where it is no comma, a comma is the decimal point.

    Raises
    ------
    ValueError
        If it is none.

    Examples
    --------
    >>> (
    ...     number_in("1,5", ";"),
    ...     number_in("1.234,5", ";"),
    ...     number_in("0,5", ","),
    ...     number_in("NaN", ","),
    ... )
    (1.5, 1234.5, 0.5, nan)
    """
    try:
        if "_" in text:  # allowed in numbers by Python
            raise ValueError(text)
        if delimiter != ",":  # a comma is the decimal point
            return float(text.replace(",", "."))
        return float(text)
    except ValueError:
        plain = text.strip()
    if (lower := plain.lower()) in _MISSING:
        return nan
    if lower in _OVER:
        return _OVER[lower]
    if _GROUPED_POINTS.fullmatch(plain):
        return float(plain.replace(".", "").replace(",", "."))
    if _GROUPED_COMMAS.fullmatch(plain):
        return float(plain.replace(",", ""))
    if _DECIMAL_COMMA.fullmatch(plain) and not is_either(plain):
        return float(plain.replace(",", "."))
    raise ValueError(text)


def is_number(text: str, delimiter: str | None) -> bool:
    """Return whether a cell has a number, or one that is missing.

    Examples
    --------
    >>> is_number("1e-3", ","), is_number("", ","), is_number("Recorder", ",")
    (True, True, False)
    """
    try:
        number_in(text, delimiter)
    except ValueError:
        return False
    return True


def is_either(text: str) -> bool:
    """Return whether a point or comma in a number may group digits, or be the decimal sign.

    Examples
    --------
    >>> is_either("1.234"), is_either("0.234"), is_either("1.2345")
    (True, False, False)
    """
    return _EITHER.fullmatch(text.strip()) is not None
