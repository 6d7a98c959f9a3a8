"""One contact from touch to release, where bodies vibrate: stretches of contact, the events that
end them, and recoil.

Each stretch is searched for its first event: separation, zero force of a law that may not pull, a
breakpoint of the law, a turn of the approach at which the law's memory changes. It is then solved
again so that it ends there. Once the law has stopped pushing while the surfaces still overlap, they
recoil without a force until they separate or it pushes again.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Vector
from vibroimpact.compiled import compiled, energies_at
from vibroimpact.dynamics.core.attempt import beginning_of
from vibroimpact.dynamics.core.coasting import end_of_coasting
from vibroimpact.dynamics.core.contact_peaks import peaks_since
from vibroimpact.dynamics.core.contact_records import (
    PARTS,
    RECOIL,
    Begun,
    Bodies,
    Manner,
    Parts,
    Progress,
)
from vibroimpact.dynamics.core.events import (
    ENDS_AT_NO_FORCE,
    NO_EVENT,
    NO_PUSH,
    PARTED,
    TENSION_CUT,
    TURN,
)
from vibroimpact.dynamics.core.flight import approach_of, lost_in_flight, state_after
from vibroimpact.dynamics.core.law import law_after, law_indentation, stored_energy
from vibroimpact.dynamics.core.next_stretch import end_of, length_growth, next_stretch
from vibroimpact.dynamics.core.parts import (
    has_room,
    lose_at_end,
    write_free,
    write_law,
    write_next,
)
from vibroimpact.dynamics.core.records import Bases, Law, State, System
from vibroimpact.dynamics.core.rest import is_captured, is_near_rest
from vibroimpact.dynamics.core.surface_friction import flown
from vibroimpact.dynamics.core.touch import time_to_separation

RELEASED, CAPTURED, RIDES, TOO_STIFF, MAY_REST, FULL = range(6)
"""How a contact goes on: released; too little energy to leave; in contact at the end of the time or
of the steps; not to be integrated; near equilibrium, which is to be looked at; no room for a
further part.
"""

ROUNDING = 1e-14  # of the deepest indentation
_TIME_ROUNDING = 1e-11  # of the duration of a contact
NO_FORCE = 1e-10  # of the largest force
ZERO_RATE = 1e-9  # of the speed of the motion: a slower approach counts as having turned already
SHORTEST = 1e-12  # of the duration of a contact
_LONG = 10.0  # in durations of a contact: a sphere in contact for longer rides
_NOTHING = 2e-15  # of the energy of the motion: less is a rounding error


@compiled
def separates_at_no_force(system: System, law: Law, manner: Manner, state: State) -> bool:
    """Does a contact end with its force? Its law does, and the surfaces will separate;
    otherwise they close again.
    """
    if manner.contact_end != ENDS_AT_NO_FORCE:
        return False
    return bool(np.isfinite(time_to_separation(system, state, law.release_level)))


@compiled
def energy_held(law: Law, manner: Manner, delta: float) -> float:
    """Return the energy that a contact stores at an indentation of its law [J], with
    rounding errors set to zero.
    """
    held = stored_energy(law, delta)
    if abs(held) > _NOTHING * manner.energy:
        return held
    return 0.0


@compiled
def indentation_in(system: System, law: Law, state: State) -> float:
    """Return the indentation of a law in a state [m], at least that of release."""
    return law_indentation(law, max(approach_of(system, state)[0], law.release_level))


@compiled
def plastic_work(law: Law, delta: float) -> float:
    """Return the plastic work of a law since its memory last changed [J], at an indentation [m]."""
    _, plastic = energies_at(law.addresses[1])(delta, law.coefficients)
    return float(plastic)


@compiled
def law_turned(law: Law, number: int, delta: float, parts: Parts) -> tuple[Law, int]:
    """Return a law, and its number in `parts`, after the indentation has turned at its largest [m];
    `number`: that of the law before.
    """
    after = law_after(law, delta)
    return after, write_law(parts, number, delta, after)


@compiled
def follow_contact(
    bases: Bases,
    bodies: Bodies,
    manner: Manner,
    law: Law,
    state: State,
    progress: Progress,
    lost: Vector,
    parts: Parts,
) -> tuple[int, Progress, State, Law]:
    """Follow a contact until it is released, or until something is to be decided; return how it
    goes on.

    Parameters
    ----------
    bases : Bases
        The Radau rule under the three maps of time.
    bodies : Bodies
        The linear system.
    manner : Manner
        What stays the same through the contact.
    law : Law
        The law, with its memory of the last call.
    state, progress : State, Progress
        Where the last call ended, or the touch.
    lost : array, shape (n + 1,)
        Energy lost in each coordinate, and last in the contact [J], to which is added.
    parts : Parts
        The parts of the motion, to which is added.
    """
    system = bodies.system
    time = progress.time
    next_length = progress.next_length
    delta = progress.delta
    force = progress.force
    trend = progress.trend
    closing = progress.closing
    fresh = progress.fresh
    pushes = progress.pushes
    steps = progress.steps
    number = progress.law
    plastic = progress.plastic
    largest_force = progress.largest_force
    deepest = progress.deepest
    peaks = progress.peaks
    sphere = progress.sphere
    elements = len(lost) - 1
    nodes = parts.force.shape[1]
    under_law = parts.written[PARTS]  # the first part under the law as it is now
    outcome = FULL
    while has_room(parts):
        if not pushes:  # recoil
            length, separates = end_of_coasting(system, law, manner, state)
            if not np.isfinite(length):
                outcome = TOO_STIFF
                break
            after = state_after(system, state, length)
            write_free(parts, RECOIL, time, length, state, number)
            gone = lost_in_flight(system, state, after)
            held = stored_energy(law, indentation_in(system, law, state))
            left = stored_energy(law, indentation_in(system, law, after))
            for coordinate in range(len(lost)):
                lost[coordinate] += gone[coordinate]
            lost[elements] += held - left
            time += length
            state = after
            sphere = flown(sphere, length)
            if separates:
                outcome = RELEASED
                break
            pushes = True
            delta = indentation_in(system, law, state)
            trend = 0.0
            continue

        steps += 1
        rides = time - manner.begun > _LONG * manner.span
        remaining = manner.until - time
        if steps > manner.most_steps or (rides and remaining <= _TIME_ROUNDING * manner.span):
            outcome = RIDES
            break
        longest = manner.longest
        if rides:
            longest = min(remaining, longest)
        turned = False
        if not fresh:  # events at the end of the last stretch: it is within rounding of them
            approach, rate = approach_of(system, state)
            overlap = max(approach - law.release_level, 0.0)
            if overlap <= ROUNDING * deepest and rate < 0.0:
                lose_at_end(parts, lost, energy_held(law, manner, law.release))
                outcome = RELEASED
                break
            if manner.tension == TENSION_CUT and force <= NO_FORCE * largest_force and trend < 0.0:
                if separates_at_no_force(system, law, manner, state):
                    lose_at_end(parts, lost, energy_held(law, manner, delta))
                    outcome = RELEASED
                    break
                pushes = False
                continue
            turned = closing <= ZERO_RATE * manner.motion_speed and delta > law.memory_level
        if turned:
            peaks = peaks_since(bases, law, peaks, parts, under_law, largest_force, deepest)
            under_law = parts.written[PARTS]
            plastic += plastic_work(law, delta)
            law, number = law_turned(law, number, delta, parts)
        if next_length < SHORTEST * manner.span:
            outcome = TOO_STIFF
            break

        beginning = beginning_of(bodies, law, manner, state, sphere, delta)
        length = min(next_length, longest)
        time_map = 0 if fresh else 1
        stretch = next_stretch(bases, bodies, manner, beginning, time_map, length, trend)
        if not stretch.accepted:
            # it is not resolved, or its event is not met: half of it, or of the way to the event
            next_length = 0.5 * min(next_length, stretch.event_time)
            continue
        part = parts.written[PARTS]
        write_next(parts, bases, system, stretch, Begun(time, state, number, sphere), lost)
        end = end_of(bases, stretch)
        state = end.state
        sphere = end.sphere
        time += end.length
        delta = end.delta
        force = end.force
        closing = end.closing
        trend = end.trend
        largest_force = max(largest_force, end.largest_force)
        for node in range(1, parts.indentation.shape[1]):
            deepest = max(deepest, parts.indentation[part, node])
        event = stretch.event
        fresh = False
        if event.kind == NO_EVENT:
            next_length = end.length * length_growth(end.roughness, manner.tolerance, nodes)
        elif event.kind == PARTED or (
            event.kind == NO_PUSH and separates_at_no_force(system, law, manner, state)
        ):
            # stored energy is lost where a sticking contact breaks, or where the surface recovers
            # more slowly than the bodies part
            lose_at_end(parts, lost, energy_held(law, manner, delta))
            outcome = RELEASED
            break
        elif event.kind == NO_PUSH:
            pushes = False
        elif event.kind == TURN:
            peaks = peaks_since(bases, law, peaks, parts, under_law, largest_force, deepest)
            under_law = parts.written[PARTS]
            plastic += plastic_work(law, delta)
            law, number = law_turned(law, number, delta, parts)
        if pushes:
            if is_captured(system, law, manner, state, delta):
                outcome = CAPTURED
                break
            if is_near_rest(system, law, state, force):
                outcome = MAY_REST
                break
    peaks = peaks_since(bases, law, peaks, parts, under_law, largest_force, deepest)
    now = Progress(
        time,
        next_length,
        delta,
        force,
        trend,
        closing,
        fresh,
        pushes,
        steps,
        number,
        plastic,
        largest_force,
        deepest,
        peaks,
        sphere,
    )
    return outcome, now, state, law
