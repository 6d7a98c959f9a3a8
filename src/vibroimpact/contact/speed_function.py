"""A parameter of a contact law as a function of the approach speed: a polynomial, or a table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

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

    @property
    def extremes(self) -> tuple[float, float]:
        """The smallest and the largest value within the range of the fit."""
        turning_speeds = np.zeros(0)
        if self.degree > 1:
            turning_speeds = polynomial.polyroots(polynomial.polyder(self.coefficients))
        is_real = np.abs(np.imag(turning_speeds)) < 1e-9
        inner_speeds = np.clip(turning_speeds[is_real].real, self.slowest, self.fastest)
        values = self(np.array([self.slowest, self.fastest, *inner_speeds]))
        return float(values.min()), float(values.max())

    @property
    def words(self) -> str:
        """The function in words."""
        terms = " + ".join(
            f"{value:.6g}{f' v^{power}' if power else ''}"
            for power, value in enumerate(self.coefficients)
        )
        return f"{terms.replace('+ -', '- ')}, v from {self.slowest:.6g} to {self.fastest:.6g} m/s"

    def table(self) -> dict[str, Any]:
        """Return the table of a case file."""
        return {"polynomial": list(self.coefficients), "from": self.slowest, "to": self.fastest}


@dataclass(frozen=True)
class SpeedTable:
    """Values at several approach speeds, linear between them.

    Beyond the ends the nearest value holds.

    Parameters
    ----------
    speeds : tuple of float
        Approach speeds [m/s], ascending.
    values : tuple of float
        The value of the parameter at each.

    Examples
    --------
    >>> SpeedTable((1.0, 3.0), (0.8, 0.7))([0.1, 2.0, 9.0]).round(9).tolist()
    [0.8, 0.75, 0.7]
    """

    speeds: tuple[float, ...]
    values: tuple[float, ...]

    def __call__(self, speed: Any) -> Any:
        """Return the value of the parameter at an approach speed [m/s]."""
        return np.interp(speed, self.speeds, self.values)

    @property
    def slowest(self) -> float:
        """The lowest speed [m/s]."""
        return self.speeds[0]

    @property
    def fastest(self) -> float:
        """The highest speed [m/s]."""
        return self.speeds[-1]

    @property
    def words(self) -> str:
        """The function in words."""
        first = f"{self.values[0]:.6g} at {self.speeds[0]:.6g} m/s"
        if len(self.speeds) == 1:
            return first
        last = f"{self.values[-1]:.6g} at {self.speeds[-1]:.6g} m/s"
        return f"{first} to {last}, linear between {len(self.speeds)} speeds"

    def table(self) -> dict[str, Any]:
        """Return the table of a case file."""
        return {"speed": list(self.speeds), "value": list(self.values)}


def toml_of(function: BySpeed) -> str:
    """Return a function as the text of a case file.

    Examples
    --------
    >>> toml_of(SpeedFunction((0.9, -0.1), 1.0, 3.0)), toml_of(SpeedTable((1.0, 3.0), (0.8, 0.7)))
    ('{ polynomial = [0.9, -0.1], from = 1, to = 3 }', '{ speed = [1, 3], value = [0.8, 0.7] }')
    """

    def text(value: Any) -> str:
        if isinstance(value, list):
            return f"[{', '.join(map(text, value))}]"
        return f"{value:.9g}"

    entries = [f"{key} = {text(value)}" for key, value in function.table().items()]
    return f"{{ {', '.join(entries)} }}"


BySpeed: TypeAlias = SpeedFunction | SpeedTable


def held(function: BySpeed, speed: Any) -> Any:
    """Return the value of a function at an approach speed [m/s].

    Beyond its range it is that at the nearest end.

    Examples
    --------
    >>> round(float(held(SpeedFunction((0.9, -0.1), 1.0, 3.0), 5.0)), 12)
    0.6
    """
    return function(np.clip(speed, function.slowest, function.fastest))


def of_table(table: Mapping[str, Any]) -> BySpeed:
    """Return the function of a table in SI, as the methods `table` return it.

    Examples
    --------
    >>> of_table(SpeedTable((1.0, 3.0), (0.8, 0.7)).table())
    SpeedTable(speeds=(1.0, 3.0), values=(0.8, 0.7))
    """
    if "polynomial" in table:
        return SpeedFunction(tuple(table["polynomial"]), table["from"], table["to"])
    return SpeedTable(tuple(table["speed"]), tuple(table["value"]))
