"""Flores and others' law: hysteretic damping for soft materials too."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.hysteretic import HystereticLaw
from vibroimpact.contact.parameters import inherited_parameter


@dataclass(frozen=True, kw_only=True)
class Flores(HystereticLaw):
    r"""Hertz's force with hysteretic damping (Flores and others 2011).

    .. math:: F = K \delta^n \left[1 + \frac{8 (1 - e)}{5 e}\, \dot\delta / \dot\delta_0\right]

    with :math:`\dot\delta_0` the closing speed at touch; each further contact of an impact has its
    own.

    Notes
    -----
    For e < 1 the restitution achieved is smaller than the one asked for: 0.7 gives 0.683, 0.3 gives
    0.256.

    References
    ----------
    Flores, P., Machado, M., Silva, M. T. and Martins, J. M. (2011). On the continuous contact force
    models for soft materials in multibody dynamics. Multibody Syst. Dyn. 25, 357-375.

    Examples
    --------
    >>> law = Flores(stiffness=2.0, restitution=0.5)
    >>> elastic, dissipative = law.forces(4.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 6)
    (16.0, 25.6)
    """

    name = "flores"
    equation = "F = K delta^n [1 + 8 (1 - e) / (5 e) delta_dot / v0]"
    source = "Flores et al. 2011, Multibody Syst. Dyn. 25:357"

    restitution: Array = inherited_parameter(HystereticLaw, "restitution", above=0, at_most=1)

    @property
    def damping_factor(self) -> Array:
        """The damping factor D(e) [-]."""
        return 1.6 * (1.0 - self.restitution) / self.restitution
