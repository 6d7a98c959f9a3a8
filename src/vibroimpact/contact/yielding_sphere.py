"""A sphere's contact that is Hertz's until it yields, and unloads as Hertz's of a flatter sphere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.elastic_plastic import ElasticPlasticLaw
from vibroimpact.contact.law import parameter
from vibroimpact.contact.pair import hertz_stiffness


@dataclass(frozen=True, kw_only=True)
class YieldingSphereLaw(ElasticPlasticLaw):
    r"""Base of the elastic-plastic laws of a sphere.

    Below `yield_indentation` the contact is Hertz's. From beyond, it unloads as Hertz's contact of the flatter sphere that
    has the same contact radius :math:`a_m = \sqrt{R \delta_m}` and force :math:`F_m`, so that

    .. math:: \delta_m - \delta_r = \frac{3 F_m}{4 E^* a_m}

    (Thornton 1997, J. Appl. Mech. 64, 383-386).
    """

    effective_modulus: Array = parameter("effective modulus E*", "Pa", above=0, from_pair="effective_modulus")
    effective_radius: Array = parameter("effective radius R", "m", above=0, from_pair="effective_radius")

    @property
    def yield_indentation(self) -> Array:
        """Indentation at which plastic deformation begins [m]."""
        raise NotImplementedError

    def plastic_force(self, delta: Array) -> Array:
        """Return the loading force beyond `yield_indentation` [N]."""
        raise NotImplementedError

    def plastic_loading_work(self, delta: Array) -> Array:
        """Return the integral of `plastic_force` from `yield_indentation` [J]."""
        raise NotImplementedError

    @property
    def breakpoints(self) -> tuple[Array, ...]:
        """Where it yields, or the deepest indentation so far."""
        return (np.maximum(self.yield_indentation, self.loaded_to),)

    @property
    def stiffness(self) -> Array:
        """Hertz's stiffness [N/m^1.5]."""
        return hertz_stiffness(self.effective_modulus, self.effective_radius)

    def loading_force(self, delta: Array) -> Array:
        """Return Hertz's force below the yield indentation, the plastic one beyond [N]."""
        yielded, elastic = self._split(delta)
        return np.where(delta > elastic, self.plastic_force(yielded), self.stiffness * elastic * np.sqrt(elastic))

    def loading_work(self, delta: Array) -> Array:
        """Return the integral of the loading force from zero [J]."""
        yielded, elastic = self._split(delta)
        plastic = np.where(delta > elastic, self.plastic_loading_work(yielded), 0.0)  # which rounding would not leave at zero
        return 0.4 * self.stiffness * elastic**2 * np.sqrt(elastic) + plastic

    def elastic_part(self, deepest: Array) -> Array:
        """Return how far the contact springs back [m]: all of it, if it has not yielded."""
        yielded, elastic = self._split(deepest)
        spring_back = 0.75 * self.plastic_force(yielded) / (self.effective_modulus * np.sqrt(self.effective_radius * yielded))
        return np.where(deepest > elastic, spring_back, deepest)

    def _split(self, delta: Array) -> tuple[Array, Array]:
        """Return an indentation, but not less than that of yield, and not more than it."""
        at = self.yield_indentation
        return np.maximum(delta, at), np.minimum(delta, at)
