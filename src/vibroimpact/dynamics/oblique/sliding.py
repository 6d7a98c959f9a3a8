"""The sliding of contact points along the plate, during contacts."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.friction.law import CompliantFriction, FrictionLaw, ImpulsiveFriction
from vibroimpact.dynamics.oblique.compliant import slide_compliant
from vibroimpact.dynamics.oblique.normal_motion import NormalMotion
from vibroimpact.dynamics.oblique.state import Sliding


def slide(law: FrictionLaw | None, normal: NormalMotion, slip: Floats, mass: Floats, pull: Floats) -> Sliding:
    """Return the sliding of contacts.

    Parameters
    ----------
    law : FrictionLaw or None
        The friction law; None if there is no friction.
    normal : NormalMotion
        Normal motion of the contacts.
    slip : array, shape (B,)
        Slip velocities at first touch [m/s], >= 0.
    mass : array, shape (B,)
        Effective masses of the tangential motion [kg].
    pull : array, shape (B,)
        Accelerations along the direction [m/s^2].
    """
    if isinstance(law, CompliantFriction):
        return Sliding(normal.time, *slide_compliant(law, normal, slip, mass, pull))
    free, none = slip + pull * normal.time, np.zeros_like(slip)
    if not isinstance(law, ImpulsiveFriction):
        return Sliding(normal.time, free, slip * normal.time + 0.5 * pull * normal.time**2, np.zeros_like(free), none)
    pressed = normal.pressed
    left = law.slip_after(free, pressed, pressed[-1], mass)
    force = law.force(left, normal.force)
    return Sliding(normal.time, left, normal.integrals(left, normal.pace * (pull - force / mass)), force, none)
