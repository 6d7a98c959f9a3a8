"""Axes of a study: the list, range or distribution of values of a swept key."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.ranges import Range

Values = NDArray[Any]
"""Array of floats or integers, or of objects if values are names or tables."""


class Axis(Protocol):
    """The values of one swept key."""

    @property
    def is_random(self) -> bool:
        """Whether it is a distribution rather than chosen values."""

    def __len__(self) -> int:
        """Return the number of levels in a grid."""

    def levels(self) -> Values:
        """Return the levels in a grid."""

    def quantiles(self, parts: Floats) -> Values:
        """Return the quantiles of the distribution at probabilities in [0, 1)."""


@dataclass(frozen=True)
class Listed:
    """A list of values; in sampling designs equally likely, or with given weights.

    Parameters
    ----------
    values : tuple
        The values.
    weights : tuple of float, optional
        Weights >= 0, not necessarily normalized, not all zero.

    Examples
    --------
    >>> Listed((0.3, 0.5)).quantiles(np.array([0.0, 0.49, 0.5])).tolist()
    [0.3, 0.3, 0.5]
    """

    values: tuple[Any, ...]
    weights: tuple[float, ...] | None = None

    @property
    def is_random(self) -> bool:
        """False: the values were chosen."""
        return False

    def __len__(self) -> int:
        return len(self.values)

    def levels(self) -> Values:
        """Return the values as floats or integers if all have that type, else as objects."""
        if {type(value) for value in self.values} in ({float}, {int}):
            return np.array(self.values)
        objects = np.empty(len(self.values), dtype=object)
        objects[:] = self.values
        return objects

    def quantiles(self, parts: Floats) -> Values:
        """Return the quantiles, in the order of the list."""
        weights = self.weights
        if weights is None:
            weights = (1.0,) * len(self.values)
        cumulative = np.cumsum(weights)
        index = np.searchsorted(cumulative / cumulative[-1], parts, side="right")
        return np.asarray(self.levels()[np.minimum(index, len(self.values) - 1)])


@dataclass(frozen=True)
class Spaced:
    """Values from `start` to `end`, equally spaced on a linear or logarithmic scale.

    In sampling designs they are uniform on that scale.

    Parameters
    ----------
    start, end : float
        Limits of the range.
    number : int
        Number of levels in a grid, including both limits.
    scale : {"linear", "log"}
        Constant steps, or constant ratios.
    is_random : bool
        Whether it is a distribution.
    """

    start: float
    end: float
    number: int
    scale: Literal["linear", "log"] = "linear"
    is_random: bool = False

    def __len__(self) -> int:
        return self.number

    def levels(self) -> Values:
        """Return the levels, including both limits."""
        if self.scale == "linear":
            return np.linspace(self.start, self.end, self.number)
        return np.geomspace(self.start, self.end, self.number)

    def quantiles(self, parts: Floats) -> Values:
        """Return the quantiles of the uniform or log-uniform distribution."""
        if self.scale == "linear":
            return self.start + parts * (self.end - self.start)
        return np.asarray(self.start * (self.end / self.start) ** parts)


def _log(limit: float) -> float:
    return math.log(limit) if limit > 0.0 else -math.inf


@dataclass(frozen=True)
class Normal:
    r"""A normal or lognormal distribution, optionally truncated.

    Parameters
    ----------
    mean, standard_deviation : float
        Of the quantity itself before truncation, also for a lognormal distribution.
    number : int
        Number of levels in a grid: the medians of equally likely intervals.
    at_least, at_most : float
        Truncation limits.
    lognormal : bool
        Whether the logarithm is normal, with :math:`\sigma^2 = \ln(1 + s^2/m^2)` and :math:`\mu =
        \ln m - \sigma^2/2`.

    Raises
    ------
    InputError
        If a lognormal mean is not positive, or the probability between the truncation limits is
        below 1e-9.

    Examples
    --------
    >>> Normal(2.0, 0.1, 3).levels().round(4).tolist()
    [1.9033, 2.0, 2.0967]
    >>> round(float(Normal(2.0, 0.1, 3, lognormal=True).quantiles(np.array([0.5]))[0]), 5)
    1.9975
    """

    mean: float
    standard_deviation: float
    number: int
    at_least: float = -math.inf
    at_most: float = math.inf
    lognormal: bool = False
    is_random: bool = True

    def __post_init__(self) -> None:
        if self.lognormal and self.mean <= 0.0:
            raise InputError(
                f"{self.mean:g} is not allowed; the mean of a lognormal distribution must "
                "be greater than 0",
                "mean",
            )
        low, high = self._bounds()
        if not high - low > 1e-9:
            limits = Range(at_least=self.at_least, at_most=self.at_most).words
            percentage = 100 * max(high - low, 0.0)
            key = "at_least" if math.isfinite(self.at_least) else "at_most"
            raise InputError(
                f"{percentage:.2g} % of the distribution is {limits}; it must be truncated less",
                key,
            )

    def _normal_parameters(self) -> tuple[float, float]:
        """Return mean and standard deviation of the normal variable.

        It is the quantity, or its logarithm.
        """
        if not self.lognormal:
            return self.mean, self.standard_deviation
        variance = math.log1p((self.standard_deviation / self.mean) ** 2)
        return math.log(self.mean) - 0.5 * variance, math.sqrt(variance)

    def _bounds(self) -> tuple[float, float]:
        """Return the cumulative probabilities at the truncation limits."""
        from scipy.special import ndtr

        mean, deviation = self._normal_parameters()
        limits = [self.at_least, self.at_most]
        if self.lognormal:
            limits = [_log(limit) for limit in limits]
        low, high = (float(ndtr((limit - mean) / deviation)) for limit in limits)
        return low, high

    def __len__(self) -> int:
        return self.number

    def levels(self) -> Values:
        """Return the medians of equally likely intervals."""
        return self.quantiles((np.arange(self.number) + 0.5) / self.number)

    def quantiles(self, parts: Floats) -> Values:
        """Return the quantiles of the truncated distribution."""
        from scipy.special import ndtri

        low, high = self._bounds()
        mean, deviation = self._normal_parameters()
        # avoid the infinite quantiles at 0 and 1
        probabilities = np.clip(low + parts * (high - low), 1e-300, 1.0 - 2.0**-53)
        values = mean + deviation * ndtri(probabilities)
        if self.lognormal:
            values = np.exp(values)
        return np.asarray(np.clip(values, self.at_least, self.at_most))
