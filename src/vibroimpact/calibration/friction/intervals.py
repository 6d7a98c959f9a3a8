"""Intervals of parameters that are fitted together: by the profile of the sum of squares,
or by a parametric bootstrap.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.friction.least_squares import (
    Bounds,
    Minimum,
    Residuals,
    jacobian,
    minimize,
)
from vibroimpact.contact.roots import find_root

_FURTHER = 4.0 ** np.arange(-1.0, 7.0)
"""Distances from the best value in the search for the ends of an interval, in first-order
half widths.
"""

_CLOSE = 1e-3
_AT_ONCE = 100


def profile_intervals(residuals: Residuals, best: Minimum, bounds: Bounds, rise: float) -> Floats:
    r"""Return the ends of the intervals (K, 2) within which the sum of squares rises by at most
    :math:`r^2`, all other values refitted.

    An end is infinite, or the bound, where no value on that side makes it rise so far.

    Parameters
    ----------
    residuals : callable
        The residuals, the same for all chains.
    best : Minimum
        The minimum, of one chain.
    bounds : Bounds
        Bounds of the values.
    rise : float
        r, the half width in standard deviations.

    References
    ----------
    Venzon, D. J. and Moolgavkar, S. H. (1988). A method for computing profile-likelihood-based
    confidence intervals. Applied Statistics 37, 87-94.

    Examples
    --------
    >>> bounds = Bounds(np.zeros(1), np.full(1, np.inf), np.ones(1))
    >>> residuals = lambda values, chains: (np.minimum(values, 3.0) - 2.0) / 0.5
    >>> profile_intervals(residuals, Minimum(np.full((1, 1), 2.0), np.zeros(1)), bounds, 2.5).round(
    ...     3
    ... ).tolist()
    [[0.75, inf]]
    """
    count = best.values.shape[1]
    which, sides = np.repeat(np.arange(count), 2), np.tile([-1.0, 1.0], count)

    def excess(ends: Indices, places: Floats) -> Floats:
        """Return by how much the root of the rise exceeds r, with the value of each end
        at a place.
        """
        start, rows = np.repeat(best.values, len(ends), axis=0), np.arange(len(ends))
        start[rows, which[ends]] = places
        fixed = np.zeros(start.shape, dtype=bool)
        fixed[rows, which[ends]] = True
        found = minimize(residuals, start, bounds, fixed)
        return np.asarray(np.sqrt(np.maximum(found.cost - best.cost[0], 0.0)) - rise)

    half = _half_widths(residuals, best, bounds, rise)[which]
    most = np.where(sides > 0.0, bounds.most[which], bounds.least[which])
    trials = best.values[0, which] + sides * _FURTHER[:, None] * half
    trials = np.where(sides > 0.0, np.minimum(trials, most), np.maximum(trials, most))
    every = np.tile(np.arange(2 * count), len(_FURTHER))
    beyond = (excess(every, trials.ravel()) > 0.0).reshape(trials.shape)
    closed = np.flatnonzero(beyond.any(axis=0))
    first = beyond.argmax(axis=0)
    inner = np.where(first > 0, trials[first - 1, np.arange(2 * count)], best.values[0, which])
    outer = trials[first, np.arange(2 * count)]
    found = most.copy()
    if closed.size:
        found[closed] = find_root(
            lambda places: excess(closed, places),
            inner[closed],
            outer[closed],
            tolerance=_CLOSE,
            close=_CLOSE * rise,
        )
    return found.reshape(count, 2)


def _half_widths(residuals: Residuals, best: Minimum, bounds: Bounds, rise: float) -> Floats:
    """Return half widths of the intervals (K,) to first order; where a value has no
    influence, its size.
    """
    chains = np.zeros(1, dtype=np.intp)
    slopes = jacobian(residuals, best.values, residuals(best.values, chains), chains, bounds)[0]
    size = bounds.size(best.values[0])
    scaled = slopes * size
    spread = np.sqrt(np.diag(np.linalg.pinv(scaled.T @ scaled, hermitian=True)))
    return np.asarray(np.where((spread > 0.0) & (rise * spread < 1.0), rise * spread, 1.0) * size)


def bootstrap_intervals(
    residuals: Residuals,
    best: Minimum,
    bounds: Bounds,
    draws: int,
    confidence: float,
    progress: Callable[[float], None],
) -> Floats:
    """Return the ends of the intervals (K, 2) from fits to samples, a chain each.

    Parameters
    ----------
    residuals : callable
        The residuals from the sample of each chain.
    best : Minimum
        The fit to the measurement.
    bounds : Bounds
        Bounds of the values.
    draws : int
        Number of samples.
    confidence : float
        Confidence level.
    progress : callable
        Called with the fraction done.
    """
    found = []
    for begin in range(0, draws, _AT_ONCE):
        some = np.arange(begin, min(begin + _AT_ONCE, draws))
        start = np.repeat(best.values, len(some), axis=0)

        def residuals_of_samples(values: Floats, chains: Indices, some: Indices = some) -> Floats:
            return residuals(values, some[chains])

        found.append(minimize(residuals_of_samples, start, bounds).values)
        progress(float(some[-1] + 1) / draws)
    tails = 50.0 * (1.0 - confidence)
    return np.asarray(np.percentile(np.concatenate(found), [tails, 100.0 - tails], axis=0).T)
