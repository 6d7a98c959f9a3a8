"""Intervals of parameters that are fitted together.

They follow from the profile of the sum of squares, or from a parametric bootstrap.
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

_DISTANCES = 4.0 ** np.arange(-1.0, 7.0)
"""Distances from the best value in the search for the ends of an interval, in first-order half
widths.
"""

_CLOSE = 1e-3
"""Tolerance of the ends of an interval."""

_AT_ONCE = 100
"""Number of samples that are fitted at once."""


def profile_intervals(residuals: Residuals, best: Minimum, bounds: Bounds, rise: float) -> Floats:
    r"""Return the ends of the intervals (K, 2) by the profile of the sum of squares.

    Within an interval it rises by at most :math:`r^2`, with all other values refitted. An end is
    infinite, or the bound, where no value on that side makes it rise so far.

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
    parameter_count = best.values.shape[1]
    # each parameter has two ends, below and above the best value
    parameter = np.repeat(np.arange(parameter_count), 2)
    sides = np.tile([-1.0, 1.0], parameter_count)

    def excess(ends: Indices, end_values: Floats) -> Floats:
        """Return by how much the root of the rise exceeds r, with values of some ends."""
        chains = np.arange(len(ends))
        start = np.repeat(best.values, len(ends), axis=0)
        start[chains, parameter[ends]] = end_values
        fixed = np.zeros(start.shape, dtype=bool)
        fixed[chains, parameter[ends]] = True
        minimum = minimize(residuals, start, bounds, fixed)
        return np.asarray(np.sqrt(np.maximum(minimum.cost - best.cost[0], 0.0)) - rise)

    all_ends = np.arange(2 * parameter_count)
    best_values = best.values[0, parameter]
    half_widths = _half_widths(residuals, best, bounds, rise)[parameter]
    furthest = np.where(sides > 0.0, bounds.most[parameter], bounds.least[parameter])
    # outwards from the best value, until the sum of squares has risen too far
    trials = best_values + sides * _DISTANCES[:, None] * half_widths
    trials = np.where(sides > 0.0, np.minimum(trials, furthest), np.maximum(trials, furthest))
    beyond = np.zeros(trials.shape, dtype=bool)
    for trial, row in zip(trials, beyond, strict=True):
        inside = np.flatnonzero(~beyond.any(axis=0))
        if inside.size:
            row[inside] = excess(inside, trial[inside]) > 0.0
    closed = np.flatnonzero(beyond.any(axis=0))
    first_beyond = beyond.argmax(axis=0)
    inner = np.where(first_beyond > 0, trials[first_beyond - 1, all_ends], best_values)
    outer = trials[first_beyond, all_ends]
    # an end that no trial is beyond lies at the bound
    interval_ends = furthest.copy()
    if closed.size:
        interval_ends[closed] = find_root(
            lambda end_values: excess(closed, end_values),
            inner[closed],
            outer[closed],
            tolerance=_CLOSE,
            close=_CLOSE * rise,
        )
    return interval_ends.reshape(parameter_count, 2)


def _half_widths(residuals: Residuals, best: Minimum, bounds: Bounds, rise: float) -> Floats:
    """Return half widths of the intervals (K,) to first order.

    Where a value has no influence, it is the size of the value.
    """
    chain = np.zeros(1, dtype=np.intp)
    slopes = jacobian(residuals, best.values, residuals(best.values, chain), chain, bounds)[0]
    size = bounds.size(best.values[0])
    scaled = slopes * size
    deviations = np.sqrt(np.diag(np.linalg.pinv(scaled.T @ scaled, hermitian=True)))
    relative = rise * deviations
    return np.asarray(np.where((deviations > 0.0) & (relative < 1.0), relative, 1.0) * size)


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
    fitted_values = []
    for begin in range(0, draws, _AT_ONCE):
        samples = np.arange(begin, min(begin + _AT_ONCE, draws))
        start = np.repeat(best.values, len(samples), axis=0)

        def residuals_of_samples(
            values: Floats, chains: Indices, samples: Indices = samples
        ) -> Floats:
            return residuals(values, samples[chains])

        fitted_values.append(minimize(residuals_of_samples, start, bounds).values)
        progress(float(samples[-1] + 1) / draws)
    tail = 50.0 * (1.0 - confidence)
    ends = np.percentile(np.concatenate(fitted_values), [tail, 100.0 - tail], axis=0)
    return np.asarray(ends.T)
