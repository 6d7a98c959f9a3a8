"""Elastic-plastic contact: plastic loading, elastic unloading, residual indentation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.choice import where
from vibroimpact.contact.law import (
    CompliantLaw,
    Levels,
    ScalarCompressed,
    ScalarEnergies,
    ScalarForces,
    ScalarLevels,
)
from vibroimpact.contact.parameters import memory
from vibroimpact.contact.power_law import power

OfIndentation = Callable[[Array, Any], Array]
"""A function of indentation and coefficients, marked by `compiled.scalar`."""

LoadingState = Callable[[Array, Any], tuple[Array, Array, Array]]
"""Such a function, which returns three quantities."""


class LoadingCurve(NamedTuple):
    """The curve of loading: functions of an indentation on it [m] and the law's coefficients.

    Attributes
    ----------
    force : callable
        Loading force [N].
    state : callable
        This force, its integral from zero indentation [J], and the elastic recovery on unloading
        from there [m]. They are computed together since compiling takes a twentieth of a second
        for each function.
    """

    force: OfIndentation
    state: LoadingState


class LawFunctions(NamedTuple):
    """The functions of floats of a law that follow from its loading curve."""

    forces: ScalarForces
    energies: ScalarEnergies
    compressed: ScalarCompressed


@scalar
def _levels(coefficients: Any) -> Levels:
    loaded_to = coefficients[0]
    touch_level = coefficients[1]
    return touch_level, touch_level, loaded_to, loaded_to, np.inf


def law_functions(curve: LoadingCurve) -> LawFunctions:
    """Return the functions of floats of an elastic-plastic law.

    Its coefficients are largest indentation so far, touch level, elastic recovery, largest force,
    exponent of unloading, and plastic loss so far; those of the loading curve follow. The recovery
    is one where nothing has been loaded, and the largest force zero, so that no force is 0/0.
    """
    loading_force, loading_state = curve

    @scalar
    def forces(
        delta: Array, delta_dot: Array, approach_speed: Array, coefficients: Any
    ) -> tuple[Array, Array]:
        loaded_to = coefficients[0]
        touch_level = coefficients[1]
        recovery = coefficients[2]
        largest_force = coefficients[3]
        exponent = coefficients[4]
        loading = loading_force(np.maximum(delta, loaded_to), coefficients)
        unloading = largest_force * power(np.maximum(delta - touch_level, 0.0) / recovery, exponent)
        force = where(delta < loaded_to, unloading, loading)
        return force, 0.0 * force

    @scalar
    def energies(delta: Array, coefficients: Any) -> tuple[Array, Array]:
        loaded_to = coefficients[0]
        exponent = coefficients[4]
        plastic_loss = coefficients[5]
        deepest = np.maximum(delta, loaded_to)
        force, work, recovery = loading_state(deepest, coefficients)
        # the integral of the unloading curve, a power of the exponent q: F_m times the recovery
        # over q + 1 in full, and of its fraction (delta - delta_r)/recovery that power
        full_elastic_energy = force * recovery / (exponent + 1.0)
        fraction = np.maximum(delta - (deepest - recovery), 0.0) / where(
            recovery > 0.0, recovery, 1.0
        )
        elastic_energy = full_elastic_energy * power(fraction, exponent + 1.0)
        # static work is stored or plastic; below the largest indentation nothing yields
        plastic_work = work - full_elastic_energy - plastic_loss
        return elastic_energy, where(delta > loaded_to, plastic_work, 0.0)

    @scalar
    def compressed(deepest: Array, coefficients: Any, changed: Any) -> Array:
        loaded_to = np.maximum(coefficients[0], deepest)
        force, work, recovery = loading_state(loaded_to, coefficients)
        changed[0] = loaded_to
        changed[1] = loaded_to - recovery
        changed[2] = where(recovery > 0.0, recovery, 1.0)
        changed[3] = force
        changed[5] = work - force * recovery / (coefficients[4] + 1.0)
        return loaded_to

    return LawFunctions(forces, energies, compressed)


@dataclass(frozen=True, kw_only=True)
class ElasticPlasticLaw(CompliantLaw):
    r"""Base of the laws with a loading curve and elastic unloading from each of its points.

    The unloading curve is

    .. math:: F = F_m \left(\frac{\delta - \delta_r}{\delta_m - \delta_r}\right)^q

    from the largest indentation :math:`(\delta_m, F_m)` to the residual indentation
    :math:`\delta_r`. Reloading follows the same curve. A law defines its `loading_curve`, from
    which its functions of floats follow, and the `loading_coefficients` of this.
    """

    contact_end = "zero-force"
    tension = "none"
    lasting = True
    unloading_exponent: ClassVar[float] = 1.5
    """The exponent q of unloading, 1.5 for a Hertzian contact."""

    yields = True
    scalar_levels: ClassVar[ScalarLevels | None] = staticmethod(_levels)
    loading_curve: ClassVar[LoadingCurve]
    """The curve of loading, as functions of floats; its coefficients begin with index 6."""

    _functions: ClassVar[LawFunctions]

    loaded_to: Array = memory("deepest indentation so far", "m")

    def __init_subclass__(cls, **options: Any) -> None:
        if "loading_curve" in vars(cls):
            cls._functions = law_functions(cls.loading_curve)
            cls.scalar_forces = staticmethod(cls._functions.forces)
            cls.scalar_energies = staticmethod(cls._functions.energies)
            cls.scalar_compressed = staticmethod(cls._functions.compressed)
        super().__init_subclass__(**options)

    @property
    def loading_coefficients(self) -> tuple[Array, ...]:
        """The coefficients of the loading curve."""
        raise NotImplementedError

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """Those of a dented contact, which `law_functions` lists, and of the loading curve."""
        coefficients = list(self._undented)
        self._functions.compressed(self.loaded_to, self._undented, coefficients)
        return tuple(coefficients)

    def loading_force(self, delta: Array) -> Array:
        """Return the force on the loading curve [N]."""
        return self.loading_curve.force(delta, self._undented)

    def loading_work(self, delta: Array) -> Array:
        """Return the integral of the loading force from zero indentation [J]."""
        return self.loading_curve.state(delta, self._undented)[1]

    def elastic_recovery(self, deepest: Array) -> Array:
        """Return the elastic recovery on unloading: largest less residual indentation [m]."""
        return self.loading_curve.state(deepest, self._undented)[2]

    def after_compression(self, deepest: Array) -> Self:
        """Return the law with the new largest indentation."""
        return self.changed({"loaded_to": np.maximum(self.loaded_to, deepest)})

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        """Return the square root of the energy recovered over the kinetic energy."""
        kinetic_energy = np.asarray(0.5 * mass * speed * speed, dtype=float)
        # the loading work at the turn: kinetic energy, and the plastic loss of the dent so far
        work_at_turn = (
            kinetic_energy
            + self.loading_work(self.loaded_to)
            - self._unloading_work(self.loaded_to)
        )
        deepest = np.full(np.shape(work_at_turn), 1e-6)
        # Newton's method in logarithms, since the loading work is nearly a power of the indentation
        for _ in range(60):
            work = self.loading_work(deepest)
            step = np.log(work_at_turn / work) * work / (deepest * self.loading_force(deepest))
            deepest = deepest * np.exp(step)
            # convergence is quadratic: the next step would be below rounding
            if np.all(np.abs(step) < 1e-9):
                break
        recovered_share = np.minimum(self._unloading_work(deepest) / kinetic_energy, 1.0)
        # an impact that does not deepen the dent is elastic
        return np.where(deepest > self.loaded_to, np.sqrt(recovered_share), 1.0)[()]

    @cached_property
    def _undented(self) -> tuple[Array, ...]:
        """The coefficients of a fresh contact, which the loading curve takes."""
        return 0.0, 0.0, 1.0, 0.0, self.unloading_exponent, 0.0, *self.loading_coefficients

    def _unloading_work(self, deepest: Array) -> Array:
        """Return the energy recovered on unloading from an indentation on the loading curve [J]."""
        force, _, recovery = self.loading_curve.state(deepest, self._undented)
        return force * recovery / (self.unloading_exponent + 1.0)
