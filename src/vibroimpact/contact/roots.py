"""Vectorized root finding and maximization of scalar functions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.ranges import Range

_MAX_ITERATIONS = 200  # of the refinement of a bracket
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
    """Return the roots of a function, elementwise, between the ends of brackets.

    The function is positive at `high` and not positive at `low`. Each step is an inverse quadratic
    interpolation or a bisection, by the criterion of Chandrupatla (1997).

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
        The end of the bracket at which the function is positive, or the argument at which it counts
        as zero.

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
    # `latest` and `opposite` bracket the root
    latest = np.asarray(low, dtype=float)
    opposite = np.asarray(high, dtype=float)
    latest_value = function(latest)
    opposite_value = function(opposite)
    # the next trial is at this fraction of the bracket, from `latest`: first that of the secant
    with np.errstate(all="ignore"):
        fraction = latest_value / (latest_value - opposite_value)
    fraction = np.where(np.isfinite(fraction), np.clip(fraction, 0.05, 0.95), 0.5)
    for _ in range(_MAX_ITERATIONS):
        trial = latest + fraction * (opposite - latest)
        trial_value = function(trial)
        same_sign = np.equal(trial_value > 0.0, latest_value > 0.0)
        # `previous` has just left the bracket
        previous = np.where(same_sign, latest, opposite)
        previous_value = np.where(same_sign, latest_value, opposite_value)
        opposite = np.where(same_sign, opposite, latest)
        opposite_value = np.where(same_sign, opposite_value, latest_value)
        latest = trial
        latest_value = trial_value
        width = np.abs(opposite - latest)
        final_width = tolerance * np.maximum(np.abs(latest), np.abs(opposite))
        is_narrow = ~(width > final_width)
        is_zero = np.minimum(np.abs(latest_value), np.abs(opposite_value)) < close
        if not np.any(~is_narrow & ~is_zero):
            break
        points = (latest, opposite, previous)
        values = (latest_value, opposite_value, previous_value)
        with np.errstate(all="ignore"):
            fraction = _interpolated_fraction(points, values, final_width / width)
        # elements that have converged stay where they are, whatever the others still need
        fraction = np.where(is_narrow, 0.0, fraction)
        latest_is_nearer = np.abs(latest_value) <= np.abs(opposite_value)
        fraction = np.where(is_zero, np.where(latest_is_nearer, 0.0, 1.0), fraction)
    latest_is_nearer = np.abs(latest_value) <= np.abs(opposite_value)
    is_zero = np.minimum(np.abs(latest_value), np.abs(opposite_value)) < close
    return np.where(np.where(is_zero, latest_is_nearer, latest_value > 0.0), latest, opposite)


def _interpolated_fraction(
    points: tuple[Array, Array, Array], values: tuple[Array, Array, Array], final_width: Array
) -> Array:
    """Return where to look next, as a fraction of the bracket from its latest end.

    It is that of inverse quadratic interpolation where Chandrupatla's criterion allows it, and one
    half, a bisection, elsewhere.

    Parameters
    ----------
    points, values : tuple of three arrays
        The latest end of the bracket, the opposite one and the previous point, and the values of
        the function there.
    final_width : array
        The final width of the bracket relative to its present one, by which trials stay away from
        its ends.
    """
    a, b, c = points
    f_a, f_b, f_c = values
    # Chandrupatla: the inverse quadratic through the three points is monotonic between the ends
    xi = (a - b) / (c - b)
    phi = (f_a - f_b) / (f_c - f_b)
    is_monotonic = (phi * phi < xi) & ((1.0 - phi) ** 2 < 1.0 - xi)
    # its argument at zero, less a and over b - a, by Lagrange's formula
    by_opposite = f_a / (f_b - f_a) * f_c / (f_b - f_c)
    by_previous = (c - a) / (b - a) * f_a / (f_c - f_a) * f_b / (f_c - f_b)
    fraction = by_opposite + by_previous
    edge = np.minimum(final_width, 0.5)
    interpolated = np.clip(fraction, edge, 1.0 - edge)
    return np.where(is_monotonic & np.isfinite(fraction), interpolated, 0.5)


class MonotonicRoots(NamedTuple):
    """Arguments at which a function has wanted values.

    Attributes
    ----------
    place : array
        The arguments; NaN where none was found.
    least, most : array
        The extreme values of the function among those evaluated in the search for brackets.
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
    low = np.full_like(start, np.nan)
    high = np.full_like(start, np.nan)
    least = np.full_like(start, np.inf)
    most = np.full_like(start, -np.inf)
    unreachable = np.zeros(start.shape, dtype=bool)
    for number, trial in enumerate(_trials(start, allowed, max_steps)):
        # at extreme arguments, which only others need, the function may be slow
        has_bracket = ~(np.isnan(low) | np.isnan(high))
        trial = np.where(has_bracket, low, trial)
        value = function(trial)
        least = np.fmin(least, value)
        most = np.fmax(most, value)
        # the first arguments found on either side of the wanted value bracket it
        low = np.where(np.isnan(low) & (value <= wanted), trial, low)
        high = np.where(np.isnan(high) & (value > wanted), trial, high)
        is_exact = np.abs(value - wanted) <= _RESIDUAL
        low = np.where(is_exact, trial, low)
        high = np.where(is_exact, trial, high)
        # the first trial is the lower end of the range, if there is one
        if falls and number == 0 and np.isfinite(allowed.at_least):
            unreachable = value < wanted - _RESIDUAL
        if not (np.isnan(low) | np.isnan(high))[~unreachable].any():
            break
    has_no_bracket = np.isnan(low) | np.isnan(high)
    if has_no_bracket.all():
        return MonotonicRoots(np.full_like(start, np.nan), least, most)
    # those without a bracket are discarded at the end
    low = np.where(has_no_bracket, start, low)
    high = np.where(has_no_bracket, start, high)
    root = find_root(lambda argument: function(argument) - wanted, low, high, close=_RESIDUAL)
    # at a jump the bracket closes on a place where the function is not near the wanted value
    is_discontinuous = ~(np.abs(function(root) - wanted) <= _JUMP)
    return MonotonicRoots(np.where(has_no_bracket | is_discontinuous, np.nan, root), least, most)


def _trials(start: Array, allowed: Range, max_steps: int) -> Iterator[Array]:
    """Yield the finite ends of a range, then the start times powers of four to either side."""
    for end in (allowed.at_least, allowed.at_most):
        if np.isfinite(end):
            yield allowed.clip(end + 0.0 * start)
    for count in range(max_steps):
        powers = (-count, count) if count else (0,)
        for power in powers:
            yield allowed.clip(start * 4.0**power)
