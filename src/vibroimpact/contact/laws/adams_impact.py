"""The IMPACT function of MSC Adams.

It is a power-law spring and a dashpot that grows with the penetration.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.law import Levels, ScalarForces, ScalarLevels
from vibroimpact.contact.parameters import inherited_parameter, parameter
from vibroimpact.contact.power_law import PowerLaw, power


@scalar
def _forces(
    delta: Array, delta_dot: Array, approach_speed: Array, coefficients: Any
) -> tuple[Array, Array]:
    stiffness = coefficients[0]
    exponent = coefficients[1]
    damping_max = coefficients[2]
    full_damping_penetration = coefficients[3]
    s = np.minimum(delta / full_damping_penetration, 1.0)
    damping = damping_max * (s * s * (3.0 - 2.0 * s))
    return stiffness * power(delta, exponent), damping * delta_dot


@scalar
def _levels(coefficients: Any) -> Levels:
    # the second derivative of STEP jumps where the damping is full
    return 0.0, 0.0, np.inf, coefficients[3], np.inf


@dataclass(frozen=True, kw_only=True)
class AdamsImpact(PowerLaw):
    r"""The IMPACT function of Adams: a power law, with damping that rises with penetration.

    STEP is the cubic :math:`C s^2 (3 - 2 s)` in :math:`s = \delta/d`, and C beyond :math:`d`.

    Notes
    -----
    The clip at zero belongs to Adams' definition of the function. The contact is over when the
    bodies no longer overlap. Without the clip the rebound heights of the case
    `paper:type1-variable` are 3 to 9 % lower.

    References
    ----------
    MSC Software. Adams/Solver guide, functions IMPACT and STEP.

    Examples
    --------
    >>> law = AdamsImpact(stiffness=2.0, damping_max=3.0, full_damping_penetration=8.0)
    >>> elastic, dissipative = law.forces(4.0, 1.0, 1.0)
    >>> float(elastic), float(dissipative)
    (16.0, 1.5)
    """

    name = "adams-impact"
    equation = "F = max(0, K delta^n + STEP(delta; 0, 0; d, C) delta_dot)"
    source = "MSC Adams/Solver guide, functions IMPACT and STEP"
    contact_end = "zero-indentation"
    tension = "cut"
    scalar_forces: ClassVar[ScalarForces | None] = staticmethod(_forces)
    scalar_levels: ClassVar[ScalarLevels | None] = staticmethod(_levels)
    free_parameter = "damping_max"

    stiffness: Array = inherited_parameter(
        PowerLaw,
        "stiffness",
        detail="Contact stiffness :math:`K`. From N/mm^n it is multiplied by 1000^n.",
    )
    exponent: Array = inherited_parameter(
        PowerLaw, "exponent", detail="Force exponent :math:`n` (Adams calls it e)."
    )
    damping_max: Array = parameter(
        "largest damping C", "N s/m", detail="Largest damping :math:`C`.", example=150.0, at_least=0
    )
    full_damping_penetration: Array = parameter(
        "indentation d at which the damping is full",
        "m",
        detail="Indentation :math:`d` at which the damping is full.",
        above=0,
        default=1e-4,
    )

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """Stiffness, exponent, largest damping and the penetration at which it is full."""
        return self.stiffness, self.exponent, self.damping_max, self.full_damping_penetration
