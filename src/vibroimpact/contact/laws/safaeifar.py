"""Safaeifar and Farshidianfar's law: hysteretic damping for all restitutions."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.hysteretic import HystereticLaw
from vibroimpact.contact.parameters import inherited_parameter


@dataclass(frozen=True, kw_only=True)
class Safaeifar(HystereticLaw):
    r"""Hertz's force with hysteretic damping (Safaeifar and Farshidianfar 2020).

    .. math:: F = K \delta^n \left[1 + \frac{5 (1 - e)}{4 e}\, \dot\delta / \dot\delta_0\right]

    with :math:`\dot\delta_0` the closing speed at touch; each further contact of an impact has its
    own.

    Notes
    -----
    The restitution achieved is larger than the one asked for above 0.22 and below 1: 0.7 gives
    0.735, 0.3 gives 0.314.

    References
    ----------
    Safaeifar, H. and Farshidianfar, A. (2020). A new model of the contact force for the collision
    between two solid bodies. Multibody Syst. Dyn. 50, 233-257.

    Examples
    --------
    >>> law = Safaeifar(stiffness=2.0, restitution=0.5)
    >>> elastic, dissipative = law.forces(4.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 6)
    (16.0, 20.0)
    """

    name = "safaeifar"
    equation = "F = K delta^n [1 + 5 (1 - e) / (4 e) delta_dot / v0]"
    source = "Safaeifar & Farshidianfar 2020, Multibody Syst. Dyn. 50:233"

    restitution: Array = inherited_parameter(HystereticLaw, "restitution", above=0, at_most=1)

    @property
    def damping_factor(self) -> Array:
        """The damping factor D(e) [-]."""
        return 1.25 * (1.0 - self.restitution) / self.restitution
