"""Least squares with bounds for many chains at once.

The chains differ in their start, their data, or what they hold fixed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices

Residuals = Callable[[Floats, Indices], Floats]
"""Takes values (S, K) and the indices of their chains (S,); returns residuals over their
standard deviations, (S, N).
"""

_MOST_ITERATIONS = 100

_STEP = 1e-3
"""Step of the difference quotients, relative to the values."""

_CLOSE = 1e-7
"""Last change of the values, relative to the values."""

_IDLE = 1e-9
"""Gain of a step, as a fraction of the sum of squares, with which a chain has settled."""

_FIRST_DAMPING = 1e-3
_LEAST_DAMPING = 1e-12
_MOST_DAMPING = 1e8
"""Damping of the steps, relative to the diagonal of the normal matrix."""


class Bounds(NamedTuple):
    """Least and largest values, and sizes below which values count as small, each (K,)."""

    least: Floats
    most: Floats
    small: Floats

    def size(self, values: Floats) -> Floats:
        """Return the sizes of values, for steps relative to them."""
        return np.asarray(np.maximum(np.abs(values), self.small))


class Minimum(NamedTuple):
    """Values (S, K), and the sums of squared residuals (S,)."""

    values: Floats
    cost: Floats


def minimize(
    residuals: Residuals, start: Floats, bounds: Bounds, fixed: Bools | None = None
) -> Minimum:
    """Return the values with the least sum of squares near their start, by Levenberg-Marquardt.

    Parameters
    ----------
    residuals : callable
        The residuals.
    start : array, shape (S, K)
        The values at the start of each chain.
    bounds : Bounds
        Bounds of the values.
    fixed : array of bool, shape (S, K), optional
        Which values stay as they are.

    References
    ----------
    Marquardt, D. W. (1963). An algorithm for least-squares estimation of nonlinear parameters. J.
    Soc. Ind. Appl. Math. 11, 431-441.

    Examples
    --------
    >>> bounds = Bounds(np.zeros(1), np.full(1, np.inf), np.ones(1))
    >>> residuals = lambda values, chains: values**2 - np.array([[2.0], [9.0]])[chains]
    >>> minimize(residuals, np.ones((2, 1)), bounds).values.round(6).tolist()
    [[1.414214], [3.0]]
    """
    values = np.clip(start, bounds.least, bounds.most)
    held = fixed
    if held is None:
        held = np.zeros(values.shape, dtype=bool)
    residual = residuals(values, np.arange(len(values)))
    cost = _cost(residual)
    damping = np.full(len(values), _FIRST_DAMPING)
    moving = np.flatnonzero(~held.all(axis=1))
    for _ in range(_MOST_ITERATIONS):
        if not moving.size:
            break
        current = values[moving]
        slopes = jacobian(residuals, current, residual[moving], moving, bounds, held[moving])
        gradient = np.einsum("snk,sn->sk", slopes, residual[moving])
        # values at a bound stay there if the sum of squares falls beyond it
        below = (current <= bounds.least) & (gradient > 0.0)
        above = (current >= bounds.most) & (gradient < 0.0)
        free = ~(held[moving] | below | above)
        step = _damped_step(slopes, gradient, free, damping[moving])
        trial = np.clip(current - step, bounds.least, bounds.most)
        trial_residual = residuals(trial, moving)
        trial_cost = _cost(trial_residual)
        better = trial_cost < cost[moving]
        with np.errstate(invalid="ignore"):  # infinite where an impact could not be computed
            idle = better & (cost[moving] - trial_cost <= _IDLE * cost[moving])
        accepted = moving[better]
        values[accepted] = trial[better]
        residual[accepted] = trial_residual[better]
        cost[accepted] = trial_cost[better]
        # towards Gauss-Newton after a step that helped, towards steepest descent after one that
        # did not
        change = np.where(better, 0.1, 10.0)
        damping[moving] = np.maximum(damping[moving] * change, _LEAST_DAMPING)
        close = np.abs(trial - current) <= _CLOSE * bounds.size(current)
        settled = idle | close.all(axis=1)
        moving = moving[~settled & (damping[moving] < _MOST_DAMPING)]
    return Minimum(values, cost)


def _damped_step(slopes: Floats, gradient: Floats, free: Bools, damping: Floats) -> Floats:
    """Return the steps (S, K) that solve the normal equations with Marquardt's damping.

    Its scale is the diagonal of the normal matrix. Values that are not `free` do not move.
    """
    slopes = np.where(free[:, None, :], slopes, 0.0)
    normal = np.einsum("snk,snj->skj", slopes, slopes)
    diagonal = np.einsum("skk->sk", normal)
    scales = damping[:, None] * np.where(diagonal > 0.0, diagonal, 1.0)
    step = np.linalg.solve(
        normal + scales[:, :, None] * np.eye(slopes.shape[2]),
        np.where(free, gradient, 0.0)[:, :, None],
    )
    return np.asarray(step[:, :, 0])


def jacobian(
    residuals: Residuals,
    values: Floats,
    residual: Floats,
    chains: Indices,
    bounds: Bounds,
    held: Bools | None = None,
) -> Floats:
    """Return the derivatives of the residuals by the values, (S, N, K).

    Those by values that are `held` (S, K) are not computed, and zero.
    `residual`: the residuals at the values, (S, N).
    """
    chain_count, value_count = values.shape
    step = _STEP * bounds.size(values)
    # backwards where a step forwards would leave the bounds
    step = np.where(values + step > bounds.most, -step, step)
    if held is None:
        held = np.zeros(values.shape, dtype=bool)
    # all steps are computed at once: a chain for each value that moves, with that one moved
    chain, moved_value = np.nonzero(~held)
    moved_step = step[chain, moved_value]
    moved = values[chain]
    moved[np.arange(len(moved)), moved_value] += moved_step
    change = residuals(moved, chains[chain]) - residual[chain]
    slopes = np.zeros((chain_count, value_count, residual.shape[1]))
    slopes[chain, moved_value] = change / moved_step[:, None]
    return np.moveaxis(slopes, 1, 2)


def _cost(residual: Floats) -> Floats:
    """Return the sums of squares, (S,); infinite where an impact could not be computed."""
    squares = np.einsum("sn,sn->s", residual, residual)
    return np.where(np.isnan(residual).any(axis=1), np.inf, squares)
