"""Sensitivity of a result to the swept keys.

Sobol indices, rank correlations, and one-at-a-time ranges on a grid.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats, Indices
from vibroimpact.studies.planning.design import generator

MOST_LEFT_OUT = 0.05
"""Maximum fraction of points without a value; with more, indices would not represent the study."""

RESAMPLES = 200
"""Number of bootstrap samples for the standard error of an index."""

# points of a block used for the bootstrap; for larger blocks the error is scaled by the root of
# their number
_MOST_RESAMPLED = 8192
_QUANTILE = 1.959964  # of the normal distribution, for 95 %


class SobolIndices(NamedTuple):
    """Sobol indices of one result, one value per axis.

    Attributes
    ----------
    first, total : array, shape (axes,)
        First-order index, the fraction of the variance due to an axis alone, and total index,
        including all interactions.
    first_error, total_error : array, shape (axes,)
        Half widths of the 95 % intervals.
    points, left_out : int
        Number of points of a block used, and number omitted since a drop has no value.
    """

    first: Floats
    total: Floats
    first_error: Floats
    total_error: Floats
    points: int
    left_out: int


def sobol_indices(values: Floats, axes: int, seed: int = 0) -> SobolIndices | None:
    r"""Return the Sobol indices of a result at the points of the design "saltelli".

    .. math::

        S_i = \frac{\overline{f_B\,(f_{AB_i} - f_A)}}{V}, \qquad
        T_i = \frac{\overline{(f_A - f_{AB_i})^2}}{2 V}

    :math:`V` is the variance over the blocks A and B. The half width of the interval is 1.96
    standard errors, from a bootstrap over at most the first 8192 points of a block and scaled by
    the root of the number of points for larger blocks. As the points of a Sobol sequence are more
    even than random ones, the interval is conservative.

    A point without a value in one block is omitted from all blocks. The indices are then those of
    the remaining points.

    Parameters
    ----------
    values : array, shape ((2 + axes) points,)
        Block A, block B, and for each axis block A with the values of B on that axis.
    axes : int
        Number of axes.
    seed : int
        Seed of the bootstrap.

    Returns
    -------
    SobolIndices or None
        None if the result does not vary, or more than 5 % of the points would have to be omitted.

    References
    ----------
    Saltelli, A. et al. (2010). Variance based sensitivity analysis of model output. Comput. Phys.
    Commun. 181, 259-270, table 2 (b) and (f).

    Examples
    --------
    >>> from vibroimpact.studies.planning.axes import Spaced
    >>> from vibroimpact.studies.planning.design import Asked
    >>> from vibroimpact.studies.designs.saltelli import plan
    >>> points = plan(Asked({"a": Spaced(0.0, 1.0, 2), "b": Spaced(0.0, 1.0, 2)}, 1024, 0)).columns
    >>> indices = sobol_indices(points["a"] + 2.0 * points["b"], 2)  # variances 1/12 and 4/12
    >>> indices.first.round(2).tolist(), indices.total.round(2).tolist()
    ([0.2, 0.8], [0.2, 0.8])
    """
    blocks = np.asarray(values, dtype=float).reshape(2 + axes, -1)
    complete = np.isfinite(blocks).all(axis=0)
    points = int(complete.sum())
    left_out = int((~complete).sum())
    if points < 2 or left_out > MOST_LEFT_OUT * len(complete):
        return None
    # the variance is that over the blocks A and B, at the points that have a value in all blocks
    sampled = blocks[:2, complete]
    if not float(np.std(sampled)) > 1e-9 * float(np.abs(sampled).max()):
        return None
    # SciPy requires a power of two: omitted points are set to the mean, which contributes nothing
    # to the sums
    blocks = np.where(complete, blocks, sampled.mean())
    first, total = _estimates(blocks)
    resampled_points = min(len(complete), _MOST_RESAMPLED)
    random = generator(seed, resampled_points)
    resampled = []
    for _ in range(RESAMPLES):
        indices = random.integers(resampled_points, size=resampled_points)
        resampled.append(_estimates(blocks[:, indices]))
    # the standard error falls with the root of the number of points
    scale = _QUANTILE * math.sqrt(resampled_points / len(complete))
    first_error, total_error = scale * np.std(resampled, axis=0, ddof=1)
    return SobolIndices(first, total, first_error, total_error, points, left_out)


def _estimates(blocks: Floats) -> Floats:
    """Return first and total indices, (2, axes), of blocks (2 + axes, points)."""
    from scipy.stats import sobol_indices as estimate

    evaluations = {"f_A": blocks[:1], "f_B": blocks[1:2], "f_AB": blocks[2:, None]}
    indices = estimate(func=evaluations, n=blocks.shape[1])
    return np.array([indices.first_order, indices.total_order])


def rank_correlations(inputs: Floats, output: Floats) -> Floats:
    """Return Spearman's rank correlation of a result with each input.

    It is 1 if the result increases monotonically with the input, -1 if it decreases.

    Parameters
    ----------
    inputs : array, shape (axes, drops)
        Input values of the drops.
    output : array, shape (drops,)
        The result; drops without a finite value are ignored.

    Returns
    -------
    array, shape (axes,)
        NaN for an input or a result that does not vary.

    References
    ----------
    Spearman, C. (1904). The proof and measurement of association between two things. Am. J.
    Psychol. 15, 72-101.

    Examples
    --------
    >>> rank_correlations(
    ...     np.array([[1.0, 2.0, 3.0], [3.0, 2.0, 1.0], [1.0, 1.0, 1.0]]), np.array([1.0, 8.0, 9.0])
    ... ).tolist()
    [1.0, -1.0, nan]
    """
    from scipy.stats import spearmanr

    correlations = np.full(len(inputs), math.nan)
    finite = np.isfinite(output)
    finite_output = output[finite]
    if len(finite_output) < 3 or not np.ptp(finite_output) > 0.0:
        return correlations
    for axis, values in enumerate(inputs):
        if np.ptp(values[finite]) > 0.0:
            correlations[axis] = float(spearmanr(values[finite], finite_output).statistic)
    return correlations


class OneAtATime(NamedTuple):
    """Range of a result along each axis of a grid, with all others at their middle level.

    Attributes
    ----------
    middle : float
        The result with all axes at their middle level.
    lowest, highest : array, shape (axes,)
        Minimum and maximum of the result along an axis.
    """

    middle: float
    lowest: Floats
    highest: Floats

    @property
    def relative(self) -> Floats:
        """The range relative to the result in the middle; NaN if that is zero."""
        if not self.middle:
            return np.full(len(self.lowest), math.nan)
        return (self.highest - self.lowest) / abs(self.middle)


def one_at_a_time(values: NDArray[Any], orders: list[Indices]) -> OneAtATime:
    """Return the range of a result along each axis of a grid.

    Parameters
    ----------
    values : array, of as many dimensions as the grid
        The result; NaN where a drop failed.
    orders : list of array
        For each axis the indices of its levels in ascending order; the middle one (the upper of
        two) is the middle level.

    Examples
    --------
    >>> one_at_a_time(np.array([[1.0, 2.0], [2.0, 4.0], [9.0, 8.0]]), [np.arange(3), np.arange(2)])
    OneAtATime(middle=4.0, lowest=array([2., 2.]), highest=array([8., 4.]))
    """
    middle = tuple(int(order[len(order) // 2]) for order in orders)
    lowest = np.full(len(orders), math.nan)
    highest = np.full(len(orders), math.nan)
    for axis in range(len(orders)):
        through_middle: list[Any] = list(middle)
        through_middle[axis] = slice(None)
        along_axis = np.asarray(values[tuple(through_middle)], dtype=np.float64)
        if np.isfinite(along_axis).any():
            lowest[axis] = np.nanmin(along_axis)
            highest[axis] = np.nanmax(along_axis)
    return OneAtATime(float(values[middle]), lowest, highest)
