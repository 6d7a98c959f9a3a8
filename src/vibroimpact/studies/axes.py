"""What a swept value runs over: a list, a range, or a distribution."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError

Values = NDArray[Any]
"""Floats, whole numbers, or objects where values are names or tables."""


class Axis(Protocol):
    """What one swept value runs over."""

    @property
    def is_random(self) -> bool:
        """Is it a distribution, rather than values that were chosen?"""

    def __len__(self) -> int:
        """Return how many values it has in a grid."""

    def levels(self) -> Values:
        """Return its values in a grid."""

    def quantiles(self, parts: Floats) -> Values:
        """Return the values that have given parts, in [0, 1), of the distribution below them."""


@dataclass(frozen=True)
class Listed:
    """Values one by one; drawn, each is as likely as another, or as its weight says.

    Parameters
    ----------
    values : tuple
        The values.
    weights : tuple of float, optional
        Their weights, >= 0, in any unit; not all of them zero.

    Examples
    --------
    >>> Listed((0.3, 0.5)).quantiles(np.array([0.0, 0.49, 0.5])).tolist()
    [0.3, 0.3, 0.5]
    """

    values: tuple[Any, ...]
    weights: tuple[float, ...] | None = None

    @property
    def is_random(self) -> bool:
        """They were chosen."""
        return False

    def __len__(self) -> int:
        return len(self.values)

    def levels(self) -> Values:
        """Return the values: floats or whole numbers if all are, else as they are."""
        if {type(value) for value in self.values} in ({float}, {int}):
            return np.array(self.values)
        objects = np.empty(len(self.values), dtype=object)
        objects[:] = self.values
        return objects

    def quantiles(self, parts: Floats) -> Values:
        """Return the values by their place in the list."""
        below = np.cumsum(np.ones(len(self.values)) if self.weights is None else self.weights)
        places = np.searchsorted(below / below[-1], parts, side="right")
        return np.asarray(self.levels()[np.minimum(places, len(self.values) - 1)])


@dataclass(frozen=True)
class Spaced:
    """Values from `start` to `end`, evenly apart or by even factors; drawn, they are uniform on that scale.

    Parameters
    ----------
    start, end : float
        The ends.
    number : int
        How many levels it has in a grid, both ends among them.
    scale : {"linear", "log"}
        Even steps, or even factors.
    is_random : bool
        Is it a distribution?
    """

    start: float
    end: float
    number: int
    scale: Literal["linear", "log"] = "linear"
    is_random: bool = False

    def __len__(self) -> int:
        return self.number

    def levels(self) -> Values:
        """Return the values, both ends among them."""
        return np.asarray((np.linspace if self.scale == "linear" else np.geomspace)(self.start, self.end, self.number))

    def quantiles(self, parts: Floats) -> Values:
        """Return the values at parts of the way."""
        if self.scale == "linear":
            return self.start + parts * (self.end - self.start)
        return np.asarray(self.start * (self.end / self.start) ** parts)


@dataclass(frozen=True)
class Normal:
    r"""A normal distribution, or a lognormal one, perhaps truncated.

    Parameters
    ----------
    mean, standard_deviation : float
        Of the quantity itself before it is truncated, also of a lognormal one.
    number : int
        How many levels it has in a grid: the middles of parts that are equally likely.
    at_least, at_most : float
        Where it is truncated.
    lognormal : bool
        Is its logarithm normal? Then with :math:`\sigma^2 = \ln(1 + s^2/m^2)` and :math:`\mu = \ln m - \sigma^2/2`.

    Raises
    ------
    InputError
        If a lognormal mean is not above zero, or next to nothing lies between the ends.

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
            raise InputError(f"{self.mean:g} is not allowed; the mean of a lognormal distribution must be greater than 0", "mean")
        low, high = self._ends()
        if not high - low > 1e-9:
            words = f"{100 * max(high - low, 0.0):.2g} % of the distribution lies from {self.at_least:g} to {self.at_most:g}"
            raise InputError(f"{words}; it must be truncated less", "at_least" if math.isfinite(self.at_least) else "at_most")

    def _of_logarithm(self) -> tuple[float, float]:
        """Return mean and standard deviation of what is normal: the quantity, or its logarithm."""
        if not self.lognormal:
            return self.mean, self.standard_deviation
        variance = math.log1p((self.standard_deviation / self.mean) ** 2)
        return math.log(self.mean) - 0.5 * variance, math.sqrt(variance)

    def _ends(self) -> tuple[float, float]:
        """Return which parts of the distribution lie below its two ends."""
        from scipy.special import ndtr

        middle, spread = self._of_logarithm()
        ends = [self.at_least, self.at_most]
        if self.lognormal:
            ends = [math.log(end) if end > 0.0 else -math.inf for end in ends]
        low, high = (float(ndtr((end - middle) / spread)) for end in ends)
        return low, high

    def __len__(self) -> int:
        return self.number

    def levels(self) -> Values:
        """Return the middles of parts that are equally likely."""
        return self.quantiles((np.arange(self.number) + 0.5) / self.number)

    def quantiles(self, parts: Floats) -> Values:
        """Return the values below which lie parts of the distribution."""
        from scipy.special import ndtri

        (low, high), (middle, spread) = self._ends(), self._of_logarithm()
        inside = np.clip(low + parts * (high - low), 1e-300, 1.0 - 2.0**-53)  # the ends of the whole are infinite
        values = middle + spread * ndtri(inside)
        return np.asarray(np.clip(np.exp(values) if self.lognormal else values, self.at_least, self.at_most))
