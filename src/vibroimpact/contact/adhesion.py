"""Adhesive contact of Johnson, Kendall and Roberts (JKR), in closed form.

Force and energy are functions of the indentation.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.choice import where
from vibroimpact.contact.law import CompliantLaw, Levels, ScalarEnergies, ScalarForces, ScalarLevels
from vibroimpact.contact.mixins import ElasticPairLaw
from vibroimpact.contact.parameters import parameter

# made dimensionless by the contact radius a0 at zero indentation, with z^2 = a/a0: indentation z^4
# - z, force 4/3 z^6 - 2 z^3, energy 8/15 z^10 - 4/3 z^7 + 1/2 z^4 + 3/10; pull-off is at the
# minimum of the indentation
_PULL_OFF_Z = 0.25 ** (1.0 / 3.0)
_PULL_OFF_INDENTATION = _PULL_OFF_Z**4 - _PULL_OFF_Z


@scalar
def _stable_root(s: Array) -> Array:
    """Return the largest root z of z^4 - z = s, by Ferrari's formula and one Newton step."""
    s = np.maximum(s, _PULL_OFF_INDENTATION)
    # the real root y of the resolvent y^3 + s y = 1/8, by Cardano's formula
    third = s / 3.0
    u = np.cbrt(0.0625 + np.sqrt(np.maximum(0.00390625 + third * third * third, 0.0)))
    v = -third / u
    # u + v cancel for s > 0: there the same root as a quotient
    y = where(s > 0.0, 0.125 / (u * u + third + v * v), u + v)
    # the larger root of the quadratic factor with real roots
    z = 0.5 * (np.sqrt(2.0 * y) + np.sqrt(np.maximum(np.sqrt(2.0 / y) - 2.0 * y, 0.0)))
    cube = z * z * z
    # the slope vanishes at pull-off, where z is accurate without the step
    slope = np.maximum(4.0 * cube - 1.0, 1e-3)
    return z - (cube * z - z - s) / slope


@scalar
def _forces(
    delta: Array, delta_dot: Array, approach_speed: Array, coefficients: Any
) -> tuple[Array, Array]:
    unit_indentation = coefficients[0]
    unit_force = coefficients[1]
    unit_dashpot = coefficients[2]
    z = _stable_root(delta / unit_indentation)
    cube = z * z * z
    adhesive_force = (4.0 / 3.0 * cube - 2.0) * cube * unit_force
    return adhesive_force, unit_dashpot * (z * z) * delta_dot


@scalar
def _energies(delta: Array, coefficients: Any) -> tuple[Array, Array]:
    unit_indentation = coefficients[0]
    unit_energy = coefficients[3]
    z = _stable_root(delta / unit_indentation)
    cube = z * z * z
    elastic_energy = (((8.0 / 15.0 * cube - 4.0 / 3.0) * cube + 0.5) * cube * z + 0.3) * unit_energy
    return elastic_energy, 0.0 * delta


@scalar
def _levels(coefficients: Any) -> Levels:
    return 0.0, _PULL_OFF_INDENTATION * coefficients[0], np.inf, np.inf, np.inf


@dataclass(frozen=True, kw_only=True)
class AdhesiveLaw(ElasticPairLaw, CompliantLaw):
    r"""Base of the laws with adhesion after Johnson, Kendall and Roberts (1971).

    .. math::

        F = \frac{4 E^* a^3}{3 R} - \sqrt{8 \pi w E^* a^3},\qquad
        \delta = \frac{a^2}{R} - \sqrt{\frac{2 \pi w a}{E^*}}

    on the branch of the larger contact radius a, from first touch at :math:`\delta = 0` to pull-off
    at the smallest indentation. The elastic energy is counted from zero indentation; at pull-off it
    is the energy lost.
    """

    contact_end = "pull-off"
    tension = "kept"
    scalar_forces: ClassVar[ScalarForces | None] = staticmethod(_forces)
    scalar_energies: ClassVar[ScalarEnergies | None] = staticmethod(_energies)
    scalar_levels: ClassVar[ScalarLevels | None] = staticmethod(_levels)

    work_of_adhesion: Array = parameter(
        "work of adhesion w", "J/m^2", detail="Work of adhesion :math:`w`.", example=0.5, above=0
    )

    def contact_radius(self, delta: Array) -> Array:
        """Return the contact radius a [m]."""
        z = _stable_root(delta / self._unit_indentation)
        return self._radius_at_zero * z * z

    @property
    def dashpot_per_radius(self) -> Array:
        """The dashpot constant over the contact radius [N s/m^2]; zero here.

        A law with damping defines its own.
        """
        return 0.0

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """The units of indentation, force, dashpot constant and energy.

        By these the contact is made dimensionless.
        """
        unit_force = self.effective_modulus * self._radius_at_zero**3 / self.effective_radius
        unit_energy = self.effective_modulus * self._radius_at_zero**5 / self.effective_radius**2
        return (
            self._unit_indentation,
            unit_force,
            self.dashpot_per_radius * self._radius_at_zero,
            unit_energy,
        )

    @property
    def _radius_at_zero(self) -> Array:
        """Contact radius at zero indentation [m]."""
        return np.cbrt(
            2.0 * np.pi * self.work_of_adhesion * self.effective_radius**2 / self.effective_modulus
        )

    @property
    def _unit_indentation(self) -> Array:
        """Indentation of Hertz's contact of the radius at zero indentation, a0^2/R [m]."""
        return self._radius_at_zero**2 / self.effective_radius
