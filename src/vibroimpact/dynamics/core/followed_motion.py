"""The normal motion of contacts that do not come out by collocation, read from their steps.

It consists of the parts between which the force is not smooth. In each the time is a cosine of the
parameter, so that the depth of the contact grows with its square.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled, force_at
from vibroimpact.dynamics.core.events import TENSION_CUT
from vibroimpact.dynamics.core.law import law_remembering
from vibroimpact.dynamics.core.line import follow_line
from vibroimpact.dynamics.core.line_records import LineContact, LineManner, LineSteps
from vibroimpact.dynamics.core.line_step import BY_ROOT, FREE
from vibroimpact.dynamics.core.lines import read_line
from vibroimpact.dynamics.core.normal_records import (
    FORCE,
    FORCE_SLOPE,
    IMPULSE,
    MORE_STEPS,
    MOTION_ROWS,
    PACE,
    PACE_SLOPE,
    TIME,
    NormalPath,
)
from vibroimpact.dynamics.core.records import Law

_TOLERANCE = 1e-12  # of a step
_ROOM = 200  # steps, at first
_ON_CORNER = 1e-9  # of the duration
_ASIDE = 1e-6  # of a part: step of finite differences
_NONE, _STEEP = 1e-6, 1e-2
"""Parts of the largest force: one that is zero, and a slope that is not."""


@compiled
def within(manner: LineManner, tolerance: float) -> LineManner:
    """Return the bodies with another relative error allowed in a step."""
    return LineManner(
        manner.root,
        manner.tension,
        manner.contact_end,
        manner.mass,
        manner.gravity,
        manner.depth,
        manner.speed_scale,
        tolerance,
        manner.most_steps,
    )


@compiled
def recorded(law: Law, manner: LineManner) -> tuple[LineContact, LineSteps]:
    """Return a contact that is followed step by step, and its steps."""
    room = _ROOM
    while True:
        steps = LineSteps(
            np.zeros(room, np.int64),
            np.zeros(room, np.bool_),
            np.zeros((room, 4)),
            np.zeros(room),
            np.zeros(1, np.int64),
        )
        contact = follow_line(law, manner, steps)
        if steps.written[0] <= room:
            return contact, steps
        room = steps.written[0]


@compiled
def corners_of(contact: LineContact, steps: LineSteps) -> Vector:
    """Return the times between which the force of a contact is smooth, from touch to its end
    [s].
    """
    end = contact.end.time
    number = steps.written[0]
    times = np.empty(number + 2)
    times[0] = 0.0
    times[1] = contact.time_of_deepest
    count = 2
    for step in range(number - 1):
        variable = steps.variable[step]
        # after steps in the root of the indentation, and where free motion begins or ends
        if variable in (BY_ROOT, FREE) or steps.variable[step + 1] == FREE:
            times[count] = steps.begun[step + 1, 0]
            count += 1
    rising = np.sort(times[:count])
    corners = np.empty(count + 1)
    corners[0] = 0.0
    last = 0
    for time in rising:
        inside = _ON_CORNER * end < time < (1.0 - _ON_CORNER) * end
        if inside and time > corners[last]:
            last += 1
            corners[last] = time
    corners[last + 1] = end
    return corners[: last + 2]


@compiled
def force_under(law: Law, delta: float, rate: float) -> float:
    """Return the force of a law before any clipping [N]; `delta` [m], `rate` [m/s]."""
    static, loss = force_at(law.addresses[0])(delta, rate, law.speed, law.coefficients)
    return float(static + loss)


@compiled
def write_part(
    law: Law,
    manner: LineManner,
    length: float,
    motion: Matrix,
    rows: Matrix,
    first: int,
    steps: int,
) -> None:
    """Write the normal motion in a part of a contact, counted from its begin.

    Parameters
    ----------
    law, manner : Law, LineManner
        The law with its memory in this part, and the bodies.
    length : float
        Of the part [s].
    motion : array, shape (3, steps + 1)
        Indentation [m] and its rate [m/s] at the points of the part.
    rows : array, shape (6, R)
        Where it is written, from the point `first` on.
    first, steps : int
        First point, and number of steps.
    """
    # Chebyshev's points t = L/2 (1 - cos(pi j/n)), with the first two derivatives of t by j
    half = 0.5 * length
    step = math.pi / steps
    aside = _ASIDE * length
    for point in range(steps + 1):
        angle = math.pi if point == steps else point * step
        delta = motion[0, point]
        rate = motion[1, point]
        time = half * (1.0 - math.cos(angle))
        pace = step * half * math.sin(angle)
        force = force_under(law, delta, rate)
        moved = aside * rate
        faster = aside * (manner.gravity - force / manner.mass)
        later = force_under(law, max(delta + moved, law.release), rate + faster)
        earlier = force_under(law, max(delta - moved, law.release), rate - faster)
        slope = (later - earlier) / (2.0 * aside) * pace
        if manner.tension == TENSION_CUT and not force > 0.0:
            slope = 0.0
        target = first + point
        rows[TIME, target] = time
        rows[PACE, target] = pace
        rows[PACE_SLOPE, target] = step * step * half * math.cos(angle)
        rows[FORCE, target] = max(force, 0.0)
        rows[FORCE_SLOPE, target] = slope
        # what stops the bodies is the force: its integral is m g t - m (v - v_0)
        stopped = rate - motion[1, 0]
        rows[IMPULSE, target] = manner.mass * (manner.gravity * time - stopped)


@compiled
def is_steep_at_end(rows: Matrix, first: int, steps: int) -> bool:
    """Does the force begin or end a part at zero with a slope? The radius of the contact has an
    infinite one then.
    """
    most = 0.0
    for point in range(first, first + steps + 1):
        most = max(most, rows[FORCE, point])
    for point in (first, first + steps):
        slope = rows[FORCE_SLOPE, point] * steps
        if rows[FORCE, point] <= _NONE * most and abs(slope) > _STEEP * most:
            return True
    return False


@compiled
def followed_path(law: Law, manner: LineManner, steps: int) -> NormalPath:
    """Return the normal motion of a contact that is followed step by step.

    `steps`: in each part, or `MORE_STEPS` times as many where the force is steep.
    """
    finer = within(manner, _TOLERANCE)
    contact, record = recorded(law, finer)
    leaving = law_remembering(law, contact.deepest)
    corners = corners_of(contact, record)
    most = (len(corners) - 1) * (MORE_STEPS * steps + 1)
    rows = np.empty((MOTION_ROWS, most))
    parameter = np.ones(most)
    first = 0
    for part in range(len(corners) - 1):
        begin = corners[part]
        length = corners[part + 1] - begin
        here = leaving
        if corners[part + 1] <= contact.time_of_deepest:
            here = law
        number = steps
        for _ in range(2):
            times = np.empty(number + 1)
            for point in range(number + 1):
                times[point] = begin + 0.5 * length * (1.0 - math.cos(math.pi * point / number))
            motion = np.empty((3, number + 1))
            read_line(law, finer, contact.deepest, record, times, motion)
            write_part(here, finer, length, motion, rows, first, number)
            if number > steps or not is_steep_at_end(rows, first, number):
                break
            number = MORE_STEPS * steps
        if first > 0:
            parameter[first - 1] = 0.0
            for point in range(first, first + number + 1):
                rows[TIME, point] += rows[TIME, first - 1]
                rows[IMPULSE, point] += rows[IMPULSE, first - 1]
        first += number + 1
    return NormalPath(rows[:, :first].copy(), parameter[: first - 1].copy())
