"""Hertz's law: elastic sphere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.law import ScalarForces
from vibroimpact.contact.parameters import inherited_parameter
from vibroimpact.contact.power_law import PowerLaw, power


@scalar
def _forces(
    delta: Array, delta_dot: Array, approach_speed: Array, coefficients: Any
) -> tuple[Array, Array]:
    stiffness = coefficients[0]
    exponent = coefficients[1]
    return stiffness * power(delta, exponent), 0.0 * delta


@dataclass(frozen=True, kw_only=True)
class Hertz(PowerLaw):
    r"""Elastic contact of two smooth spheres, or of a sphere and a flat (Hertz 1881).

    .. math:: F = K \delta^n

    Notes
    -----
    The law loses nothing: its restitution is 1. It is valid while the contact radius is small
    beside the sphere's and nothing yields.

    References
    ----------
    Hertz, H. (1881). Ueber die Beruehrung fester elastischer Koerper. J. reine angew. Math. 92,
    156-171.

    Johnson, K. L. (1985). Contact Mechanics. Cambridge University Press, eq. (4.23).

    Examples
    --------
    >>> elastic, dissipative = Hertz(stiffness=2.0).forces(4.0, 1.0, 1.0)
    >>> float(elastic), float(dissipative)
    (16.0, 0.0)
    """

    name = "hertz"
    equation = "F = K delta^n"
    source = "Hertz 1881, J. reine angew. Math. 92:156"
    contact_end = "zero-indentation"
    tension = "none"
    scalar_forces: ClassVar[ScalarForces | None] = staticmethod(_forces)

    exponent: Array = inherited_parameter(
        PowerLaw, "exponent", detail="Force exponent :math:`n`; 1.5 for a sphere."
    )

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """Stiffness and exponent."""
        return self.stiffness, self.exponent

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        """Return 1, since no energy is lost."""
        return np.ones_like(mass * speed)
