"""What the core computes friction along one direction with, in named tuples.

The annotations name the types of compiled code. Velocities,
displacements and integrals are those of `contact.friction.law`: over kappa, and I.
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Integers, Matrix

NO_FRICTION, IMPULSIVE, ELASTIC = range(3)
"""Kinds of friction laws: none; one that follows the normal impulse; one with the tangential
compliance of the contact.
"""

HERTZ, SPRING, RADIUS, MODULUS, KAPPA = range(5)
"""Coefficients of an elastic one: Hertz's stiffness [N/m^1.5], 2 G* [Pa], effective radius [m], E*
[Pa], kappa.
"""

ELASTIC_COEFFICIENTS = 5


class Rubbing(NamedTuple):
    """The friction law of a batch of drops.

    kind: of those above. addresses (2,): of the functions of an impulsive one. growing, shrinking,
    at_rim, sliding_energy: of an elastic one; see `Friction`. rounding: error of the rate of its
    depth at release, as a part of the largest.
    """

    kind: int
    addresses: Integers
    growing: float
    shrinking: float
    at_rim: bool
    sliding_energy: float
    rounding: float


class NormalState(NamedTuple):
    r"""The normal motion at one end of a step, whose parameter goes from 0 to 1.

    time: since first touch [s]; pace, pace_slope: its derivatives. depth [m], depth_slope. most:
    the integral I of a contact that slides [m^1.5]; swept: its integral over time so far.
    """

    time: float
    pace: float
    pace_slope: float
    depth: float
    depth_slope: float
    most: float
    swept: float


class SlipState(NamedTuple):
    """The motion of a contact along the plate: velocity [m/s], displacement [m] and integral I
    [m^1.5].

    direction: of the slip, 1 or -1; 0 while all of the contact sticks. front: root of the depth at
    which the slip ends, 0 where all of it slides. microslip: energy lost while a part of the
    contact sticks, over mass and the square of kappa [J/kg].
    """

    velocity: float
    displacement: float
    integral: float
    direction: float
    front: float
    microslip: float


class Friction(NamedTuple):
    r"""Law and bodies of one contact.

    growing, shrinking, at_rim, sliding_energy: `stretching`, `slips_at_rim` and `sliding_energy` of
    the law. stiffness: k = 2 G* sqrt(R) over m [1/(m^0.5 s^2)]. pull: acceleration along the
    direction [m/s^2].
    """

    growing: float
    shrinking: float
    at_rim: bool
    sliding_energy: float
    stiffness: float
    pull: float


class Curve(NamedTuple):
    """The turning points of a contact, from its middle to its rim; see `core.turning_points`.

    points (P, 3): depth [m], displacement [m], integral [m^1.5] of each. top (2,): number of the
    point at the rim, and of that below which the slip ends.
    """

    points: Matrix
    top: Integers


class Cubic(NamedTuple):
    """A cubic over a step, by value and slope at its start and at its end."""

    value: float
    slope: float
    end_value: float
    end_slope: float
