"""The normal motion of a contact on a grid, written segment by segment as it is collocated.

Its parameter counts the steps of the grid. It rises nearly evenly with y through each segment,
slowly at its ends, so that the depth of the contact grows with its square.
"""

from __future__ import annotations

from vibroimpact.arrays import Matrix
from vibroimpact.compiled import compiled, multiply_row
from vibroimpact.dynamics.core.normal_records import (
    FORCE,
    FORCE_SLOPE,
    IMPULSE,
    INTEGRALS,
    MORE_STEPS,
    NODE_FORCE,
    NODE_FORCE_SLOPE,
    NODE_IMPULSE,
    NODE_PACE,
    NODE_PACE_SLOPE,
    NODE_PUSH,
    NODE_TIME,
    PACE,
    PACE_SLOPE,
    TIME,
    VALUES,
    NormalGrid,
    NormalPath,
)
from vibroimpact.dynamics.core.phase_records import (
    BARYCENTRIC,
    KINDS,
    LOSS,
    PLACE,
    STATIC,
    TURNING,
    Phase,
    PhaseRules,
    Segment,
)
from vibroimpact.dynamics.core.phase_records import PACE as PACE_OF_PHASE

_COARSER = 0.2
"""Part by which steps are longer than evenly where the contact is deepest, and shorter
where it begins and ends.
"""

_NONE = 1e-6  # of the largest force: one that is zero
_STEEP = 1e-2  # of the largest force: a slope that is not
_SMALL = 1e-4  # of an impulse: error at the nodes
_TINY = 1e-300  # so that a node has a distance from itself


@compiled
def graded(share: float) -> float:
    """Return y at a share of the steps of a segment."""
    return share * (1.0 + _COARSER * (1.0 - share))


@compiled
def note_part(grid: NormalGrid, steps: int) -> None:
    """Note that a part of a contact has been written."""
    first = grid.points[0]
    if first > 0:
        grid.parameter[first - 1] = 0.0
    for step in range(steps):
        grid.parameter[first + step] = 1.0
    grid.points[0] = first + steps + 1


@compiled
def written_path(grid: NormalGrid) -> NormalPath:
    """Return the normal motion that has been written."""
    points = grid.points[0]
    return NormalPath(grid.motion[:, :points].copy(), grid.parameter[: points - 1].copy())


@compiled
def is_steep(grid: NormalGrid, rule: int, count: int) -> bool:
    """Return whether the force of a segment pulls at an end of it, or begins or ends there with a
    slope.

    Where it becomes zero with a slope, the radius of the contact has an infinite one.
    """
    room = grid.room
    values = grid.values
    matrix = 2 * rule
    most = 0.0
    for node in range(count):
        most = max(most, room[NODE_FORCE, node])
    for point in (0, grid.steps):
        force = 0.0
        slope = 0.0
        for node in range(count):
            force += values[matrix, node, point] * room[NODE_FORCE, node]
            slope += values[matrix, node, point] * room[NODE_FORCE_SLOPE, node]
        if force < -_NONE * most or (force <= _NONE * most and abs(slope) > _STEEP * most):
            return True
    return False


@compiled
def write_own(
    grid: NormalGrid, rules: PhaseRules, vector: int, count: int, steps: int, end: float
) -> None:
    """Write the matrices of a grid from the deep end of a segment up to another y."""
    vectors = rules.vectors
    own = grid.own
    for point in range(steps + 1):
        y = end * graded(point / steps)
        of_values = 0.0
        of_integrals = 0.0
        for node in range(count + 1):
            weight = vectors[vector, BARYCENTRIC, node] / (y - vectors[vector, PLACE, node] + _TINY)
            own[INTEGRALS, node, point] = weight
            of_integrals += weight
            weight *= vectors[vector, PLACE, node] - 1.0  # without the far end
            own[VALUES, node, point] = weight
            of_values += weight
        for node in range(count + 1):
            own[INTEGRALS, node, point] /= of_integrals
            own[VALUES, node, point] /= of_values
    for matrix in range(2):
        for node in range(count + 1, own.shape[1]):
            for point in range(steps + 1):
                own[matrix, node, point] = 0.0


@compiled
def write_segment(
    grid: NormalGrid,
    rules: PhaseRules,
    segment: Segment,
    phase: Phase,
    end: float,
    stopped: float,
    solved: Matrix,
) -> None:
    """Write the normal motion in a segment of a phase.

    Parameters
    ----------
    grid : NormalGrid
        Where it is written.
    rules : PhaseRules
        The Gauss rules.
    segment, phase : Segment, Phase
        The segment and its solution.
    end : float
        The y at which the contact ends within it, or 1.
    stopped : float
        The impulse of the force in it by the speeds at its ends [N s], which are more exact than
        its nodes.
    solved : array, shape (19, M)
        The room in which it was solved.
    """
    room = grid.room
    motion = grid.motion
    rule = phase.rule
    vector = rule * KINDS + TURNING  # of one whose integrals begin at its deep end
    count = rules.counts[rule]
    # the nodes and the far end, up to whole vectors of eight numbers, which are multiplied at once
    width = (count + 8) // 8 * 8
    for node in range(width):
        pace = 0.0
        force = 0.0
        if node < count:
            pace = solved[PACE_OF_PHASE, node]
            force = solved[STATIC, node] + solved[LOSS, node]
        room[NODE_PACE, node] = pace
        room[NODE_FORCE, node] = force
        room[NODE_PUSH, node] = pace * force
    multiply_row(room, NODE_PACE, grid.derivatives, rule, width, width, NODE_PACE_SLOPE)
    multiply_row(room, NODE_FORCE, grid.derivatives, rule, width, width, NODE_FORCE_SLOPE)
    multiply_row(room, NODE_PACE, rules.matrices, 2 * vector + 1, width, width, NODE_TIME)
    multiply_row(room, NODE_PUSH, rules.matrices, 2 * vector + 1, width, width, NODE_IMPULSE)
    steep = end < 1.0 or is_steep(grid, rule, count)
    steps = MORE_STEPS * grid.steps if steep else grid.steps
    columns = (steps + 8) // 8 * 8
    values = grid.values
    integrals = grid.integrals
    matrix = 2 * rule + 1 if steep else 2 * rule
    of_integrals = matrix
    if end < 1.0:
        write_own(grid, rules, vector, count, steps, end)
        values = grid.own
        integrals = grid.own
        matrix = VALUES
        of_integrals = INTEGRALS
    multiply_row(room, NODE_PACE, values, matrix, width, columns, PACE)
    multiply_row(room, NODE_PACE_SLOPE, values, matrix, width, columns, PACE_SLOPE)
    multiply_row(room, NODE_FORCE, values, matrix, width, columns, FORCE)
    multiply_row(room, NODE_FORCE_SLOPE, values, matrix, width, columns, FORCE_SLOPE)
    multiply_row(room, NODE_TIME, integrals, of_integrals, width, columns, TIME)
    multiply_row(room, NODE_IMPULSE, integrals, of_integrals, width, columns, IMPULSE)
    room[TIME, 0] = 0.0
    room[IMPULSE, 0] = 0.0
    # the impulse at the end is known from the speeds; what the nodes miss is shared out
    missing = stopped - room[IMPULSE, steps]
    if abs(missing) <= _SMALL * abs(stopped):
        factor = stopped / room[IMPULSE, steps]
        for point in range(steps):
            room[IMPULSE, point] *= factor
        room[IMPULSE, steps] = stopped
    first = grid.points[0]
    time = motion[TIME, first - 1] if first > 0 else 0.0
    impulse = motion[IMPULSE, first - 1] if first > 0 else 0.0
    sign = -segment.sign
    target = first
    if sign < 0.0:  # y falls in compression
        target = first + steps
        time += room[TIME, steps]
        impulse += room[IMPULSE, steps]
    for point in range(steps + 1):
        # rate, bend: first and second derivative of y by the step's number
        share = point / steps
        rate = end * (1.0 + _COARSER * (1.0 - 2.0 * share)) / steps
        bend = -2.0 * _COARSER * end / (steps * steps)
        pace = room[PACE, point]
        motion[TIME, target] = time + sign * room[TIME, point]
        motion[PACE, target] = pace * rate
        motion[PACE_SLOPE, target] = sign * (room[PACE_SLOPE, point] * rate * rate + pace * bend)
        motion[FORCE, target] = max(room[FORCE, point], 0.0)
        motion[FORCE_SLOPE, target] = sign * room[FORCE_SLOPE, point] * rate
        motion[IMPULSE, target] = impulse + sign * room[IMPULSE, point]
        target += 1 if sign > 0.0 else -1
    note_part(grid, steps)


@compiled
def write_glide(grid: NormalGrid, duration: float) -> None:
    """Write a motion without a force, after a segment, for a time [s]."""
    motion = grid.motion
    first = grid.points[0]
    for point in range(grid.steps + 1):
        motion[TIME, first + point] = motion[TIME, first - 1] + duration * point / grid.steps
        motion[PACE, first + point] = duration / grid.steps
        motion[PACE_SLOPE, first + point] = 0.0
        motion[FORCE, first + point] = 0.0
        motion[FORCE_SLOPE, first + point] = 0.0
        motion[IMPULSE, first + point] = motion[IMPULSE, first - 1]
    note_part(grid, grid.steps)
