"""Solve for the parameter value with which each impact matches its target, and
derivatives of the impact quantities.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.matchable import REBOUNDS
from vibroimpact.contact.roots import find_root, solve_monotonic
from vibroimpact.dynamics.problem import Problem
from vibroimpact.ranges import Range

_STEP = 1e-4
"""Relative step of central differences: with impacts accurate to 1e-12, truncation and
rounding errors are both about 1e-8.
"""

_CLOSE = 1e-11
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
    """Values (n,), NaN without a solution; least and largest value of the matched
    quantity found during the search (NaN for several).
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
    """Return the value with which each impact matches its target, or for several quantities the
    best compromise.

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
    scales = {name: residual_scale(name, speeds, wanted[name]) for name in weights}

    def misses(values: Floats) -> dict[str, Floats]:
        found = tunable.respond(speeds, values, which)
        return {name: (found[name] - wanted[name]) / scales[name] for name in weights}

    start = np.full(len(speeds), tunable.start)
    if len(weights) == 1:
        (name,) = weights
        falls = tunable.damps and name in REBOUNDS
        # force over damping has a minimum: take the smallest solution
        if tunable.damps and not falls:
            grid = [tunable.allowed.clip(factor * start) for factor in GRID]
            seen = np.array([misses(values)[name] for values in grid])
            least, most = (
                bound * scales[name] + wanted[name]
                for bound in (np.nanmin(seen, axis=0), np.nanmax(seen, axis=0))
            )
            return Match(
                _smallest_root(lambda values: misses(values)[name], start, grid, seen), least, most
            )
        found = solve_monotonic(
            lambda values: misses(values)[name] + 1.0,
            np.ones(len(speeds)),
            start,
            tunable.allowed,
            falls=falls,
            max_steps=max_steps,
        )
        least, most = (
            (bound - 1.0) * scales[name] + wanted[name] for bound in (found.least, found.most)
        )
        return Match(found.place, least, most)
    return Match(
        _least_squares_value(misses, start, weights, tunable.allowed),
        *np.full((2, len(speeds)), np.nan),
    )


def _smallest_root(
    miss: Callable[[Floats], Floats], start: Floats, grid: list[Floats], misses: Floats
) -> Floats:
    """Return the smallest root of the deviation, NaN if it has no sign change on the
    grid; `misses` are its values there, (values, n).
    """
    above = misses > 0.0
    turns = above[1:] != above[:-1]
    first, which = turns.argmax(axis=0), np.arange(len(start))
    some = turns.any(axis=0)
    ends = [np.where(some, np.stack(grid)[first + side, which], start) for side in (0, 1)]
    upwards = above[first + 1, which]  # find_root expects the function to become positive
    low, high = (np.where(upwards, ends[side], ends[1 - side]) for side in (0, 1))
    return np.where(some, find_root(miss, low, high, close=_CLOSE), np.nan)


def _least_squares_value(
    misses: Callable[[Floats], dict[str, Floats]],
    start: Floats,
    weights: Mapping[str, float],
    allowed: Range,
) -> Floats:
    """Return the minimizer of the weighted sum of squares: the best point of a grid,
    refined by a root of the derivative.
    """

    def cost(values: Floats) -> Floats:
        return np.asarray(
            sum(weight * misses(values)[name] ** 2 for name, weight in weights.items())
        )

    inside = [allowed.clip(factor * start) for factor in GRID]
    costs = np.array([cost(values) for values in inside])
    best = np.nanargmin(np.where(np.isnan(costs), np.inf, costs), axis=0)
    ends = [
        np.stack(inside)[np.clip(best + side, 0, len(inside) - 1), np.arange(len(start))]
        for side in (-1, 1)
    ]

    def slope(values: Floats) -> Floats:
        step = _STEP * np.maximum(values, start * 1e-3)
        up, down = (misses(allowed.clip(values + side * step)) for side in (1.0, -1.0))
        return np.asarray(
            sum(weight * (up[name] ** 2 - down[name] ** 2) for name, weight in weights.items())
        )

    turns = (slope(ends[0]) < 0.0) & (slope(ends[1]) > 0.0)
    if not turns.any():
        return np.where(best == 0, inside[0], np.nan)
    found = find_root(slope, *ends, tolerance=1e-10)
    return np.where(turns, found, np.where(best == 0, inside[0], np.nan))


def residual_scale(name: str, speeds: Floats, wanted: Floats) -> Floats:
    """Return the scale of a deviation: the target value; for a separation speed, which
    may be zero, the approach speed.
    """
    return speeds if name == "separation_speed" else np.abs(wanted)


@dataclass(frozen=True)
class Derivatives:
    """Impact quantities (n,) by name, and their derivatives with respect to the parameter
    and to the approach speed.
    """

    outcomes: dict[str, Floats]
    by_value: dict[str, Floats]
    by_speed: dict[str, Floats]


def derivatives(tunable: Tunable, speeds: Floats, values: Floats, which: Indices) -> Derivatives:
    """Return impact quantities and their derivatives by central differences within the
    allowed range of the parameter.
    """
    # one batch of impacts for all five points of the two differences
    step = _STEP * np.maximum(np.abs(values), 1e-3 * tunable.start)
    high, low = tunable.allowed.clip(values + step), tunable.allowed.clip(values - step)
    faster, slower = speeds * (1.0 + _STEP), speeds * (1.0 - _STEP)
    rows = np.tile(which, 5)
    every = tunable.respond(
        np.concatenate([speeds, speeds, speeds, faster, slower]),
        np.concatenate([values, high, low, values, values]),
        rows,
    )
    parts = {name: found.reshape(5, -1) for name, found in every.items()}
    return Derivatives(
        {name: part[0] for name, part in parts.items()},
        {name: (part[1] - part[2]) / (high - low) for name, part in parts.items()},
        {name: (part[3] - part[4]) / (faster - slower) for name, part in parts.items()},
    )
