"""Coulomb's friction: sliding without tangential compliance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.friction.law import ImpulsiveFriction


@dataclass(frozen=True, kw_only=True)
class Coulomb(ImpulsiveFriction):
    r"""Coulomb's friction, which acts against the slip until it has ended.

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

    def slip_after(self, slip: Floats, impulse: Floats, whole: Floats, mass: Floats) -> Floats:
        """Return the slip that friction has left; see `ImpulsiveFriction`."""
        return np.asarray(
            slip - np.sign(slip) * np.minimum(np.abs(slip), self.coefficient * impulse / mass)
        )

    def force(self, slip: Floats, normal_force: Floats) -> Floats:
        """Return the force of sliding where it slips [N]."""
        return np.asarray(np.sign(slip) * self.coefficient * normal_force)
