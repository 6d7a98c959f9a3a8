"""Lankarani and Nikravesh's law: Hertz with hysteretic damping."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.hysteretic import HystereticLaw


@dataclass(frozen=True, kw_only=True)
class LankaraniNikravesh(HystereticLaw):
    r"""Hertz contact with hysteretic damping by a restitution (Lankarani and Nikravesh 1990).

    .. math:: F = K \delta^n \left[1 + \tfrac34 (1 - e^2)\, \dot\delta / \dot\delta_0\right]

    with :math:`\dot\delta_0` the closing speed at touch; each further contact of an impact has its
    own.

    Notes
    -----
    The relation is for e near 1. For e < 1 the restitution achieved is larger than the one asked
    for: 0.65 gives 0.775, and no value gives less than 0.66.

    References
    ----------
    Lankarani, H. M. and Nikravesh, P. E. (1990). A contact force model with hysteresis damping for
    impact analysis of multibody systems. J. Mech. Des. 112, 369-376.

    Examples
    --------
    >>> law = LankaraniNikravesh(stiffness=2.0, restitution=0.5)
    >>> elastic, dissipative = law.forces(4.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 6)
    (16.0, 9.0)
    """

    name = "lankarani-nikravesh"
    equation = "F = K delta^n [1 + 3/4 (1 - e^2) delta_dot / v0]"
    source = "Lankarani & Nikravesh 1990, J. Mech. Des. 112:369"

    @property
    def damping_factor(self) -> Array:
        """The damping factor D(e) [-]."""
        return 0.75 * (1.0 - self.restitution * self.restitution)
