"""The impact of a sphere on a surface, from first touch to the last release, where bodies vibrate.

After separation the sphere is followed to the top of its flight: if the surfaces touch again
before, the impact continues with another contact. It also continues where the sphere separates more
slowly than the rest speed while the vibration could still lift it: it chatters and then rides,
until it separates, no energy is left to lift it, or a limit of stretches or time is reached.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Integers, Vector
from vibroimpact.compiled import compiled, force_at, levels_at
from vibroimpact.dynamics.core.contact import (
    CAPTURED,
    FULL,
    MAY_REST,
    RELEASED,
    RIDES,
    follow_contact,
    indentation_in,
    plastic_work,
)
from vibroimpact.dynamics.core.contact_records import (
    APART,
    LAWS,
    OF_IMPACT,
    PARTS,
    Bodies,
    Manner,
    Parts,
    Peaks,
    Progress,
)
from vibroimpact.dynamics.core.drop_records import (
    END_BY_DURATION,
    END_BY_REST_SPEED,
    END_CAPTURED,
    END_FAILED,
    END_RIDING,
    END_STUCK,
    GRAVITY,
    IN_FLIGHT,
    MASS,
    REST_SPEED,
    TIME,
)
from vibroimpact.dynamics.core.drops import depth_and_speed, elastic_energy
from vibroimpact.dynamics.core.flight import (
    approach_of,
    dashpot_rate,
    lost_in_flight,
    mechanical_energy,
    separation_speed,
    state_after,
)
from vibroimpact.dynamics.core.law import law_after, law_at_touch, stored_energy
from vibroimpact.dynamics.core.parts import write_free, write_law
from vibroimpact.dynamics.core.records import Bases, Law, State, System
from vibroimpact.dynamics.core.static import static_indentation
from vibroimpact.dynamics.core.stop_rules import is_too_slow
from vibroimpact.dynamics.core.surface_friction import flown
from vibroimpact.dynamics.core.surface_friction_records import SlidingSphere
from vibroimpact.dynamics.core.touch import next_touch, time_to_separation
from vibroimpact.dynamics.core.vibrating_records import (
    FIRST_LAW,
    FIRST_PART,
    HELD,
    IMPACTS,
    IN_CONTACT,
    NEAR_REST,
    ImpactManner,
    Now,
    VibratingDrop,
)

FIRST_LENGTH = 0.125  # of the duration of a contact: length of the first stretch
_LEAST_SPEED = 1e-300


@compiled
def closing_speed(system: System, state: State) -> float:
    """Return the closing speed of the surfaces [m/s], > 0.

    It is the larger of the rates with and without the coordinates inside the contact: a surface may
    meet the other by its own vibration while the centre hardly moves.
    """
    _, rate = approach_of(system, state)
    return max(dashpot_rate(system, state), rate, _LEAST_SPEED)


@compiled
def motion_speed(
    addresses: Integers, coefficients: Vector, system: System, closing: float
) -> float:
    """Return the speed scale of the motion in a contact [m/s].

    It is the closing speed, or the speed that gravity adds at a soft touch.
    """
    # v^2/g is twice the height from which a fall has this speed
    if system.gravity <= 0.0:
        return closing
    weight = system.mass * system.gravity
    fall_height = closing * closing / system.gravity
    static, _ = force_at(addresses[0])(fall_height, 0.0, closing, coefficients)
    if static >= weight:
        return closing  # the sphere sinks in by less than that height
    _, release, _, _, _ = levels_at(addresses[2])(coefficients)
    sag = static_indentation(addresses, coefficients, release, weight)
    return max(closing, math.sqrt(max(system.gravity * sag, 0.0)))


@compiled
def manner_at_touch(
    system: System,
    manner: ImpactManner,
    drop: VibratingDrop,
    state: State,
    sphere: SlidingSphere,
) -> Manner:
    """Return what stays the same through an impact, from the state at its first touch.

    The duration of Hertz's contact goes with the 0.4th power of the mass; a free plate reduces the
    effective mass.
    """
    mass = drop.state[MASS]
    none = np.zeros(len(manner.series))
    law = law_at_touch(manner.addresses, drop.coefficients, none, dashpot_rate(system, state))
    # Hertz: a contact lasts 2.94 depth/speed
    depth, speed = depth_and_speed(law, manner.contact_end, mass, drop.state[GRAVITY])
    span = 3.0 * (system.mass / mass) ** 0.4 * depth / speed
    speed_of_motion = motion_speed(
        manner.addresses, drop.coefficients, system, closing_speed(system, state)
    )
    longest = manner.longest
    if sphere.directions:
        longest = min(longest, manner.of_contact * span)
    return Manner(
        manner.tension,
        manner.contact_end,
        speed_of_motion,
        0.5 * system.mass * speed_of_motion * speed_of_motion,
        span,
        manner.tolerance,
        0.0,
        manner.run_end - drop.state[TIME],
        longest,
        manner.most_steps,
    )


@compiled
def begin_impact(
    system: System,
    manner: ImpactManner,
    drop: VibratingDrop,
    parts: Parts,
    state: State,
    sphere: SlidingSphere,
) -> Now:
    """Return where a drop is as its impact begins; `sphere`: friction at first touch."""
    of_contact = manner_at_touch(system, manner, drop, state, sphere)
    for coordinate in range(len(drop.lost_in_impact)):
        drop.lost_in_impact[coordinate] = 0.0
    row = drop.rows[drop.counts[IMPACTS]]
    row[FIRST_PART] = parts.written[PARTS]
    row[FIRST_LAW] = parts.written[LAWS]
    untouched = Progress(
        0.0,
        np.inf,
        0.0,
        np.inf,
        0.0,
        np.inf,
        True,
        True,
        0,
        OF_IMPACT,
        0.0,
        0.0,
        0.0,
        Peaks(0.0, 0.0, 0.0, 0.0),
        sphere,
    )
    law, progress = begin_contact(
        system, manner, drop.coefficients, of_contact.span, state, untouched, parts
    )
    return Now(IN_CONTACT, state, state, law, of_contact, progress, 1)


@compiled
def begin_contact(
    system: System,
    manner: ImpactManner,
    coefficients: Vector,
    span: float,
    state: State,
    progress: Progress,
    parts: Parts,
) -> tuple[Law, Progress]:
    """Return the law of a contact as the surfaces touch, and how far the impact has come.

    Parameters
    ----------
    system, manner : System, ImpactManner
        The bodies, and what stays the same.
    coefficients : array, shape (K,)
        Of the law.
    span : float
        About the duration of the contact [s].
    state : State
        At touch.
    progress : Progress
        At the end of the contact before; its `law` is the number of that which is made anew.
    parts : Parts
        Where the law is written.
    """
    closing = closing_speed(system, state)
    law = law_at_touch(manner.addresses, coefficients.copy(), manner.series, closing)
    number = write_law(parts, progress.law, np.nan, law)
    begun = Progress(
        progress.time,
        min(progress.next_length, FIRST_LENGTH * span),
        indentation_in(system, law, state),
        np.inf,
        0.0,
        np.inf,
        True,
        True,
        progress.steps,
        number,
        progress.plastic,
        0.0,
        0.0,
        progress.peaks,
        progress.sphere,
    )
    return law, begun


@compiled
def with_law(
    progress: Progress, time: float, law: int, plastic: float, sphere: SlidingSphere
) -> Progress:
    """Return how far an impact has come at another time [s], with another law, plastic work [J] and
    friction.
    """
    return Progress(
        time,
        progress.next_length,
        progress.delta,
        progress.force,
        progress.trend,
        progress.closing,
        progress.fresh,
        progress.pushes,
        progress.steps,
        law,
        plastic,
        progress.largest_force,
        progress.deepest,
        progress.peaks,
        sphere,
    )


@compiled
def separates_slower_than(system: System, touch: float, state: State, speed: float) -> bool:
    """Does a sphere apart from the surface lack the energy to reach a separation speed [m/s]?

    `touch`: indentation of the law at the next touch [m]. Where something is driven it never does.
    """
    if system.driven > 0:
        return False
    # E(y) of `vibrating.contact_equilibrium` at touch, where the contact stores nothing
    weight = system.mass * system.gravity
    least = -weight * touch - 0.5 * system.compliance * weight * weight
    return bool(mechanical_energy(system, state) < least + 0.5 * system.mass * speed * speed)


@compiled
def next_contact(
    system: System, manner: ImpactManner, drop: VibratingDrop, now: Now
) -> tuple[float, bool]:
    """Return when the surfaces touch again in an impact after a release [s from here], infinite if
    they do not, and whether it is the same law that acts then.

    The sphere is followed to the top of its flight, and one that separates below the rest speed
    without limit. Where the next contact meets undeformed surfaces, the impact continues at least
    until these have separated. Where the plate is shaken, it continues as long as the surfaces meet
    more slowly than the rest speed: any faster touch is an impact of its own.
    """
    state = now.state
    separation = separation_speed(system, state)
    is_slow = is_too_slow(separation, drop.state[REST_SPEED]) and system.gravity > 0.0
    is_shaken = system.driven > 0
    top = np.inf
    if separation > 0.0 and system.gravity != 0.0 and not (is_slow or is_shaken):
        top = separation / system.gravity
    levels = levels_at(manner.addresses[2])
    touch, _, _, _, _ = levels(drop.coefficients)
    dent_touch, dent_release, _, _, _ = levels(now.law.coefficients)
    parted = time_to_separation(system, state, touch)
    time = np.inf
    in_dent = False
    # surfaces that still overlap where they are undeformed may meet in the dent before they part
    if dent_release > touch:
        time = next_touch(system, state, dent_release, parted)
        in_dent = time < parted
    is_same = in_dent or not manner.recovers
    if not in_dent:
        level = dent_touch if is_same else touch
        time = next_touch(system, state, level, max(top, parted))
    if not np.isfinite(time):
        return np.inf, is_same
    if is_slow and separation > 0.0 and time > now.manner.until - now.progress.time:
        return np.inf, is_same  # after the end of the run
    if is_shaken and separation >= 0.0:
        _, rate = approach_of(system, state_after(system, state, time))
        if rate >= drop.state[REST_SPEED]:
            return np.inf, is_same
    return time, is_same


@compiled
def touch_again(
    system: System,
    manner: ImpactManner,
    drop: VibratingDrop,
    parts: Parts,
    now: Now,
    time: float,
    is_same: bool,
) -> Now:
    """Return where a drop is after free motion to its next contact in an impact.

    `time` [s], `is_same`: as `next_contact` gives them; where the time is infinite, the surfaces
    touch at once.
    """
    state = now.state
    progress = now.progress
    sphere = progress.sphere
    begun = progress.time
    if np.isfinite(time):
        after = state_after(system, state, time)
        write_free(parts, APART, progress.time, time, state, progress.law)
        gone = lost_in_flight(system, state, after)
        for coordinate in range(len(gone)):
            drop.lost_in_impact[coordinate] += gone[coordinate]
        state = after
        sphere = flown(sphere, time)
        begun = progress.time + time
    number = progress.law
    coefficients = now.law.coefficients
    if not is_same:
        coefficients = drop.coefficients
        number = progress.law if manner.lasts else OF_IMPACT
    law, at_touch = begin_contact(
        system,
        manner,
        coefficients,
        now.manner.span,
        state,
        with_law(progress, begun, number, progress.plastic, sphere),
        parts,
    )
    of_contact = Manner(
        now.manner.tension,
        now.manner.contact_end,
        now.manner.motion_speed,
        now.manner.energy,
        now.manner.span,
        now.manner.tolerance,
        begun,
        now.manner.until,
        now.manner.longest,
        now.manner.most_steps,
    )
    return Now(IN_CONTACT, state, now.begun, law, of_contact, at_touch, now.contacts + 1)


@compiled
def follow_impact(
    bases: Bases, bodies: Bodies, manner: ImpactManner, drop: VibratingDrop, parts: Parts, now: Now
) -> Now:
    """Follow an impact to its end, or until something is to be decided.

    The phase then is `IN_FLIGHT`, or how the run has ended with the impact; `NEAR_REST`, or
    `IN_CONTACT` where there is no room for further parts.
    """
    system = bodies.system
    while True:
        outcome = CAPTURED
        if now.phase != HELD:
            outcome, progress, state, law = follow_contact(
                bases,
                bodies,
                now.manner,
                now.law,
                now.state,
                now.progress,
                drop.lost_in_impact,
                parts,
            )
            now = Now(IN_CONTACT, state, now.begun, law, now.manner, progress, now.contacts)
        if outcome == FULL:
            return now
        if outcome == MAY_REST:
            return in_phase(now, NEAR_REST)
        if outcome != RELEASED:
            return stayed(manner, drop, parts, now, outcome)
        if manner.lasts:
            for number in range(len(drop.coefficients)):
                drop.coefficients[number] = now.law.coefficients[number]
        speed = separation_speed(system, now.state)
        rest_speed = drop.state[REST_SPEED]
        touch, _, _, _, _ = levels_at(manner.addresses[2])(drop.coefficients)
        is_slow = speed > 0.0 and is_too_slow(speed, rest_speed) and system.gravity > 0.0
        if is_slow and separates_slower_than(system, touch, now.state, rest_speed):
            return settled(system, manner, drop, parts, now, touch)
        time, is_same = next_contact(system, manner, drop, now)
        if not np.isfinite(time) and speed >= 0.0:
            return in_phase(now, IN_FLIGHT)
        # where the sphere does not separate, the next touch is within rounding of this one
        now = touch_again(system, manner, drop, parts, now, time, is_same)


@compiled
def in_phase(now: Now, phase: int) -> Now:
    """Return where a drop is, in another phase."""
    return Now(phase, now.state, now.begun, now.law, now.manner, now.progress, now.contacts)


@compiled
def settled(
    system: System, manner: ImpactManner, drop: VibratingDrop, parts: Parts, now: Now, touch: float
) -> Now:
    """Return where a drop is that lacks the energy to leave the plate again, after a release.

    Its law is that of the next contact where that is above the dent; `touch`: its indentation then
    [m].
    """
    law = now.law
    progress = now.progress
    approach, _ = approach_of(system, now.state)
    if approach <= touch:
        origin = progress.law if manner.lasts else OF_IMPACT
        law = law_at_touch(manner.addresses, drop.coefficients.copy(), manner.series, now.law.speed)
        number = write_law(parts, origin, np.nan, law)
        progress = with_law(progress, progress.time, number, progress.plastic, progress.sphere)
    return Now(END_BY_REST_SPEED, now.state, now.begun, law, now.manner, progress, now.contacts)


@compiled
def stayed(manner: ImpactManner, drop: VibratingDrop, parts: Parts, now: Now, outcome: int) -> Now:
    """Return where a drop is whose impact ends in contact; `outcome`: of the contact.

    The law keeps its memory of the largest indentation.
    """
    law = now.law
    progress = now.progress
    delta = progress.delta
    if delta > law.memory_level:
        plastic = progress.plastic + plastic_work(law, delta)
        law = law_after(law, delta)
        number = write_law(parts, progress.law, delta, law)
        progress = with_law(progress, progress.time, number, plastic, progress.sphere)
    phase = END_FAILED
    if outcome == CAPTURED:
        _, release, _, _, _ = levels_at(manner.addresses[2])(law.coefficients)
        # a law that stores energy at release adheres: it holds the sphere
        phase = END_CAPTURED
        if elastic_energy(law, release) > 0.0:
            phase = END_STUCK
    elif outcome == RIDES:
        phase = END_RIDING
        if drop.state[TIME] + progress.time >= manner.run_end:
            phase = END_BY_DURATION
    return Now(phase, now.state, now.begun, law, now.manner, progress, now.contacts)


@compiled
def energy_in_contact(now: Now) -> float:
    """Return the energy that the contact stores at the end of an impact [J]."""
    if now.phase == IN_FLIGHT or now.phase == END_BY_REST_SPEED:
        return 0.0  # they have separated
    return float(stored_energy(now.law, now.progress.delta))
