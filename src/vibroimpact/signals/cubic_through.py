"""Monotone cubics through chosen samples of many signals at once, as empirical mode
decomposition needs them.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats, Indices


def cubic_through(value: Floats, knots: Indices) -> Floats:
    """Return piecewise cubics through samples of signals, at all samples.

    Between two knots the cubic does not leave their heights (Fritsch and Butland 1984, SIAM J. Sci.
    Stat. Comput. 5:300); before the first knot and after the last one it is constant.

    Parameters
    ----------
    value : array, shape (n, samples)
        The signals.
    knots : array of int
        The samples that the cubics go through, as places in the flattened signals, rising: one in
        each signal at least.

    Returns
    -------
    array, shape (n, samples)
        The cubics.
    """
    count, samples = value.shape
    number = np.diff(np.searchsorted(knots, samples * np.arange(count + 1)))
    row = np.repeat(np.arange(count), number)
    # of each signal: one before it, its knots, one after it; the two have the heights of their
    # neighbours
    last = np.cumsum(number + 2) - 1
    first = last - number - 1
    inner = np.arange(len(knots)) + 2 * row + 1
    place, height = np.empty((2, len(knots) + 2 * count))
    place[inner], height[inner] = knots - samples * row, value.ravel()[knots]
    place[first], height[first] = -1.0, height[first + 1]
    place[last], height[last] = samples, height[last - 1]
    step, slope = np.diff(place), np.diff(height)
    slope /= step
    # slopes at the knots: weighted harmonic means of those beside, zero where these have different
    # signs
    before, after, bent = slope[:-1], slope[1:], np.zeros(len(place))
    near, distant = 2.0 * step[1:] + step[:-1], step[1:] + 2.0 * step[:-1]
    same = before * after > 0.0
    np.divide(
        (near + distant) * before * after,
        near * after + distant * before,
        out=bent[1:-1],
        where=same,
    )
    bent[first] = bent[last] = 0.0
    square = (3.0 * slope - 2.0 * bent[:-1] - bent[1:]) / step
    cubic = (bent[:-1] + bent[1:] - 2.0 * slope) / step**2
    # the samples of each interval between knots
    bound = np.empty(len(place), dtype=np.int64)
    begin = samples * np.arange(count)
    bound[first], bound[inner], bound[last] = begin, knots, begin + samples
    length = np.diff(bound)
    far, height, linear, square, found = (
        np.repeat(one, length).reshape(count, samples)
        for one in (-place[:-1], height[:-1], bent[:-1], square, cubic)
    )
    far += np.arange(samples)
    for part in (square, linear, height):
        found *= far
        found += part
    return np.asarray(found)
