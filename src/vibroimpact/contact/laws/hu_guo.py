"""Hu and Guo's law: hysteretic damping for all restitutions."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.hysteretic import HystereticLaw
from vibroimpact.contact.parameters import inherited_parameter


@dataclass(frozen=True, kw_only=True)
class HuGuo(HystereticLaw):
    r"""Hertz's force with hysteretic damping (Hu and Guo 2015).

    .. math:: F = K \delta^n \left[1 + \frac{3 (1 - e)}{2 e}\, \dot\delta / \dot\delta_0\right]

    with :math:`\dot\delta_0` the closing speed at touch; each further contact of an impact has its
    own.

    Notes
    -----
    The restitution achieved is within 0.01 of the one asked for above 0.55: 0.7 gives 0.697, 0.3
    gives 0.271.

    References
    ----------
    Hu, S. and Guo, X. (2015). A dissipative contact force model for impact analysis in multibody
    dynamics. Multibody Syst. Dyn. 35, 131-151.

    Examples
    --------
    >>> law = HuGuo(stiffness=2.0, restitution=0.5)
    >>> elastic, dissipative = law.forces(4.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 6)
    (16.0, 24.0)
    """

    name = "hu-guo"
    equation = "F = K delta^n [1 + 3 (1 - e) / (2 e) delta_dot / v0]"
    source = "Hu & Guo 2015, Multibody Syst. Dyn. 35:131"

    restitution: Array = inherited_parameter(HystereticLaw, "restitution", above=0, at_most=1)

    @property
    def damping_factor(self) -> Array:
        """The damping factor D(e) [-]."""
        return 1.5 * (1.0 - self.restitution) / self.restitution
