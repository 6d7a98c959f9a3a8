"""Hunt and Crossley's law: the first hysteretic damping."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.hysteretic import HystereticLaw


@dataclass(frozen=True, kw_only=True)
class HuntCrossley(HystereticLaw):
    r"""Hertz's force with hysteretic damping (Hunt and Crossley 1975).

    .. math:: F = K \delta^n \left[1 + \tfrac32 (1 - e)\, \dot\delta / \dot\delta_0\right]

    with :math:`\dot\delta_0` the speed at the first touch of this impact.

    Notes
    -----
    Derived for e near 1, from an energy loss that is small. The restitution achieved is larger than the one
    asked for: 0.7 gives 0.768, and no value gives less than 0.487.

    References
    ----------
    Hunt, K. H. and Crossley, F. R. E. (1975). Coefficient of restitution interpreted as damping in vibroimpact.
    J. Appl. Mech. 42, 440-445.

    Examples
    --------
    >>> law = HuntCrossley(stiffness=2.0, restitution=0.5)
    >>> elastic, dissipative = law.forces(4.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 6)
    (16.0, 12.0)
    """

    name = "hunt-crossley"
    equation = "F = K delta^n [1 + 3/2 (1 - e) delta_dot / v0]"
    source = "Hunt & Crossley 1975, J. Appl. Mech. 42:440"

    @property
    def damping_factor(self) -> Array:
        """The damping factor D(e) [-]."""
        return 1.5 * (1.0 - self.restitution)
