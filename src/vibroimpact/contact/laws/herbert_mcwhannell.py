"""Herbert and McWhannell's law: hysteretic damping."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.hysteretic import HystereticLaw


@dataclass(frozen=True, kw_only=True)
class HerbertMcWhannell(HystereticLaw):
    r"""Hertz's force with hysteretic damping (Herbert and McWhannell 1977).

    .. math::
        F = K \delta^n \left[1 + \frac{6 (1 - e)}{(2 e - 1)^2 + 3}\, \dot\delta /
        \dot\delta_0\right]

    with :math:`\dot\delta_0` the closing speed at touch; each further contact of an impact has its
    own.

    Notes
    -----
    For e < 1 the restitution achieved is larger than the one asked for: 0.9 gives 0.901, 0.7 gives
    0.723, and no value gives less than 0.487.

    References
    ----------
    Herbert, R. G. and McWhannell, D. C. (1977). Shape and frequency composition of pulses from an
    impact pair. J. Eng. Ind. 99, 513-518.

    Examples
    --------
    >>> law = HerbertMcWhannell(stiffness=2.0, restitution=0.5)
    >>> elastic, dissipative = law.forces(4.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 6)
    (16.0, 16.0)
    """

    name = "herbert-mcwhannell"
    equation = "F = K delta^n [1 + 6 (1 - e) / ((2 e - 1)^2 + 3) delta_dot / v0]"
    source = "Herbert & McWhannell 1977, J. Eng. Ind. 99:513"

    @property
    def damping_factor(self) -> Array:
        """The damping factor D(e) [-]."""
        return 6.0 * (1.0 - self.restitution) / ((2.0 * self.restitution - 1.0) ** 2 + 3.0)
