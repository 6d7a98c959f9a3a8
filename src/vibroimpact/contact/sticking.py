"""The sticking contact of Johnson, Kendall and Roberts, in closed form as a function of the indentation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.law import CompliantLaw, parameter

# in units of the contact radius a0 at zero indentation, with z^2 = a/a0: indentation z^4 - z, force 4/3 z^6 - 2 z^3,
# energy 8/15 z^10 - 4/3 z^7 + 1/2 z^4 + 3/10; the contact breaks where the indentation is least
_BREAK_Z = 0.25 ** (1.0 / 3.0)
_BREAK_INDENTATION = _BREAK_Z**4 - _BREAK_Z


@dataclass(frozen=True, kw_only=True)
class StickingLaw(CompliantLaw):
    r"""Base of the laws with adhesion after Johnson, Kendall and Roberts (1971).

    .. math:: F = \frac{4 E^* a^3}{3 R} - \sqrt{8 \pi w E^* a^3},\qquad \delta = \frac{a^2}{R} - \sqrt{\frac{2 \pi w a}{E^*}}

    on the branch of the larger contact radius a, which it follows from first touch at :math:`\delta = 0` to where the
    bodies can't be drawn out any more.
    """

    contact_end = "pull-off"
    tension = "kept"

    effective_modulus: Array = parameter("effective modulus E*", "Pa", above=0, from_pair="effective_modulus")
    effective_radius: Array = parameter("effective radius R", "m", above=0, from_pair="effective_radius")
    work_of_adhesion: Array = parameter("work of adhesion w", "J/m^2", example=0.5, above=0)

    @property
    def release_level(self) -> Array:
        """Indentation at which the contact breaks [m], below zero."""
        return _BREAK_INDENTATION * self._radius_at_zero**2 / self.effective_radius

    def contact_radius(self, delta: Array) -> Array:
        """Return the contact radius a [m]."""
        z = self._z(delta)
        return self._radius_at_zero * z * z

    def adhesive_force(self, radius: Array) -> Array:
        """Return the static force [N], negative where it pulls, at a contact radius [m]."""
        ratio = radius / self._radius_at_zero
        cube = ratio * np.sqrt(ratio)
        return (4.0 / 3.0 * cube - 2.0) * cube * (self.effective_modulus * self._radius_at_zero**3 / self.effective_radius)

    def elastic_energy(self, delta: Array) -> Array:
        """Return the integral of the static force from zero indentation [J]; at the break it is what the break costs."""
        z = self._z(delta)
        cube = z * z * z
        unit = self.effective_modulus * self._radius_at_zero**5 / self.effective_radius**2
        return (((8.0 / 15.0 * cube - 4.0 / 3.0) * cube + 0.5) * cube * z + 0.3) * unit

    @property
    def _radius_at_zero(self) -> Array:
        """Contact radius at zero indentation [m]."""
        return np.cbrt(2.0 * np.pi * self.work_of_adhesion * self.effective_radius**2 / self.effective_modulus)

    def _z(self, delta: Array) -> Array:
        return _stable_root(delta * self.effective_radius / self._radius_at_zero**2)


def _stable_root(s: Array) -> Array:
    """Return the largest z with z^4 - z = s, by Ferrari's formula and a step of Newton's method."""
    s = np.maximum(s, _BREAK_INDENTATION)
    third = s / 3.0
    u = np.cbrt(0.0625 + np.sqrt(np.maximum(0.00390625 + third * third * third, 0.0)))
    v = -third / u
    y = np.where(s > 0.0, 0.125 / (u * u + third + v * v), u + v)  # the same root of y^3 + s y = 1/8, without cancellation
    z = 0.5 * (np.sqrt(2.0 * y) + np.sqrt(np.maximum(np.sqrt(2.0 / y) - 2.0 * y, 0.0)))
    cube = z * z * z
    slope = np.maximum(4.0 * cube - 1.0, 1e-3)  # next to the break, where the slope is zero, z is good already
    return z - (cube * z - z - s) / slope
