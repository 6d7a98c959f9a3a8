r"""A contact of a sphere, driven by its normal motion: the motion along the plate under friction
along the first slip, across it, and against rolling and twisting.

The slip keeps to its first direction. Its velocity s, with the effective mass :math:`m_t` of the
tangential motion, gravity :math:`g_t` along the direction and the friction Q against it, obeys

.. math:: m_t \dot s = m_t g_t - Q

which `sliding_paths` solves with tangential compliance, and the law itself without. Across the
direction the slip is small: Q slows it at the rate :math:`Q / (m_t s)`, and holds it where s is
over. The moment of rolling resistance acts at the end, against the spin that is left, with the
whole normal impulse. The moment against twisting changes the spin about the normal alone.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Integers, Matrix, Vector
from vibroimpact.compiled import compiled, friction_at, slip_after_at
from vibroimpact.dynamics.core.normal_records import (
    FORCE,
    FORCE_SLOPE,
    IMPULSE,
    PACE,
    PACE_SLOPE,
    TIME,
    NormalPath,
)
from vibroimpact.dynamics.core.sliding_paths import DISPLACEMENT, FRICTION_FORCE, VELOCITY
from vibroimpact.dynamics.core.sphere_records import (
    RubbedSphere,
    SphereState,
    length_of,
    sphere_of,
    state_of,
    tangential_mass,
    turning_of,
    twisting_of,
    write_state,
)
from vibroimpact.dynamics.core.twisting import full_moment, moment_share, slowed_spin

_ACROSS = 1e-12
"""Of gravity along the plate: the part of it across the slip that counts as none."""

_PARTS = 8
"""Steps of twisting in one of the normal motion: its moment grows steeply where a slip ends."""


class FirstSlip(NamedTuple):
    """The slip at first touch: its direction, its speed [m/s], and the acceleration of gravity
    along the direction [m/s^2].
    """

    direction_x: float
    direction_y: float
    speed: float
    pull: float


class Change(NamedTuple):
    """What acts beside the friction along the slip changes by the end of a contact: velocities
    [m/s] and spins [rad/s].
    """

    velocity_x: float
    velocity_y: float
    spin_x: float
    spin_y: float
    spin_z: float


@compiled
def first_slip(sphere: RubbedSphere, begun: SphereState) -> FirstSlip:
    """Return the slip at first touch; where nothing slips its direction is that of gravity."""
    turning_x, turning_y = turning_of(sphere, begun)
    x = begun.velocity_x + turning_x
    y = begun.velocity_y + turning_y
    speed = length_of(x, y)
    if speed == 0.0:
        x = sphere.gravity_x
        y = sphere.gravity_y
    length = length_of(x, y)
    if length == 0.0:
        return FirstSlip(1.0, 0.0, 0.0, 0.0)
    direction_x = x / length
    direction_y = y / length
    pull = sphere.gravity_x * direction_x + sphere.gravity_y * direction_y
    return FirstSlip(direction_x, direction_y, speed, pull)


@compiled
def integral_of_step(
    step: float, rate_before: float, rate: float, bend_before: float, bend: float
) -> float:
    """Return the integral over a step of a quantity, from it and its slope at both ends."""
    # the rule of order four of `sliding_steps`
    return step * (0.5 * (rate + rate_before) + (bend_before - bend) / 12.0)


@compiled
def slide_impulsively(
    addresses: Integers,
    coefficients: Vector,
    slip: FirstSlip,
    mass: float,
    normal: NormalPath,
    path: Matrix,
) -> None:
    """Follow the sliding of a contact whose law has no tangential compliance.

    Parameters
    ----------
    addresses : array of int, shape (2,)
        Of the functions of the law; see `compiled.law_addresses`.
    coefficients : array, shape (K,)
        Of the law.
    slip : FirstSlip
        The slip at first touch.
    mass : float
        Effective mass of the tangential motion [kg].
    normal : NormalPath
        The normal motion.
    path : array, shape (3, G)
        Room for slip velocities [m/s], displacements [m] and friction forces [N].
    """
    slip_after = slip_after_at(addresses[0])
    friction = friction_at(addresses[1])
    rows = normal.rows
    points = rows.shape[1]
    whole = rows[IMPULSE, 0]
    for point in range(points):
        whole = max(whole, rows[IMPULSE, point])
    # a force that pulls, as some laws have at the end, gives nothing back
    pressed = rows[IMPULSE, 0]
    displacement = 0.0
    rate = 0.0
    bend = 0.0
    for point in range(points):
        pressed = max(pressed, rows[IMPULSE, point])
        free = slip.speed + slip.pull * rows[TIME, point]
        velocity = slip_after(free, pressed, whole, mass, coefficients)
        force = friction(velocity, rows[FORCE, point], coefficients)
        pace = rows[PACE, point]
        rate_before = rate
        bend_before = bend
        rate = pace * velocity
        bend = rows[PACE_SLOPE, point] * velocity + pace * pace * (slip.pull - force / mass)
        if point > 0:
            step = normal.steps[point - 1]
            displacement += integral_of_step(step, rate_before, rate, bend_before, bend)
        path[VELOCITY, point] = velocity
        path[DISPLACEMENT, point] = displacement
        path[FRICTION_FORCE, point] = force


@compiled
def state_along(
    sphere: RubbedSphere,
    begun: SphereState,
    slip: FirstSlip,
    change: Change,
    time: float,
    velocity: float,
    displacement: float,
    share: float,
) -> SphereState:
    """Return the state of a sphere within a contact.

    Parameters
    ----------
    sphere : RubbedSphere
        The sphere.
    begun : SphereState
        Its state at first touch.
    slip : FirstSlip
        Its slip then.
    change : Change
        By the end of the contact, evenly in time.
    time : float
        Since first touch [s].
    velocity, displacement : float
        Of the contact point along the slip [m/s], [m].
    share : float
        Part of the duration that is over.
    """
    # the impulse of friction is what gravity does not explain of the motion of the contact point;
    # it moves the centre, and turns the sphere
    mass = tangential_mass(sphere)
    impulse = mass * (velocity - slip.speed - slip.pull * time)
    moved = mass * (displacement - slip.speed * time - 0.5 * slip.pull * time * time)
    moved /= sphere.mass
    faster = impulse / sphere.mass
    turn = sphere.radius / sphere.inertia * impulse
    # `change` comes evenly, up to share * change by now: its way is half of that times the time
    half = 0.5 * time * share
    free_x = begun.velocity_x + 0.5 * sphere.gravity_x * time
    free_y = begun.velocity_y + 0.5 * sphere.gravity_y * time
    return SphereState(
        begun.x + free_x * time + moved * slip.direction_x + half * change.velocity_x,
        begun.y + free_y * time + moved * slip.direction_y + half * change.velocity_y,
        begun.velocity_x
        + sphere.gravity_x * time
        + faster * slip.direction_x
        + share * change.velocity_x,
        begun.velocity_y
        + sphere.gravity_y * time
        + faster * slip.direction_y
        + share * change.velocity_y,
        begun.spin_x + turn * slip.direction_y + share * change.spin_x,
        begun.spin_y - turn * slip.direction_x + share * change.spin_y,
        begun.spin_z + share * change.spin_z,
    )


@compiled
def held_across(slip: FirstSlip, normal: NormalPath, path: Matrix) -> float:
    """Return what friction takes across the slip, over gravity there [s].

    `normal`, `path`: of the contact; see `slide_impulsively`.
    """
    # backwards from the end: across the slip a velocity decays like the slip itself, without the
    # part of gravity along it
    taken = 0.0
    remaining = 1.0  # by the end of the slip, of what is there at a point
    for point in range(len(normal.steps) - 1, -1, -1):
        elapsed = normal.rows[TIME, point + 1] - normal.rows[TIME, point]
        velocity = path[VELOCITY, point]
        slowed = 0.0
        if velocity > 0.0:
            slowed = (path[VELOCITY, point + 1] - slip.pull * elapsed) / velocity
        remaining_after = remaining
        remaining *= min(max(slowed, 0.0), 1.0)
        taken += elapsed * (0.5 * (remaining_after + remaining) - 1.0)
    return taken


@compiled
def between(start: float, end: float, share: float) -> float:
    """Return the value at a share of a straight line, at its end the very value there: a contact
    that slides has no moment by sticking, which is a difference from one.
    """
    if share == 1.0:
        return end
    return start + share * (end - start)


@compiled
def twisted_back(sphere: RubbedSphere, spin: float, normal: NormalPath, path: Matrix) -> float:
    """Return the change of a spin about the normal by a contact [rad/s].

    `normal`, `path`: of the contact; see `slide_impulsively`.
    """
    twisting = twisting_of(sphere)
    if spin == 0.0 or twisting.coefficient * twisting.radius == 0.0:
        return 0.0
    rows = normal.rows
    begun = abs(spin)
    kept = begun
    share = 0.0
    rate = 0.0
    bend = 0.0
    for point in range(rows.shape[1]):
        force = rows[FORCE, point]
        moment = full_moment(twisting, force) / sphere.inertia
        # full twisting goes with F^(4/3), so that dM/dt = 4/3 M F'/F
        growth = 0.0
        if force > 0.0:
            growth = (4.0 / 3.0) * moment * rows[FORCE_SLOPE, point] / force
        rate_before = rate
        bend_before = bend
        rate = rows[PACE, point] * moment
        bend = rows[PACE_SLOPE, point] * moment + rows[PACE, point] * growth
        if point == 0:
            friction = abs(path[FRICTION_FORCE, 0])
            share = moment_share(twisting, force, friction, abs(path[VELOCITY, 0]), kept)
            continue
        full = (
            integral_of_step(normal.steps[point - 1], rate_before, rate, bend_before, bend) / _PARTS
        )
        for part in range(_PARTS):
            after = (part + 1) / _PARTS
            lost, share = slowed_spin(
                twisting,
                kept,
                full,
                share,
                between(rows[FORCE, point - 1], force, after),
                between(
                    abs(path[FRICTION_FORCE, point - 1]), abs(path[FRICTION_FORCE, point]), after
                ),
                between(abs(path[VELOCITY, point - 1]), abs(path[VELOCITY, point]), after),
            )
            kept = max(kept - lost, 0.0)
    return float(np.sign(spin) * (kept - begun))


@compiled
def rolling_change(
    sphere: RubbedSphere, after: SphereState, impulse: float, rubbed: float
) -> tuple[float, float, float, float]:
    """Return what rolling resistance changes after a contact: velocities [m/s], and spins about x
    and y [rad/s].

    What the impulse of friction so far has left of friction keeps the sphere rolling, but where the
    contact point slips with the spin so fast that this made energy.

    Parameters
    ----------
    sphere : RubbedSphere
        The sphere.
    after : SphereState
        Its state without this.
    impulse : float
        The whole normal impulse [N s].
    rubbed : float
        Impulse of friction so far [N s].
    """
    turning_x, turning_y = turning_of(sphere, after)
    speed = length_of(turning_x, turning_y)
    if sphere.rolling_coefficient == 0.0 or speed == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    # impulses of the moment over R, and of friction, along w
    share = tangential_mass(sphere) / sphere.mass
    moment = sphere.rolling_coefficient * impulse
    along_x = turning_x / speed
    along_y = turning_y / speed
    slip = (after.velocity_x + turning_x) * along_x + (after.velocity_y + turning_y) * along_y
    held = 0.0
    if not 2.0 * (1.0 - share) * slip > speed:
        held = min((1.0 - share) * moment, max(sphere.coefficient * impulse - rubbed, 0.0))
    turn = sphere.radius * sphere.radius / sphere.inertia
    slower = (moment - held) * turn
    # the moment ends with the spin: it takes no more than there is
    part = 1.0
    if slower > speed:
        part = speed / slower
    push = part * held
    faster = push / sphere.mass
    spins = push * sphere.radius / sphere.inertia - part * moment * turn / sphere.radius
    return faster * along_x, faster * along_y, spins * along_y, -spins * along_x


@compiled
def change_beside(
    sphere: RubbedSphere, begun: SphereState, slip: FirstSlip, normal: NormalPath, path: Matrix
) -> Change:
    """Return what acts beside the friction along the slip changes by the end of a contact.

    Parameters
    ----------
    sphere : RubbedSphere
        The sphere.
    begun, slip : SphereState, FirstSlip
        Its state and its slip at first touch.
    normal, path : NormalPath, array
        Of the contact; see `slide_impulsively`.
    """
    last = len(normal.steps)
    time = normal.rows[TIME, last]
    velocity = path[VELOCITY, last]
    mass = tangential_mass(sphere)
    impulse_x = 0.0
    impulse_y = 0.0
    across_x = sphere.gravity_x - slip.pull * slip.direction_x
    across_y = sphere.gravity_y - slip.pull * slip.direction_y
    gravity = length_of(sphere.gravity_x, sphere.gravity_y)
    if length_of(across_x, across_y) > _ACROSS * gravity:
        held = mass * held_across(slip, normal, path)
        impulse_x = held * across_x
        impulse_y = held * across_y
    turn = sphere.radius / sphere.inertia
    change = Change(
        impulse_x / sphere.mass,
        impulse_y / sphere.mass,
        turn * impulse_y,
        -turn * impulse_x,
        twisted_back(sphere, begun.spin_z, normal, path),
    )
    after = state_along(sphere, begun, slip, change, time, velocity, path[DISPLACEMENT, last], 1.0)
    rubbed = mass * abs(velocity - slip.speed - slip.pull * time)
    pressed = normal.rows[IMPULSE, last]
    faster_x, faster_y, spin_x, spin_y = rolling_change(sphere, after, pressed, rubbed)
    return Change(
        change.velocity_x + faster_x,
        change.velocity_y + faster_y,
        change.spin_x + spin_x,
        change.spin_y + spin_y,
        change.spin_z,
    )


@compiled
def write_states_along(
    sphere: RubbedSphere,
    begun: SphereState,
    slip: FirstSlip,
    change: Change,
    times: Vector,
    velocities: Vector,
    displacements: Vector,
    duration: float,
    states: Matrix,
) -> None:
    """Write the states of a sphere (T, 7) at T times within a contact; see `state_along`."""
    for point in range(len(times)):
        time = times[point]
        state = state_along(
            sphere,
            begun,
            slip,
            change,
            time,
            velocities[point],
            displacements[point],
            time / duration,
        )
        write_state(states[point], state)


@compiled
def struck(
    addresses: Integers,
    coefficients: Vector,
    sphere: RubbedSphere,
    begun: SphereState,
    impulse: float,
) -> SphereState:
    """Return the state of a sphere after a normal impulse without duration [N s].

    `addresses`, `coefficients`: of the friction law; see `slide_impulsively`. `begun`: the state
    before.
    """
    slip_after = slip_after_at(addresses[0])
    slip = first_slip(sphere, begun)
    mass = tangential_mass(sphere)
    velocity = slip_after(slip.speed, impulse, impulse, mass, coefficients)
    still = Change(0.0, 0.0, 0.0, 0.0, 0.0)
    after = state_along(sphere, begun, slip, still, 0.0, velocity, 0.0, 1.0)
    rubbed = mass * abs(velocity - slip.speed)
    faster_x, faster_y, spin_x, spin_y = rolling_change(sphere, after, impulse, rubbed)
    change = Change(faster_x, faster_y, spin_x, spin_y, 0.0)
    return state_along(sphere, begun, slip, change, 0.0, velocity, 0.0, 1.0)


@compiled
def strike(
    addresses: Integers,
    coefficients: Matrix,
    spheres: Matrix,
    states: Matrix,
    impulses: Vector,
    ends: Matrix,
) -> None:
    """Write the states of B spheres after normal impulses without duration.

    Parameters
    ----------
    addresses, coefficients : array, shape (2,), (B, K)
        Of the friction law; see `slide_impulsively`.
    spheres, states : array, shape (B, 8), (B, 7)
        Of each the members of `RubbedSphere` and `SphereState` before.
    impulses : array, shape (B,)
        The normal impulses [N s].
    ends : array, shape (B, 7)
        Room for the states after them.
    """
    for number in range(len(spheres)):
        sphere = sphere_of(spheres[number])
        begun = state_of(states[number])
        end = struck(addresses, coefficients[number], sphere, begun, impulses[number])
        write_state(ends[number], end)
