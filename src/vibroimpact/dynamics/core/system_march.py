"""Time marching of a system of several bodies through its contacts.

Flights are known in closed form: while no contact pushes, the march advances to the next touch.
Otherwise it advances by stretches of the contacts that push, which are solved together. Each is
searched for its first event: separation, zero force of a law that may not pull, a breakpoint of a
law, a turn of an approach, or an event at another contact (`system_events`). The stretch is then
solved again so that it ends there.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Bools, Integers, Vector
from vibroimpact.compiled import Lent, compiled
from vibroimpact.dynamics.core.attempt import attempt, balance_of, basis_of, time_at, up_to_event
from vibroimpact.dynamics.core.coasting import end_of_coasting
from vibroimpact.dynamics.core.contact import (
    NO_FORCE,
    ROUNDING,
    SHORTEST,
    ZERO_RATE,
    energy_held,
    indentation_in,
    plastic_work,
    separates_at_no_force,
)
from vibroimpact.dynamics.core.contact_records import (
    Attempt,
    Balance,
    Beginning,
    Manner,
)
from vibroimpact.dynamics.core.depths import undamped_depth
from vibroimpact.dynamics.core.events import NO_EVENT, NO_PUSH, PARTED, TENSION_CUT, TURN
from vibroimpact.dynamics.core.flight import approach_of, lost_in_flight, state_after
from vibroimpact.dynamics.core.impacts import FIRST_LENGTH, closing_speed, motion_speed
from vibroimpact.dynamics.core.law import (
    law_after,
    law_at_touch,
    law_of,
    room_for_laws,
    stored_energy,
    write_law_of,
)
from vibroimpact.dynamics.core.linear import largest_of
from vibroimpact.dynamics.core.next_stretch import length_growth
from vibroimpact.dynamics.core.records import (
    TOUCH,
    Bases,
    Basis,
    Event,
    Nodes,
    State,
    System,
)
from vibroimpact.dynamics.core.stretch import begun_indentations
from vibroimpact.dynamics.core.surface_friction_records import SlidingSphere, SlidStretch
from vibroimpact.dynamics.core.system_events import (
    NONE,
    SEPARATES,
    TOUCHES,
    TOUCHES_DENT,
    first_other_event,
    release_of,
    value_at_end,
)
from vibroimpact.dynamics.core.system_parts import (
    add_impact,
    has_room,
    lose_stored,
    write_flight,
    write_law,
    write_peaks,
    write_stretch,
)
from vibroimpact.dynamics.core.system_points import (
    group_of,
    start_of,
    state_at,
    state_now,
    state_of,
    system_at,
)
from vibroimpact.dynamics.core.system_records import (
    APART,
    CLOSING,
    DEEPEST,
    DELTA,
    END,
    FORCE,
    LARGEST_FORCE,
    MOTION_SPEED,
    NEXT_LENGTH,
    NOW,
    PARTS,
    PLASTIC,
    PUSHING,
    RATE,
    RECOILING,
    SLACK,
    SPAN,
    STRETCHES,
    TREND,
    ContactPoints,
    Group,
    MarchManner,
    OtherEvent,
    SystemMarch,
    SystemParts,
)
from vibroimpact.dynamics.core.touch import approach_in, next_touch, time_apart, time_to_separation

ENDED, FULL, TOO_STIFF, PAUSED = range(4)
"""How a march goes on: it has come to its end; there is no room for a further part; a contact can't
be integrated; it has tried as many stretches as it was to.
"""

_TOUCH_SLACK = 1e-12
"""Of the deepest indentation: a smaller overlap is no touch while other contacts push."""
_SAME_TIME = 1e-13
_BOUND = 1.0 - 1e-9  # of a time that rounding may exceed
_SLOW = 1e-3
"""Of the closing speeds of the impacts under way: surfaces that touch more slowly are pressed
together by these.
"""
_MOST_CORRECTIONS = 8  # of the length of a stretch that ends at an event of another contact
_MOST_LONGER = 1.01  # of the length of a stretch: no correction goes further
_EXACT = 1e-13  # of the length of a stretch


@compiled
def march_on(
    bases: Lent[Bases],
    system: Lent[System],
    points: Lent[ContactPoints],
    march: Lent[SystemMarch],
    parts: Lent[SystemParts],
    no_friction: SlidingSphere,
    manner: MarchManner,
) -> int:
    """March until the end, or until something is to be decided; return how it goes on.

    A contact in progress is cut off at the end.

    Parameters
    ----------
    bases : Bases
        The Radau rule under the three maps of time.
    system : System
        All coordinates; its contact is of no account.
    points : ContactPoints
        The contacts.
    march, parts : SystemMarch, SystemParts
        Where the system is, and the parts of its motion, to which is written.
    no_friction : SlidingSphere
        Stands for friction, which contacts of systems do not have.
    manner : MarchManner
        What stays the same.
    """
    group = group_of(points, np.zeros(1, np.int64), len(march.displacement))
    while march.numbers[NOW] < manner.until:
        pushing = contacts_in(march, PUSHING)
        if len(pushing) and has_ended_at_once(points, march, parts, pushing):
            continue
        if march.counts[STRETCHES] == manner.pause:
            return PAUSED
        if not has_room(parts, len(march.phase)):
            return FULL
        march.counts[STRETCHES] += 1
        longest = manner.until - march.numbers[NOW]
        if not len(pushing):
            fly(system, points, march, parts, longest)
            continue
        if not are_same(group.contacts, pushing):
            group = group_of(points, pushing, len(march.displacement))
        if march.numbers[NEXT_LENGTH] < SHORTEST * shortest_span(march, pushing):
            return TOO_STIFF
        go_through_stretch(
            bases, system, points, march, parts, group, no_friction, manner.tolerance, longest
        )
    return ENDED


@compiled
def contacts_in(march: SystemMarch, phase: int) -> Integers:
    """Return the numbers of the contacts in a phase."""
    count = 0
    for contact in range(len(march.phase)):
        if march.phase[contact] == phase:
            count += 1
    contacts = np.empty(count, np.int64)
    count = 0
    for contact in range(len(march.phase)):
        if march.phase[contact] == phase:
            contacts[count] = contact
            count += 1
    return contacts


@compiled
def are_same(some: Integers, others: Integers) -> bool:
    """Are numbers the same as others?"""
    same = len(some) == len(others)
    for index in range(min(len(some), len(others))):
        same = same and some[index] == others[index]
    return bool(same)


@compiled
def shortest_span(march: SystemMarch, contacts: Integers) -> float:
    """Return the shortest duration of some contacts [s]."""
    span = math.inf
    for contact in contacts:
        span = min(span, march.of_contact[contact, SPAN])
    return span


@compiled
def same_time(march: SystemMarch, length: float) -> float:
    """Return until when surfaces touch at the same time as after a length [s]."""
    return float(length + _SAME_TIME * (march.numbers[NOW] + length))


@compiled
def manner_of(points: ContactPoints, march: SystemMarch, contact: int) -> Manner:
    """Return what stays the same through an impact of a contact."""
    speed = march.of_contact[contact, MOTION_SPEED]
    return Manner(
        march.acting.tension[contact],
        points.contact_end[contact],
        speed,
        0.5 * points.mass[contact] * speed * speed,
        march.of_contact[contact, SPAN],
        0.0,
        march.numbers[NOW],
        math.inf,
        math.inf,
        0,
    )


# without contact forces
# -------------------------------------------------------------------------


@compiled
def fly(
    system: System,
    points: ContactPoints,
    march: SystemMarch,
    parts: SystemParts,
    longest: float,
) -> None:
    """Advance in free motion to the next touch, to the end of a recoil, or by a length [s]."""
    contacts = len(march.phase)
    state = State(march.displacement.copy(), march.velocity.copy(), np.zeros(0))
    touches = np.full(contacts, math.inf)
    in_dent = np.zeros(contacts, np.bool_)
    length = first_touch(points, march, state, longest, touches, in_dent)
    ended = -1
    separates = False
    for contact in range(contacts):
        if march.phase[contact] == RECOILING:
            time, has_parted = end_of_coasting(
                system_at(points, contact),
                law_of(march.acting, contact),
                manner_of(points, march, contact),
                state_at(points, contact, state),
            )
            if time <= length:
                length = time
                ended = contact
                separates = has_parted
    write_flight(parts, march, length)
    after = state_after(system, state, length)
    gone = lost_in_flight(system, state, after)
    for coordinate in range(len(gone)):
        march.lost[coordinate] += gone[coordinate]
    lose_in_recoil(points, march, state, after)
    advance(march, after, length)
    if ended >= 0:
        end_recoil(points, march, parts, ended, separates)
    for contact in range(contacts):
        # also where rounding makes another touch a little earlier, so that they overlap already
        if touches[contact] <= same_time(march, length) or (
            touches[contact] < math.inf
            and has_closed(points, march, state, contact, in_dent[contact])
        ):
            begin_contact(points, march, parts, contact, in_dent[contact])


@compiled
def first_touch(
    points: ContactPoints,
    march: SystemMarch,
    state: State,
    longest: float,
    touches: Vector,
    in_dent: Bools,
) -> float:
    """Return when the first contact touches in free motion [s from here], at most `longest`.

    Into `touches` (C,) is written when each does, and into `in_dent` (C,) whether it then touches
    the dent of its last impact. Those are left out that surely touch later than another.
    """
    contacts = len(march.phase)
    apart_until = np.full(contacts, math.inf)
    for contact in range(contacts):
        if march.phase[contact] != APART:
            continue
        now = approach_in(system_at(points, contact), state_at(points, contact, state))
        level = march.upcoming.numbers[contact, TOUCH]
        apart_until[contact] = 0.0
        if now.approach < level:
            apart_until[contact] = time_apart(now, level, points.gravity[contact])
        elif 0.0 < now.approach - level <= march.numbers[SLACK] and now.rate > 0.0:
            # it has touched in the last stretch, by less than was looked for
            touches[contact] = 0.0
            apart_until[contact] = math.inf
            longest = 0.0
    while True:
        soonest = 0
        for contact in range(contacts):
            if apart_until[contact] < apart_until[soonest]:
                soonest = contact
        if not _BOUND * apart_until[soonest] <= same_time(march, longest):
            return longest
        apart_until[soonest] = math.inf  # it has been looked at
        until = same_time(march, longest)
        write_touch(points, march, state, soonest, until, touches, in_dent)
        longest = min(longest, touches[soonest])


@compiled
def has_closed(
    points: ContactPoints, march: SystemMarch, before: State, contact: int, in_dent: bool
) -> bool:
    """Do the surfaces of a contact close and overlap that did not in a state `before`? Those of its
    dent, if it is `in_dent`.
    """
    of_contact = system_at(points, contact)
    level = march.upcoming.numbers[contact, TOUCH]
    if in_dent:
        level = release_of(march.dents, contact)
    earlier, _ = approach_of(of_contact, state_at(points, contact, before))
    now, rate = approach_of(of_contact, state_at(points, contact, state_now(march)))
    return bool(earlier <= level <= now and rate > 0.0)


@compiled
def write_touch(
    points: ContactPoints,
    march: SystemMarch,
    state: State,
    contact: int,
    until: float,
    touches: Vector,
    in_dent: Bools,
) -> None:
    """Write when a contact next touches in free motion [s from here], and whether in its dent."""
    of_contact = system_at(points, contact)
    now = state_at(points, contact, state)
    level = march.upcoming.numbers[contact, TOUCH]
    if march.has_dent[contact]:
        separation = time_to_separation(of_contact, now, level)
        dent_level = release_of(march.dents, contact)
        touch = next_touch(of_contact, now, dent_level, min(separation, until))
        if touch < separation:  # they touch the dent before they have separated from it
            touches[contact] = touch
            in_dent[contact] = True
            return
    touches[contact] = next_touch(of_contact, now, level, until)


@compiled
def lose_in_recoil(points: ContactPoints, march: SystemMarch, before: State, after: State) -> None:
    """Add to what is lost what recoiling contacts have lost between two states."""
    for contact in range(len(march.phase)):
        if march.phase[contact] == RECOILING:
            law = law_of(march.acting, contact)
            of_contact = system_at(points, contact)
            held = indentation_in(of_contact, law, state_at(points, contact, before))
            left = indentation_in(of_contact, law, state_at(points, contact, after))
            march.lost[len(march.lost) - 1] += stored_energy(law, held) - stored_energy(law, left)


@compiled
def advance(march: SystemMarch, state: State, length: float) -> None:
    """Advance to a state after a length [s]."""
    for coordinate in range(len(march.displacement)):
        march.displacement[coordinate] = state.displacement[coordinate]
        march.velocity[coordinate] = state.velocity[coordinate]
    march.numbers[NOW] += length


# from touch to release
# -------------------------------------------------------------------------


@compiled
def begin_contact(
    points: ContactPoints,
    march: SystemMarch,
    parts: SystemParts,
    contact: int,
    in_dent: bool,
) -> None:
    """Begin an impact at a contact; `in_dent`: on the dent of the last one."""
    of_contact = system_at(points, contact)
    state = state_at(points, contact, state_now(march))
    # surfaces that other impacts press together close with a speed that says nothing of what comes
    closing = closing_speed(of_contact, state)
    fastest = 0.0
    for other in range(len(march.phase)):
        if march.phase[other] != APART:
            fastest = max(fastest, parts.impacts[march.impact[other], CLOSING])
    if closing < _SLOW * fastest:
        closing = fastest
    upcoming = law_of(march.upcoming, contact)
    origin = march.upcoming_law[contact]
    if in_dent:
        upcoming = law_of(march.dents, contact)
        origin = march.dent_law[contact]
    law = law_at_touch(upcoming.addresses, upcoming.coefficients.copy(), upcoming.series, closing)
    write_law_of(march.acting, contact, law)
    march.acting_law[contact] = write_law(parts, contact, origin, math.nan, law)
    march.has_dent[contact] = False
    march.impact[contact] = add_impact(parts, contact, march.numbers[NOW], closing)
    march.phase[contact] = PUSHING
    march.is_fresh[contact] = True
    # Hertz: a contact lasts 2.94 depth/speed
    speed = motion_speed(law.addresses, law.coefficients, of_contact, closing)
    energy = 0.5 * points.mass[contact] * speed * speed
    depth = undamped_depth(law.addresses, law.coefficients, law.touch, energy, 0.0) - law.touch
    numbers = march.of_contact[contact]
    numbers[DELTA] = indentation_in(of_contact, law, state)
    numbers[FORCE] = math.inf
    numbers[TREND] = 0.0
    numbers[RATE] = math.inf
    numbers[MOTION_SPEED] = speed
    numbers[SPAN] = 3.0 * depth / speed
    numbers[LARGEST_FORCE] = 0.0
    numbers[DEEPEST] = 0.0
    march.numbers[NEXT_LENGTH] = min(march.numbers[NEXT_LENGTH], FIRST_LENGTH * numbers[SPAN])


@compiled
def end_contact(
    points: ContactPoints, march: SystemMarch, parts: SystemParts, contact: int
) -> None:
    """End an impact.

    The law keeps its memory where the next impact falls on the same spot.
    """
    parts.impacts[march.impact[contact], END] = march.numbers[NOW]
    if points.keeps_memory[contact]:
        write_law_of(march.upcoming, contact, law_of(march.acting, contact))
        march.upcoming_law[contact] = march.acting_law[contact]
    elif release_of(march.acting, contact) > march.upcoming.numbers[contact, TOUCH]:
        write_law_of(march.dents, contact, law_of(march.acting, contact))
        march.dent_law[contact] = march.acting_law[contact]
        march.has_dent[contact] = True
    march.phase[contact] = APART


@compiled
def end_recoil(
    points: ContactPoints,
    march: SystemMarch,
    parts: SystemParts,
    contact: int,
    separates: bool,
) -> None:
    """End the recoil of a contact, which separates or pushes again."""
    if separates:
        end_contact(points, march, parts, contact)
        return
    march.phase[contact] = PUSHING
    state = state_at(points, contact, state_now(march))
    law = law_of(march.acting, contact)
    march.of_contact[contact, DELTA] = indentation_in(system_at(points, contact), law, state)
    march.of_contact[contact, TREND] = 0.0


@compiled
def separate(
    points: ContactPoints, march: SystemMarch, parts: SystemParts, contact: int, delta: float
) -> None:
    """End an impact at an indentation of its law [m]; what the contact stores is then lost.

    It does where a sticking contact breaks, or where the surface recovers more slowly than the
    bodies part.
    """
    law = law_of(march.acting, contact)
    lose_stored(parts, march, contact, energy_held(law, manner_of(points, march, contact), delta))
    end_contact(points, march, parts, contact)


@compiled
def remember(march: SystemMarch, parts: SystemParts, contact: int) -> None:
    """Update the memory of a law with its largest indentation."""
    law = law_of(march.acting, contact)
    delta = march.of_contact[contact, DELTA]
    march.numbers[PLASTIC] += plastic_work(law, delta)
    changed = law_after(law, delta)
    write_law_of(march.acting, contact, changed)
    march.acting_law[contact] = write_law(parts, contact, march.acting_law[contact], delta, changed)


@compiled
def separates_then(points: ContactPoints, march: SystemMarch, contact: int) -> bool:
    """Does a contact end now that its force is zero? Otherwise it recoils."""
    return separates_at_no_force(
        system_at(points, contact),
        law_of(march.acting, contact),
        manner_of(points, march, contact),
        state_at(points, contact, state_now(march)),
    )


@compiled
def has_ended_at_once(
    points: ContactPoints, march: SystemMarch, parts: SystemParts, pushing: Integers
) -> bool:
    """Treat events at the end of the last stretch; return whether one ends a push.

    Another contact has ended that stretch, or it ends within rounding of its event.
    """
    for contact in pushing:
        if march.is_fresh[contact]:
            continue
        law = law_of(march.acting, contact)
        numbers = march.of_contact[contact]
        state = state_at(points, contact, state_now(march))
        approach, rate = approach_of(system_at(points, contact), state)
        overlap = max(approach - law.release_level, 0.0)
        if overlap <= ROUNDING * numbers[DEEPEST] and rate < 0.0:
            separate(points, march, parts, contact, law.release)
            return True
        if (
            march.acting.tension[contact] == TENSION_CUT
            and numbers[FORCE] <= NO_FORCE * numbers[LARGEST_FORCE]
            and numbers[TREND] < 0.0
        ):
            if separates_then(points, march, contact):
                separate(points, march, parts, contact, numbers[DELTA])
            else:
                march.phase[contact] = RECOILING
            return True
        has_turned = numbers[RATE] <= ZERO_RATE * numbers[MOTION_SPEED]
        if has_turned and numbers[DELTA] > law.memory_level:
            remember(march, parts, contact)
    return False


# under contact forces
# -------------------------------------------------------------------------


@compiled
def beginning_of_group(
    points: ContactPoints, march: SystemMarch, group: Group, no_friction: SlidingSphere
) -> Beginning:
    """Return what a stretch of the contacts of a group begins with."""
    count = len(group.contacts)
    laws = room_for_laws(law_of(march.acting, group.contacts[0]), count, 0)
    estimates = np.empty(count)
    for index in range(count):
        contact = group.contacts[index]
        write_law_of(laws, index, law_of(march.acting, contact))
        laws.tension[index] = march.acting.tension[contact]
        estimates[index] = march.of_contact[contact, DELTA]
    state = state_of(group.coordinates, state_now(march))
    start = start_of(points, group, state)
    delta = begun_indentations(laws, start, estimates)
    sliding = SlidStretch(group.bodies.surfaces, start, no_friction)
    return Beginning(state, start, laws, delta, sliding)


@compiled
def manner_of_group(
    points: ContactPoints, march: SystemMarch, group: Group, tolerance: float
) -> Manner:
    """Return what stays the same through a stretch of the contacts of a group."""
    speed = 0.0
    energy = 0.0
    for contact in range(len(march.phase)):
        if march.phase[contact] != APART:
            of_contact = manner_of(points, march, contact)
            speed = max(speed, of_contact.motion_speed)
            if march.phase[contact] == PUSHING:
                energy = max(energy, of_contact.energy)
    return Manner(
        0,
        0,
        speed,
        energy,
        shortest_span(march, group.contacts),
        tolerance,
        march.numbers[NOW],
        math.inf,
        math.inf,
        0,
    )


@compiled
def go_through_stretch(
    bases: Bases,
    system: System,
    points: ContactPoints,
    march: SystemMarch,
    parts: SystemParts,
    group: Group,
    no_friction: SlidingSphere,
    tolerance: float,
    longest: float,
) -> None:
    """Advance by one stretch of the contacts of a group, up to its first event.

    Where it is not solved or not resolved, the next one is to be shorter.
    """
    bodies = group.bodies
    manner = manner_of_group(points, march, group, tolerance)
    beginning = beginning_of_group(points, march, group, no_friction)
    # the map of touch where one of the contacts begins, else that of none
    trend = np.empty(len(group.contacts))
    time_map = 1
    deepest = -math.inf
    for index in range(len(group.contacts)):
        trend[index] = march.of_contact[group.contacts[index], TREND]
        if march.is_fresh[group.contacts[index]]:
            time_map = 0
    basis = basis_of(bases, time_map)
    given = Event(NO_EVENT, 0.0, min(march.numbers[NEXT_LENGTH], longest), 0)
    no_guess = Nodes(np.zeros(0), np.zeros(0), np.zeros(0))
    tried = attempt(basis, bodies, manner, beginning, no_guess, trend, False, given)
    if not tried.solved:
        march.numbers[NEXT_LENGTH] *= 0.5
        return
    balance = balance_of(basis, bodies, manner, beginning, tried)
    state = State(march.displacement.copy(), march.velocity.copy(), np.zeros(0))
    for index in range(len(group.contacts)):
        deepest = max(deepest, largest_of(tried.contact.delta[index]))
    slack = _TOUCH_SLACK * deepest
    march.numbers[SLACK] = slack
    other = first_other_event(
        basis, system, points, march, group, state, balance.path.velocity, tried.length, slack
    )
    event = tried.event
    # also tried if the stretch is not resolved, as the event may be the only reason
    if event.kind != NO_EVENT and event.x <= other.x:
        success, ended, ended_map, seen = up_to_event(
            bases, bodies, manner, beginning, tried, time_map
        )
        basis_to_event = basis_of(bases, ended_map)
        to_event = balance_of(basis_to_event, bodies, manner, beginning, ended)
        if not (success and to_event.resolved):
            near = 1.0
            if balance.resolved:  # otherwise the event is not certain
                near = max(event.x, 1.0 / (len(basis.grid) - 1))
            length = tried.length * time_at(basis, near)
            march.numbers[NEXT_LENGTH] = 0.5 * min(march.numbers[NEXT_LENGTH], length)
            return
        missed = first_other_event(
            basis_to_event,
            system,
            points,
            march,
            group,
            state,
            to_event.path.velocity,
            ended.length,
            slack,
        )
        if missed.kind != NONE:  # it lies between the estimate and the solved event
            length = ended.length * time_at(basis_to_event, missed.x)
            march.numbers[NEXT_LENGTH] = 0.5 * length
            return
        accept(system, points, march, parts, basis_to_event, group, ended, to_event)
        end_at_event(points, march, parts, group.contacts[seen.contact], seen.kind)
        return
    if not balance.resolved:
        march.numbers[NEXT_LENGTH] *= 0.5
        return
    if other.kind == NONE:
        accept(system, points, march, parts, basis, group, tried, balance)
        march.numbers[NEXT_LENGTH] = tried.length * length_growth(
            tried.contact.roughness, tolerance, len(basis.time)
        )
        return
    success, ended, to_event = up_to_other_event(
        basis, points, march, group, manner, beginning, trend, tried, balance, other, slack
    )
    if not success:
        march.numbers[NEXT_LENGTH] = 0.5 * tried.length
        return
    accept(system, points, march, parts, basis, group, ended, to_event)
    act(points, march, parts, state, other, slack)


@compiled
def up_to_other_event(
    basis: Basis,
    points: ContactPoints,
    march: SystemMarch,
    group: Group,
    manner: Manner,
    beginning: Beginning,
    trend: Vector,
    whole: Attempt,
    balance: Balance,
    other: OtherEvent,
    slack: float,
) -> tuple[bool, Attempt, Balance]:
    """Return whether it succeeds to solve a stretch again up to an event of a contact that is not
    part of it, the solution, and its balance.

    By Newton's method for the length. It fails where a contact of the stretch has an event before.
    `whole`, `balance`: the stretch beyond the event. `slack`: an overlap that is no touch [m].
    """
    no_guess = Nodes(np.zeros(0), np.zeros(0), np.zeros(0))
    state = state_now(march)
    ended = whole
    length = whole.length * time_at(basis, other.x)
    for _ in range(_MOST_CORRECTIONS):
        given = Event(NO_EVENT, 0.0, length, 0)
        ended = attempt(basis, group.bodies, manner, beginning, no_guess, trend, False, given)
        balance = balance_of(basis, group.bodies, manner, beginning, ended)
        if not ended.solved:
            return False, ended, balance
        value, rate = value_at_end(
            basis, points, march, group, state, balance.path.velocity, length, slack, other
        )
        correction = value / rate
        if abs(correction) <= _EXACT * whole.length:
            break
        length -= correction
        if not 0.0 < length <= _MOST_LONGER * whole.length:
            return False, ended, balance
    return ended.event.kind == NO_EVENT, ended, balance


@compiled
def accept(
    system: System,
    points: ContactPoints,
    march: SystemMarch,
    parts: SystemParts,
    basis: Basis,
    group: Group,
    solved: Attempt,
    balance: Balance,
) -> None:
    """Write a stretch of a group, and advance to its end; all other coordinates move freely."""
    write_stretch(parts, march, basis, group, solved, balance)
    first_row = parts.first_row[parts.written[PARTS] - 1]
    nodes = len(basis.time)
    contact_loss = len(march.lost) - 1
    for index in range(len(group.contacts)):
        contact = group.contacts[index]
        write_peaks(parts, march, basis, first_row + index)
        forces = solved.nodes.force[index * nodes : (index + 1) * nodes]
        trend = 0.0
        for node in range(nodes):
            trend += basis.at_end[node] * forces[node] / solved.length
        numbers = march.of_contact[contact]
        numbers[DELTA] = solved.contact.delta[index, nodes]
        numbers[FORCE] = forces[nodes - 1]
        numbers[TREND] = trend
        numbers[RATE] = solved.contact.closing[index, nodes]
        march.is_fresh[contact] = False
        march.lost[contact_loss] += solved.contact.dissipated[index]
    before = state_now(march)
    after = state_after(system, before, solved.length)
    gone = lost_in_flight(system, before, after)
    path = balance.path
    for coordinate in range(len(group.place)):
        at = group.place[coordinate]
        if at < 0:
            march.lost[coordinate] += gone[coordinate]
        else:
            march.lost[coordinate] += path.lost[at]
            after.displacement[coordinate] = path.displacement[at]
            after.velocity[coordinate] = path.speed[at]
    lose_in_recoil(points, march, before, after)
    advance(march, after, solved.length)


@compiled
def end_at_event(
    points: ContactPoints, march: SystemMarch, parts: SystemParts, contact: int, kind: int
) -> None:
    """Let happen what follows an event, of `events`, of a contact at the end of a stretch."""
    if kind == PARTED or (kind == NO_PUSH and separates_then(points, march, contact)):
        separate(points, march, parts, contact, march.of_contact[contact, DELTA])
    elif kind == NO_PUSH:
        march.phase[contact] = RECOILING
    elif kind == TURN:
        remember(march, parts, contact)


@compiled
def act(
    points: ContactPoints,
    march: SystemMarch,
    parts: SystemParts,
    start: State,
    event: OtherEvent,
    slack: float,
) -> None:
    """Let happen what follows an event of a contact that was not part of a stretch.

    Surfaces touch with all others that then overlap by half a slack [m], and did not at the start.
    """
    if event.kind == TOUCHES_DENT:
        begin_contact(points, march, parts, event.contact, True)
        return
    if event.kind != TOUCHES:
        end_recoil(points, march, parts, event.contact, event.kind == SEPARATES)
        return
    begin_contact(points, march, parts, event.contact, False)
    state = state_now(march)
    for contact in range(len(march.phase)):
        if march.phase[contact] != APART:
            continue
        of_contact = system_at(points, contact)
        level = march.upcoming.numbers[contact, TOUCH]
        before, _ = approach_of(of_contact, state_at(points, contact, start))
        after, _ = approach_of(of_contact, state_at(points, contact, state))
        if before - level <= slack and after - level > 0.5 * slack:
            begin_contact(points, march, parts, contact, False)
