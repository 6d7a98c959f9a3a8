"""The elastic part that most laws share: a power of the indentation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.law import CompliantLaw, parameter


@dataclass(frozen=True, kw_only=True)
class PowerLaw(CompliantLaw):
    r"""Base of the laws whose elastic force is :math:`K \delta^n`."""

    stiffness: Array = parameter("contact stiffness K", "N/m^n", above=0, from_pair="hertz_stiffness")
    exponent: Array = parameter("force exponent n, 1.5 for a sphere", at_least=1, default=1.5)

    def elastic_force(self, delta: Array) -> Array:
        r"""Return :math:`K \delta^n` [N]."""
        return self.stiffness * power(delta, self.exponent)

    def elastic_energy(self, delta: Array) -> Array:
        r"""Return :math:`K \delta^{n+1}/(n+1)` [J]."""
        return self.elastic_force(delta) * delta / (self.exponent + 1.0)


@dataclass(frozen=True, kw_only=True)
class SphereLaw(CompliantLaw):
    r"""Base of the laws that hold for a sphere alone: their elastic force is :math:`K \delta^{3/2}`."""

    stiffness: Array = parameter("contact stiffness K", "N/m^1.5", above=0, from_pair="hertz_stiffness")

    def elastic_force(self, delta: Array) -> Array:
        r"""Return :math:`K \delta^{3/2}` [N]."""
        return self.stiffness * power(delta, 1.5)

    def elastic_energy(self, delta: Array) -> Array:
        r"""Return :math:`\tfrac25 K \delta^{5/2}` [J]."""
        return 0.4 * delta * self.elastic_force(delta)


def power(delta: Array, exponent: Array) -> Array:
    """Return delta^exponent for delta >= 0; Hertz's 3/2 by a square root, which is many times faster.

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
