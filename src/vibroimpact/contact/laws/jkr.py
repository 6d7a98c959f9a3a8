"""Johnson, Kendall and Roberts's law: adhesive elastic sphere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.adhesion import AdhesiveLaw
from vibroimpact.contact.parameters import inherited_parameter


@dataclass(frozen=True, kw_only=True)
class JKR(AdhesiveLaw):
    r"""Elastic sphere with adhesion (Johnson, Kendall and Roberts 1971).

    .. math::
        F = \frac{4 E^* a^3}{3 R} - \sqrt{8 \pi w E^* a^3},\qquad
        \delta = \frac{a^2}{R} - \sqrt{\frac{2 \pi w a}{E^*}}

    Notes
    -----
    At first touch, at zero indentation, the force jumps to :math:`-\tfrac43 \pi w R`; the bodies
    part when drawn out to
    :math:`\delta = -\tfrac34 (\pi^2 w^2 R/E^{*2})^{1/3}`. The work from zero indentation to there,
    :math:`7.09\, (w^5 R^4/E^{*2})^{1/3}`, is lost (Thornton and Ning 1998). A sphere with less
    kinetic energy, on a plate
    that does not vibrate, sticks. The law is for soft, large spheres of high surface energy; small
    hard ones follow Derjaguin, Muller and Toporov.

    References
    ----------
    Johnson, K. L., Kendall, K. and Roberts, A. D. (1971). Surface energy and the contact of elastic
    solids. Proc. R. Soc. Lond. A 324, 301-313.

    Thornton, C. and Ning, Z. (1998). A theoretical model for the stick/bounce behaviour of
    adhesive, elastic-plastic spheres. Powder Technology 99, 154-162.

    Examples
    --------
    >>> law = JKR(effective_modulus=1e9, effective_radius=1e-3, work_of_adhesion=0.1)
    >>> force, _ = law.forces(0.0, 1.0, 1.0)
    >>> bool(abs(force / (-4 / 3 * np.pi * 0.1 * 1e-3) - 1) < 1e-12)
    True
    """

    name = "jkr"
    equation = "F = 4 E* a^3 / (3 R) - sqrt(8 pi w E* a^3), delta = a^2 / R - sqrt(2 pi w a / E*)"
    source = "Johnson, Kendall & Roberts 1971, Proc. R. Soc. Lond. A 324:301"
    free_parameter = "work_of_adhesion"

    work_of_adhesion: Array = inherited_parameter(
        AdhesiveLaw,
        "work_of_adhesion",
        detail="Work of adhesion :math:`w`: what it takes to part a unit of area, for equal "
        "materials twice the surface energy of each.",
    )

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        r"""Return :math:`\sqrt{1 - v_s^2/v^2}`, zero below the sticking speed :math:`v_s`."""
        lost = self.elastic_energy(self.release_level) / (0.5 * mass * speed * speed)
        return np.sqrt(np.maximum(1.0 - lost, 0.0))
