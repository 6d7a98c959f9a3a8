"""Events within a stretch of contact: separation, zero force, a breakpoint of the law, a
turn of the approach.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Vector
from vibroimpact.compiled import compiled, force_at
from vibroimpact.dynamics.core.law import law_of
from vibroimpact.dynamics.core.linear import largest_of, least_of, product
from vibroimpact.dynamics.core.records import Basis, Contacts, Event, Histories, Nodes, Surfaces

NO_EVENT, PARTED, NO_PUSH, BREAKPOINT, TURN = 0, 1, 2, 3, 4
"""Kinds of events: none; the surfaces separate; the force is zero; the law's indentation
is at a breakpoint; the approach turns.
"""

NO_TENSION, TENSION_CUT, TENSION_KEPT = 0, 1, 2
"""May the force of a law be tensile? No; by its formula, which is cut; yes."""

TENSIONS = ("none", "cut", "kept")
"""The same as a law states it, by their numbers."""

ENDS = ("zero-indentation", "zero-force", "pull-off")
"""When a contact ends, as its law states it, by their numbers."""

ENDS_AT_NO_FORCE = 1

_ROUNDING = 1e-11  # relative to an indentation
# relative to an indentation: a stretch that begins so near to a breakpoint begins on it; ends are
# solved to 1e-11
_ON_LEVEL = 1e-10
_ZERO_RATE = 1e-9  # of the speed of the motion: a slower approach counts as having turned already
_SLACK = 1e-11  # of the force


@compiled
def crossing(values: Vector, reached: Bools) -> tuple[float, bool]:
    """Return where values on the grid fall below zero, as a part of it, by the secant;
    and whether they do.
    """
    last = len(values) - 1
    for point in range(1, last + 1):
        if reached[point]:
            before = values[point - 1]
            after = values[point]
            share = 1.0
            if before > 0.0 > after:
                share = before / (before - after)
            # at least half a point from the start, so that the stretch up to there has a length
            return max((point - 1 + share) / last, 0.5 / last), True
    return 1.0, False


@compiled
def first_event(
    basis: Basis,
    surfaces: Surfaces,
    contacts: Contacts,
    histories: Histories,
    nodes: Nodes,
    speed: float,
    span: float,
) -> Event:
    """Return the first event in a stretch of contacts of about a speed [m/s] and a duration [s]."""
    first = Event(NO_EVENT, 0.0, np.inf, 0)
    for contact in range(len(contacts.numbers)):
        event = first_event_of(basis, surfaces, contacts, histories, nodes, speed, span, contact)
        if event.x < first.x:
            first = event
    return first


@compiled
def first_event_of(
    basis: Basis,
    surfaces: Surfaces,
    contacts: Contacts,
    histories: Histories,
    nodes: Nodes,
    speed: float,
    span: float,
    contact: int,
) -> Event:
    """Return the first event of one of the contacts in a stretch."""
    law = law_of(contacts, contact)
    delta = product(basis.grid, histories.delta[contact])
    rate = product(basis.grid, histories.rate[contact])
    points = len(delta)
    deepest = largest_of(delta)
    reached = np.zeros(points, dtype=np.bool_)
    first = Event(NO_EVENT, 0.0, np.inf, contact)

    above = np.empty(points)
    for point in range(points):
        above[point] = delta[point] - law.release
        reached[point] = above[point] < -_ROUNDING * (deepest - law.release)
    x, crosses = crossing(above, reached)
    if crosses:
        first = Event(PARTED, law.release, x, contact)

    # also without tension the force is negative where the surfaces recoil fast enough
    if contacts.tension[contact] != TENSION_KEPT:
        number = len(basis.time)
        largest = 0.0
        for node in range(contact * number, (contact + 1) * number):
            largest = max(largest, abs(nodes.force[node]))
        slack = _SLACK * (largest + surfaces.mass[contact] * speed / span)
        force_of = force_at(law.addresses[0])
        force = np.empty(points)
        for point in range(points):
            static, dissipative = force_of(
                max(delta[point], law.release), rate[point], law.speed, law.coefficients
            )
            force[point] = static + dissipative
            reached[point] = force[point] < -slack
        x, crosses = crossing(force, reached)
        if crosses and x < first.x:
            first = Event(NO_PUSH, 0.0, x, contact)

    for number in range(2):
        level = law.first_breakpoint
        if number == 1:
            level = law.second_breakpoint
        if not np.isfinite(level):
            continue
        # a stretch that begins on a breakpoint leaves it to the side of its next point
        on_it = abs(delta[0] - level) <= _ON_LEVEL * max(abs(level), deepest - least_of(delta))
        begins_at = 1 if on_it else 0
        side = np.sign(delta[begins_at] - level)
        beyond = np.empty(points)
        for point in range(points):
            beyond[point] = side * (delta[point] - level)
            reached[point] = beyond[point] < 0.0
        x, crosses = crossing(beyond, reached)
        if crosses and x < first.x:
            first = Event(BREAKPOINT, level, x, contact)

    if deepest > law.memory_level:
        rates = product(basis.grid, histories.closing[contact])
        fastest = -np.inf
        for point in range(points):
            fastest = max(fastest, rates[point])
            reached[point] = rates[point] < 0.0 and fastest > _ZERO_RATE * speed
        x, crosses = crossing(rates, reached)
        if crosses and x < first.x:
            first = Event(TURN, 0.0, x, contact)
    return first
