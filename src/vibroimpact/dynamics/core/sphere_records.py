"""A sphere that moves along the plate and spins, in named tuples and rows of arrays.

The annotations name the types of compiled code.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from vibroimpact.arrays import Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.twisting import Twisting


class RubbedSphere(NamedTuple):
    """A sphere and the law of its friction.

    mass [kg], radius [m], inertia [kg m^2]. gravity_x, gravity_y: along the plate [m/s^2].
    coefficient, rolling_coefficient: of friction. contact_radius: see `Twisting`.
    """

    mass: float
    radius: float
    inertia: float
    gravity_x: float
    gravity_y: float
    coefficient: float
    rolling_coefficient: float
    contact_radius: float


class SphereState(NamedTuple):
    """Place of the centre over the plate [m], its velocity [m/s], and the spin [rad/s]."""

    x: float
    y: float
    velocity_x: float
    velocity_y: float
    spin_x: float
    spin_y: float
    spin_z: float


@compiled
def sphere_of(row: Vector) -> RubbedSphere:
    """Return the sphere in a row of an array."""
    return RubbedSphere(row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7])


@compiled
def state_of(row: Vector) -> SphereState:
    """Return the state in a row of an array."""
    return SphereState(row[0], row[1], row[2], row[3], row[4], row[5], row[6])


@compiled
def write_state(row: Vector, state: SphereState) -> None:
    """Write a state into a row of an array."""
    for column in range(len(state)):
        row[column] = state[column]


@compiled
def tangential_mass(sphere: RubbedSphere) -> float:
    """Return the effective mass of the motion of the contact point [kg]: 2/7 of that of a solid
    sphere.
    """
    return 1.0 / (1.0 / sphere.mass + sphere.radius * sphere.radius / sphere.inertia)


@compiled
def turning_of(sphere: RubbedSphere, state: SphereState) -> tuple[float, float]:
    """Return the part of the spin in the velocity of the contact point along the plate [m/s]."""
    return -sphere.radius * state.spin_y, sphere.radius * state.spin_x


@compiled
def length_of(x: float, y: float) -> float:
    """Return the length of a vector, alike to the last bit in compiled code and in Python."""
    return math.sqrt(x * x + y * y)


@compiled
def flown(sphere: RubbedSphere, state: SphereState, elapsed: float) -> SphereState:
    """Return the state after a time without contact [s]."""
    return SphereState(
        state.x + (state.velocity_x + 0.5 * sphere.gravity_x * elapsed) * elapsed,
        state.y + (state.velocity_y + 0.5 * sphere.gravity_y * elapsed) * elapsed,
        state.velocity_x + sphere.gravity_x * elapsed,
        state.velocity_y + sphere.gravity_y * elapsed,
        state.spin_x,
        state.spin_y,
        state.spin_z,
    )


@compiled
def kinetic_of(sphere: RubbedSphere, state: SphereState) -> float:
    """Return the kinetic energy of the motion along the plate and of the rotation [J]."""
    square = state.velocity_x * state.velocity_x + state.velocity_y * state.velocity_y
    turning = state.spin_x * state.spin_x + state.spin_y * state.spin_y
    turning += state.spin_z * state.spin_z
    return 0.5 * sphere.mass * square + 0.5 * sphere.inertia * turning


@compiled
def energy_taken(sphere: RubbedSphere, before: SphereState, after: SphereState) -> float:
    """Return the energy that friction takes between two states [J]."""
    pulled = sphere.gravity_x * (after.x - before.x) + sphere.gravity_y * (after.y - before.y)
    return kinetic_of(sphere, before) + sphere.mass * pulled - kinetic_of(sphere, after)


@compiled
def twisting_of(sphere: RubbedSphere) -> Twisting:
    """Return what resists the twisting of the contact of a sphere."""
    return Twisting(sphere.coefficient, sphere.contact_radius)
