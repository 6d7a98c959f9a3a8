r"""Air, and its drag on a sphere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.dynamics.fluid import Fluid
from vibroimpact.errors import InputError

AIR_DENSITY, AIR_VISCOSITY = 1.2, 1.81e-5
"""Density [kg/m^3] and viscosity [Pa s] of air at 20 C and sea level."""

_DENSEST = 0.02  # largest density, relative to the sphere's: buoyancy then takes as much of gravity, and is left out
_STILL = 1e-30  # m/s, for a speed of zero, at which Stokes' drag is none


def drag_coefficient(reynolds: Array) -> Array:
    r"""Return the drag coefficient of a smooth sphere at a Reynolds number.

    .. math:: C_d = \frac{24}{Re}\left(1 + 0.15\,Re^{0.687}\right) + \frac{0.42}{1 + 42500\,Re^{-1.16}}

    Within 6 % of measurements up to a Reynolds number of 3e5.

    References
    ----------
    Clift, R. and Gauvin, W. H. (1970). The motion of particles in turbulent gas streams. Proc. Chemeca '70, 1, 14-28.

    Examples
    --------
    >>> round(float(drag_coefficient(1e4)), 2)
    0.42
    """
    return 24.0 / reynolds * (1.0 + 0.15 * reynolds**0.687) + 0.42 / (1.0 + 42500.0 * reynolds**-1.16)


@dataclass(frozen=True, kw_only=True, eq=False)
class Air(Fluid):
    """Air at rest; each value is a number, or an array with one a drop.

    Parameters
    ----------
    density : float or array, default 1.2
        Density [kg/m^3].
    viscosity : float or array, default 1.81e-5
        Viscosity [Pa s], from which the Reynolds number and so the drag coefficient follow (`drag_coefficient`).
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

    word = "air"

    density: Array = AIR_DENSITY
    viscosity: Array = AIR_VISCOSITY
    drag_coefficient: Array | None = None

    def drag(self, speed: Array, radius: Array, density: Array) -> Array:
        r"""Return by how much air slows a sphere down [m/s^2], :math:`\tfrac38 (\rho_a / \rho) C_d v^2 / R`.

        Parameters
        ----------
        speed : float or array
            Through air that is at rest [m/s], >= 0.
        radius, density : float or array
            Of the sphere [m], [kg/m^3].
        """
        fast = np.maximum(speed, _STILL)
        coefficient = self.drag_coefficient
        if coefficient is None:
            coefficient = drag_coefficient(self.density * fast * 2.0 * radius / self.viscosity)
        return 0.375 * self.density / density * coefficient * fast**2 / radius


def density_of(mass: Array, radius: Array) -> Array:
    """Return the density of a solid sphere [kg/m^3]."""
    return mass / (4.0 / 3.0 * np.pi * np.asarray(radius) ** 3)


def check_thin(density: Array, of_sphere: Array, key: str = "") -> None:
    """Raise InputError, with a key, unless air is so thin beside a sphere that drag is what matters of it; densities [kg/m^3]."""
    part = float(np.max(density / of_sphere))
    if part > _DENSEST:
        raise InputError(
            f"the medium of the fall has {100.0 * part:.3g} % of its density, and {100.0 * _DENSEST:g} % are the most: drag alone "
            "acts on it, and in what is denser buoyancy, the mass of fluid that moves along, and the film over the plate count too",
            key,
        )
