"""Roots of one function an element, for whole arrays at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.contact.pair import Array


def find_root(function: Callable[[Array], Array], low: Array, high: Array, *, tolerance: float = 1e-13) -> Array:
    """Return where a function becomes positive between `low` (it is not) and `high` (it is).

    The Illinois method, with a bisection wherever it is slow.

    Parameters
    ----------
    function : callable
        Takes and returns an array, element by element.
    low, high : array
        The brackets; which of the two is the larger does not matter.
    tolerance : float, default 1e-13
        How near the brackets come, as a part of the larger.

    Returns
    -------
    array
        The bracket at which the function is positive.

    Examples
    --------
    >>> find_root(lambda x: x * x - np.array([2.0, 9.0]), np.zeros(2), np.array([2.0, 10.0])).round(12).tolist()
    [1.414213562373, 3.0]
    """
    low, high = np.array(low, dtype=float), np.array(high, dtype=float)
    below, above = function(low), function(high)
    side = np.zeros(low.shape, dtype=int)
    for sweep in range(200):
        with np.errstate(all="ignore"):
            middle = (low * above - high * below) / (above - below)
        halved = (sweep % 4 == 3) | ~np.isfinite(middle)
        middle = np.where(halved, 0.5 * (low + high), middle)
        value = function(middle)
        up = value > 0.0
        below = np.where(up, np.where(side > 0, 0.5 * below, below), value)
        above = np.where(up, value, np.where(side < 0, 0.5 * above, above))
        low, high = np.where(up, low, middle), np.where(up, middle, high)
        side = np.where(up, 1, -1)
        if not np.any(np.abs(high - low) > tolerance * np.maximum(np.abs(low), np.abs(high))):
            break
    return high
