"""Hint on the likely unit of lengths that exceed the plate."""

from __future__ import annotations

from collections.abc import Sequence

from vibroimpact.cases.wrong_units.plausible import number_text

_UNITS = {"mm": 1e-3, "cm": 1e-2, "um": 1e-6}
_FAR = 5.0  # excess ratio below which a length is not taken for a slip of a unit


def likely_lengths(values: Sequence[float], most: Sequence[float]) -> str:
    """Return a hint, to be added to a message, that lengths which are far too large were meant in
    another unit; "" if no unit fits.

    Parameters
    ----------
    values, most : sequence of float
        The lengths, and the maximum of each [m].

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
            texts = ", ".join(f'"{number_text(value)} {unit}"' for value in values)
            if len(values) > 1:
                texts = f"[{texts}]"
            return f"; were {unit} meant? Write {texts}"
    return ""
