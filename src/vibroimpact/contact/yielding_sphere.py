"""Elastic-plastic contact of a sphere: Hertzian up to yield, and in its flatter unloading."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.choice import where
from vibroimpact.contact.elastic_plastic import (
    ElasticPlasticLaw,
    LoadingCurve,
    LoadingState,
    OfIndentation,
)
from vibroimpact.contact.law import Levels, ScalarLevels
from vibroimpact.contact.mixins import ElasticPairLaw
from vibroimpact.contact.pair import hertz_stiffness


@scalar
def _levels(coefficients: Any) -> Levels:
    loaded_to = coefficients[0]
    touch_level = coefficients[1]
    yield_indentation = coefficients[6]
    return touch_level, touch_level, loaded_to, np.maximum(yield_indentation, loaded_to), np.inf


def yielding_sphere(plastic_force: OfIndentation, plastic_state: LoadingState) -> LoadingCurve:
    """Return the loading curve of a sphere that is Hertzian up to yield.

    Its coefficients, from index 6, are yield indentation, Hertz's stiffness, effective modulus and
    effective radius; a law adds its own.

    Parameters
    ----------
    plastic_force : callable
        Loading force beyond yield [N].
    plastic_state : callable
        This force, its integral from the yield indentation [J], and the contact radius [m].
    """

    @scalar
    def force(delta: Array, coefficients: Any) -> Array:
        yield_indentation = coefficients[6]
        stiffness = coefficients[7]
        # both branches are computed, each within its range
        elastic_delta = np.minimum(delta, yield_indentation)
        beyond_yield = plastic_force(np.maximum(delta, yield_indentation), coefficients)
        hertzian = stiffness * elastic_delta * np.sqrt(elastic_delta)
        return where(delta > yield_indentation, beyond_yield, hertzian)

    @scalar
    def state(delta: Array, coefficients: Any) -> tuple[Array, Array, Array]:
        yield_indentation = coefficients[6]
        stiffness = coefficients[7]
        effective_modulus = coefficients[8]
        yields = delta > yield_indentation
        elastic_delta = np.minimum(delta, yield_indentation)
        beyond_yield, work_beyond_yield, contact_radius = plastic_state(
            np.maximum(delta, yield_indentation), coefficients
        )
        hertzian = stiffness * elastic_delta * np.sqrt(elastic_delta)
        force = where(yields, beyond_yield, hertzian)
        hertzian_work = 0.4 * stiffness * (elastic_delta * elastic_delta) * np.sqrt(elastic_delta)
        # exactly no plastic work up to yield, despite rounding
        loading_work = hertzian_work + where(yields, work_beyond_yield, 0.0)
        # 3 F/(4 E* a); up to yield all of the indentation recovers
        plastic_recovery = 0.75 * beyond_yield / (effective_modulus * contact_radius)
        recovery = where(yields, plastic_recovery, delta)
        return force, loading_work, recovery

    return LoadingCurve(force, state)


@dataclass(frozen=True, kw_only=True)
class YieldingSphereLaw(ElasticPairLaw, ElasticPlasticLaw):
    r"""Base of the elastic-plastic laws of a sphere.

    Up to `yield_indentation` the contact is Hertzian. Beyond, it unloads as the Hertzian contact of
    a sphere of larger radius with the same contact radius :math:`a_m`, which is
    :math:`\sqrt{R \delta_m}` unless a law has it otherwise, and force :math:`F_m`, so that

    .. math:: \delta_m - \delta_r = \frac{3 F_m}{4 E^* a_m}

    (Thornton 1997, J. Appl. Mech. 64, 383-386). A law takes its `loading_curve` from
    `yielding_sphere`.
    """

    scalar_levels: ClassVar[ScalarLevels | None] = staticmethod(_levels)

    @property
    def yield_indentation(self) -> Array:
        """Indentation at yield [m]."""
        raise NotImplementedError

    @property
    def plastic_coefficients(self) -> tuple[Array, ...]:
        """The coefficients of loading beyond yield."""
        raise NotImplementedError

    @property
    def stiffness(self) -> Array:
        """Hertz's stiffness [N/m^1.5]."""
        return hertz_stiffness(self.effective_modulus, self.effective_radius)

    @property
    def loading_coefficients(self) -> tuple[Array, ...]:
        """Yield indentation, Hertz's stiffness, effective modulus and radius, and plastic ones."""
        return (
            self.yield_indentation,
            self.stiffness,
            self.effective_modulus,
            self.effective_radius,
            *self.plastic_coefficients,
        )

    def contact_radius(self, delta: Array) -> Array:
        """Return the contact radius beyond `yield_indentation` [m]."""
        return np.sqrt(self.effective_radius * delta)
