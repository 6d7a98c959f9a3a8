"""Roots of one function an element, for whole arrays at once."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from vibroimpact.contact.pair import Array
from vibroimpact.ranges import Range

_FARTHEST = 20  # steps of four from its start in which a value is looked for
_EXACT = 1e-11  # as near as this to what is wanted is there


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


class Sought(NamedTuple):
    """Where a function has the wanted values, NaN where none was found; the least and the largest of its values that were seen."""

    place: Array
    least: Array
    most: Array


def solve_monotonic(function: Callable[[Array], Array], wanted: Array, start: Array, allowed: Range, *, falls: bool = False) -> Sought:
    """Return where a function, that rises or falls with its argument, has wanted values of the order of one.

    Looks at the ends of the range and in steps of four away from the start, then closes in.

    Parameters
    ----------
    function : callable
        Takes and returns an array, element by element; NaN where it can't be computed.
    wanted, start : array
        Values wanted, and arguments to begin with, other than zero.
    allowed : Range
        Of the argument.
    falls : bool, default False
        Is it known to fall? Then what is above its value at the lower end of the range is not looked for.

    Examples
    --------
    >>> solve_monotonic(lambda x: np.exp(-x), np.array([0.5, 2.0]), np.ones(2), Range(at_least=0), falls=True).place.round(6).tolist()
    [0.693147, nan]
    """
    low, high = np.full_like(start, np.nan), np.full_like(start, np.nan)
    least, most = np.full_like(start, np.inf), np.full_like(start, -np.inf)
    hopeless = np.zeros(start.shape, dtype=bool)
    ends = [end + 0.0 * start for end in (allowed.at_least, allowed.at_most) if np.isfinite(end)]
    steps = (start * 4.0**power for count in range(_FARTHEST) for power in ((-count, count) if count else (0,)))
    for number, value in enumerate(itertools.chain(ends, steps)):
        trial = np.clip(value, allowed.at_least, allowed.at_most)
        found = function(trial)
        least, most = np.fmin(least, found), np.fmax(most, found)
        low = np.where(np.isnan(low) & (found <= wanted), trial, low)
        high = np.where(np.isnan(high) & (found > wanted), trial, high)
        exact = np.abs(found - wanted) <= _EXACT
        low, high = np.where(exact, trial, low), np.where(exact, trial, high)
        if falls and number == 0 and np.isfinite(allowed.at_least):
            hopeless = found < wanted - _EXACT
        if not (np.isnan(low) | np.isnan(high))[~hopeless].any():
            break
    missed = np.isnan(low) | np.isnan(high)
    if missed.all():
        return Sought(np.full_like(start, np.nan), least, most)
    place = find_root(lambda value: function(value) - wanted, np.where(missed, start, low), np.where(missed, start, high))
    return Sought(np.where(missed, np.nan, place), least, most)
