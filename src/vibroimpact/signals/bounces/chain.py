"""The chain of bounces among touches: intervals that shrink by a factor which changes slowly."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats, Indices

LOWEST = 0.05
"""Lowest restitution at which bounces are sought."""
HIGHEST = 0.99
"""Highest restitution at which bounces are sought."""

_CHANGE_DEVIATION = 0.05
"""Standard deviation of the change of the logarithm of the restitution between two bounces."""
_LARGEST_CHANGE = 3.0
"""Largest such change, in standard deviations."""


def longest_chain(time: Floats, weight: Floats, tolerance: float) -> Indices:
    r"""Return the touches of the chain that explains most.

    Of all chains :math:`t_0 < t_1 < \dots` whose factors :math:`e_n = (t_{n+2} - t_{n+1}) /
    (t_{n+1} - t_n)` lie between 0.05 and 0.99, it is the one with the largest sum of weights less
    half the squares of the changes of :math:`\ln e_n`, in standard deviations. It is found by
    dynamic programming over triples.

    Parameters
    ----------
    time : array, shape (n,)
        Times of the touches, ascending [s].
    weight : array, shape (n,)
        What each explains, above 0.
    tolerance : float
        Standard deviation of the times [s].

    Returns
    -------
    array of int
        Indices of the chain, three at least; none if there is no chain.

    Examples
    --------
    >>> longest_chain(np.array([0.0, 0.3, 1.0, 1.5, 1.6, 1.75]), np.ones(6), 1e-4).tolist()
    [0, 2, 3, 5]
    """
    count = len(time)
    no_chain = np.zeros(0, dtype=np.intp)
    if count < 3:
        return no_chain
    log_factor, log_deviation = _log_factors(time, tolerance)
    # the largest score of a chain that ends with the touches i, j, k; at first of these alone
    best = np.where(
        np.isfinite(log_factor),
        weight[:, None, None] + weight[None, :, None] + weight[None, None, :],
        -np.inf,
    )
    # the touch before them in that chain; -1 if there is none
    previous = np.full((count, count, count), -1)
    # the scores of chains that end with h, i, j are final by then: they were set at the pair h, i
    for j in range(2, count):
        for i in range(1, j):
            earlier = np.flatnonzero(best[:i, i, j] > -np.inf)
            later = j + np.flatnonzero(np.isfinite(log_factor[i, j, j:]))
            if not len(earlier) or not len(later):
                continue
            # of each earlier touch (rows) and each later one (columns)
            difference = log_factor[i, j, later][None] - log_factor[earlier, i, j][:, None]
            variance = (
                _CHANGE_DEVIATION**2
                + log_deviation[earlier, i, j][:, None] ** 2
                + log_deviation[i, j, later][None] ** 2
            )
            change = difference**2 / variance
            score = np.where(
                change <= _LARGEST_CHANGE**2, best[earlier, i, j][:, None] - 0.5 * change, -np.inf
            )
            best_row = np.argmax(score, axis=0)
            best_score = score[best_row, np.arange(len(later))] + weight[later]
            better = best_score > best[i, j, later]
            best[i, j, later[better]] = best_score[better]
            previous[i, j, later[better]] = earlier[best_row[better]]
    if not best.max() > -np.inf:
        return no_chain
    return _traced_back(best, previous)


def _log_factors(time: Floats, tolerance: float) -> tuple[Floats, Floats]:
    """Return the logarithms of the factors of all triples i, j, k, with their deviations.

    They are NaN where touches are not in order, or the factor is out of range.
    """
    interval = time[None, :] - time[:, None]
    first = interval[:, :, None]
    second = interval[None, :, :]
    with np.errstate(divide="ignore", invalid="ignore"):
        factor = second / first
        ascending = (first > 0.0) & (second > 0.0)
        in_range = (factor >= LOWEST) & (factor <= HIGHEST)
        log_factor = np.log(np.where(ascending & in_range, factor, np.nan))
        # derivatives of ln((t_k - t_j) / (t_j - t_i)) by the three times
        by_first = 1.0 / first
        by_last = 1.0 / second
        slope_norm = np.sqrt(by_first**2 + (by_first + by_last) ** 2 + by_last**2)
        log_deviation = tolerance * slope_norm
    return log_factor, log_deviation


def _traced_back(best: Floats, previous: Indices) -> Indices:
    """Return the chain with the largest score, from its last triple back to its first touch."""
    last_triple = np.unravel_index(int(np.argmax(best)), best.shape)
    i, j, k = (int(touch) for touch in last_triple)
    chain = [k, j, i]
    while previous[i, j, k] >= 0:
        i, j, k = int(previous[i, j, k]), i, j
        chain.append(i)
    return np.array(chain[::-1])
