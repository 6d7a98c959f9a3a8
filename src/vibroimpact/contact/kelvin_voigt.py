"""The linear spring with a dashpot beside it, which two laws share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.damping_ratio import restitution_of
from vibroimpact.contact.law import CompliantLaw, parameter


@dataclass(frozen=True, kw_only=True)
class KelvinVoigtLaw(CompliantLaw):
    r"""Base of the laws :math:`F = k \delta + c \dot\delta`, in contact until there is no overlap."""

    contact_end = "zero-indentation"
    tension = "kept"

    stiffness: Array = parameter("spring stiffness k", "N/m", example=2e6, above=0)

    @property
    def dashpot(self) -> Array:
        """The dashpot c [N s/m]."""
        raise NotImplementedError

    def forces(self, delta: Array, delta_dot: Array, approach_speed: Array) -> tuple[Array, Array]:
        """Return the elastic and the dissipative force [N]."""
        return self.stiffness * delta, self.dashpot * delta_dot

    def elastic_energy(self, delta: Array) -> Array:
        r"""Return :math:`k \delta^2/2` [J]."""
        return 0.5 * self.stiffness * delta * delta

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        r"""Return :math:`\exp(-\pi\beta/\sqrt{1 - \beta^2})` with :math:`\beta = c/(2\sqrt{k m})`, at any speed."""
        return restitution_of(self.dashpot / (2.0 * np.sqrt(self.stiffness * mass)) + 0.0 * speed)
