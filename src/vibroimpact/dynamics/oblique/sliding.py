"""The sliding of contact points along the plate, during contacts."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.friction.law import CompliantFriction, FrictionLaw, ImpulsiveFriction
from vibroimpact.contact.pair import hertz_stiffness
from vibroimpact.dynamics.oblique.normal_motion import NormalMotion
from vibroimpact.dynamics.oblique.state import Sliding

_ROUNDING = 1e-5
"""Error of the rate of the depth at release, as a part of the largest."""


def slide(
    law: FrictionLaw | None, normal: NormalMotion, slip: Floats, mass: Floats, pull: Floats
) -> Sliding:
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
        return _slide_compliant(law, normal, slip, mass, pull)
    free, none = slip + pull * normal.time, np.zeros_like(slip)
    if not isinstance(law, ImpulsiveFriction):
        return Sliding(
            normal.time,
            free,
            slip * normal.time + 0.5 * pull * normal.time**2,
            np.zeros_like(free),
            none,
        )
    pressed = normal.pressed
    left = law.slip_after(free, pressed, pressed[-1], mass)
    force = law.force(left, normal.force)
    return Sliding(
        normal.time, left, normal.integrals(left, normal.pace * (pull - force / mass)), force, none
    )


def _slide_compliant(
    law: CompliantFriction, normal: NormalMotion, slip: Floats, mass: Floats, pull: Floats
) -> Sliding:
    """Return the sliding of contacts under a law with tangential compliance, each followed by the
    core.

    Parameters
    ----------
    law : CompliantFriction
        The law, of B contacts.
    normal : NormalMotion
        Their normal motion.
    slip : array, shape (B,)
        Slip velocities at first touch [m/s].
    mass : array, shape (B,)
        Effective masses of the tangential motion [kg].
    pull : array, shape (B,)
        Accelerations along the direction [m/s^2].
    """
    # a drop without such friction does not load the compiler
    from vibroimpact.dynamics.core.sliding_paths import slide_contacts

    size = len(slip)
    points = len(normal.steps) + 1
    hertz = hertz_stiffness(law.effective_modulus, law.effective_radius)
    spring = 2.0 * law.effective_shear_modulus * np.sqrt(law.effective_radius)
    contacts = np.empty((size, 6))
    for column, values in enumerate((hertz, spring, law.kappa, slip, mass, pull)):
        contacts[:, column] = values
    paths = np.empty((size, 3, points))
    microslips = np.empty(size)
    growing, shrinking = law.stretching
    of_law = (float(growing), float(shrinking), law.slips_at_rim, law.sliding_energy)
    slide_contacts(*of_law, _ROUNDING, contacts, normal.rows, normal.steps, paths, microslips)
    velocity, displacement, force = paths.transpose(1, 2, 0)
    return Sliding(normal.time, velocity, displacement, force, microslips)
