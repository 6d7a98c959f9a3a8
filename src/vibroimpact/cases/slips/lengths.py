"""Lengths that do not fit on the plate: in which unit they would."""

from __future__ import annotations

from collections.abc import Sequence

from vibroimpact.cases.slips.plausible import number_text

_UNITS = {"mm": 1e-3, "cm": 1e-2, "um": 1e-6}
_FAR = 5.0  # times too long: nearer ones are no slip of a unit


def likely_lengths(values: Sequence[float], most: Sequence[float]) -> str:
    """Return the hint that lengths which are far too long were meant in another unit, to be added to a message; "" if none explains it.

    Parameters
    ----------
    values, most : sequence of float
        The lengths, and what each may be at most [m].

    Examples
    --------
    >>> likely_lengths([100.0, 50.0], [0.26, 0.21])
    '; were mm meant? Write ["100 mm", "50 mm"]'
    >>> likely_lengths([0.3, 0.0], [0.26, 0.21])
    ''
    """
    if not any(abs(value) > _FAR * end for value, end in zip(values, most, strict=True)):
        return ""
    for unit, size in _UNITS.items():
        if all(abs(value) * size <= end for value, end in zip(values, most, strict=True)):
            texts = [f'"{number_text(value)} {unit}"' for value in values]
            return f"; were {unit} meant? Write {texts[0] if len(texts) == 1 else '[' + ', '.join(texts) + ']'}"
    return ""
