"""The tolerance to which contacts are integrated, and its range."""

from __future__ import annotations

from vibroimpact.errors import InputError
from vibroimpact.ranges import Range

DEFAULT_TOLERANCE = 1e-9
"""Relative error allowed in the state at the end of a contact."""

TOLERANCES = Range(at_least=1e-13, at_most=1e-6)
"""Tolerances to which a contact can be integrated."""


def check_tolerance(tolerance: float) -> None:
    """Check a tolerance.

    Raises
    ------
    InputError
        If it is out of range.

    Examples
    --------
    >>> check_tolerance(1e-3)
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: tolerance must lie between 1e-13 and 1e-6
    """
    lowest, highest = TOLERANCES.at_least, TOLERANCES.at_most
    if not lowest <= tolerance <= highest:
        bounds = f"{lowest:.0e} and {highest:.0e}".replace("e-0", "e-")
        raise InputError(f"tolerance must lie between {bounds}")
