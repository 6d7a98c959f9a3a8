"""Monotone cubics through chosen samples of many signals at once.

Empirical mode decomposition needs them.
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
    knots_of_each = np.diff(np.searchsorted(knots, samples * np.arange(count + 1)))
    signal = np.repeat(np.arange(count), knots_of_each)
    # the knots of each signal lie between one before its samples and one after them, which have the
    # heights of their neighbours
    last = np.cumsum(knots_of_each + 2) - 1
    first = last - knots_of_each - 1
    inner = np.arange(len(knots)) + 2 * signal + 1
    position, height = np.empty((2, len(knots) + 2 * count))
    position[inner] = knots - samples * signal
    height[inner] = value.ravel()[knots]
    position[first] = -1.0
    height[first] = height[first + 1]
    position[last] = samples
    height[last] = height[last - 1]
    width = np.diff(position)
    secant = np.diff(height)
    secant /= width
    slope = _monotone_slopes(width, secant)
    slope[first] = slope[last] = 0.0
    # of the cubic in the distance from the left knot of each interval
    quadratic = (3.0 * secant - 2.0 * slope[:-1] - slope[1:]) / width
    cubic = (slope[:-1] + slope[1:] - 2.0 * secant) / width**2

    # the samples of each interval between knots
    begin = samples * np.arange(count)
    bounds = np.empty(len(position), dtype=np.int64)
    bounds[first] = begin
    bounds[inner] = knots
    bounds[last] = begin + samples
    in_interval = np.diff(bounds)

    def at_samples(of_intervals: Floats) -> Floats:
        return np.repeat(of_intervals, in_interval).reshape(count, samples)

    distance = at_samples(-position[:-1])
    distance += np.arange(samples)
    # Horner's scheme
    polynomial = at_samples(cubic)
    for coefficient in (quadratic, slope[:-1], height[:-1]):
        polynomial *= distance
        polynomial += at_samples(coefficient)
    return np.asarray(polynomial)


def _monotone_slopes(width: Floats, secant: Floats) -> Floats:
    """Return the slopes of monotone cubics at knots, from widths and secants of intervals.

    They are weighted harmonic means of the secants to either side, and zero where these have
    different signs (Fritsch and Butland 1984); at the ends of the row they are zero.
    """
    left = secant[:-1]
    right = secant[1:]
    left_weight = 2.0 * width[1:] + width[:-1]
    right_weight = width[1:] + 2.0 * width[:-1]
    slope = np.zeros(len(width) + 1)
    np.divide(
        (left_weight + right_weight) * left * right,
        left_weight * right + right_weight * left,
        out=slope[1:-1],
        where=left * right > 0.0,
    )
    return slope
