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


@compiled(lambda t: t.of(RubbedSphere)(t.vector))
def sphere_of(row: Floats) -> RubbedSphere:
    """Return the sphere in a row of an array."""
    return RubbedSphere(row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7])


@compiled(lambda t: t.of(SphereState)(t.vector))
def state_of(row: Floats) -> SphereState:
    """Return the state in a row of an array."""
    return SphereState(row[0], row[1], row[2], row[3], row[4], row[5], row[6])


@compiled(lambda t: t.void(t.vector, t.of(SphereState)))
def write_state(row: Floats, state: SphereState) -> None:
    """Write a state into a row of an array."""
    for column in range(len(state)):
        row[column] = state[column]


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


@compiled(lambda t: t.of(SphereState)(t.of(RubbedSphere), t.of(SphereState), t.real))
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


@compiled(lambda t: t.real(t.of(RubbedSphere), t.of(SphereState)))
def kinetic_of(sphere: RubbedSphere, state: SphereState) -> float:
    """Return the kinetic energy of the motion along the plate and of the rotation [J]."""
    square = state.velocity_x * state.velocity_x + state.velocity_y * state.velocity_y
    turning = state.spin_x * state.spin_x + state.spin_y * state.spin_y
    turning += state.spin_z * state.spin_z
    return 0.5 * sphere.mass * square + 0.5 * sphere.inertia * turning


@compiled(lambda t: t.real(t.of(RubbedSphere), t.of(SphereState), t.of(SphereState)))
def energy_taken(sphere: RubbedSphere, before: SphereState, after: SphereState) -> float:
    """Return the energy that friction takes between two states [J]."""
    pulled = sphere.gravity_x * (after.x - before.x) + sphere.gravity_y * (after.y - before.y)
    return kinetic_of(sphere, before) + sphere.mass * pulled - kinetic_of(sphere, after)


@compiled(lambda t: t.of(Twisting)(t.of(RubbedSphere)))
def twisting_of(sphere: RubbedSphere) -> Twisting:
    """Return what resists the twisting of the contact of a sphere."""
    return Twisting(sphere.coefficient, sphere.contact_radius)
