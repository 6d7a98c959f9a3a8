"""A sphere that moves along the plate and spins, in named tuples and rows of arrays.

The annotations name the types of compiled code, in `vibroimpact.compiler.types`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from vibroimpact.arrays import Floats
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.records import Real
from vibroimpact.dynamics.core.twisting import Twisting


class RubbedSphere(NamedTuple):
    """A sphere and the law of its friction.

    mass [kg], radius [m], inertia [kg m^2]. gravity_x, gravity_y: along the plate [m/s^2].
    coefficient, rolling_coefficient: of friction. contact_radius: see `Twisting`.
    """

    mass: Real
    radius: Real
    inertia: Real
    gravity_x: Real
    gravity_y: Real
    coefficient: Real
    rolling_coefficient: Real
    contact_radius: Real


class SphereState(NamedTuple):
    """Place of the centre over the plate [m], its velocity [m/s], and the spin [rad/s]."""

    x: Real
    y: Real
    velocity_x: Real
    velocity_y: Real
    spin_x: Real
    spin_y: Real
    spin_z: Real


@compiled(lambda t: t.of(RubbedSphere)(t.matrix, t.integer))
def sphere_at(spheres: Floats, number: int) -> RubbedSphere:
    """Return the sphere in a row of an array."""
    row = spheres[number]
    return RubbedSphere(row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7])


@compiled(lambda t: t.of(SphereState)(t.matrix, t.integer))
def state_at(states: Floats, number: int) -> SphereState:
    """Return the state in a row of an array."""
    row = states[number]
    return SphereState(row[0], row[1], row[2], row[3], row[4], row[5], row[6])


@compiled(lambda t: t.void(t.matrix, t.integer, t.of(SphereState)))
def write_state(states: Floats, number: int, state: SphereState) -> None:
    """Write a state into a row of an array."""
    for column in range(len(state)):
        states[number, column] = state[column]


@compiled(lambda t: t.real(t.of(RubbedSphere)))
def tangential_mass(sphere: RubbedSphere) -> float:
    """Return the effective mass of the motion of the contact point [kg]: 2/7 of that of a solid
    sphere.
    """
    return 1.0 / (1.0 / sphere.mass + sphere.radius * sphere.radius / sphere.inertia)


@compiled(lambda t: t.pair(t.of(RubbedSphere), t.of(SphereState)))
def turning_of(sphere: RubbedSphere, state: SphereState) -> tuple[float, float]:
    """Return the part of the spin in the velocity of the contact point along the plate [m/s]."""
    return -sphere.radius * state.spin_y, sphere.radius * state.spin_x


@compiled(lambda t: t.real(t.real, t.real))
def length_of(x: float, y: float) -> float:
    """Return the length of a vector, alike to the last bit in compiled code and in Python."""
    return math.sqrt(x * x + y * y)


@compiled(lambda t: t.of(Twisting)(t.of(RubbedSphere)))
def twisting_of(sphere: RubbedSphere) -> Twisting:
    """Return what resists the twisting of the contact of a sphere."""
    return Twisting(sphere.coefficient, sphere.contact_radius)
