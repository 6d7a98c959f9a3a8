r"""A liquid around sphere and plate: buoyancy, drag, added mass, and a film between them.

The film takes from the rebound.

In flight the sphere is accelerated by

.. math:: \dot v = \frac{\rho - \rho_f}{\rho + \tfrac12 \rho_f}\, g - a(v)

with the drag a of `vibroimpact.dynamics.fluids.fluid`, and half the displaced mass moves along, as
in unbounded liquid without viscosity.

The film has to be pressed out before sphere and plate touch, and drawn in as they part. What is
left of the restitution in air depends on the Stokes number alone, the inertia of the sphere over
the viscous force of the film.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.fluids.fluid import Fluid
from vibroimpact.errors import InputError

WATER_DENSITY, WATER_VISCOSITY = 998.2, 1.002e-3
"""Density [kg/m^3] and viscosity [Pa s] of water at 20 C."""

CRITICAL_STOKES = 10.0
"""Stokes number below which spheres were seen to stay on the wall: Joseph and others 2001."""

_DRAINAGE = 35.0
# part of the restitution that is left at least: laws take none of zero, and so slow a sphere is at
# rest
_LEAST = 1e-3

Law = TypeVar("Law", bound=ContactLaw)


@dataclass(frozen=True, kw_only=True, eq=False)
class Liquid(Fluid):
    """A liquid at rest around sphere and plate.

    Each value is a number, or an array with one a drop.

    Parameters
    ----------
    density : float or array, default 998.2
        Density [kg/m^3].
    viscosity : float or array, default 1.002e-3
        Viscosity [Pa s].

    Raises
    ------
    InputError
        If a value is not finite, or not greater than 0.

    Examples
    --------
    >>> round(float(Liquid().stokes_number(1.0, 0.005, 2650.0)))
    3492
    """

    word, key, added_mass = "a liquid", "liquid", 0.5

    density: Array = WATER_DENSITY
    viscosity: Array = WATER_VISCOSITY

    def weight(self, density: Array) -> Array:
        """Return the weight in the liquid over that in a vacuum [-]: less buoyancy.

        `density`: of the sphere [kg/m^3].
        """
        return 1.0 - self.density / density

    def stokes_number(self, speed: Array, radius: Array, density: Array) -> Array:
        r"""Return the Stokes number of a sphere that meets a wall.

        .. math:: St = \frac{(\rho + \tfrac12 \rho_f)\, 2R\, v}{9 \mu}

        with the mass of liquid that moves along, as the correlation of `restitution_kept` takes it.

        Parameters
        ----------
        speed : float or array
            Approach speed along the normal [m/s].
        radius, density : float or array
            Of the sphere [m], [kg/m^3].
        """
        return (
            (density + self.added_mass * self.density)
            * 2.0
            * radius
            * speed
            / (9.0 * self.viscosity)
        )

    def around(self, law: Law, speed: Array, radius: Array, density: Array) -> Law:
        """Return the law of an impact with what the film leaves of its restitution.

        Parameters
        ----------
        law : ContactLaw
            A law that takes a restitution, that in air.
        speed, radius, density : float or array
            As those of `stokes_number`.

        Examples
        --------
        >>> from vibroimpact.contact.laws.newton import Newton
        >>> round(
        ...     float(
        ...         Liquid(viscosity=0.1)
        ...         .around(Newton(restitution=0.9), 1.0, 0.005, 2650.0)
        ...         .restitution
        ...     ),
        ...     4,
        ... )
        0.331
        """
        dry: Array = vars(law)["restitution"]
        return law.changed(
            {"restitution": dry * restitution_kept(self.stokes_number(speed, radius, density))}
        )


def check_sinks(density: Array, of_sphere: Array, key: str = "") -> None:
    """Raise InputError, with a key, unless a sphere is denser than the liquid [kg/m^3]."""
    if np.any(np.asarray(density) >= np.asarray(of_sphere)):
        part = float(np.max(np.asarray(density) / np.asarray(of_sphere)))
        raise InputError(
            f"the liquid has {part:.4g} times the density of the sphere, which floats in "
            "it and doesn't fall; give one of less density, "
            "or drop.speed with drop.gravity = 0",
            key,
        )


def restitution_kept(stokes: Array) -> Array:
    r"""Return the restitution in a liquid over that in air, :math:`e^{-35/St}`, at least 0.001.

    Parameters
    ----------
    stokes : float or array
        Stokes number [-], > 0.

    References
    ----------
    Legendre, D., Zenit, R., Daniel, C. and Guiraud, P. (2006). A note on the modelling of the
    bouncing of spherical drops or solid spheres on a wall in viscous fluid. Chem. Eng. Sci. 61,
    3543-3549; a fit to the measurements of Gondret, P., Lance, M. and Petit, L. (2002). Bouncing
    motion of spherical particles in fluids. Phys. Fluids 14, 643-652, and of Joseph, G. G., Zenit,
    R., Hunt, M. L. and Rosenwinkel, A. M. (2001). Particle-wall collisions in a viscous fluid. J.
    Fluid Mech. 433, 329-346, among others.

    Examples
    --------
    >>> [round(float(restitution_kept(stokes)), 3) for stokes in (10.0, 100.0, 500.0, 3000.0)]
    [0.03, 0.705, 0.932, 0.988]
    """
    return np.maximum(np.exp(-_DRAINAGE / np.asarray(stokes)), _LEAST)
