"""The end of a run in words."""

from __future__ import annotations

from decimal import ROUND_FLOOR, Context, Decimal

_DIGITS = Context(prec=6, rounding=ROUND_FLOOR)


def end_in_words(end: float) -> str:
    """Return the end of a run [s] in six digits, rounded down so that the time that is named lies
    within the run.

    Examples
    --------
    >>> end_in_words(0.5), end_in_words(2.0 / 3.0)
    ('0.5', '0.666666')
    """
    return f"{float(_DIGITS.create_decimal(Decimal(float(end)))):.6g}"
