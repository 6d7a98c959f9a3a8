"""Elastic-plastic contact of a sphere: Hertzian up to yield, with Hertzian unloading of a flattened sphere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.choice import where
from vibroimpact.contact.elastic_plastic import ElasticPlasticLaw, static_force
from vibroimpact.contact.mixins import ElasticPairLaw
from vibroimpact.contact.pair import hertz_stiffness
from vibroimpact.contact.power_law import power


@scalar
def yielded_indentation(delta: Array, coefficients: Any) -> Array:
    """Return the indentation [m] at which the plastic force is taken: at least the largest so far, and that at yield."""
    loaded_to, yield_indentation = coefficients[0], coefficients[5]
    return np.maximum(np.maximum(delta, loaded_to), yield_indentation)


@scalar
def yielding_sphere_forces(delta: Array, plastic: Array, coefficients: Any) -> tuple[Array, Array]:
    """Return the forces [N] of a yielding sphere at an indentation [m] from the plastic force [N] at the yielded indentation."""
    loaded_to, yield_indentation, stiffness = coefficients[0], coefficients[5], coefficients[6]
    deepest = np.maximum(delta, loaded_to)
    elastic = stiffness * power(np.minimum(deepest, yield_indentation), 1.5)
    force = static_force(delta, where(deepest > yield_indentation, plastic, elastic), coefficients)
    return force, 0.0 * force


@dataclass(frozen=True, kw_only=True)
class YieldingSphereLaw(ElasticPairLaw, ElasticPlasticLaw):
    r"""Base of the elastic-plastic laws of a sphere.

    Up to `yield_indentation` the contact is Hertzian. Beyond, it unloads as the Hertzian contact of a sphere of larger radius
    with the same contact radius :math:`a_m`, which is :math:`\sqrt{R \delta_m}` unless a law has it otherwise, and force
    :math:`F_m`, so that

    .. math:: \delta_m - \delta_r = \frac{3 F_m}{4 E^* a_m}

    (Thornton 1997, J. Appl. Mech. 64, 383-386). A law defines the plastic force as a function that compiled code calls, from which its
    `scalar_forces` follow by `yielding_sphere_forces`.
    """

    @property
    def yield_indentation(self) -> Array:
        """Indentation at yield [m]."""
        raise NotImplementedError

    def plastic_force(self, delta: Array) -> Array:
        """Return the loading force beyond `yield_indentation` [N]."""
        raise NotImplementedError

    def plastic_loading_work(self, delta: Array) -> Array:
        """Return the integral of `plastic_force` from `yield_indentation` [J]."""
        raise NotImplementedError

    def contact_radius(self, delta: Array) -> Array:
        """Return the contact radius beyond `yield_indentation` [m]."""
        return np.sqrt(self.effective_radius * delta)

    @property
    def breakpoints(self) -> tuple[Array, ...]:
        """The yield indentation, or the largest indentation so far if that is larger."""
        return (np.maximum(self.yield_indentation, self.loaded_to),)

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """Those of unloading, yield indentation and Hertz's stiffness; a law adds those of its plastic force."""
        return *super().coefficients, self.yield_indentation, self.stiffness

    @property
    def stiffness(self) -> Array:
        """Hertz's stiffness [N/m^1.5]."""
        return hertz_stiffness(self.effective_modulus, self.effective_radius)

    def loading_force(self, delta: Array) -> Array:
        """Return Hertz's force up to the yield indentation, the plastic force beyond [N]."""
        yielded, elastic = self._split(delta)
        return np.where(delta > elastic, self.plastic_force(yielded), self.stiffness * elastic * np.sqrt(elastic))

    def loading_work(self, delta: Array) -> Array:
        """Return the integral of the loading force from zero [J]."""
        yielded, elastic = self._split(delta)
        plastic = np.where(delta > elastic, self.plastic_loading_work(yielded), 0.0)  # exactly zero up to yield, despite rounding
        return 0.4 * self.stiffness * elastic**2 * np.sqrt(elastic) + plastic

    def elastic_recovery(self, deepest: Array) -> Array:
        """Return the elastic recovery [m], which is the full indentation up to yield."""
        yielded, elastic = self._split(deepest)
        recovery = 0.75 * self.plastic_force(yielded) / (self.effective_modulus * self.contact_radius(yielded))
        return np.where(deepest > elastic, recovery, deepest)

    def _split(self, delta: Array) -> tuple[Array, Array]:
        """Return the indentation clipped from below and from above at the yield indentation [m]."""
        at_yield = self.yield_indentation
        return np.maximum(delta, at_yield), np.minimum(delta, at_yield)
