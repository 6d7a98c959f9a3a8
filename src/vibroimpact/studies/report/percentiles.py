"""Statistics of a result over the drops of a study: mean, standard deviation and percentiles."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats

PERCENTILES = (5, 25, 50, 75, 95)
"""The reported percentiles."""


class Spread(NamedTuple):
    """Statistics of a sample.

    Attributes
    ----------
    drops : int
        Number of finite values; the others are ignored.
    mean, standard_deviation : float
        The standard deviation is that of a sample (n - 1); NaN for a single value.
    percentiles : tuple of float
        At `PERCENTILES`; NaN without values.
    lowest, highest : float
        The smallest and the largest value; NaN without values.
    """

    drops: int
    mean: float
    standard_deviation: float
    percentiles: tuple[float, ...]
    lowest: float
    highest: float

    @property
    def varies(self) -> bool:
        """Whether the values differ by more than rounding."""
        return self.drops > 1 and self.standard_deviation > 1e-9 * max(
            abs(self.mean), abs(self.percentiles[2])
        )


def spread_of(values: Floats) -> Spread:
    """Return the statistics of values; percentiles are interpolated linearly.

    Parameters
    ----------
    values : array
        Of any shape and unit; non-finite values are ignored.

    Returns
    -------
    Spread
        In the unit of the values.

    Examples
    --------
    >>> spread = spread_of(np.array([1.0, 2.0, 3.0, np.nan]))
    >>> spread.drops, spread.mean, spread.standard_deviation, spread.percentiles
    (3, 2.0, 1.0, (1.1, 1.5, 2.0, 2.5, 2.9))
    """
    # a copy, to be sorted and shifted in place
    finite = np.asarray(values, dtype=float)[np.isfinite(values)]
    drops = len(finite)
    if not drops:
        nothing = (math.nan,) * len(PERCENTILES)
        return Spread(0, math.nan, math.nan, nothing, math.nan, math.nan)
    mean = float(finite.mean())
    percentiles = tuple(np.percentile(finite, PERCENTILES, overwrite_input=True).tolist())
    lowest = float(finite.min())
    highest = float(finite.max())
    finite -= mean
    deviation = math.nan
    if drops > 1:
        deviation = math.sqrt(float(finite @ finite) / (drops - 1))
    return Spread(drops, mean, deviation, percentiles, lowest, highest)


def median_interval(values: Floats, independent: int) -> tuple[float, float] | None:
    """Return two of the values that enclose the median of the population with at least 95 %.

    As many independent values lie below the median as heads fall in that many tosses of a coin
    (Thompson 1936, Ann. Math. Stat. 7:122).

    Parameters
    ----------
    values : array, shape (drops,)
        A result, of any unit; non-finite values are ignored.
    independent : int
        How many of them are independent, such as the number of rocks, each of which falls
        several times.

    Returns
    -------
    (float, float) or None
        None of fewer than six independent values, which may all lie on one side of it.

    Examples
    --------
    >>> median_interval(np.arange(100.0), 100), median_interval(np.arange(100.0), 10)
    ((39.0, 60.0), (10.0, 89.0))
    >>> median_interval(np.arange(100.0), 5)
    """
    from scipy.stats import binom

    finite = values[np.isfinite(values)]
    tosses = min(independent, len(finite))
    heads = int(binom.ppf(0.025, tosses, 0.5)) - 1
    if heads < 0:
        return None
    below = math.floor(heads / tosses * len(finite))
    above = len(finite) - 1 - below
    ordered = np.partition(finite, (below, above))
    return float(ordered[below]), float(ordered[above])
