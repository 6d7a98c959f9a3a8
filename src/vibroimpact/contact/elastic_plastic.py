"""Loading that leaves a dent, and elastic unloading: what the elastic-plastic laws share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.law import CompliantLaw, memory
from vibroimpact.contact.power_law import power


@dataclass(frozen=True, kw_only=True)
class ElasticPlasticLaw(CompliantLaw):
    r"""Base of the laws with one loading curve and, from each of its points, an elastic unloading curve

    .. math:: F = F_m \left(\frac{\delta - \delta_r}{\delta_m - \delta_r}\right)^q

    from the deepest point :math:`(\delta_m, F_m)` to the residual indentation :math:`\delta_r`, on which it also
    loads again. A law gives the loading curve, its work, and the residual indentation.
    """

    contact_end = "zero-force"
    tension = "none"
    lasting = True
    unloading_exponent: ClassVar[float] = 1.5
    """The power q: 1.5 where the unloading contact is Hertz's."""

    loaded_to: Array = memory("deepest indentation so far", "m")

    def loading_force(self, delta: Array) -> Array:
        """Return the force of the first loading [N]."""
        raise NotImplementedError

    def loading_work(self, delta: Array) -> Array:
        """Return the integral of the force of the first loading from zero [J]."""
        raise NotImplementedError

    def elastic_part(self, deepest: Array) -> Array:
        """Return how far the contact springs back from an indentation: deepest less residual [m]."""
        raise NotImplementedError

    @property
    def touch_level(self) -> Array:
        """The depth of the dent [m], where the surfaces meet and part."""
        return self.loaded_to - self.elastic_part(self.loaded_to)

    @property
    def breakpoints(self) -> tuple[Array, ...]:
        """The deepest indentation so far, beyond which the contact loads anew."""
        return (self.loaded_to,)

    def forces(self, delta: Array, delta_dot: Array, approach_speed: Array) -> tuple[Array, Array]:
        """Return the static force, and zero [N]."""
        with np.errstate(divide="ignore", invalid="ignore"):
            risen = np.maximum(delta - self.touch_level, 0.0) / self.elastic_part(self.loaded_to)
            unloading = self.loading_force(self.loaded_to) * power(risen, self.unloading_exponent)
        force = np.where(delta < self.loaded_to, unloading, self.loading_force(np.maximum(delta, self.loaded_to)))
        return force, np.zeros_like(force)

    def elastic_energy(self, delta: Array) -> Array:
        """Return the work that unloading gives back [J]."""
        deepest = np.maximum(delta, self.loaded_to)
        with np.errstate(divide="ignore", invalid="ignore"):
            part = self.elastic_part(deepest)
            risen = np.maximum(delta - (deepest - part), 0.0) / part
            return np.where(part > 0.0, self._recoverable(deepest) * risen ** (self.unloading_exponent + 1.0), 0.0)

    def plastic_work(self, delta: Array) -> Array:
        """Return the work spent on making the dent deeper [J]."""
        deepest = np.maximum(delta, self.loaded_to)
        return self._spent(deepest) - self._spent(self.loaded_to)

    def after_compression(self, deepest: Array) -> Self:
        """Return the law with the new deepest indentation."""
        return self.changed({"loaded_to": np.maximum(self.loaded_to, deepest)})

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        """Return the root of what unloading gives back over what was put in, from the balance of energy."""
        energy = np.asarray(0.5 * mass * speed * speed, dtype=float)
        wanted = energy + self.loading_work(self.loaded_to) - self._recoverable(self.loaded_to)
        deepest = np.full(np.shape(wanted), 1e-6)
        for _ in range(60):  # Newton's method in the logarithms: both curves are nearly powers
            work = self.loading_work(deepest)
            step = np.log(wanted / work) * work / (deepest * self.loading_force(deepest))
            deepest = deepest * np.exp(step)
            if np.all(np.abs(step) < 1e-9):  # and the next would be below rounding
                break
        return np.where(deepest > self.loaded_to, np.sqrt(np.minimum(self._recoverable(deepest) / energy, 1.0)), 1.0)[()]

    def _recoverable(self, deepest: Array) -> Array:
        return self.loading_force(deepest) * self.elastic_part(deepest) / (self.unloading_exponent + 1.0)

    def _spent(self, deepest: Array) -> Array:
        return self.loading_work(deepest) - self._recoverable(deepest)
