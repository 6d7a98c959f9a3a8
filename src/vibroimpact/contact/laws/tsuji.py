"""Tsuji and others' law: Hertz's force with a dashpot.

The dashpot makes the restitution independent of the speed.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.kelvin_voigt import (
    damping_ratio_from_restitution,
    restitution_from_damping_ratio,
)
from vibroimpact.contact.law import ScalarForces
from vibroimpact.contact.mixins import RestitutionForMassLaw
from vibroimpact.contact.power_law import SphereLaw, fourth_root_forces


@dataclass(frozen=True, kw_only=True)
class Tsuji(RestitutionForMassLaw, SphereLaw):
    r"""Damped Hertz contact (Tsuji and others 1992; damping of Antypov and Elliott 2011).

    .. math:: F = K \delta^{3/2} + \alpha \sqrt{m K}\, \delta^{1/4}\, \dot\delta,
              \qquad \alpha = -\sqrt5 \ln e / \sqrt{\pi^2 + \ln^2 e}

    Notes
    -----
    A change of variables makes the motion that of a damped linear oscillator: without gravity the
    restitution of an impact with this effective mass is the one asked for at any speed. The contact
    ends at zero overlap and may pull before that, as in the published solution; with the tension
    cut, 0.5 would give 0.55.

    References
    ----------
    Tsuji, Y., Tanaka, T. and Ishida, T. (1992). Lagrangian numerical simulation of plug flow of
    cohesionless particles in a horizontal pipe. Powder Technology 71, 239-250.

    Antypov, D. and Elliott, J. A. (2011). On an analytical solution for the damped Hertzian spring.
    EPL 94, 50004.

    Examples
    --------
    >>> law = Tsuji(stiffness=100.0, restitution=0.5, effective_mass=1.0)
    >>> elastic, dissipative = law.forces(1.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 5)
    (100.0, 4.81769)
    """

    name = "tsuji"
    equation = (
        "F = K delta^1.5 + alpha sqrt(m K) delta^0.25 delta_dot, alpha = -sqrt(5) ln e / "
        "sqrt(pi^2 + ln^2 e)"
    )
    source = "Tsuji et al. 1992, Powder Technology 71:239; Antypov & Elliott 2011, EPL 94:50004"
    contact_end = "zero-indentation"
    tension = "kept"
    root = 4
    scalar_forces: ClassVar[ScalarForces | None] = staticmethod(fourth_root_forces)

    @property
    def _dashpot(self) -> Array:
        return np.sqrt(5.0 * self.effective_mass * self.stiffness) * damping_ratio_from_restitution(
            self.restitution
        )

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """Stiffness and dashpot constant."""
        return self.stiffness, self._dashpot

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        """Return Antypov and Elliott's restitution, independent of the speed."""
        return restitution_from_damping_ratio(
            self._dashpot / np.sqrt(5.0 * mass * self.stiffness) + 0.0 * speed
        )
