"""Gonthier and others' law: hysteretic damping for all restitutions."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.hysteretic import HystereticLaw
from vibroimpact.contact.parameters import inherited_parameter


@dataclass(frozen=True, kw_only=True)
class Gonthier(HystereticLaw):
    r"""Hertz's force with hysteretic damping (Gonthier and others 2004).

    .. math:: F = K \delta^n \left[1 + (1 - e^2)/e\, \dot\delta / \dot\delta_0\right]

    with :math:`\dot\delta_0` the closing speed at touch; each further contact of an impact has its
    own.

    Notes
    -----
    An approximation of the relation between damping and restitution. The restitution achieved is
    within 0.033 of the one asked for: 0.7 gives 0.670, 0.1 gives 0.101.

    References
    ----------
    Gonthier, Y., McPhee, J., Lange, C. and Piedboeuf, J.-C. (2004). A regularized contact model
    with asymmetric damping and dwell-time dependent friction. Multibody Syst. Dyn. 11, 209-233.

    Examples
    --------
    >>> law = Gonthier(stiffness=2.0, restitution=0.5)
    >>> elastic, dissipative = law.forces(4.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 6)
    (16.0, 24.0)
    """

    name = "gonthier"
    equation = "F = K delta^n [1 + (1 - e^2) / e delta_dot / v0]"
    source = "Gonthier et al. 2004, Multibody Syst. Dyn. 11:209"

    restitution: Array = inherited_parameter(HystereticLaw, "restitution", above=0, at_most=1)

    @property
    def damping_factor(self) -> Array:
        """The damping factor D(e) [-]."""
        return (1.0 - self.restitution * self.restitution) / self.restitution
