"""Coulomb's friction: sliding without tangential compliance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.friction.law import ImpulsiveFriction, SlidingForce, SlipAfter


@scalar
def _slip_after(slip: Array, impulse: Array, whole: Array, mass: Array, coefficients: Any) -> Array:
    """Return the slip that friction has left; see `ImpulsiveFriction.slip_after`."""
    taken = coefficients[0] * impulse / mass
    return slip - np.sign(slip) * np.minimum(np.abs(slip), taken)


@scalar
def _friction(slip: Array, normal_force: Array, coefficients: Any) -> Array:
    """Return the force of sliding where it slips [N]."""
    return np.sign(slip) * coefficients[0] * normal_force


@dataclass(frozen=True, kw_only=True)
class Coulomb(ImpulsiveFriction):
    r"""Coulomb's sliding friction, without tangential compliance.

    .. math:: Q = \mu F

    while the contact point slips; then it rolls, without a force.

    Notes
    -----
    The friction does not reverse the slip: nothing stores energy. A solid sphere that falls without
    spin on a plate that does not move is left with 5/7 of its tangential velocity if the slip ends.

    References
    ----------
    Johnson, K. L. (1985). Contact Mechanics. Cambridge University Press, section 11.6.

    Examples
    --------
    >>> law, one = Coulomb(coefficient=0.5), np.ones(1)
    >>> law.slip_after(one, np.array([[1.0], [4.0]]), 4 * one, 2 * one).tolist()
    [[0.75], [0.0]]
    """

    name = "coulomb"
    equation = "Q = mu F while it slips"
    source = "Johnson 1985, Contact Mechanics, section 11.6"

    scalar_slip_after: ClassVar[SlipAfter | None] = staticmethod(_slip_after)
    scalar_friction: ClassVar[SlidingForce | None] = staticmethod(_friction)

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """The coefficient of friction."""
        return (self.coefficient,)
