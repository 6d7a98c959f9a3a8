"""Spheres that lie on the plate, as Python asks for them: where each is at some times, and whether
it has left the plate by then.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Cube, Matrix, Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.dormand_prince import STAGES
from vibroimpact.dynamics.core.lying_sphere import (
    BEGIN,
    IS_EVENT,
    LyingSphere,
    edge_time,
    follow,
    goes_along_line,
    lying_sphere,
    part_at,
    start_of,
    write_within,
)
from vibroimpact.dynamics.core.sphere_records import (
    RubbedSphere,
    SphereState,
    length_of,
    sphere_of,
    state_of,
    tangential_mass,
    twisting_of,
    write_state,
)
from vibroimpact.dynamics.core.twisting import full_moment, moment_share, slowed_spin

_STEPS = 256
"""Of the spin about the normal, from each event to the next."""

TIME, LEFT, RATE = range(3)
"""Columns of the spin about the normal: time [s], its size then [rad/s], and how fast it falls from
there on [rad/s^2].
"""


@compiled
def write_at(
    lying: LyingSphere, motion: Matrix, time: float, stages: Matrix, state: Vector
) -> None:
    """Write place, s, w and q (8,) at a time [s]."""
    row = motion[part_at(motion, time)]
    write_within(lying, row, time - row[BEGIN], stages, state)


@compiled
def twisted(
    sphere: RubbedSphere,
    lying: LyingSphere,
    motion: Matrix,
    until: float,
    begun: tuple[float, float],
) -> Matrix:
    """Return the size of the spin about the normal up to a time [s] (K, 3); see `TIME`.

    `begun`: normal force [N], and the spin at the begin [rad/s].
    """
    # in steps from event to event, as the share of the moment is not smooth there
    load, spin = begun
    twisting = twisting_of(sphere)
    slowing = full_moment(twisting, load) / sphere.inertia
    if spin == 0.0 or slowing == 0.0:
        still = np.zeros((1, 3))
        still[0, LEFT] = abs(spin)
        return still
    falling = np.zeros((_STEPS * len(motion) + 1, 3))
    mass = tangential_mass(sphere)
    stages = np.empty((STAGES + 1, 6))
    state = np.empty(8)
    left = abs(spin)
    share = 0.0
    event = 0.0
    point = -1
    for part in range(1, len(motion) + 1):
        is_last = part == len(motion)
        next_event = until if is_last else motion[part, BEGIN]
        if not (is_last or motion[part, IS_EVENT] > 0.0) or next_event == event > 0.0:
            continue
        first_step = 0 if point < 0 else 1  # a span begins where the last one has ended
        for step in range(first_step, _STEPS + 1):
            # close to each other where the slip begins or ends
            share_of_span = 0.5 * (1.0 - math.cos(math.pi * step / _STEPS))
            time = event + (next_event - event) * share_of_span
            if step == _STEPS:
                time = next_event
            write_at(lying, motion, time, stages, state)
            friction = mass * length_of(state[6], state[7])
            slip = length_of(state[2], state[3])
            if point < 0:
                share = moment_share(twisting, load, friction, slip, left)
            else:
                before = falling[point, TIME]
                full = slowing * time - slowing * before
                lost, share = slowed_spin(twisting, left, full, share, load, friction, slip)
                if time > before:
                    falling[point, RATE] = lost / (time - before)
                left = max(left - lost, 0.0)
            point += 1
            falling[point, TIME] = time
            falling[point, LEFT] = left
        event = next_event
    return falling[: point + 1]


@compiled
def spin_left(falling: Matrix, time: float) -> float:
    """Return the size of the spin about the normal at a time [s]."""
    step = part_at(falling, time)
    elapsed = time - falling[step, TIME]
    return float(max(falling[step, LEFT] - falling[step, RATE] * elapsed, 0.0))


@compiled
def lying_state(sphere: RubbedSphere, state: Vector, spin_z: float) -> SphereState:
    """Return the state of a sphere from place, s and w (6,)."""
    return SphereState(
        state[0],
        state[1],
        state[2] - state[4],
        state[3] - state[5],
        state[5] / sphere.radius,
        -state[4] / sphere.radius,
        spin_z,
    )


@compiled
def is_in_closed_form(sphere: RubbedSphere, begun: SphereState, pressing: float) -> bool:
    """Is the motion of a sphere known in closed form, from event to event?

    `pressing`: acceleration of gravity along the normal [m/s^2].
    """
    start = start_of(sphere, begun)
    twists = begun.spin_z != 0.0 and sphere.coefficient * sphere.contact_radius > 0.0
    return goes_along_line(lying_sphere(sphere, pressing, start), start) and not twists


@compiled
def lie_on_plate(
    spheres: Matrix,
    starts: Matrix,
    pressing: Vector,
    half: tuple[float, float],
    times: Matrix,
    states: Cube,
    friction: Cube,
) -> None:
    """Let B spheres lie on the plate, each on its own.

    Parameters
    ----------
    spheres : array, shape (B, 8)
        Of each the members of `RubbedSphere`.
    starts : array, shape (B, 7)
        Their states, of `SphereState`, at the begin.
    pressing : array, shape (B,)
        Accelerations of gravity along the normal [m/s^2].
    half : tuple of two floats
        Half the sides of the plate [m].
    times : array, shape (B, T)
        Times since the begin [s], the last one the largest; then, those of spheres that have left
        the plate before are the time at which they did.
    states : array, shape (B, T, 7)
        Room for the states at these times.
    friction : array, shape (B, T, 2)
        Room for the friction forces on the spheres [N].
    """
    stages = np.empty((STAGES + 1, 6))
    state = np.empty(8)
    for number in range(len(spheres)):
        sphere = sphere_of(spheres[number])
        begun = state_of(starts[number])
        until = times[number, times.shape[1] - 1]
        start = start_of(sphere, begun)
        lying = lying_sphere(sphere, pressing[number], start)
        motion = follow(lying, start, until)
        load = sphere.mass * pressing[number]
        falling = twisted(sphere, lying, motion, until, (load, begun.spin_z))
        leaves = edge_time(lying, motion, until, half)
        mass = tangential_mass(sphere)
        for point in range(times.shape[1]):
            time = min(times[number, point], leaves)
            write_at(lying, motion, time, stages, state)
            times[number, point] = time
            spin_z = np.sign(begun.spin_z) * spin_left(falling, time)
            write_state(states[number, point], lying_state(sphere, state, spin_z))
            friction[number, point, 0] = -mass * state[6]
            friction[number, point, 1] = -mass * state[7]
