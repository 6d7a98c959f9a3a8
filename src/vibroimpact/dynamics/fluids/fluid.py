r"""What air and liquids have in common: density, viscosity and the drag on a sphere."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np

from vibroimpact.arrays import Array, Bools, Drops
from vibroimpact.dynamics.core.fall import STILL, drag_coefficient
from vibroimpact.errors import InputError


@dataclass(frozen=True, kw_only=True, eq=False)
class Fluid:
    """Base of the fluids; each value is a number, or an array with one a drop.

    Raises
    ------
    InputError
        If a value is not finite, or not greater than 0.
    """

    word: ClassVar[str]
    """What messages call it."""
    key: ClassVar[str]
    """What the names of its columns begin with."""
    added_mass: ClassVar[float] = 0.0
    """Mass of fluid that moves along with a sphere, over the mass that the sphere displaces [-]."""

    density: Array
    viscosity: Array

    def __post_init__(self) -> None:
        for name, value in self._given():
            found = np.asarray(value)
            if not (found.dtype.kind in "iuf" and np.all(np.isfinite(found) & (found > 0.0))):
                raise InputError(
                    f"{name} of {self.word} must be a finite number greater than "
                    f"0 in SI, not {value!r}"
                )

    def _given(self) -> list[tuple[str, Any]]:
        return [
            (item.name, value)
            for item in fields(self)
            if (value := getattr(self, item.name)) is not None
        ]

    @property
    def values(self) -> list[Array]:
        """All values that may be arrays."""
        return [value for _, value in self._given()]

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """() for one drop, (B,) for a batch."""
        return np.broadcast_shapes(*(np.shape(value) for value in self.values))

    def take(self, drops: int | slice | Drops | Bools) -> Self:
        """Return the fluid of one drop of a batch, or of some."""
        if self.shape == ():
            return self
        taken = {}
        for name, value in self._given():
            taken[name] = value
            if np.ndim(value) > 0:
                taken[name] = np.asarray(value)[drops]
        return type(self)(**taken)

    @property
    def constant_coefficient(self) -> Array | None:
        """A constant drag coefficient, or None where it follows from the Reynolds number."""
        return None

    def inertia(self, density: Array) -> Array:
        """Return the mass that is accelerated in flight over that of the sphere [-].

        `density`: of the sphere [kg/m^3].
        """
        return 1.0 + self.added_mass * self.density / density

    def weight(self, density: Array) -> Array:
        """Return the weight in the fluid over that in a vacuum [-].

        `density`: of the sphere [kg/m^3].
        """
        return 1.0 + 0.0 * density

    def drag(self, speed: Array, radius: Array, density: Array) -> Array:
        r"""Return by how much the fluid slows a sphere down [m/s^2].

        .. math:: a = \frac{3}{8} \frac{\rho_f}{\rho + C_a \rho_f}\, C_d \frac{v^2}{R}

        with the added mass C_a. Flights are computed with `drag_of` in the core, which is the same.

        Parameters
        ----------
        speed : float or array
            Through fluid that is at rest [m/s], >= 0.
        radius, density : float or array
            Of the sphere [m], [kg/m^3].
        """
        fast = np.maximum(speed, STILL)
        coefficient = self.constant_coefficient
        if coefficient is None:
            coefficient = drag_coefficient(self.reynolds_number(fast, radius))
        return self.drag_by_square(radius, density) * coefficient * fast**2

    def reynolds_number(self, speed: Array, radius: Array) -> Array:
        """Return the Reynolds number of a sphere of a radius [m] at a speed [m/s]."""
        return self.density * speed * 2.0 * radius / self.viscosity

    def drag_by_square(self, radius: Array, density: Array) -> Array:
        """Return the deceleration over drag coefficient and square of the speed [1/m]."""
        return 0.375 * self.density / (density * self.inertia(density)) / radius
