"""Solve for the parameter value with which each impact matches its target.

Further, derivatives of the impact quantities.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.observed.matchable import REBOUNDS
from vibroimpact.contact.roots import find_root, solve_monotonic
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.ranges import Range

_STEP = 1e-4
"""Relative step of central differences: with impacts accurate to 1e-12, truncation and
rounding errors are both about 1e-8.
"""

_CLOSE = 1e-11
"""Relative deviation from the target that counts as zero."""

GRID = np.append(0.0, 4.0 ** np.arange(-8.0, 9.0))
"""Multiples of the initial guess that are scanned before a root is refined."""


@dataclass(frozen=True)
class Tunable:
    """A parameter that can be tuned, and the impacts as a function of it.

    Parameters
    ----------
    name, unit : str
        Name and unit of the parameter.
    allowed : Range
        Allowed range of the value.
    start : float
        Initial guess, > 0.
    given : array, shape (n,) or ()
        Its value as given by the case, one per impact; NaN where the case gives none.
    respond : callable
        Takes approach speeds [m/s] (m,), values (m,) and indices of the impacts (m,); returns the
        impact quantities, as `single_impacts` does.
    drop : callable
        Takes values, one per impact, and returns the drop with them; the last value holds for all
        further impacts.
    damps : bool
        Whether the separation speed is known to decrease with the value from its lower end.
    """

    name: str
    unit: str
    allowed: Range
    start: float
    given: Floats
    respond: Callable[[Floats, Floats, Indices], dict[str, Floats]]
    drop: Callable[[Floats], Problem]
    damps: bool = False


@dataclass(frozen=True)
class Match:
    """Values (n,) of the parameter, NaN without a solution.

    `least` and `most` are the extreme values of the matched quantity that the search has met; NaN
    for several quantities.
    """

    values: Floats
    least: Floats
    most: Floats


def match(
    tunable: Tunable,
    speeds: Floats,
    wanted: Mapping[str, Floats],
    weights: Mapping[str, float],
    which: Indices,
    max_steps: int = 20,
) -> Match:
    """Return the value with which each impact matches its target.

    For several quantities it is the best compromise.

    Parameters
    ----------
    tunable : Tunable
        The parameter.
    speeds : array, shape (n,)
        Approach speeds [m/s].
    wanted : mapping of str to array, shape (n,)
        Target values in SI units.
    weights : mapping of str to float
        Weights of the matched quantities. With several, the sum of weight times squared relative
        deviation is minimized.
    which : array of int, shape (n,)
        Index of the impact of the drop that each represents.
    max_steps : int, default 20
        Maximum number of steps by a factor of four from the initial guess in the search for a
        bracket.
    """
    start = np.full(len(speeds), tunable.start)
    if len(weights) == 1:
        (name,) = weights
        return _match_one(tunable, speeds, name, wanted[name], which, start, max_steps)
    scales = {name: residual_scale(name, speeds, wanted[name]) for name in weights}

    def deviations(values: Floats) -> dict[str, Floats]:
        outcomes = tunable.respond(speeds, values, which)
        return {name: (outcomes[name] - wanted[name]) / scales[name] for name in weights}

    values = _least_squares_value(deviations, start, weights, tunable.allowed)
    unknown = np.full(len(speeds), np.nan)
    return Match(values, least=unknown, most=unknown)


def _match_one(
    tunable: Tunable,
    speeds: Floats,
    name: str,
    wanted: Floats,
    which: Indices,
    start: Floats,
    max_steps: int,
) -> Match:
    """Return the value with which each impact matches one quantity, the root of its deviation."""
    scale = residual_scale(name, speeds, wanted)

    def deviation(values: Floats) -> Floats:
        return (tunable.respond(speeds, values, which)[name] - wanted) / scale

    falls = tunable.damps and name in REBOUNDS
    # force over damping has a minimum: take the smallest solution
    if tunable.damps and not falls:
        grid = [tunable.allowed.clip(factor * start) for factor in GRID]
        on_grid = np.array([deviation(values) for values in grid])
        return Match(
            _smallest_root(deviation, start, grid, on_grid),
            least=np.nanmin(on_grid, axis=0) * scale + wanted,
            most=np.nanmax(on_grid, axis=0) * scale + wanted,
        )
    # the solver wants values of the order of one: the deviation plus one is to be one
    roots = solve_monotonic(
        lambda values: deviation(values) + 1.0,
        np.ones(len(speeds)),
        start,
        tunable.allowed,
        falls=falls,
        max_steps=max_steps,
    )
    return Match(
        roots.place,
        least=(roots.least - 1.0) * scale + wanted,
        most=(roots.most - 1.0) * scale + wanted,
    )


def _smallest_root(
    deviation: Callable[[Floats], Floats], start: Floats, grid: list[Floats], on_grid: Floats
) -> Floats:
    """Return the smallest root of the deviation, NaN if it has no sign change on the grid.

    `on_grid` are the deviations there, (values, n).
    """
    positive = on_grid > 0.0
    changes = positive[1:] != positive[:-1]
    has_root = changes.any(axis=0)
    first = changes.argmax(axis=0)  # the lower end of the first interval with a root
    impacts = np.arange(len(start))
    values = np.stack(grid)
    lower = np.where(has_root, values[first, impacts], start)
    upper = np.where(has_root, values[first + 1, impacts], start)
    # find_root expects the function to become positive from its first end to its second
    rises = positive[first + 1, impacts]
    negative_end = np.where(rises, lower, upper)
    positive_end = np.where(rises, upper, lower)
    roots = find_root(deviation, negative_end, positive_end, close=_CLOSE)
    return np.where(has_root, roots, np.nan)


def _least_squares_value(
    deviations: Callable[[Floats], dict[str, Floats]],
    start: Floats,
    weights: Mapping[str, float],
    allowed: Range,
) -> Floats:
    """Return the minimizer of the weighted sum of squared deviations.

    It is the best point of a grid, refined by a root of the derivative.
    """

    def cost(values: Floats) -> Floats:
        return np.asarray(
            sum(weight * deviations(values)[name] ** 2 for name, weight in weights.items())
        )

    grid = [allowed.clip(factor * start) for factor in GRID]
    costs = np.array([cost(values) for values in grid])
    # the minimum lies between the neighbours of the best value of each impact
    best = np.nanargmin(np.where(np.isnan(costs), np.inf, costs), axis=0)
    grid_values = np.stack(grid)
    impacts = np.arange(len(start))
    lower = grid_values[np.maximum(best - 1, 0), impacts]
    upper = grid_values[np.minimum(best + 1, len(grid) - 1), impacts]

    def slope(values: Floats) -> Floats:
        """Return the central difference of the cost, up to its positive step."""
        step = _STEP * np.maximum(values, start * 1e-3)
        up = deviations(allowed.clip(values + step))
        down = deviations(allowed.clip(values - step))
        return np.asarray(
            sum(weight * (up[name] ** 2 - down[name] ** 2) for name, weight in weights.items())
        )

    has_minimum = (slope(lower) < 0.0) & (slope(upper) > 0.0)
    # a cost that rises from the least value on is least there; one that falls up to the largest of
    # the grid has no minimizer
    at_lowest_value = np.where(best == 0, grid[0], np.nan)
    if not has_minimum.any():
        return at_lowest_value
    minimizer = find_root(slope, lower, upper, tolerance=1e-10)
    return np.where(has_minimum, minimizer, at_lowest_value)


def residual_scale(name: str, speeds: Floats, wanted: Floats) -> Floats:
    """Return the scale of a deviation, the target value.

    For a separation speed, which may be zero, it is the approach speed.
    """
    if name == "separation_speed":
        return speeds
    return np.abs(wanted)


@dataclass(frozen=True)
class Derivatives:
    """Impact quantities (n,) by name, and their derivatives by the parameter and by the speed."""

    outcomes: dict[str, Floats]
    by_value: dict[str, Floats]
    by_speed: dict[str, Floats]


def derivatives(tunable: Tunable, speeds: Floats, values: Floats, which: Indices) -> Derivatives:
    """Return impact quantities and their derivatives by central differences.

    Values stay within the allowed range of the parameter.
    """
    step = _STEP * np.maximum(np.abs(values), 1e-3 * tunable.start)
    high = tunable.allowed.clip(values + step)
    low = tunable.allowed.clip(values - step)
    faster = speeds * (1.0 + _STEP)
    slower = speeds * (1.0 - _STEP)
    # one batch of impacts for all five points of the two differences
    batch = tunable.respond(
        np.concatenate([speeds, speeds, speeds, faster, slower]),
        np.concatenate([values, high, low, values, values]),
        np.tile(which, 5),
    )
    outcomes = {}
    by_value = {}
    by_speed = {}
    for name, quantity in batch.items():
        centre, at_high, at_low, at_faster, at_slower = quantity.reshape(5, -1)
        outcomes[name] = centre
        by_value[name] = (at_high - at_low) / (high - low)
        by_speed[name] = (at_faster - at_slower) / (faster - slower)
    return Derivatives(outcomes, by_value, by_speed)
