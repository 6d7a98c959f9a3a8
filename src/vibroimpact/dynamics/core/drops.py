"""Rigid drops from their starts to the ends of their runs: flight, touch, contact, release, rest.

A batch is a loop over its drops, each of which is what it is alone. What each impact is like goes
into the rows of a table, and what has become of the energy into the state of the drop.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Integers, Vector
from vibroimpact.compiled import compiled, compressed_at, energies_at, levels_at
from vibroimpact.dynamics.core.depths import undamped_depth
from vibroimpact.dynamics.core.drop_records import (
    ACCELERATION,
    APPROACH,
    AT_START,
    AT_TOUCH,
    CLOSING,
    COMPRESSION,
    DAMPED,
    DEEPEST,
    DENT,
    DENT_BEFORE,
    DISSIPATED,
    DURATION,
    END_BY_REST_SPEED,
    END_CAPTURED,
    END_FAILED,
    END_STUCK,
    END_TIME,
    FORCE,
    GAP,
    GRAVITY,
    IMPACT,
    IN_FLIGHT,
    INDENTATION,
    INERTIA,
    LEFT_STORED,
    LOST,
    MASS,
    PLASTIC,
    PLASTIC_WORK,
    RADIUS,
    REBOUND,
    RELEASE_GAP,
    RELEASE_VELOCITY,
    REST_SPEED,
    REST_TIME,
    RESTITUTION,
    SAG,
    SEPARATION,
    STORED,
    TIME,
    TIME_OF_FORCE,
    TIME_OF_INDENTATION,
    TOUCH,
    VELOCITY,
    WRITTEN_OFF,
    DropManner,
    Drops,
    FreeFall,
    StopRules,
)
from vibroimpact.dynamics.core.events import ENDS
from vibroimpact.dynamics.core.free_fall import next_touch
from vibroimpact.dynamics.core.law import law_at_touch, law_remembering
from vibroimpact.dynamics.core.line import CAPTURED, FAILED
from vibroimpact.dynamics.core.line_records import LineContact, LineManner
from vibroimpact.dynamics.core.linear import write_all
from vibroimpact.dynamics.core.lines import room_of, solve_pair, with_bodies
from vibroimpact.dynamics.core.records import Law
from vibroimpact.dynamics.core.static import static_indentation
from vibroimpact.dynamics.core.stop_rules import first_end, is_too_slow

LEAST_REST_SPEED = 1e-6  # of the first approach speed
LEAST_MISSING = 1e-6  # of a restitution of one, with which bounces have an end
_ENDS_AT_PULL_OFF = ENDS.index("pull-off")


@compiled
def follow_drops(manner: DropManner, drops: Drops, pause: int) -> None:
    """Follow drops along the normal until their runs end, or they have had `pause` impacts.

    Where the law depends on the approach speed, or has no force, they are followed until they
    touch; in the next call they go on from there, with what the law is at that speed.
    """
    contacts = manner.contacts
    addresses = contacts.addresses
    room = room_of(contacts.rules)
    next_coefficients = np.zeros(drops.coefficients.shape[1])
    last_law = drops.laws.shape[1] - 1
    for drop in range(len(drops.phases)):
        state = drops.state[drop]
        coefficients = drops.coefficients[drop]
        impacts = drops.impacts[drop]
        phase = ready(manner, drops, drop)
        while phase == IN_FLIGHT or (phase == AT_TOUCH and impacts < pause):
            if phase == IN_FLIGHT:
                if manner.is_told_flights:
                    break
                gap = touch_gap(manner.has_force, addresses, coefficients)
                phase = fly(manner.stops, next_touch(state, gap), impacts, state)
                drops.flights[drop] += 1
                if manner.waits:
                    break
                continue
            row = drops.rows[drop, impacts]
            impacts += 1
            row[IMPACT] = impacts
            if not manner.has_force:
                phase = collide_at_once(drops.at_touch[drop, 0], state, row)
                continue
            law = law_at_touch(addresses, coefficients, room.series, state[CLOSING])
            bodies = bodies_at_touch(contacts.manner, law, state)
            _, contact = solve_pair(
                law, bodies, contacts.rules, contacts.grid, contacts.collocates, room
            )
            write_contact(state, row, contact)
            fresh = drops.laws[drop, min(impacts, last_law)]
            remember(addresses, manner.lasts, fresh, state[DENT], next_coefficients)
            phase = leave(manner.waits, law, contact, next_coefficients, state, row)
            write_all(coefficients, next_coefficients)
        drops.phases[drop] = phase
        drops.impacts[drop] = impacts


@compiled
def ready(manner: DropManner, drops: Drops, drop: int) -> int:
    """Give a drop that begins, or that has waited at its touch, the coefficients of its law; return
    its phase then.
    """
    addresses = manner.contacts.addresses
    state = drops.state[drop]
    coefficients = drops.coefficients[drop]
    phase = drops.phases[drop]
    if phase == AT_START:
        begin(manner.has_force, addresses, drops.laws[drop, 0], coefficients, state)
        return IN_FLIGHT
    if phase == AT_TOUCH and manner.waits and manner.has_force:
        remember(addresses, manner.lasts, drops.at_touch[drop], state[DENT], coefficients)
    return int(phase)


@compiled
def begin(
    has_force: bool, addresses: Integers, fresh: Vector, coefficients: Vector, state: Vector
) -> None:
    """Give a drop the coefficients of its first law, and a rest speed unless it has one."""
    approach_speed = next_touch(state, 0.0).speed
    rest_speed = LEAST_REST_SPEED * approach_speed
    if has_force:
        remember(addresses, False, fresh, 0.0, coefficients)
        rest_speed = default_rest_speed(
            addresses, coefficients, state[MASS], state[GRAVITY], approach_speed
        )
    if math.isnan(state[REST_SPEED]):
        state[REST_SPEED] = rest_speed


@compiled
def default_rest_speed(
    addresses: Integers, coefficients: Vector, mass: float, gravity: float, approach_speed: float
) -> float:
    """Return the speed of separation below which a drop without a stated one rests [m/s].

    From it a sphere would rise by its static indentation. It is at least 1e-6 of the first approach
    speed.

    Parameters
    ----------
    addresses, coefficients : array
        Functions and coefficients of the law of the first impact.
    mass, gravity : float
        Of the sphere [kg], and what accelerates it onto the plate [m/s^2].
    approach_speed : float
        Of the first impact [m/s].
    """
    # v^2 = 2 g h with the static indentation for the height h
    touch, release, _, _, _ = levels_at(addresses[2])(coefficients)
    sag = static_indentation(addresses, coefficients, release, mass * gravity) - touch
    return max(math.sqrt(2.0 * gravity * sag), LEAST_REST_SPEED * approach_speed)


@compiled
def touch_gap(has_force: bool, addresses: Integers, coefficients: Vector) -> float:
    """Return the gap at which a drop touches next [m]: zero, or below it in a dent."""
    if not has_force:
        return 0.0
    level, _, _, _, _ = levels_at(addresses[2])(coefficients)
    return -float(level)


@compiled
def write_touch_gaps(manner: DropManner, drops: Drops, gaps: Vector) -> None:
    """Write the gaps at which drops touch next [m] (B,)."""
    for drop in range(len(gaps)):
        coefficients = drops.coefficients[drop]
        gaps[drop] = touch_gap(manner.has_force, manner.contacts.addresses, coefficients)


@compiled
def collide_at_once(separation: float, state: Vector, row: Vector) -> int:
    """Let a drop rebound at its touch with a separation speed [m/s], and return its phase then."""
    speed = state[CLOSING]
    # without duration: all that is lost is kinetic
    lost = 0.5 * state[MASS] * (speed * speed - separation * separation)
    state[GAP] = 0.0
    state[VELOCITY] = separation
    state[DISSIPATED] += lost
    row[TOUCH] = state[TIME]
    row[DURATION] = 0.0
    row[APPROACH] = speed
    row[SEPARATION] = separation
    row[INDENTATION] = 0.0
    row[LOST] = lost
    row[PLASTIC_WORK] = 0.0
    row[RELEASE_GAP] = 0.0
    row[RELEASE_VELOCITY] = separation
    write_rebound(state, row)
    if not is_slow(state):
        return IN_FLIGHT
    limit = end_by_bounces(state, row)
    lie_still(state, limit, 0.0, 0.0, 0.0)
    return END_BY_REST_SPEED


@compiled
def remember(
    addresses: Integers, lasts: bool, fresh: Vector, deepest: float, coefficients: Vector
) -> None:
    """Write the coefficients of a law, which remembers the deepest indentation so far [m] if its
    memory lasts.
    """
    for number in range(len(fresh)):
        coefficients[number] = fresh[number]
    if lasts:
        _, _, memory_level, _, _ = levels_at(addresses[2])(fresh)
        if deepest > memory_level:
            compressed_at(addresses[3])(deepest, fresh, coefficients)


@compiled
def fly(stops: StopRules, flight: FreeFall, impacts: int, state: Vector) -> int:
    """Let a drop fly until it touches, or until a rule ends its run; return its phase then."""
    end, ending = first_end(stops, flight, impacts)
    time = min(end, flight.touch)
    elapsed = time - flight.start
    velocity = state[VELOCITY]
    gravity = state[GRAVITY]
    state[GAP] += elapsed * (velocity - 0.5 * gravity * elapsed)
    state[VELOCITY] = velocity - gravity * elapsed
    state[TIME] = time
    if flight.touch >= end:
        state[END_TIME] = end
        return ending
    state[CLOSING] = flight.speed
    return AT_TOUCH


@compiled
def bodies_at_touch(manner: LineManner, law: Law, state: Vector) -> LineManner:
    """Return the bodies of a drop as it touches, with the depth that it would reach undamped."""
    mass = state[MASS]
    gravity = state[GRAVITY]
    depth, speed = depth_and_speed(law, manner.contact_end, mass, gravity)
    return with_bodies(manner, mass, gravity, depth, speed)


@compiled
def depth_and_speed(law: Law, contact_end: int, mass: float, gravity: float) -> tuple[float, float]:
    """Return the depth that a rigid body would reach undamped [m], and the scale of its speed in
    contact [m/s]: at its touch, or due to gravity and adhesion in a soft one.
    """
    weight = mass * gravity
    square = law.speed * law.speed
    depth = undamped_depth(law.addresses, law.coefficients, law.touch, 0.5 * mass * square, weight)
    scale = square + gravity * (depth - law.touch)
    if contact_end == _ENDS_AT_PULL_OFF:
        sag = static_indentation(law.addresses, law.coefficients, law.release, weight)
        # negative: the energy of adhesion
        scale -= 2.0 * elastic_energy(law, sag) / mass
    return depth, math.sqrt(max(scale, 0.0))


@compiled
def elastic_energy(law: Law, delta: float) -> float:
    """Return the energy that a law stores at an indentation [J]."""
    elastic, _ = energies_at(law.addresses[1])(delta, law.coefficients)
    return float(elastic)


@compiled
def write_contact(state: Vector, row: Vector, contact: LineContact) -> None:
    """Write the columns of a contact, and where it leaves the drop."""
    touch = state[TIME]
    gravity = state[GRAVITY]
    row[TOUCH] = touch
    row[APPROACH] = state[CLOSING]
    row[DURATION] = contact.end.time
    row[PLASTIC_WORK] = contact.plastic
    row[INDENTATION] = contact.deepest
    row[TIME_OF_INDENTATION] = touch + contact.time_of_deepest
    row[FORCE] = contact.peak_force
    row[TIME_OF_FORCE] = touch + contact.time_of_peak_force
    # upwards at the largest force, or downwards in free fall
    row[ACCELERATION] = max(contact.peak_force / state[MASS] - gravity, gravity)
    row[COMPRESSION] = contact.time_of_deepest
    row[DAMPED] = contact.end.lost
    row[RELEASE_GAP] = -contact.end.delta
    row[RELEASE_VELOCITY] = -contact.end.rate
    row[LEFT_STORED] = contact.stored
    row[DENT_BEFORE] = state[DENT]
    state[DEEPEST] = max(state[DEEPEST], contact.deepest)
    state[DENT] = max(state[DENT], contact.deepest)
    state[TIME] = touch + contact.end.time
    state[GAP] = -contact.end.delta
    state[VELOCITY] = -contact.end.rate


@compiled
def leave(
    waits: bool,
    law: Law,
    contact: LineContact,
    next_coefficients: Vector,
    state: Vector,
    row: Vector,
) -> int:
    """Release a drop from its contact, and bring it to rest if it is slow; return its phase then.

    Its law at rest is that of the next impact, or, where a drop waits for this, that of the last.
    """
    addresses = law.addresses
    touch_level, release_level, _, _, _ = levels_at(addresses[2])(next_coefficients)
    compressed_law = law_remembering(law, contact.deepest)
    phase = release(state, row, contact, compressed_law, touch_level)
    if phase != IN_FLIGHT or not is_slow(state):
        return phase
    limit = end_by_bounces(state, row)
    coefficients = next_coefficients
    if waits:
        coefficients = compressed_law.coefficients
        release_level = compressed_law.release
    bring_to_rest(state, addresses, coefficients, release_level, limit, 0.0)
    return END_BY_REST_SPEED


@compiled
def release(state: Vector, row: Vector, contact: LineContact, law: Law, next_level: float) -> int:
    """Write what the contact of a drop took and how it leaves it, and return its phase then.

    It stays where it has too little energy to leave the indentation, or falls back before it has
    risen to the touch level of its next law [m]. `law`: with its memory of the contact.
    """
    velocity = state[VELOCITY]
    overlap = max(contact.end.delta - next_level, 0.0)
    failed = contact.outcome == FAILED
    falls_back = velocity * velocity < 2.0 * state[GRAVITY] * overlap
    stays = contact.outcome == CAPTURED or (falls_back and not failed)
    phase = IN_FLIGHT
    if failed:
        phase = END_FAILED
        state[END_TIME] = state[TIME]
    elif stays:
        # a law that stores energy at release adheres: it holds the sphere
        phase = END_CAPTURED
        if elastic_energy(law, law.release) > 0.0:
            phase = END_STUCK
        row[SEPARATION] = 0.0
        state[END_TIME] = state[TIME]
        bring_to_rest(
            state, law.addresses, law.coefficients, law.release, state[TIME], contact.stored
        )
    else:
        row[SEPARATION] = velocity
    given_up = 0.0 if stays else contact.stored
    lost = contact.end.lost + given_up + contact.plastic
    state[DISSIPATED] += lost - contact.plastic
    state[PLASTIC] += contact.plastic
    row[LOST] = lost
    write_rebound(state, row)
    return phase


@compiled
def write_rebound(state: Vector, row: Vector) -> None:
    """Write the restitution of an impact, and the height to which a drop rises after it."""
    separation = row[SEPARATION]
    row[RESTITUTION] = separation / row[APPROACH]
    if state[GRAVITY] > 0.0:
        rise = 0.5 * (separation * separation) / state[GRAVITY]
        row[REBOUND] = state[RADIUS] + state[GAP] + rise


@compiled
def bring_to_rest(
    state: Vector,
    addresses: Integers,
    coefficients: Vector,
    release_level: float,
    time: float,
    stored: float,
) -> None:
    """Put a drop that has come to rest at a time [s] into its static indentation.

    The contact has an energy `stored` [J].
    """
    weight = state[MASS] * state[GRAVITY]
    sag = static_indentation(addresses, coefficients, release_level, weight)
    stored_at_rest, _ = energies_at(addresses[1])(sag, coefficients)
    lie_still(state, time, stored, sag, stored_at_rest)


@compiled
def lie_still(state: Vector, time: float, stored: float, sag: float, stored_at_rest: float) -> None:
    """Write that a drop has come to rest at a time [s] with an indentation `sag` [m].

    The energy of the contact was `stored` and is `stored_at_rest` [J]; what the drop had beyond
    that at rest is written off.
    """
    mass = state[MASS]
    gravity = state[GRAVITY]
    velocity = state[VELOCITY]
    weight = mass * gravity
    # m v^2/2 + m g z + U now, less U - m g delta at rest
    energy = mass * (0.5 * (velocity * velocity) + gravity * state[GAP]) + stored
    state[REST_TIME] = time
    state[SAG] = sag
    state[STORED] = stored_at_rest
    state[WRITTEN_OFF] = energy - (stored_at_rest - weight * sag)


@compiled
def is_slow(state: Vector) -> bool:
    """Does a drop separate below the rest speed, or not at all?"""
    return is_too_slow(state[VELOCITY], state[REST_SPEED])


@compiled
def end_by_bounces(state: Vector, row: Vector) -> float:
    """End the run of a drop when infinitely many bounces with the last restitution would, and
    return that time [s]; it ends now where they would not.

    Their flights are a geometric series with the ratio of the last restitution e, whose sum is that
    of the first, 2 v/g, over 1 - e.
    """
    missing = 1.0 - row[RESTITUTION]
    limit = math.inf
    if state[GRAVITY] > 0.0 and missing > LEAST_MISSING:
        first_flight = 2.0 * state[VELOCITY] * state[INERTIA] / state[GRAVITY]
        limit = float(state[TIME] + first_flight / missing)
    state[END_TIME] = limit if limit < math.inf else state[TIME]
    return limit
