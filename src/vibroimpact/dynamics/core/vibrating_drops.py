"""Drops whose bodies vibrate, from their starts to the ends of their runs.

Flights are known in closed form, contacts are followed in stretches (`impacts`). What each impact
is like goes into the rows of a table, what has become of the energy into the state of the drop, and
the motion into parts, from which histories are read.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Vector
from vibroimpact.compiled import Lent, compiled, levels_at
from vibroimpact.dynamics.core.contact_records import FLIGHT, LAWS, OF_IMPACT, Bodies, Parts
from vibroimpact.dynamics.core.drop_records import (
    ACCELERATION,
    APPROACH,
    AT_TOUCH,
    CLOSING,
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
    LEFT_STORED,
    LOST,
    MASS,
    PLASTIC,
    PLASTIC_WORK,
    RADIUS,
    REBOUND,
    RELEASE_GAP,
    RELEASE_VELOCITY,
    RESTITUTION,
    SEPARATION,
    STORED,
    TIME,
    TIME_OF_FORCE,
    TIME_OF_INDENTATION,
    TOUCH,
    VELOCITY,
    FreeFall,
)
from vibroimpact.dynamics.core.drops import remember
from vibroimpact.dynamics.core.flight import (
    dashpot_rate,
    driven_rate,
    lost_in_flight,
    separation_speed,
    state_after,
    vibration_energy,
)
from vibroimpact.dynamics.core.impacts import begin_impact, energy_in_contact, follow_impact
from vibroimpact.dynamics.core.parts import has_room, write_free
from vibroimpact.dynamics.core.records import Bases, State, System
from vibroimpact.dynamics.core.stop_rules import first_end
from vibroimpact.dynamics.core.surface_friction_records import SlidingSphere
from vibroimpact.dynamics.core.touch import next_touch
from vibroimpact.dynamics.core.vibrating_records import (
    CLOSING_SPEED,
    CONTACTS,
    DRIVE_WORK,
    FIRST_LAW,
    HELD,
    IMPACTS,
    IN_CONTACT,
    SURFACE_VELOCITY,
    TO_VIBRATION,
    ImpactManner,
    Now,
    VibratingDrop,
)


@compiled
def follow_vibrating_drop(
    bases: Lent[Bases],
    bodies: Lent[Bodies],
    manner: ImpactManner,
    drop: Lent[VibratingDrop],
    parts: Lent[Parts],
    sphere: SlidingSphere,
    now: Now,
    pause: int,
) -> Now:
    """Follow a drop until its run ends, it has had `pause` impacts, or something is to be decided.

    Its phase tells which. One that waits is followed through one impact at a time, from its touch
    on.

    Parameters
    ----------
    bases : Bases
        The Radau rule under the three maps of time.
    bodies : Bodies
        The linear system.
    manner : ImpactManner
        What stays the same.
    drop, parts : VibratingDrop, Parts
        The drop, and the parts of its motion, to which is written.
    sphere : SlidingSphere
        Friction at touch.
    now : Now
        Where the last call ended, or the start.
    pause : int
        Number of impacts after which it is not followed any further.
    """
    system = bodies.system
    while True:
        if now.phase == IN_FLIGHT:
            if manner.waits or not has_room(parts):
                break
            now = fly(system, manner, drop, parts, now)
        elif now.phase == AT_TOUCH:
            if drop.counts[IMPACTS] == pause:
                break
            now = begin_impact(system, manner, drop, parts, now.state, sphere)
        elif now.phase == IN_CONTACT or now.phase == HELD:
            now = follow_impact(bases, bodies, manner, drop, parts, now)
            if now.phase == IN_CONTACT:  # there is no room
                break
            if now.phase == IN_FLIGHT or now.phase >= 0:
                write_impact(system, manner, drop, parts, now)
        else:
            break
    return now


@compiled
def fly(system: System, manner: ImpactManner, drop: VibratingDrop, parts: Parts, now: Now) -> Now:
    """Return where a drop is after its flight: at its next touch, or where a rule ends its run."""
    flight = next_flight(system, manner, drop, now.state)
    end, ending = first_end(manner.stops, flight, drop.counts[IMPACTS])
    time = min(end, flight.touch)
    after = state_after(system, now.state, time - flight.start)
    write_flight(system, drop, parts, now.state, after, time)
    phase = AT_TOUCH
    if flight.touch >= end:
        drop.state[END_TIME] = end
        phase = ending
    return Now(phase, after, now.begun, now.law, now.manner, now.progress, now.contacts)


@compiled
def next_flight(
    system: System, manner: ImpactManner, drop: VibratingDrop, state: State
) -> FreeFall:
    """Return the flight that a drop is about to make until its surfaces touch."""
    start = drop.state[TIME]
    velocity = drop.state[VELOCITY]
    gravity = drop.state[GRAVITY]
    top = start
    if velocity > 0.0 and gravity == 0.0:
        top = math.inf
    elif velocity > 0.0:
        top = start + velocity / gravity
    level, _, _, _, _ = levels_at(manner.addresses[2])(drop.coefficients)
    touch = start + next_touch(system, state, level, np.inf)
    return FreeFall(start, top, touch, math.nan, False)


@compiled
def write_flight(
    system: System, drop: VibratingDrop, parts: Parts, before: State, after: State, time: float
) -> None:
    """Write a flight between two states that ends at a time [s], and what it took."""
    start = drop.state[TIME]
    write_free(parts, FLIGHT, start, time - start, before, OF_IMPACT)
    gone = lost_in_flight(system, before, after)
    for coordinate in range(len(gone)):
        drop.lost[coordinate] += gone[coordinate]
    drop.state[TIME] = time
    drop.state[CLOSING] = -separation_speed(system, after)
    write_centre(drop.state, after)


@compiled
def write_centre(numbers: Vector, state: State) -> None:
    """Write where the sphere's centre is, and its velocity, to the numbers of a drop."""
    # the fall of the sphere is a coordinate of unit mass, q = sqrt(m) times the way down
    root = math.sqrt(numbers[MASS])
    numbers[GAP] = -state.displacement[0] / root
    numbers[VELOCITY] = -state.velocity[0] / root


@compiled
def write_impact(
    system: System, manner: ImpactManner, drop: VibratingDrop, parts: Parts, now: Now
) -> None:
    """Write the row of an impact that has ended, and what it has made of the drop."""
    numbers = drop.state
    impacts = drop.counts[IMPACTS]
    row = drop.rows[impacts]
    drop.counts[IMPACTS] = impacts + 1
    progress = now.progress
    peaks = progress.peaks
    touch = numbers[TIME]
    gravity = numbers[GRAVITY]
    stored = energy_in_contact(now)
    row[IMPACT] = impacts + 1
    row[TOUCH] = touch
    row[APPROACH] = numbers[CLOSING]
    row[DURATION] = progress.time
    row[INDENTATION] = peaks.indentation
    row[TIME_OF_INDENTATION] = touch + peaks.time_of_indentation
    row[FORCE] = peaks.force
    row[TIME_OF_FORCE] = touch + peaks.time_of_force
    row[ACCELERATION] = max(peaks.force / numbers[MASS] - gravity, gravity)
    row[PLASTIC_WORK] = progress.plastic
    row[LEFT_STORED] = stored
    row[DENT_BEFORE] = numbers[DENT]
    row[CONTACTS] = now.contacts
    write_vibration(system, drop, now, row)
    numbers[TIME] = touch + progress.time
    numbers[DEEPEST] = max(numbers[DEEPEST], peaks.indentation)
    write_centre(numbers, now.state)
    row[RELEASE_GAP] = numbers[GAP]
    row[RELEASE_VELOCITY] = numbers[VELOCITY]
    write_losses(drop, now, stored, row)
    write_separation(system, drop, now, row)
    if manner.lasts:
        for law in range(int(row[FIRST_LAW]), parts.written[LAWS]):
            if parts.compressed[law] > numbers[DENT]:
                numbers[DENT] = parts.compressed[law]
    fresh = drop.laws[min(impacts + 1, len(drop.laws) - 1)]
    remember(manner.addresses, manner.lasts, fresh, numbers[DENT], drop.coefficients)
    if now.phase >= 0:
        numbers[END_TIME] = numbers[TIME]


@compiled
def write_vibration(system: System, drop: VibratingDrop, now: Now, row: Vector) -> None:
    """Write what vibration gained in an impact, and add what it lost to that of the drop."""
    # vibration gains what it has more at the end, and what it has lost on the way; a driven
    # coordinate loses minus the work of its drive
    lost = drop.lost_in_impact
    own = len(lost) - 1 - system.driven
    gained = vibration_energy(system, now.state) - vibration_energy(system, now.begun)
    drive = 0.0
    for coordinate in range(len(lost) - 1):
        drop.lost[coordinate] += lost[coordinate]
        if coordinate < own:
            gained += lost[coordinate]
        else:
            drive -= lost[coordinate]
    row[CLOSING_SPEED] = dashpot_rate(system, now.begun)
    row[TO_VIBRATION] = gained
    row[DRIVE_WORK] = drive
    row[SURFACE_VELOCITY] = driven_rate(system, now.begun)


@compiled
def write_losses(drop: VibratingDrop, now: Now, stored: float, row: Vector) -> None:
    """Write what was lost in the contacts of an impact; `stored`: in the last one at its end [J].

    That is lost, too, unless the sphere stays.
    """
    numbers = drop.state
    damped = drop.lost_in_impact[len(drop.lost_in_impact) - 1]
    stays = now.phase >= 0 and now.phase != END_FAILED and now.phase != END_BY_REST_SPEED
    lost = damped if stays else damped + stored
    row[DAMPED] = damped
    row[LOST] = lost + now.progress.plastic
    numbers[DISSIPATED] += lost
    numbers[PLASTIC] += now.progress.plastic
    if stays:
        numbers[STORED] = stored


@compiled
def write_separation(system: System, drop: VibratingDrop, now: Now, row: Vector) -> None:
    """Write how the sphere separates after an impact, and how high it rises.

    One that rides has no separation speed. From a shaken plate its rise is not that of its velocity
    relative to the plate.
    """
    numbers = drop.state
    phase = now.phase
    separation = separation_speed(system, now.state)
    if phase in (END_CAPTURED, END_STUCK):
        separation = 0.0
    elif phase >= 0 and phase != END_BY_REST_SPEED:
        separation = math.nan
    row[SEPARATION] = separation
    row[RESTITUTION] = separation / row[APPROACH]
    rising = separation
    if system.driven > 0 and phase < 0:
        rising = max(numbers[VELOCITY], 0.0)
    if numbers[GRAVITY] > 0.0:
        rise = 0.5 * rising * rising / numbers[GRAVITY]
        row[REBOUND] = numbers[RADIUS] + numbers[GAP] + rise
