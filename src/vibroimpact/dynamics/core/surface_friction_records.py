"""What the core computes friction on surfaces that move with, in named tuples.

The annotations name the types of compiled code.
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.dynamics.core.records import (
    Motion,
    Start,
    Surfaces,
)
from vibroimpact.dynamics.core.tangential_history import TangentialHistory

AT_X, AT_Y, ROLLING_X, ROLLING_Y, ABOUT_NORMAL = range(5)
"""Directions of friction: forces along x and y, and moments on the spins about -y, x and
the normal.
"""

WITH_MOMENTS = 5
"""Number of directions where moments act; without them it is 2, and 0 without friction."""

VELOCITY_X, VELOCITY_Y, DISPLACEMENT_X, DISPLACEMENT_Y, FORCE_X, FORCE_Y = range(6)
TURNED_X, TURNED_Y, TURNED_Z, TURNED_WAY_X, TURNED_WAY_Y, WORK, MICROSLIP = range(6, 13)
NUMBERS = 13
"""Numbers of a `SlidingSphere` that are kept of the start and the end of a stretch."""


class SlidingSphere(NamedTuple):
    """Friction of one drop, and the motion of the contact point of its sphere, at an instant.

    directions: how many friction has, see above. rolling_coefficient: of the law. mass: effective
    mass of the motion of the contact point [kg]. radius [m], inertia [kg m^2]: of the sphere. pull
    (2,): acceleration of gravity along x and y [m/s^2].

    velocity [m/s] and displacement since first touch [m] (2,): of the contact point. spin (3,): of
    the sphere about -y, x and z [rad/s]. force (2,): of friction on it, against these [N]. Since
    first touch, what the moments made of the spin, turned [rad/s] (3,), and of the displacement,
    turned_way [m] (2,). normal: force [N]. work: energy that friction took since then, with what
    the contact stores tangentially [J]; microslip: the part of it that was not lost while all of
    the contact slid [J]. history: of the contact.
    """

    directions: int
    rolling_coefficient: float
    mass: float
    radius: float
    inertia: float
    pull: Vector
    velocity: Vector
    displacement: Vector
    spin: Vector
    force: Vector
    turned: Vector
    turned_way: Vector
    normal: float
    work: float
    microslip: float
    history: TangentialHistory


class SlidStretch(NamedTuple):
    """Surfaces that rub, at the start of a stretch: with a contact for the normal force
    and one for each direction of friction.
    """

    surfaces: Surfaces
    start: Start
    sphere: SlidingSphere


class Motions(NamedTuple):
    """Motion of the surfaces through a stretch, as far as contact forces do not make it.

    across: at the contacts. along: with the directions of friction as further contacts; the same as
    across where there is none.
    """

    across: Motion
    along: Motion


class FrictionAtNodes(NamedTuple):
    """Friction through a stretch, in S steps.

    force (F, N): forces [N] and moments [N m] at the nodes in F directions. history: at the end. At
    the start and the ends of the steps: pressed (S + 1,), the normal force [N], on_the_way (S + 1,
    2), friction along x and y [N], and slid (S + 1,), how far all of the contact slid in the step
    before [m]. In each step: moved (S, 2), displacement of the surfaces past each other [m].
    """

    force: Matrix
    history: TangentialHistory
    pressed: Vector
    on_the_way: Matrix
    moved: Matrix
    slid: Vector


class SlidingPart(NamedTuple):
    """What friction does through a stretch.

    At the nodes (F, N): force, as in `FrictionAtNodes`, and slip, the velocity of the contact point
    of the sphere past the surface [m/s] and the spin past it [rad/s]. end: friction at the end.
    surface_work: work of friction on the body below [J]. imbalance: error of the balances of energy
    of the contact point and of the spins [J].
    """

    force: Matrix
    slip: Matrix
    end: SlidingSphere
    surface_work: float
    imbalance: float
