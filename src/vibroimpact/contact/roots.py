"""Roots of one function an element, for whole arrays at once."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.ranges import Range

_FARTHEST = 20  # steps of four from its start in which a value is looked for
_EXACT = 1e-11  # as near as this to what is wanted is there
_JUMP = 1e-8  # farther than this is a jump


def find_root(function: Callable[[Array], Array], low: Array, high: Array, *, tolerance: float = 1e-13, close: float = 0.0) -> Array:
    """Return where a function becomes positive between `low` (it is not) and `high` (it is).

    Inverse quadratic interpolation where three values allow it, else bisection, as Chandrupatla (1997) decides between them.

    Parameters
    ----------
    function : callable
        Takes and returns an array, element by element.
    low, high : array
        The brackets; which of the two is the larger does not matter.
    tolerance : float, default 1e-13
        How near the brackets come, as a part of the larger.
    close : float, default 0.0
        Where the function is less than this, it is taken for zero.

    Returns
    -------
    array
        The bracket at which the function is positive, or where it is taken for zero.

    References
    ----------
    Chandrupatla, T. R. (1997). A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear function
    without using derivatives. Advances in Engineering Software 28, 145-149.

    Examples
    --------
    >>> find_root(lambda x: x * x - np.array([2.0, 9.0]), np.zeros(2), np.array([2.0, 10.0])).round(12).tolist()
    [1.414213562373, 3.0]
    """
    # `new` and `far` bracket the root, and `old` is the one before
    new, far = (np.asarray(end, dtype=float) for end in (low, high))
    new_value, far_value = function(new), function(far)
    with np.errstate(all="ignore"):
        part = new_value / (new_value - far_value)
    part = np.where(np.isfinite(part), np.clip(part, 0.05, 0.95), 0.5)
    old: Array
    old_value: Array
    for _ in range(200):
        place = new + part * (far - new)
        value = function(place)
        same = np.equal(value > 0.0, new_value > 0.0)
        old, old_value = np.where(same, new, far), np.where(same, new_value, far_value)
        far, far_value = np.where(same, far, new), np.where(same, far_value, new_value)
        new, new_value = place, value
        width = np.abs(far - new)
        least = tolerance * np.maximum(np.abs(new), np.abs(far))
        zero = np.minimum(np.abs(new_value), np.abs(far_value)) < close
        if not np.any((width > least) & ~zero):
            break
        with np.errstate(all="ignore"):
            across, up = (new - far) / (old - far), (new_value - far_value) / (old_value - far_value)
            curved = (up * up < across) & ((1.0 - up) ** 2 < 1.0 - across)
            part = new_value / (far_value - new_value) * old_value / (far_value - old_value)
            part += (old - new) / (far - new) * new_value / (old_value - new_value) * far_value / (old_value - far_value)
            edge = np.minimum(least / width, 0.5)
        part = np.where(curved & np.isfinite(part), np.clip(part, edge, 1.0 - edge), 0.5)
        part = np.where(zero, np.where(np.abs(new_value) <= np.abs(far_value), 0.0, 1.0), part)  # stay there
    nearer = np.abs(new_value) <= np.abs(far_value)
    zero = np.minimum(np.abs(new_value), np.abs(far_value)) < close
    return np.where(np.where(zero, nearer, new_value > 0.0), new, far)


class Sought(NamedTuple):
    """Where a function has the wanted values, NaN where none was found; the least and the largest of its values that were seen."""

    place: Array
    least: Array
    most: Array


def solve_monotonic(
    function: Callable[[Array], Array], wanted: Array, start: Array, allowed: Range, *, falls: bool = False, farthest: int = _FARTHEST
) -> Sought:
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
    farthest : int, default 20
        How many steps of four to look to either side.

    Notes
    -----
    Where the function jumps over what is wanted, nothing is found.

    Examples
    --------
    >>> solve_monotonic(lambda x: np.exp(-x), np.array([0.5, 2.0]), np.ones(2), Range(at_least=0), falls=True).place.round(6).tolist()
    [0.693147, nan]
    """
    low, high = np.full_like(start, np.nan), np.full_like(start, np.nan)
    least, most = np.full_like(start, np.inf), np.full_like(start, -np.inf)
    hopeless = np.zeros(start.shape, dtype=bool)
    ends = [end + 0.0 * start for end in (allowed.at_least, allowed.at_most) if np.isfinite(end)]
    steps = (start * 4.0**power for count in range(farthest) for power in ((-count, count) if count else (0,)))
    for number, value in enumerate(itertools.chain(ends, steps)):
        trial = allowed.clip(value)
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
    low, high = (np.where(missed, start, bound) for bound in (low, high))
    place = find_root(lambda value: function(value) - wanted, low, high, close=_EXACT)
    jumps = ~(np.abs(function(place) - wanted) <= _JUMP)
    return Sought(np.where(missed | jumps, np.nan, place), least, most)


def highest(values: Callable[[Array], Array]) -> float:
    """Return where a smooth function on [0, 1] is largest, to 1e-6.

    Examples
    --------
    >>> round(highest(lambda x: x * (0.8 - x)), 5)
    0.4
    """
    low, high = 0.0, 1.0
    for _ in range(3):
        x = np.linspace(low, high, 33)
        found = values(x)
        best = int(found.argmax())
        low, high = x[max(best - 1, 0)], x[min(best + 1, 32)]
    if 0 < best < 32:  # the top of the parabola through three points, which rounding hardly moves
        before, top, after = found[best - 1 : best + 2]
        bend = 2.0 * top - before - after
        return float(x[best] + 0.25 * (high - low) * (after - before) / bend) if bend > 0.0 else float(x[best])
    return float(x[best])
