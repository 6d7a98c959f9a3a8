"""Contacts of many pairs of rigid bodies, one after the other, and the motion within one
of them.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.law import law_at_touch, law_remembering
from vibroimpact.dynamics.core.line import follow_line, line_under
from vibroimpact.dynamics.core.line_records import (
    ContactManner,
    ContactRoom,
    Line,
    LineContact,
    LineContacts,
    LineManner,
    LineState,
    LineSteps,
)
from vibroimpact.dynamics.core.line_step import FREE, IMPLICIT, advance, energies_of
from vibroimpact.dynamics.core.normal_records import NormalGrid
from vibroimpact.dynamics.core.phase_contact import collocate_contact
from vibroimpact.dynamics.core.phase_records import ROWS, PhaseRules
from vibroimpact.dynamics.core.records import Law

_MOST_ITERATIONS = 60
_NEAR = 4e-16  # of the time since touch


@compiled
def with_bodies(
    manner: LineManner, mass: float, gravity: float, depth: float, speed_scale: float
) -> LineManner:
    """Return what stays the same through the contact of a pair of bodies."""
    return LineManner(
        manner.root,
        manner.tension,
        manner.contact_end,
        mass,
        gravity,
        depth,
        speed_scale,
        manner.tolerance,
        manner.most_steps,
    )


@compiled
def room_of(rules: PhaseRules) -> ContactRoom:
    """Return the room in which contacts are solved whose steps are not recorded."""
    steps = LineSteps(
        np.zeros(0, np.int64),
        np.zeros(0, np.bool_),
        np.zeros((0, 4)),
        np.zeros(0),
        np.zeros(1, np.int64),
    )
    return ContactRoom(np.zeros((ROWS, rules.vectors.shape[2])), steps, np.zeros(7))


@compiled
def solve_pair(
    law: Law,
    bodies: LineManner,
    rules: PhaseRules,
    grid: NormalGrid,
    collocates: bool,
    room: ContactRoom,
) -> tuple[bool, LineContact]:
    """Return whether the contact of a pair of rigid bodies is solved by collocation, and the
    contact, which is followed step by step where that does not come out.
    """
    if collocates:
        solved, contact = collocate_contact(law, bodies, rules, grid, room.nodes)
        if solved:
            return True, contact
    return False, follow_line(law, bodies, room.steps)


@compiled
def follow_lines(
    manner: ContactManner, coefficients: Matrix, touches: Matrix, contacts: LineContacts
) -> None:
    """Solve the contacts of B pairs of rigid bodies, each from touch on: by collocation, or step by
    step where that does not come out.

    Parameters
    ----------
    manner : ContactManner
        How they are solved; the bodies of each pair take the place of those in it.
    coefficients : array, shape (B, K)
        Of the law for each pair.
    touches : array, shape (5, B)
        Effective mass [kg], gravity [m/s^2], approach speed [m/s], depth [m] and speed scale [m/s]
        of each pair.
    contacts : LineContacts
        Room for the contacts.
    """
    room = room_of(manner.rules)
    outcomes = contacts.outcomes
    ends = contacts.ends
    for pair in range(len(outcomes)):
        law = law_at_touch(manner.addresses, coefficients[pair], room.series, touches[2, pair])
        bodies = with_bodies(
            manner.manner, touches[0, pair], touches[1, pair], touches[3, pair], touches[4, pair]
        )
        _, contact = solve_pair(law, bodies, manner.rules, manner.grid, manner.collocates, room)
        outcomes[pair] = contact.outcome
        ends[0, pair] = contact.end.time
        ends[1, pair] = contact.end.delta
        ends[2, pair] = contact.end.rate
        ends[3, pair] = contact.end.lost
        ends[4, pair] = contact.deepest
        ends[5, pair] = contact.time_of_deepest
        ends[6, pair] = contact.peak_force
        ends[7, pair] = contact.time_of_peak_force
        ends[8, pair] = contact.plastic
        ends[9, pair] = contact.stored


@compiled
def read_line(
    law: Law, manner: LineManner, deepest: float, steps: LineSteps, times: Vector, motion: Matrix
) -> None:
    """Read the motion of a contact at rising times, each as the end of a shorter step.

    Parameters
    ----------
    law, manner
        As `follow_line` took them.
    deepest : float
        The largest indentation [m].
    steps : LineSteps
        What it has written.
    times : array, shape (T,)
        Times since touch [s], rising.
    motion : array, shape (3, T)
        Room for indentation [m], its rate [m/s], and energy lost since touch [J].
    """
    coming = line_under(law, manner)
    leaving = line_under(law_remembering(law, deepest), manner)
    stages = np.empty((4, 13))
    number = 0
    for point in range(len(times)):
        time = times[point]
        while number + 1 < steps.written[0] and steps.begun[number + 1, 0] <= time:
            number += 1
        line = leaving if steps.after[number] else coming
        begun = begun_of(steps, number)
        state = state_at(line, steps.variable[number], begun, steps.length[number], time, stages)
        motion[0, point] = max(state.delta, line.release)
        motion[1, point] = state.rate
        motion[2, point] = state.lost
        if steps.variable[number] == FREE:
            motion[2, point] += (
                energies_of(line, begun.delta)[0] - energies_of(line, state.delta)[0]
            )


@compiled
def time_line(
    law: Law, manner: LineManner, deepest: float, steps: LineSteps, times: Matrix
) -> None:
    """Write the times at which a contact is well resolved [s] (steps, n): at the start of
    n parts of each step.
    """
    coming = line_under(law, manner)
    leaving = line_under(law_remembering(law, deepest), manner)
    stages = np.empty((4, 13))
    parts = times.shape[1]
    for number in range(times.shape[0]):
        line = leaving if steps.after[number] else coming
        for part in range(parts):
            length = steps.length[number] * part / parts
            times[number, part] = advance(
                line, steps.variable[number], begun_of(steps, number), length, stages
            ).state.time


@compiled
def begun_of(steps: LineSteps, number: int) -> LineState:
    """Return the state at the start of a step."""
    begun = steps.begun[number]
    return LineState(begun[0], begun[1], begun[2], begun[3])


@compiled
def state_at(
    line: Line, variable: int, begun: LineState, length: float, time: float, stages: Matrix
) -> LineState:
    """Return the state at a time within a step [s], by Newton's method within a bracket;
    `length`: of the step.
    """
    if variable in (FREE, IMPLICIT):
        return advance(line, variable, begun, time - begun.time, stages).state
    if time <= begun.time:
        return begun
    low = 0.0
    high = length
    part = length
    state = begun
    for _ in range(_MOST_ITERATIONS):
        state = advance(line, variable, begun, part, stages).state
        excess = state.time - time
        if abs(excess) <= _NEAR * abs(time):
            break
        if excess > 0.0:
            high = part
        else:
            low = part
        nearer = part - excess / stages[2, 12]
        if not (nearer - low) * (nearer - high) < 0.0:
            nearer = 0.5 * (low + high)
        if nearer == part:
            break
        part = nearer
    return state
