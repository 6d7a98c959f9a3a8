"""Kuwabara and Kono's law: viscoelastic sphere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.law import ScalarForces
from vibroimpact.contact.mixins import ViscoelasticLaw
from vibroimpact.contact.power_law import SphereLaw


@scalar
def _forces(
    delta: Array, delta_dot: Array, approach_speed: Array, coefficients: Any
) -> tuple[Array, Array]:
    stiffness = coefficients[0]
    dashpot = coefficients[1]
    root = np.sqrt(delta)
    return stiffness * (delta * root), dashpot * root * delta_dot


@dataclass(frozen=True, kw_only=True)
class KuwabaraKono(ViscoelasticLaw, SphereLaw):
    r"""Viscoelastic spheres (Kuwabara and Kono 1987; Brilliantov and others 1996).

    .. math::
        F = \max\left(0,\ K \left[\delta^{3/2} + \tfrac32 A \sqrt\delta\, \dot\delta\right]\right)

    Notes
    -----
    Hertz's force at :math:`\delta + A \dot\delta` in place of :math:`\delta`, to first order in A;
    valid while A is short
    beside the contact. The restitution falls with the speed, to first order as :math:`1 - c\,
    v^{1/5}`. Fit A to a measured
    restitution.

    References
    ----------
    Kuwabara, G. and Kono, K. (1987). Restitution coefficient in a collision between two spheres.
    Jpn. J. Appl. Phys. 26, 1230-1233.

    Brilliantov, N. V., Spahn, F., Hertzsch, J.-M. and Poeschel, T. (1996). Model for collisions in
    granular gases. Phys. Rev. E 53, 5382-5392.

    Examples
    --------
    >>> law = KuwabaraKono(stiffness=2.0, dissipation_time=0.1)
    >>> elastic, dissipative = law.forces(4.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 6)
    (16.0, 0.6)
    """

    name = "kuwabara-kono"
    equation = "F = max(0, K [delta^1.5 + 3/2 A sqrt(delta) delta_dot])"
    source = (
        "Kuwabara & Kono 1987, Jpn. J. Appl. Phys. 26:1230; Brilliantov et al. "
        "1996, Phys. Rev. E 53:5382"
    )
    departure = (
        "The contact ends when the force is zero; by the formula it would be tensile from there "
        "to zero indentation."
    )
    contact_end = "zero-force"
    tension = "cut"
    scalar_forces: ClassVar[ScalarForces | None] = staticmethod(_forces)

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """Stiffness, and the dashpot constant at a root of the indentation of one."""
        return self.stiffness, 1.5 * self.stiffness * self.dissipation_time
