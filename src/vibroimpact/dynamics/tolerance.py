"""The range of tolerances to which contacts can be integrated."""

from __future__ import annotations

from vibroimpact.errors import InputError


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
    if not 1e-13 <= tolerance <= 1e-6:
        raise InputError("tolerance must lie between 1e-13 and 1e-6")
