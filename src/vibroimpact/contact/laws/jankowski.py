"""Jankowski's law: Hertz's force with a nonlinear dashpot in compression only."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.law import ScalarForces
from vibroimpact.contact.mixins import RestitutionForMassLaw, TwoPhaseLaw
from vibroimpact.contact.power_law import SphereLaw, fourth_root_forces


@dataclass(frozen=True, kw_only=True)
class Jankowski(RestitutionForMassLaw, SphereLaw, TwoPhaseLaw):
    r"""Nonlinear viscoelastic pounding (Jankowski 2005, 2006).

    .. math:: F = K \delta^{3/2} + 2 \xi \sqrt{m K \sqrt\delta}\, \dot\delta,\qquad
              \xi = \frac{9 \sqrt5}{2}\, \frac{1 - e^2}{e\, [e\, (9\pi - 16) + 16]}

    The dashpot acts until the indentation first turns; from then on :math:`F = K \delta^{3/2}`.

    Notes
    -----
    The damping ratio is approximate: 0.5 gives 0.495, 0.3 gives 0.292. Once the indentation has
    turned, nothing is lost.

    References
    ----------
    Jankowski, R. (2005). Non-linear viscoelastic modelling of earthquake-induced structural
    pounding. Earthquake Eng. Struct. Dyn. 34, 595-611.

    Jankowski, R. (2006). Analytical expression between the impact damping ratio and the coefficient
    of restitution in the non-linear viscoelastic model of structural pounding. Earthquake Eng.
    Struct. Dyn. 35, 517-524.

    Examples
    --------
    >>> law = Jankowski(stiffness=100.0, restitution=0.5, effective_mass=1.0)
    >>> elastic, dissipative = law.forces(1.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 4)
    (100.0, 13.6363)
    """

    name = "jankowski"
    equation = (
        "F = K delta^1.5 + 2 xi sqrt(m K sqrt(delta)) delta_dot until the indentation first "
        "turns, K delta^1.5 from then on, "
        "xi = 9 sqrt(5)/2 (1 - e^2) / (e [e (9 pi - 16) + 16])"
    )
    source = "Jankowski 2006, Earthquake Eng. Struct. Dyn. 35:517"
    contact_end = "zero-indentation"
    tension = "none"
    root = 4
    scalar_forces: ClassVar[ScalarForces | None] = staticmethod(fourth_root_forces)

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """Stiffness, and the dashpot constant by phase.

        The latter is zero once the indentation has turned.
        """
        e = self.restitution
        ratio = 4.5 * np.sqrt(5.0) * (1.0 - e * e) / (e * (e * (9.0 * np.pi - 16.0) + 16.0))
        dashpot = 2.0 * ratio * np.sqrt(self.effective_mass * self.stiffness)
        return self.coefficients_by_phase(self.stiffness, dashpot, 0.0)
