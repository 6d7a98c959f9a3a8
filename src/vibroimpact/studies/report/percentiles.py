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
    """

    drops: int
    mean: float
    standard_deviation: float
    percentiles: tuple[float, ...]

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
    >>> spread_of(np.array([1.0, 2.0, 3.0, np.nan]))
    Spread(drops=3, mean=2.0, standard_deviation=1.0, percentiles=(1.1, 1.5, 2.0, 2.5, 2.9))
    """
    # a copy, to be sorted and shifted in place
    finite = np.asarray(values, dtype=float)[np.isfinite(values)]
    drops = len(finite)
    if not drops:
        return Spread(0, math.nan, math.nan, (math.nan,) * len(PERCENTILES))
    mean = float(finite.mean())
    percentiles = tuple(np.percentile(finite, PERCENTILES, overwrite_input=True).tolist())
    finite -= mean
    deviation = math.nan
    if drops > 1:
        deviation = math.sqrt(float(finite @ finite) / (drops - 1))
    return Spread(drops, mean, deviation, percentiles)
