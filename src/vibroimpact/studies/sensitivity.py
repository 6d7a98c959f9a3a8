"""Sensitivity of a result to the swept keys: Sobol indices, rank correlations, and
one-at-a-time ranges on a grid.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats, Indices
from vibroimpact.studies.design import generator

MOST_LEFT_OUT = 0.05
"""Maximum fraction of points without a value; with more, indices would not represent the study."""

RESAMPLES = 200
"""Number of bootstrap samples for the standard error of an index."""

# points of a block used for the bootstrap; for larger blocks the error is scaled by the root of
# their number
_RESAMPLED = 8192
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
    >>> from vibroimpact.studies.axes import Spaced
    >>> from vibroimpact.studies.design import Asked
    >>> from vibroimpact.studies.designs.saltelli import plan
    >>> points = plan(Asked({"a": Spaced(0.0, 1.0, 2), "b": Spaced(0.0, 1.0, 2)}, 1024, 0)).columns
    >>> found = sobol_indices(points["a"] + 2.0 * points["b"], 2)  # variances 1/12 and 4/12
    >>> found.first.round(2).tolist(), found.total.round(2).tolist()
    ([0.2, 0.8], [0.2, 0.8])
    """
    blocks = np.asarray(values, dtype=float).reshape(2 + axes, -1)
    complete = np.isfinite(blocks).all(axis=0)
    points, left_out = int(complete.sum()), int((~complete).sum())
    if points < 2 or left_out > MOST_LEFT_OUT * len(complete):
        return None
    used = blocks[:2, complete]
    if not float(np.std(used)) > 1e-9 * float(np.abs(used).max()):
        return None
    # SciPy requires a power of two: omitted points are set to the mean, which contributes nothing
    # to the sums
    blocks = np.where(complete, blocks, used.mean())
    first, total = _estimates(blocks)
    drawn = min(len(complete), _RESAMPLED)
    random = generator(seed, drawn)
    resampled = [
        _estimates(blocks[:, random.integers(drawn, size=drawn)]) for _ in range(RESAMPLES)
    ]
    first_error, total_error = (
        _QUANTILE * math.sqrt(drawn / len(complete)) * np.std(resampled, axis=0, ddof=1)
    )
    return SobolIndices(first, total, first_error, total_error, points, left_out)


def _estimates(blocks: Floats) -> Floats:
    """Return first and total indices, (2, axes), of blocks (2 + axes, points)."""
    from scipy.stats import sobol_indices as estimate

    found = estimate(
        func={"f_A": blocks[:1], "f_B": blocks[1:2], "f_AB": blocks[2:, None]}, n=blocks.shape[1]
    )
    return np.array([found.first_order, found.total_order])


def rank_correlations(inputs: Floats, output: Floats) -> Floats:
    """Return Spearman's rank correlation of a result with each input: 1 if it increases
    monotonically with it, -1 if it decreases.

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

    finite = np.isfinite(output)
    here = output[finite]
    if len(here) < 3 or not np.ptp(here) > 0.0:
        return np.full(len(inputs), math.nan)
    varying = [place for place, values in enumerate(inputs) if np.ptp(values[finite]) > 0.0]
    found = np.full(len(inputs), math.nan)
    for place in varying:
        found[place] = float(spearmanr(inputs[place][finite], here).statistic)
    return found


class OneAtATime(NamedTuple):
    """Range of a result along each axis of a grid with all others at their middle level, one value
    per axis.

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
        return (
            (self.highest - self.lowest) / abs(self.middle)
            if self.middle
            else np.full(len(self.lowest), math.nan)
        )


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
    lowest, highest = np.full((2, len(orders)), math.nan)
    for axis in range(len(orders)):
        line: tuple[Any, ...] = (*middle[:axis], slice(None), *middle[axis + 1 :])
        along = np.asarray(values[line], dtype=np.float64)
        if np.isfinite(along).any():
            lowest[axis], highest[axis] = np.nanmin(along), np.nanmax(along)
    return OneAtATime(float(values[middle]), lowest, highest)
