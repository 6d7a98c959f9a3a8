"""Least squares with bounds for many chains at once, which differ in their start, their
data, or what they hold fixed.
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

_SWEEPS = 100
_STEP = 1e-3
_CLOSE = 1e-7
"""Step of the difference quotients, and last change of the values, relative to the values."""

_IDLE = 1e-9  # gain of a step, as a part of the sum of squares, with which a chain has settled
_SMALLEST, _LARGEST = 1e-12, 1e8  # of the damping of steps


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
    """Return the values with the least sum of squares near their start, by the method of Levenberg
    and Marquardt.

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
    held = np.zeros(values.shape, dtype=bool) if fixed is None else fixed
    left = residuals(values, np.arange(len(values)))
    cost, damping, moving = _sum(left), np.full(len(values), 1e-3), np.arange(len(values))
    for _ in range(_SWEEPS):
        if not moving.size:
            break
        here = values[moving]
        slopes = jacobian(residuals, here, left[moving], moving, bounds)
        uphill = np.einsum("snk,sn->sk", slopes, left[moving])
        outward = ((here <= bounds.least) & (uphill > 0.0)) | (
            (here >= bounds.most) & (uphill < 0.0)
        )
        free = ~(held[moving] | outward)
        slopes = np.where(free[:, None, :], slopes, 0.0)
        squares = np.einsum("snk,snj->skj", slopes, slopes)
        diagonal = np.einsum("skk->sk", squares)
        scales = damping[moving, None] * np.where(diagonal > 0.0, diagonal, 1.0)
        step = np.linalg.solve(
            squares + scales[:, :, None] * np.eye(values.shape[1]),
            np.where(free, uphill, 0.0)[:, :, None],
        )
        trial = np.clip(here - step[:, :, 0], bounds.least, bounds.most)
        left_there = residuals(trial, moving)
        cost_there = _sum(left_there)
        better = cost_there < cost[moving]
        with np.errstate(invalid="ignore"):  # infinite where an impact could not be computed
            idle = better & (cost[moving] - cost_there <= _IDLE * cost[moving])
        gone = moving[better]
        values[gone], left[gone], cost[gone] = trial[better], left_there[better], cost_there[better]
        damping[moving] = np.clip(damping[moving] * np.where(better, 0.1, 10.0), _SMALLEST, None)
        settled = idle | (np.abs(trial - here) <= _CLOSE * bounds.size(here)).all(axis=1)
        moving = moving[~settled & (damping[moving] < _LARGEST)]
    return Minimum(values, cost)


def jacobian(
    residuals: Residuals, values: Floats, left: Floats, chains: Indices, bounds: Bounds
) -> Floats:
    """Return the derivatives of the residuals by the values, (S, N, K); `left`: the
    residuals at the values.
    """
    number, count = values.shape
    step = _STEP * bounds.size(values)
    step = np.where(values + step > bounds.most, -step, step)
    ahead = values + np.eye(count)[:, None, :] * step  # (K, S, K), one value moved in each
    there = residuals(ahead.reshape(-1, count), np.tile(chains, count)).reshape(count, number, -1)
    return np.asarray(np.moveaxis((there - left) / step.T[:, :, None], 0, 2))


def _sum(left: Floats) -> Floats:
    return np.where(np.isnan(left).any(axis=1), np.inf, np.einsum("sn,sn->s", left, left))
