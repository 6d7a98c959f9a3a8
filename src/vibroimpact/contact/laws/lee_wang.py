"""Lee and Wang's law: half the damping of Hunt and Crossley."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.hysteretic import HystereticLaw


@dataclass(frozen=True, kw_only=True)
class LeeWang(HystereticLaw):
    r"""Hertz's force with hysteretic damping (Lee and Wang 1983).

    .. math:: F = K \delta^n \left[1 + \tfrac34 (1 - e)\, \dot\delta / \dot\delta_0\right]

    with :math:`\dot\delta_0` the closing speed at touch; each further contact of an impact has its
    own.

    Notes
    -----
    The energy lost is about half of that at the restitution asked for: 0.7 gives 0.869, and no
    value gives less than 0.66.

    References
    ----------
    Lee, T. W. and Wang, A. C. (1983). On the dynamics of intermittent-motion mechanisms, part 1:
    dynamic model and response. J. Mech. Transm. Autom. Des. 105, 534-540.

    Examples
    --------
    >>> law = LeeWang(stiffness=2.0, restitution=0.5)
    >>> elastic, dissipative = law.forces(4.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 6)
    (16.0, 6.0)
    """

    name = "lee-wang"
    equation = "F = K delta^n [1 + 3/4 (1 - e) delta_dot / v0]"
    source = "Lee & Wang 1983, J. Mech. Transm. Autom. Des. 105:534"

    @property
    def damping_factor(self) -> Array:
        """The damping factor D(e) [-]."""
        return 0.75 * (1.0 - self.restitution)
