"""Air, and the density up to which drag is all that matters of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.dynamics.fluids.fluid import Fluid
from vibroimpact.errors import InputError

AIR_DENSITY, AIR_VISCOSITY = 1.2, 1.81e-5
"""Density [kg/m^3] and viscosity [Pa s] of air at 20 C and sea level."""

SPEED_OF_SOUND = 343.2  # m/s, of dry air at 20 C: sqrt(1.4 * 287.05 J/(kg K) * 293.15 K)

# largest density, relative to the sphere's: buoyancy then takes as much of gravity, and is left out
_DENSEST = 0.02


@dataclass(frozen=True, kw_only=True, eq=False)
class Air(Fluid):
    """Still air; each value is a number, or an array with one value per drop.

    Parameters
    ----------
    density : float or array, default 1.2
        Density [kg/m^3].
    viscosity : float or array, default 1.81e-5
        Viscosity [Pa s], from which the Reynolds number and so the drag coefficient follow
        (`drag_coefficient`).
    drag_coefficient : float or array, optional
        A constant drag coefficient [-] in place of that.

    Raises
    ------
    InputError
        If a value is not finite, or not greater than 0.

    Examples
    --------
    >>> round(float(Air().drag(8.8, 0.025, 1380.0)), 3)
    0.478
    """

    word, key = "air", "air"

    density: Array = AIR_DENSITY
    viscosity: Array = AIR_VISCOSITY
    drag_coefficient: Array | None = None

    @property
    def constant_coefficient(self) -> Array | None:
        """The constant drag coefficient that was given, or None."""
        return self.drag_coefficient


def check_thin(density: Array, of_sphere: Array, key: str = "") -> None:
    """Raise InputError, with a key, unless drag is what matters of air around a sphere.

    Air must be thin beside it; densities are in kg/m^3.
    """
    part = float(np.max(density / of_sphere))
    if part > _DENSEST:
        raise InputError(
            f"the medium of the fall has {100.0 * part:.3g} % of the density of the "
            f"sphere, and {100.0 * _DENSEST:g} % are the most: only "
            "its drag is computed, and in what is denser buoyancy, the mass of fluid that "
            "moves along, and the film over the plate count "
            "too; give it as contact.liquid, with a law that takes a restitution",
            key,
        )
