"""The Kelvin-Voigt model, and the restitution of its damping ratio.

A linear spring and a dashpot act in parallel.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.law import CompliantLaw, ScalarEnergies, ScalarForces
from vibroimpact.contact.parameters import parameter
from vibroimpact.contact.power_law import spring_energies


@scalar
def _forces(
    delta: Array, delta_dot: Array, approach_speed: Array, coefficients: Any
) -> tuple[Array, Array]:
    stiffness = coefficients[0]
    dashpot = coefficients[1]
    return stiffness * delta, dashpot * delta_dot


@dataclass(frozen=True, kw_only=True)
class KelvinVoigtLaw(CompliantLaw):
    r"""Base of the laws :math:`F = k \delta + c \dot\delta`.

    Their contact ends at zero indentation.
    """

    contact_end = "zero-indentation"
    tension = "kept"
    scalar_forces: ClassVar[ScalarForces | None] = staticmethod(_forces)
    scalar_energies: ClassVar[ScalarEnergies | None] = staticmethod(spring_energies)

    stiffness: Array = parameter(
        "spring stiffness k", "N/m", detail="Spring stiffness :math:`k`.", example=2e6, above=0
    )

    @property
    def dashpot(self) -> Array:
        """The dashpot constant c [N s/m]."""
        raise NotImplementedError

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """Stiffness and dashpot constant."""
        return self.stiffness, self.dashpot

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        r"""Return :math:`\exp(-\pi\beta/\sqrt{1 - \beta^2})`, independent of the speed.

        The damping ratio is :math:`\beta = c/(2\sqrt{k m})`.
        """
        return restitution_from_damping_ratio(
            self.dashpot / (2.0 * np.sqrt(self.stiffness * mass)) + 0.0 * speed
        )


def dashpot_for_restitution(restitution: Array, stiffness: Array, mass: Array) -> Array:
    r"""Return the dashpot constant that gives a mass [kg] a restitution [N s/m].

    It is :math:`c = 2 \beta(e) \sqrt{k m}`.

    Examples
    --------
    >>> round(float(dashpot_for_restitution(0.5, stiffness=100.0, mass=1.0)), 4)
    4.3091
    """
    return 2.0 * damping_ratio_from_restitution(restitution) * np.sqrt(stiffness * mass)


def damping_ratio_from_restitution(restitution: Array) -> Array:
    r"""Return the damping ratio :math:`\beta = -\ln e/\sqrt{\pi^2 + \ln^2 e}` [-] of a restitution.

    The contact ends at zero indentation, after half a period of the damped oscillation.

    Examples
    --------
    >>> round(float(damping_ratio_from_restitution(0.5)), 6)
    0.215454
    """
    log = np.log(np.asarray(restitution, dtype=float))
    return -log / np.sqrt(np.pi**2 + log * log)


def restitution_from_damping_ratio(damping_ratio: Array) -> Array:
    r"""Return the restitution of a damping ratio [-].

    It is :math:`e = \exp(-\pi\beta/\sqrt{1 - \beta^2})`; zero at and above critical damping.

    Examples
    --------
    >>> round(float(restitution_from_damping_ratio(0.215453)), 5)
    0.5
    """
    ratio = np.asarray(damping_ratio, dtype=float)
    under = np.minimum(ratio, 1.0)
    with np.errstate(divide="ignore"):
        return np.exp(-np.pi * under / np.sqrt((1.0 - under) * (1.0 + under)))[()]
