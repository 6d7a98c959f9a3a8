"""A parameter of a contact law as a polynomial of the approach speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import polynomial

_BEYOND = 1.05  # factor beyond the ends of the fitted range


@dataclass(frozen=True)
class SpeedFunction:
    """A polynomial of the approach speed with the range of speeds of its fit.

    Parameters
    ----------
    coefficients : tuple of float
        Lowest power first; that of power k has the unit of the parameter over (m/s)^k.
    slowest, fastest : float
        The range of speeds of the fit [m/s].

    Examples
    --------
    >>> f"{SpeedFunction((138.93525, 6.00288, -0.15582), 3.2, 8.8)(8.8266):.2f}"
    '179.78'
    """

    coefficients: tuple[float, ...]
    slowest: float
    fastest: float

    @property
    def degree(self) -> int:
        """The highest power."""
        return len(self.coefficients) - 1

    def __call__(self, speed: Any) -> Any:
        """Return the value of the parameter at an approach speed [m/s]."""
        return polynomial.polyval(speed, self.coefficients)

    def beyond(self, speeds: Any) -> Any:
        """Return those of the given speeds that lie more than 5 % outside the range of the fit."""
        return speeds[(speeds > _BEYOND * self.fastest) | (speeds * _BEYOND < self.slowest)]

    def misfit(self, speeds: Any, values: Any) -> float:
        """Return the largest deviation from exact values within the range of the fit."""
        inside = (speeds >= self.slowest * (1.0 - 1e-9)) & (speeds <= self.fastest * (1.0 + 1e-9))
        return float(np.nanmax(np.abs(self(speeds) - values)[inside], initial=0.0))
