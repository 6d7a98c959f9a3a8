"""Vectorized root finding and maximization of scalar functions."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.ranges import Range

_MAX_STEPS = 20  # of the search for a bracket: factors of four from the start
_RESIDUAL = 1e-11  # a smaller residual counts as zero
_JUMP = 1e-8  # a larger residual at the root found is a discontinuity


def find_root(
    function: Callable[[Array], Array],
    low: Array,
    high: Array,
    *,
    tolerance: float = 1e-13,
    close: float = 0.0,
) -> Array:
    """Return the roots of a function, elementwise, between brackets `low` (not positive) and `high`
    (positive).

    Inverse quadratic interpolation or bisection, by the criterion of Chandrupatla (1997).

    Parameters
    ----------
    function : callable
        Takes and returns an array, elementwise.
    low, high : array
        The brackets, in either order.
    tolerance : float, default 1e-13
        Final width of the bracket relative to the larger of its ends.
    close : float, default 0.0
        A smaller absolute value of the function counts as zero.

    Returns
    -------
    array
        The end of the bracket at which the function is positive, or the place at which it counts as
        zero.

    References
    ----------
    Chandrupatla, T. R. (1997). A new hybrid quadratic/bisection algorithm for finding the zero of a
    nonlinear function without using derivatives. Advances in Engineering Software 28, 145-149.

    Examples
    --------
    >>> find_root(lambda x: x * x - np.array([2.0, 9.0]), np.zeros(2), np.array([2.0, 10.0])).round(
    ...     12
    ... ).tolist()
    [1.414213562373, 3.0]
    """
    # `new` and `far` bracket the root; `old` is the previous point, the third of the interpolation
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
        close_by = ~(width > least)
        if not np.any(~close_by & ~zero):
            break
        with np.errstate(all="ignore"):
            across, up = (
                (new - far) / (old - far),
                (new_value - far_value) / (old_value - far_value),
            )
            curved = (up * up < across) & ((1.0 - up) ** 2 < 1.0 - across)
            part = new_value / (far_value - new_value) * old_value / (far_value - old_value)
            part += (
                (old - new)
                / (far - new)
                * new_value
                / (old_value - new_value)
                * far_value
                / (old_value - far_value)
            )
            edge = np.minimum(least / width, 0.5)
        part = np.where(curved & np.isfinite(part), np.clip(part, edge, 1.0 - edge), 0.5)
        part = np.where(close_by, 0.0, part)  # whatever the others still need
        # a root found stays
        part = np.where(zero, np.where(np.abs(new_value) <= np.abs(far_value), 0.0, 1.0), part)
    nearer = np.abs(new_value) <= np.abs(far_value)
    zero = np.minimum(np.abs(new_value), np.abs(far_value)) < close
    return np.where(np.where(zero, nearer, new_value > 0.0), new, far)


class MonotonicRoots(NamedTuple):
    """Arguments at which a function has the wanted values, NaN where none was found, and
    the extreme values evaluated.
    """

    place: Array
    least: Array
    most: Array


def solve_monotonic(
    function: Callable[[Array], Array],
    wanted: Array,
    start: Array,
    allowed: Range,
    *,
    falls: bool = False,
    max_steps: int = _MAX_STEPS,
) -> MonotonicRoots:
    """Return the arguments at which a monotonic function has wanted values of the order of one.

    Roots are bracketed by the ends of the range and by the start times powers of four, then
    refined.

    Parameters
    ----------
    function : callable
        Takes and returns an array, elementwise; NaN where it can't be computed.
    wanted, start : array
        Wanted values, and nonzero initial arguments.
    allowed : Range
        Range of the argument.
    falls : bool, default False
        Is the function known to decrease? Values above that at the lower end of the range are then
        not searched for.
    max_steps : int, default 20
        Largest number of steps, by a factor of four each, in either direction.

    Notes
    -----
    Where the function jumps across the wanted value, the result is NaN.

    Examples
    --------
    >>> solve_monotonic(
    ...     lambda x: np.exp(-x), np.array([0.5, 2.0]), np.ones(2), Range(at_least=0), falls=True
    ... ).place.round(6).tolist()
    [0.693147, nan]
    """
    low, high = np.full_like(start, np.nan), np.full_like(start, np.nan)
    least, most = np.full_like(start, np.inf), np.full_like(start, -np.inf)
    unreachable = np.zeros(start.shape, dtype=bool)
    ends = [end + 0.0 * start for end in (allowed.at_least, allowed.at_most) if np.isfinite(end)]
    steps = (
        start * 4.0**power
        for count in range(max_steps)
        for power in ((-count, count) if count else (0,))
    )
    for number, value in enumerate(itertools.chain(ends, steps)):
        trial = allowed.clip(value)
        found = function(trial)
        least, most = np.fmin(least, found), np.fmax(most, found)
        # the first arguments found on either side of the wanted value bracket it
        low = np.where(np.isnan(low) & (found <= wanted), trial, low)
        high = np.where(np.isnan(high) & (found > wanted), trial, high)
        exact = np.abs(found - wanted) <= _RESIDUAL
        low, high = np.where(exact, trial, low), np.where(exact, trial, high)
        if falls and number == 0 and np.isfinite(allowed.at_least):
            unreachable = found < wanted - _RESIDUAL
        if not (np.isnan(low) | np.isnan(high))[~unreachable].any():
            break
    missed = np.isnan(low) | np.isnan(high)
    if missed.all():
        return MonotonicRoots(np.full_like(start, np.nan), least, most)
    # those without a bracket are discarded at the end
    low, high = (np.where(missed, start, bound) for bound in (low, high))
    place = find_root(lambda value: function(value) - wanted, low, high, close=_RESIDUAL)
    discontinuous = ~(np.abs(function(place) - wanted) <= _JUMP)
    return MonotonicRoots(np.where(missed | discontinuous, np.nan, place), least, most)
