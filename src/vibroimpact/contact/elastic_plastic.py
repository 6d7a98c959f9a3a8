"""Elastic-plastic contact: plastic loading, elastic unloading, residual indentation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.choice import where
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.parameters import memory
from vibroimpact.contact.power_law import power


@scalar
def static_force(delta: Array, loading: Array, coefficients: Any) -> Array:
    """Return the force of unloading below the largest indentation so far, and that of loading beyond it [N].

    Parameters
    ----------
    delta : float or array
        Indentation [m].
    loading : float or array
        Force on the loading curve [N] at the indentation, or at the largest so far where that is larger.
    coefficients : array or tuple
        The first five coefficients of an elastic-plastic law.
    """
    loaded_to, touch_level = coefficients[0], coefficients[1]
    recovery, largest_force, exponent = coefficients[2], coefficients[3], coefficients[4]
    unloading = largest_force * power(np.maximum(delta - touch_level, 0.0) / recovery, exponent)
    return where(delta < loaded_to, unloading, loading)


@dataclass(frozen=True, kw_only=True)
class ElasticPlasticLaw(CompliantLaw):
    r"""Base of the laws with a loading curve and, from each of its points, the elastic unloading curve

    .. math:: F = F_m \left(\frac{\delta - \delta_r}{\delta_m - \delta_r}\right)^q

    from the largest indentation :math:`(\delta_m, F_m)` to the residual indentation :math:`\delta_r`; reloading follows the same
    curve. A law defines the loading force, its work, and the elastic recovery :math:`\delta_m - \delta_r`; its `scalar_forces` take
    the loading force and `static_force`.
    """

    contact_end = "zero-force"
    tension = "none"
    lasting = True
    unloading_exponent: ClassVar[float] = 1.5
    """The exponent q of unloading, 1.5 for a Hertzian contact."""

    loaded_to: Array = memory("deepest indentation so far", "m")

    def loading_force(self, delta: Array) -> Array:
        """Return the force on the loading curve [N]."""
        raise NotImplementedError

    def loading_work(self, delta: Array) -> Array:
        """Return the integral of the loading force from zero indentation [J]."""
        raise NotImplementedError

    def elastic_recovery(self, deepest: Array) -> Array:
        """Return the elastic recovery on unloading: largest less residual indentation [m]."""
        raise NotImplementedError

    @property
    def touch_level(self) -> Array:
        """The residual indentation [m], at which contact begins and ends."""
        return self.loaded_to - self._unloading[0]

    @property
    def breakpoints(self) -> tuple[Array, ...]:
        """The largest indentation so far, beyond which the loading curve is followed."""
        return (self.loaded_to,)

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """Largest indentation so far, touch level, elastic recovery, largest force and exponent of unloading; a law adds its own.

        The recovery is one where nothing has been loaded, and the largest force zero, so that no force is 0/0.
        """
        recovery, largest_force = self._unloading
        return self.loaded_to, self.touch_level, np.where(recovery > 0.0, recovery, 1.0), largest_force, self.unloading_exponent

    def elastic_energy(self, delta: Array) -> Array:
        """Return the energy recovered on unloading [J]."""
        deepest = np.maximum(delta, self.loaded_to)
        with np.errstate(divide="ignore", invalid="ignore"):
            part = self.elastic_recovery(deepest)
            recovery_left = np.maximum(delta - (deepest - part), 0.0) / part
            return np.where(part > 0.0, self._unloading_work(deepest) * recovery_left ** (self.unloading_exponent + 1.0), 0.0)

    def plastic_work(self, delta: Array) -> Array:
        """Return the plastic work of loading beyond the largest indentation so far [J]."""
        deepest = np.maximum(delta, self.loaded_to)
        return self._plastic_loss(deepest) - self._plastic_loss(self.loaded_to)

    def after_compression(self, deepest: Array) -> Self:
        """Return the law with the new largest indentation."""
        return self.changed({"loaded_to": np.maximum(self.loaded_to, deepest)})

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        """Return the square root of the energy recovered over the kinetic energy, from the energy balance."""
        energy = np.asarray(0.5 * mass * speed * speed, dtype=float)
        wanted = energy + self.loading_work(self.loaded_to) - self._unloading_work(self.loaded_to)
        deepest = np.full(np.shape(wanted), 1e-6)
        for _ in range(60):  # Newton's method in logarithms, since the loading work is nearly a power of the indentation
            work = self.loading_work(deepest)
            step = np.log(wanted / work) * work / (deepest * self.loading_force(deepest))
            deepest = deepest * np.exp(step)
            if np.all(np.abs(step) < 1e-9):  # convergence is quadratic: the next step would be below rounding
                break
        return np.where(deepest > self.loaded_to, np.sqrt(np.minimum(self._unloading_work(deepest) / energy, 1.0)), 1.0)[()]

    @cached_property
    def _unloading(self) -> tuple[Array, Array]:
        """The elastic recovery [m] and the force [N] at the largest indentation so far."""
        return self.elastic_recovery(self.loaded_to), self.loading_force(self.loaded_to)

    def _unloading_work(self, deepest: Array) -> Array:
        return self.loading_force(deepest) * self.elastic_recovery(deepest) / (self.unloading_exponent + 1.0)

    def _plastic_loss(self, deepest: Array) -> Array:
        return self.loading_work(deepest) - self._unloading_work(deepest)
