"""Walton's impulse: a restitution of the slip, bounded by sliding."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.choice import where
from vibroimpact.contact.friction.law import ImpulsiveFriction, SlipAfter
from vibroimpact.contact.parameters import parameter


@scalar
def _slip_after(slip: Array, impulse: Array, whole: Array, mass: Array, coefficients: Any) -> Array:
    """Return the slip of first touch, and after the whole impulse what friction has made of it; see
    `ImpulsiveFriction.slip_after`.
    """
    coefficient = coefficients[0]
    slip_restitution = coefficients[1]
    change = np.minimum((1.0 + slip_restitution) * np.abs(slip), coefficient * whole / mass)
    return where(impulse >= whole, slip - np.sign(slip) * change, slip)


@dataclass(frozen=True, kw_only=True)
class Rigid(ImpulsiveFriction):
    r"""Tangential restitution where it sticks, Coulomb's sliding friction otherwise (Walton 1993).

    The slip is reversed by the coefficient where the friction suffices; elsewhere the contact
    slides.

    .. math::
        v_s' = -\beta_0 v_s \quad\text{or, if that takes more than}\ \mu J,\quad v_s' = v_s - \mu J
        / m_t

    with J the normal impulse and :math:`m_t` the effective mass of the tangential motion.

    Notes
    -----
    The impulse acts as a whole when the contact ends: the law says nothing of the force.

    References
    ----------
    Walton, O. R. (1993). Numerical simulation of inelastic, frictional particle-particle
    interactions. In: Particulate Two-Phase Flow, ed. M. C. Roco, Butterworth-Heinemann, 884-911.

    Examples
    --------
    >>> law, one = Rigid(coefficient=0.5, slip_restitution=0.4), np.ones(1)
    >>> law.slip_after(one, np.array([[1.0], [4.0]]), 4 * one, one).round(12).tolist()
    [[1.0], [-0.4]]
    """

    slip_restitution: Array = parameter(
        "restitution of the slip, beta0",
        detail=r"Restitution of the slip :math:`\beta_0`.",
        default=0.0,
        at_least=-1,
        at_most=1,
    )

    name = "rigid"
    equation = "v_s' = -beta0 v_s, or v_s - sgn(v_s) mu J / m_t if it slips"
    source = "Walton 1993, in Particulate Two-Phase Flow, p. 884"

    scalar_slip_after: ClassVar[SlipAfter | None] = staticmethod(_slip_after)

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """The coefficient of friction and the restitution of the slip."""
        return self.coefficient, self.slip_restitution
