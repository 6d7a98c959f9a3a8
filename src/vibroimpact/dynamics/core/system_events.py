"""Events of contacts that are not part of a stretch of others: touches, and ends of recoil.

In recoil the law of a contact has stopped pushing, and its surfaces still overlap.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled, levels_at
from vibroimpact.dynamics.core.attempt import place_at, time_at, weights_at
from vibroimpact.dynamics.core.coasting import push_at
from vibroimpact.dynamics.core.flight import state_after
from vibroimpact.dynamics.core.law import law_of
from vibroimpact.dynamics.core.line_events import narrowed, secant_of
from vibroimpact.dynamics.core.line_records import Bracket
from vibroimpact.dynamics.core.records import (
    TOUCH,
    Basis,
    Contacts,
    State,
    System,
)
from vibroimpact.dynamics.core.system_points import state_at, system_at
from vibroimpact.dynamics.core.system_records import (
    APART,
    RECOILING,
    ContactPoints,
    Group,
    OtherEvent,
    SystemMarch,
)

NONE, TOUCHES, TOUCHES_DENT, SEPARATES, PUSHES = range(5)
"""Kinds of events: none; surfaces touch, or they touch the dent of the last impact; a recoil ends
as they separate, or as the law pushes again.
"""

_FASTER_BETWEEN = 4.0  # of the largest speed at a node: bound of that between the nodes
_NEAR_TOUCH = 1e-3  # of the way in a stretch: surfaces that come so near are looked at closely
_MOST_SECANTS = 100
_ROUNDING = 1e-14  # of the length of a stretch


@compiled
def release_of(contacts: Contacts, contact: int) -> float:
    """Return the indentation at which a law releases [m], without what is in series with it."""
    levels = levels_at(contacts.addresses[4 * contact + 2])
    _, release, _, _, _ = levels(contacts.coefficients[contact])
    return float(release)


@compiled
def event_value(
    march: SystemMarch, kind: int, contact: int, slack: float, approach: float, rate: float
) -> float:
    """Return a number that is positive after an event of a contact.

    `slack`: an overlap that is no touch [m]. `approach`, `rate`: of its surfaces [m, m/s].
    """
    if kind == TOUCHES:
        return approach - float(march.upcoming.numbers[contact, TOUCH]) - slack
    if kind == TOUCHES_DENT:
        return approach - release_of(march.dents, contact) - slack
    law = law_of(march.acting, contact)
    if kind == SEPARATES:
        return law.release_level - approach
    return push_at(law, approach, rate)


@compiled
def greatest_speeds(
    system: System, group: Group, start: State, velocities: Matrix, length: float
) -> Vector:
    """Return a bound of the speed of each coordinate of a system within a stretch (n,).

    Between the nodes it stays below a few times that at them.
    """
    fastest = np.empty(len(start.velocity))
    for coordinate in range(len(fastest)):
        speed = abs(start.velocity[coordinate])
        place = group.place[coordinate]
        if place >= 0:
            for node in range(len(velocities)):
                speed = max(speed, abs(velocities[node, place]))
            fastest[coordinate] = _FASTER_BETWEEN * speed
        else:  # it moves freely
            strained = system.frequency[coordinate] * start.displacement[coordinate]
            speed = math.sqrt(speed * speed + strained * strained)
            fastest[coordinate] = speed + abs(system.load[coordinate]) * length
    return fastest


@compiled
def write_motion(
    basis: Basis,
    points: ContactPoints,
    group: Group,
    start: State,
    velocities: Matrix,
    length: float,
    contact: int,
    motion: Matrix,
) -> None:
    """Write the motion of a contact through a stretch of a group into `motion` (2, N + 4).

    Rows: its approach [m], and the rate of it [m/s]. The first three numbers are those of a fall
    with constant acceleration; then follows at the start and the nodes by how much it differs.
    """
    of_contact = system_at(points, contact)
    before = state_at(points, contact, start)
    begin = points.first[contact]
    for column in range(motion.shape[1]):
        motion[0, column] = 0.0
        motion[1, column] = 0.0
    approach = of_contact.offset
    rate = 0.0
    acceleration = 0.0
    for index in range(len(before.displacement)):
        approach += of_contact.shape[index] * before.displacement[index]
        rate += of_contact.shape[index] * before.velocity[index]
        acceleration += of_contact.shape[index] * of_contact.load[index]
    motion[0, 0] = approach
    motion[0, 1] = rate
    motion[0, 2] = acceleration
    nodes = len(basis.time)
    for node in range(nodes):
        time = length * basis.time[node]
        after = state_after(of_contact, before, time)
        for index in range(len(before.displacement)):
            place = group.place[points.coordinate[begin + index]]
            displacement = after.displacement[index]
            velocity = after.velocity[index]
            if place >= 0:
                velocity = velocities[node, place]
                displacement = before.displacement[index]
                for other in range(nodes):
                    displacement += length * basis.integral[node, other] * velocities[other, place]
            # less a fall with constant acceleration, which needs no interpolation
            load = of_contact.load[index]
            fallen = before.displacement[index] + time * (
                before.velocity[index] + 0.5 * load * time
            )
            faster = before.velocity[index] + load * time
            motion[0, node + 4] += of_contact.shape[index] * (displacement - fallen)
            motion[1, node + 4] += of_contact.shape[index] * (velocity - faster)


@compiled
def motion_at(
    basis: Basis, motion: Matrix, length: float, x: float, weights: Vector
) -> tuple[float, float]:
    """Return approach [m] and rate [m/s] of a contact at x, from what `write_motion` wrote.

    `weights` (N + 1,): room.
    """
    weights_at(basis, x, weights)
    time = length * time_at(basis, x)
    approach = motion[0, 0] + time * (motion[0, 1] + 0.5 * motion[0, 2] * time)
    rate = motion[0, 1] + motion[0, 2] * time
    for point in range(len(weights)):
        approach += weights[point] * motion[0, point + 3]
        rate += weights[point] * motion[1, point + 3]
    return approach, rate


@compiled
def first_crossing(
    basis: Basis,
    march: SystemMarch,
    motion: Matrix,
    length: float,
    kind: int,
    contact: int,
    slack: float,
) -> float:
    """Return the x at which an event of a contact is first met in a stretch; infinite if it is not.

    `motion`: that of the contact, of `write_motion`.
    """
    points = len(basis.grid)
    weights = np.empty(len(basis.places))
    value = event_value(march, kind, contact, slack, motion[0, 0], motion[0, 1])
    for point in range(1, points):
        before = value
        x = point / (points - 1)
        approach, rate = motion_at(basis, motion, length, x, weights)
        value = event_value(march, kind, contact, slack, approach, rate)
        if not (value > 0.0 and before <= 0.0):
            continue
        bracket = Bracket((point - 1) / (points - 1), x, before, value, 0)
        for _ in range(_MOST_SECANTS):
            if not bracket.high - bracket.low > _ROUNDING:
                break
            middle = max(secant_of(bracket), bracket.low + 0.25 * _ROUNDING)
            middle = min(middle, bracket.high - 0.25 * _ROUNDING)
            approach, rate = motion_at(basis, motion, length, middle, weights)
            value = event_value(march, kind, contact, slack, approach, rate)
            bracket = narrowed(bracket, middle, value)
        return bracket.high
    return math.inf


@compiled
def first_other_event(
    basis: Basis,
    system: System,
    points: ContactPoints,
    march: SystemMarch,
    group: Group,
    start: State,
    velocities: Matrix,
    length: float,
    slack: float,
) -> OtherEvent:
    """Return the first event within a stretch of contacts that are not part of it.

    Parameters
    ----------
    start : State
        State of the system at the start of the stretch.
    velocities : array, shape (N, m)
        Of the coordinates of the group at the nodes.
    length : float
        Of the stretch [s].
    slack : float
        An overlap that is no touch [m].
    """
    motion = np.empty((2, len(basis.time) + 4))
    fastest = greatest_speeds(system, group, start, velocities, length)
    first = OtherEvent(NONE, 0, math.inf)
    for contact in range(len(march.phase)):
        phase = march.phase[contact]
        if phase == APART:
            approach = points.offset[contact]
            reach = 0.0
            for index in range(points.first[contact], points.first[contact + 1]):
                approach += points.shape[index] * start.displacement[points.coordinate[index]]
                reach += abs(points.shape[index]) * fastest[points.coordinate[index]]
            # no coordinate moves by more than its greatest speed times the length
            reach *= (1.0 + _NEAR_TOUCH) * length
            if approach + reach <= march.upcoming.numbers[contact, TOUCH]:
                continue
            second = TOUCHES_DENT if march.has_dent[contact] else NONE
            kinds = (TOUCHES, second)
        elif phase == RECOILING:
            kinds = (SEPARATES, PUSHES)
        else:
            continue
        write_motion(basis, points, group, start, velocities, length, contact, motion)
        for kind in kinds:
            if kind == NONE:
                continue
            x = first_crossing(basis, march, motion, length, kind, contact, slack)
            if x < first.x:
                first = OtherEvent(kind, contact, x)
    return first


@compiled
def value_at_end(
    basis: Basis,
    points: ContactPoints,
    march: SystemMarch,
    group: Group,
    start: State,
    velocities: Matrix,
    length: float,
    slack: float,
    event: OtherEvent,
) -> tuple[float, float]:
    """Return the number of `event_value` at the end of a stretch, and its rate of change [1/s].

    The latter is that over the last millionth of the stretch. The other arguments are those of
    `first_other_event`.
    """
    motion = np.empty((2, len(basis.time) + 4))
    weights = np.empty(len(basis.places))
    write_motion(basis, points, group, start, velocities, length, event.contact, motion)
    approach, rate = motion_at(basis, motion, length, 1.0, weights)
    value = event_value(march, event.kind, event.contact, slack, approach, rate)
    step = 1e-6
    approach, rate = motion_at(basis, motion, length, place_at(basis, 1.0 - step), weights)
    before = event_value(march, event.kind, event.contact, slack, approach, rate)
    return value, (value - before) / (step * length)
