"""The motion along the plate of drops that the core follows: in flights, contacts and impulses, and
over the edges of the plate.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.drop_records import (
    ALONG,
    APPROACH,
    AT_TOUCH,
    CLOSING,
    DENT,
    DURATION,
    END_FAILED,
    FRICTION_LOST,
    GROSS_SLIP_LOST,
    IMPACT,
    IN_FLIGHT,
    MASS,
    MICROSLIP,
    MICROSLIP_LOST,
    RADIUS,
    REBOUND_ANGLE,
    RELEASE_X,
    RELEASE_Y,
    RUBBED,
    SEPARATION,
    TANGENTIAL_RESTITUTION,
    TIME,
    DropManner,
    Drops,
    FreeFall,
    ObliqueDrops,
)
from vibroimpact.dynamics.core.drops import (
    bodies_at_touch,
    collide_at_once,
    fly,
    leave,
    ready,
    remember,
    touch_gap,
    write_contact,
)
from vibroimpact.dynamics.core.free_fall import next_touch
from vibroimpact.dynamics.core.friction_records import NO_FRICTION
from vibroimpact.dynamics.core.law import law_at_touch
from vibroimpact.dynamics.core.line_records import LineManner
from vibroimpact.dynamics.core.linear import write_all
from vibroimpact.dynamics.core.lines import room_of, solve_pair
from vibroimpact.dynamics.core.normal_records import NormalGrid
from vibroimpact.dynamics.core.records import Law
from vibroimpact.dynamics.core.rubbing import Rubbed, normal_path, rub
from vibroimpact.dynamics.core.sphere_contact import struck
from vibroimpact.dynamics.core.sphere_records import (
    SphereState,
    energy_taken,
    flown,
    length_of,
    sphere_of,
    state_of,
    write_state,
)

_DEGREES = 180.0 / math.pi


@compiled
def follow_oblique_drops(
    manner: DropManner, drops: Drops, oblique: ObliqueDrops, pause: int
) -> None:
    """Follow drops that move along the plate, too; see `follow_drops`.

    It is a loop of its own, so that friction is not compiled for drops along the normal.
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
                flight = over_plate(oblique, drop, next_touch(state, gap))
                phase = fly(manner.stops, flight, impacts, state)
                fly_along(oblique, drop, state[TIME] - flight.start)
                drops.flights[drop] += 1
                if manner.waits:
                    break
                continue
            row = drops.rows[drop, impacts]
            impacts += 1
            row[IMPACT] = impacts
            if not manner.has_force:
                phase = collide_at_once(drops.at_touch[drop, 0], state, row)
                end_along(oblique, drop, struck_end(oblique, drop, state, row), 0.0, row)
                continue
            law = law_at_touch(addresses, coefficients, room.series, state[CLOSING])
            bodies = bodies_at_touch(contacts.manner, law, state)
            solved, contact = solve_pair(
                law, bodies, contacts.rules, contacts.grid, contacts.collocates, room
            )
            write_contact(state, row, contact)
            fresh = drops.laws[drop, min(impacts, last_law)]
            remember(addresses, manner.lasts, fresh, state[DENT], next_coefficients)
            phase = leave(manner.waits, law, contact, next_coefficients, state, row)
            if phase != END_FAILED:
                rubbed = rubbed_end(oblique, drop, solved, law, bodies, contacts.grid, row)
                end_along(oblique, drop, rubbed.end, rubbed.microslip, row)
            # after a flight that is told, who tells it decides
            may_leave = manner.lasts and not manner.is_told_flights
            if may_leave and leaves_dent(oblique, drop, contact.deepest, state):
                state[DENT] = 0.0
                remember(addresses, True, fresh, 0.0, next_coefficients)
            write_all(coefficients, next_coefficients)
        drops.phases[drop] = phase
        drops.impacts[drop] = impacts


@compiled
def over_plate(oblique: ObliqueDrops, drop: int, flight: FreeFall) -> FreeFall:
    """Return a flight that knows whether it ends beside the plate."""
    if flight.touch == math.inf:
        return flight
    elapsed = flight.touch - flight.start
    there = flown(sphere_of(oblique.spheres[drop]), state_of(oblique.along[drop]), elapsed)
    is_beside = abs(there.x) > oblique.half_x or abs(there.y) > oblique.half_y
    return FreeFall(flight.start, flight.top, flight.touch, flight.speed, is_beside)


@compiled
def fly_along(oblique: ObliqueDrops, drop: int, elapsed: float) -> None:
    """Move a drop along the plate through a time without contact [s]."""
    along = oblique.along[drop]
    write_state(along, flown(sphere_of(oblique.spheres[drop]), state_of(along), elapsed))


@compiled
def struck_end(oblique: ObliqueDrops, drop: int, state: Vector, row: Vector) -> SphereState:
    """Return the state along the plate after an impact without duration.

    `state`, `row`: of the drop, and of the impact.
    """
    begun = state_of(oblique.along[drop])
    rubbing = oblique.rubbing
    if rubbing.kind == NO_FRICTION:
        return begun
    # the normal impulse turns the approach speed into that of separation
    impulse = state[MASS] * (row[APPROACH] + row[SEPARATION])
    sphere = sphere_of(oblique.spheres[drop])
    return struck(rubbing.addresses, oblique.friction[drop], sphere, begun, impulse)


@compiled
def rubbed_end(
    oblique: ObliqueDrops,
    drop: int,
    solved: bool,
    law: Law,
    bodies: LineManner,
    grid: NormalGrid,
    row: Vector,
) -> Rubbed:
    """Return the end of a contact along the plate.

    Parameters
    ----------
    oblique : ObliqueDrops
        The drops.
    drop : int
        The number of the one.
    solved : bool
        Was the contact solved by collocation?
    law, bodies, grid : Law, LineManner, NormalGrid
        With which it was solved.
    row : array, shape (40,)
        Of the impact.
    """
    sphere = sphere_of(oblique.spheres[drop])
    begun = state_of(oblique.along[drop])
    if oblique.rubbing.kind == NO_FRICTION:
        return Rubbed(flown(sphere, begun, row[DURATION]), 0.0)
    normal = normal_path(solved, law, bodies, grid)
    return rub(oblique.rubbing, oblique.friction[drop], sphere, begun, normal)


@compiled
def end_along(
    oblique: ObliqueDrops, drop: int, after: SphereState, microslip: float, row: Vector
) -> None:
    """Put a drop into its state after an impact, and write the columns of its motion along the
    plate.

    `microslip`: energy that was lost while a part of the contact stuck [J].
    """
    along = oblique.along[drop]
    before = state_of(along)
    lost = energy_taken(sphere_of(oblique.spheres[drop]), before, after)
    oblique.taken[drop, RUBBED] += lost
    oblique.taken[drop, MICROSLIP] += microslip
    write_state(along, after)
    row[ALONG] = before.x
    row[ALONG + 1] = before.y
    row[ALONG + 2] = before.velocity_x
    row[ALONG + 3] = before.velocity_y
    row[ALONG + 4] = after.velocity_x
    row[ALONG + 5] = after.velocity_y
    row[ALONG + 6] = before.spin_x
    row[ALONG + 7] = before.spin_y
    row[ALONG + 8] = before.spin_z
    row[ALONG + 9] = after.spin_x
    row[ALONG + 10] = after.spin_y
    row[ALONG + 11] = after.spin_z
    # of the centre: its velocity after, along that before
    speed = length_of(before.velocity_x, before.velocity_y)
    onward = length_of(after.velocity_x, after.velocity_y)
    if speed > 0.0:
        onward = before.velocity_x * after.velocity_x + before.velocity_y * after.velocity_y
        onward /= speed
        row[TANGENTIAL_RESTITUTION] = onward / speed
    row[REBOUND_ANGLE] = _DEGREES * math.atan2(onward, row[SEPARATION])
    row[FRICTION_LOST] = lost
    row[MICROSLIP_LOST] = microslip
    row[GROSS_SLIP_LOST] = lost - microslip
    row[RELEASE_X] = after.x
    row[RELEASE_Y] = after.y


@compiled
def leaves_dent(oblique: ObliqueDrops, drop: int, deepest: float, state: Vector) -> bool:
    """Does a drop touch next beyond the radius of its last contact?

    `deepest`: indentation of that [m]. `state`: of the drop after it.
    """
    flight = next_touch(state, 0.0)
    if flight.touch == math.inf:
        return False
    here = state_of(oblique.along[drop])
    there = flown(sphere_of(oblique.spheres[drop]), here, flight.touch - flight.start)
    # Hertz: a^2 = R delta
    distance = length_of(there.x - here.x, there.y - here.y)
    return bool(distance > math.sqrt(state[RADIUS] * deepest))
