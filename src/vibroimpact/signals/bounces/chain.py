"""The chain of bounces among touches: intervals that shrink by a factor which changes slowly."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats, Indices

LOWEST, HIGHEST = 0.05, 0.99
"""Restitutions between which bounces are sought."""

_SLOWLY, _FURTHEST = 0.05, 3.0
"""Standard deviation of the change of the logarithm of the restitution from a bounce to
the next; the largest change, in these.
"""


def longest_chain(time: Floats, weight: Floats, tolerance: float) -> Indices:
    r"""Return the touches of the chain that explains most.

    Of all chains :math:`t_0 < t_1 < \dots` whose factors :math:`e_n = (t_{n+2} - t_{n+1}) /
    (t_{n+1} - t_n)` lie between 0.05 and
    0.99, it is the one with the largest sum of weights less half the squares of the changes of
    :math:`\ln e_n`, in standard deviations.
    It is found by dynamic programming over triples.

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
    number = len(time)
    if number < 3:
        return np.zeros(0, dtype=np.intp)
    apart = time[None, :] - time[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        factor = apart[None, :, :] / apart[:, :, None]  # of touches i, j, k
        order = (apart[:, :, None] > 0.0) & (apart[None, :, :] > 0.0)
        factor = np.where(order & (factor >= LOWEST) & (factor <= HIGHEST), factor, np.nan)
        log = np.log(factor)
        # of the logarithm, by the times of its three touches
        first, second = 1.0 / apart[:, :, None], 1.0 / apart[None, :, :]
        jitter = tolerance * np.sqrt(first**2 + (first + second) ** 2 + second**2)
    best = np.where(
        np.isfinite(log),
        weight[:, None, None] + weight[None, :, None] + weight[None, None, :],
        -np.inf,
    )
    came = np.full((number, number, number), -1)
    for j in range(2, number):
        for i in range(1, j):
            before, after = (
                np.flatnonzero(best[:i, i, j] > -np.inf),
                j + np.flatnonzero(np.isfinite(log[i, j, j:])),
            )
            if not len(before) or not len(after):
                continue
            variance = (
                _SLOWLY**2 + jitter[before, i, j][:, None] ** 2 + jitter[i, j, after][None] ** 2
            )
            change = (log[i, j, after][None] - log[before, i, j][:, None]) ** 2 / variance
            score = np.where(
                change <= _FURTHEST**2, best[before, i, j][:, None] - 0.5 * change, -np.inf
            )
            at = np.argmax(score, axis=0)
            top = score[at, np.arange(len(after))] + weight[after]
            better = top > best[i, j, after]
            best[i, j, after[better]] = top[better]
            came[i, j, after[better]] = before[at[better]]
    if not best.max() > -np.inf:
        return np.zeros(0, dtype=np.intp)
    i, j, k = (int(place) for place in np.unravel_index(int(np.argmax(best)), best.shape))
    chain = [k, j, i]
    while came[i, j, k] >= 0:
        i, j, k = int(came[i, j, k]), i, j
        chain.append(i)
    return np.array(chain[::-1])
