"""Power-law elastic forces, and the duration of an elastic Hertzian impact.

The exponent is 3/2 for a Hertzian contact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar, scalar_as
from vibroimpact.contact.law import CompliantLaw, ScalarEnergies
from vibroimpact.contact.parameters import parameter

HERTZ_TIME = 0.8 * math.gamma(0.4) * math.gamma(0.5) / math.gamma(0.9)
r"""Contact duration of an elastic Hertzian impact over largest indentation / approach speed [-],
2.9433.

:math:`2 \int_0^1 dx / \sqrt{1 - x^{5/2}} = \tfrac45 \Gamma(\tfrac25) \Gamma(\tfrac12) /
\Gamma(\tfrac{9}{10})`
(H. Hertz, J. reine angew. Math. 92:156, 1881; K. L. Johnson, Contact Mechanics, 1985, eq. 11.24
rounds it to 2.94).
"""


def _power_of_float(delta: float, exponent: float) -> float:
    if exponent == 1.5:
        return delta * math.sqrt(delta)
    if exponent == 1.0:
        return delta
    return float(delta**exponent)


@scalar_as(_power_of_float)
def power(delta: Array, exponent: Array) -> Array:
    """Return delta^exponent for delta >= 0.

    3/2 is computed with a square root, which is many times faster.

    Examples
    --------
    >>> float(power(4.0, 1.5))
    8.0
    """
    if isinstance(exponent, (int, float)):
        if exponent == 1.5:
            return delta * np.sqrt(delta)
        if exponent == 1.0:
            return delta
    return np.power(delta, exponent)


@scalar
def fourth_root_forces(
    delta: Array, delta_dot: Array, approach_speed: Array, coefficients: Any
) -> tuple[Array, Array]:
    r"""Return the forces of :math:`K \delta^{3/2} + c\, \delta^{1/4}\, \dot\delta` [N].

    The coefficients are K and c.
    """
    stiffness = coefficients[0]
    dashpot = coefficients[1]
    root = np.sqrt(delta)
    return stiffness * (delta * root), dashpot * np.sqrt(root) * delta_dot


@scalar
def spring_energies(delta: Array, coefficients: Any) -> tuple[Array, Array]:
    r"""Return the energies of a linear spring, :math:`k \delta^2/2` [J].

    The first coefficient is k.
    """
    return 0.5 * coefficients[0] * delta * delta, 0.0 * delta


@scalar
def sphere_energies(delta: Array, coefficients: Any) -> tuple[Array, Array]:
    r"""Return the energies of an elastic sphere, :math:`\tfrac25 K \delta^{5/2}` [J].

    The first coefficient is K.
    """
    return 0.4 * delta * (coefficients[0] * power(delta, 1.5)), 0.0 * delta


@scalar
def power_law_energies(delta: Array, coefficients: Any) -> tuple[Array, Array]:
    r"""Return the energies of a power law, :math:`K \delta^{n+1}/(n+1)` [J].

    The first coefficients are K and n.
    """
    stiffness = coefficients[0]
    exponent = coefficients[1]
    return stiffness * power(delta, exponent) * delta / (exponent + 1.0), 0.0 * delta


@dataclass(frozen=True, kw_only=True)
class PowerLaw(CompliantLaw):
    r"""Base of the laws with the elastic force :math:`K \delta^n`.

    Their first coefficients are K and n.
    """

    scalar_energies: ClassVar[ScalarEnergies | None] = staticmethod(power_law_energies)

    stiffness: Array = parameter(
        "contact stiffness K",
        "N/m^n",
        detail="Contact stiffness :math:`K`.",
        above=0,
        from_pair="hertz_stiffness",
    )
    exponent: Array = parameter(
        "force exponent n, 1.5 for a sphere",
        detail="Force exponent :math:`n`.",
        at_least=1,
        default=1.5,
    )

    def elastic_force(self, delta: Array) -> Array:
        r"""Return :math:`K \delta^n` [N]."""
        return self.stiffness * power(delta, self.exponent)


@dataclass(frozen=True, kw_only=True)
class SphereLaw(CompliantLaw):
    r"""Base of the laws with Hertz's force of a sphere, :math:`K \delta^{3/2}`.

    Their first coefficient is K.
    """

    scalar_energies: ClassVar[ScalarEnergies | None] = staticmethod(sphere_energies)

    stiffness: Array = parameter(
        "contact stiffness K",
        "N/m^1.5",
        detail="Contact stiffness :math:`K`.",
        above=0,
        from_pair="hertz_stiffness",
    )

    def elastic_force(self, delta: Array) -> Array:
        r"""Return :math:`K \delta^{3/2}` [N]."""
        return self.stiffness * power(delta, 1.5)
