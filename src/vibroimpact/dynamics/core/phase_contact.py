"""The contact of two rigid bodies, collocated phase by phase, where that comes out to the
tolerance.

Compression is solved from the touch inwards between the breakpoints of the law, and then up to its
deepest point, which is sought; restitution goes back through them. No event has to be located in
time but the largest force, and the place where the force of a law that may not pull becomes zero.
"""

from __future__ import annotations

import math

from vibroimpact.arrays import Cube, Matrix
from vibroimpact.compiled import compiled, energies_at, force_at, multiply_row
from vibroimpact.dynamics.core.events import ENDS_AT_NO_FORCE, TENSION_CUT
from vibroimpact.dynamics.core.law import law_remembering
from vibroimpact.dynamics.core.line import RELEASED, line_under, next_level
from vibroimpact.dynamics.core.line_events import (
    after_glide,
    end_of_glide,
    energy_to_part,
    narrowed,
    secant_of,
)
from vibroimpact.dynamics.core.line_records import Bracket, Line, LineContact, LineManner, LineState
from vibroimpact.dynamics.core.line_step import energies_of, force_of
from vibroimpact.dynamics.core.normal_motion import write_glide, write_segment
from vibroimpact.dynamics.core.normal_records import NormalGrid
from vibroimpact.dynamics.core.phase import solve_phase
from vibroimpact.dynamics.core.phase_records import (
    AT_TOUCH,
    AT_TOUCH_INWARD,
    BARYCENTRIC,
    BETWEEN,
    BETWEEN_INWARD,
    ELAPSED,
    KINDS,
    LOSS,
    PACE,
    PLACE,
    SHARE,
    SQUARE,
    STATIC,
    TURNING,
    TURNING_AT_TOUCH,
    Phase,
    PhaseRules,
    Segment,
)
from vibroimpact.dynamics.core.records import Law

_SEGMENTS = 3
_SEGMENTS_BACK = 6  # as the law may push again after it has pulled
_MARGIN = 5e-3  # of the depth: the depth is not certain to pass a breakpoint that is closer
_ABOUT = 10.0  # tolerances of the depth: a breakpoint passed by less counts as not passed
_LEAST_RESTITUTION = 0.1  # below it a pair may be captured
_ON_LEVEL = 1e-14  # of the depth
_ITERATIONS = 30
_ASIDE = 1e-6  # of the span: step of finite differences
_NEAR = 1e-5  # in y, of a step, after which the next one would be about its square
_NEAR_ZERO = 1e-12
_TINY = 1e-300  # so that a node has a distance from itself
_NO_FORCE = 1e-11  # of the largest force


@compiled
def potential_of(line: Line, delta: float) -> float:
    """Return the static work of a law and of the weight [J] at an indentation [m]."""
    elastic, plastic = energies_at(line.energies)(delta, line.coefficients)
    return float(elastic + plastic - line.mass * line.gravity * delta)


@compiled
def weigh(vectors: Cube, vector: int, count: int, y: float, room: Matrix) -> None:
    """Write the weights of the nodes and the far end in the value of a polynomial at y."""
    width = (count + 8) // 8 * 8
    for node in range(width):
        room[SHARE, node] = vectors[vector, BARYCENTRIC, node] / (
            y - vectors[vector, PLACE, node] + _TINY
        )
    even = 0.0
    odd = 0.0
    for node in range(0, count, 2):
        even += room[SHARE, node]
        odd += room[SHARE, node + 1]
    whole = 1.0 / (even + odd)
    for node in range(width):
        room[SHARE, node] *= whole


@compiled
def weighed(count: int, values: int, room: Matrix) -> float:
    """Return the value of a polynomial where `weigh` has been called, from the row of its
    values in the room.
    """
    even = 0.0
    odd = 0.0
    for node in range(0, count, 2):
        even += room[SHARE, node] * room[values, node]
        odd += room[SHARE, node + 1] * room[values, node + 1]
    return even + odd


@compiled
def state_in(
    rules: PhaseRules, segment: Segment, phase: Phase, y: float, room: Matrix
) -> LineState:
    """Return the state at y in a segment, with no time and no loss."""
    kind = segment.kind
    # delta = shallow + (deep - shallow) (1 - y^2)^n: about y = 0 a turn is smooth, and at touch the
    # power n makes a root of the indentation smooth
    shape = 1.0 - y * y
    is_at_touch = kind in (TURNING_AT_TOUCH, AT_TOUCH, AT_TOUCH_INWARD)
    if is_at_touch and rules.root == 2:
        shape = shape * shape
    elif is_at_touch:
        shape = shape * shape * shape * shape
    count = rules.counts[phase.rule]
    weigh(rules.vectors, phase.rule * KINDS + kind, count, y, room)
    square = max(weighed(count, SQUARE, room), 0.0)
    factor = 1.0
    if kind in (TURNING_AT_TOUCH, TURNING):  # their square is that of the rate over y
        factor = y
    delta = segment.shallow + (phase.deep - segment.shallow) * shape
    return LineState(0.0, delta, segment.sign * factor * math.sqrt(square), 0.0)


@compiled
def elapsed_at(
    vectors: Cube, matrices: Cube, vector: int, count: int, y: float, room: Matrix
) -> float:
    """Return the integral of the pace up to y [s], from the end of a segment where the
    motion is known.
    """
    width = (count + 8) // 8 * 8
    for node in range(count, width):
        room[PACE, node] = 0.0
    multiply_row(room, PACE, matrices, 2 * vector + 1, width, width, ELAPSED)
    weigh(vectors, vector, count, y, room)
    return weighed(count, ELAPSED, room)


@compiled
def peak_in(
    line: Line, rules: PhaseRules, segment: Segment, phase: Phase, room: Matrix
) -> tuple[float, float]:
    """Return the largest force within a segment of compression [N], and its time since the start of
    that [s]; none if at an end of it.

    It is where the rate of change of the force is zero, by inverse quadratic interpolation within a
    bracket.
    """
    force = force_at(line.force)
    coefficients = line.coefficients
    vectors = rules.vectors
    count = rules.counts[phase.rule]
    vector = phase.rule * KINDS + segment.kind
    turns = segment.kind in (TURNING_AT_TOUCH, TURNING)
    power = 1
    if segment.kind in (TURNING_AT_TOUCH, AT_TOUCH_INWARD):
        power = rules.root
    speed = line.speed
    release = line.release
    gravity = line.gravity
    per_mass = 1.0 / line.mass
    shallow = segment.shallow
    span = phase.deep - shallow
    aside = _ASIDE * line.span
    most = -math.inf
    best = 0
    for node in range(count):
        highest = room[STATIC, node] + room[LOSS, node]
        if highest > most:
            most = highest
            best = node
    middle = vectors[vector, PLACE, best]
    low = 0.0
    if best > 0:
        low = vectors[vector, PLACE, best - 1]
    high = 1.0
    if best < count - 1:
        high = vectors[vector, PLACE, best + 1]
    y = low
    first = low
    second = high
    first_trend = 0.0
    second_trend = 0.0
    moved = math.inf
    highest = -math.inf
    when = 0.0
    nodes_aside = (-1, 1, 0)
    for step in range(_ITERATIONS):
        node = best + nodes_aside[step] if step < 3 else -1
        if 0 <= node < count:
            square = room[SQUARE, node]
        else:
            weigh(vectors, vector, count, y, room)
            square = max(weighed(count, SQUARE, room), 0.0)
        shape = 1.0 - y * y
        if power > 1:
            shape *= shape
        if power > 2:
            shape *= shape
        delta = shallow + span * shape
        rate = math.sqrt(square)
        if turns:
            rate *= y
        static, loss = force(delta, rate, speed, coefficients)
        highest = static + loss
        if moved <= _NEAR:
            break
        faster = aside * (gravity - highest * per_mass)
        static, loss = force(max(delta - aside * rate, release), rate - faster, speed, coefficients)
        later_static, later_loss = force(delta + aside * rate, rate + faster, speed, coefficients)
        trend = later_static + later_loss - static - loss
        if step == 0:
            first_trend = trend
            y = high
        elif step == 1:
            second_trend = trend
            y = middle
            if not first_trend < 0.0 < second_trend:
                break
        elif trend == 0.0:
            break
        else:
            if trend < 0.0:
                low = y
            else:
                high = y
            # inverse quadratic interpolation: y as a parabola of the trend, at zero
            nearer = (
                first
                * second_trend
                * trend
                / ((first_trend - second_trend) * (first_trend - trend))
                + second
                * first_trend
                * trend
                / ((second_trend - first_trend) * (second_trend - trend))
                + y * first_trend * second_trend / ((trend - first_trend) * (trend - second_trend))
            )
            if not low <= nearer <= high:
                nearer = 0.5 * (low + high)
            first = second
            first_trend = second_trend
            second = y
            second_trend = trend
            moved = abs(nearer - y)
            y = nearer
    if first_trend < 0.0 < second_trend or moved < math.inf:
        # elapsed from the deep end, y = 0, or inwards from the shallow one, y = 1, where y falls
        elapsed = elapsed_at(vectors, rules.matrices, vector, count, y, room)
        when = -elapsed
        if segment.kind < AT_TOUCH_INWARD:
            when = phase.duration - elapsed
    else:
        highest = -math.inf
    return highest, when


@compiled
def tension_in(
    line: Line, rules: PhaseRules, segment: Segment, phase: Phase, is_last: bool, room: Matrix
) -> tuple[bool, float]:
    """Return whether it is certain where the force of a segment of restitution first pulls, and
    that y; infinite if it does not.

    It is looked for at the nodes and the shallow end, and not certain if a parabola through three
    of them pulls between them.
    """
    count = rules.counts[phase.rule]
    vector = phase.rule * KINDS + segment.kind
    largest = 0.0
    for node in range(count):
        largest = max(largest, abs(room[STATIC, node] + room[LOSS, node]))
    slack = _NO_FORCE * largest
    before = 0.0
    last = force_of(line, LineState(0.0, phase.deep, -math.sqrt(segment.begun), 0.0))
    before_y = 0.0
    last_y = 0.0
    for node in range(count + 1):
        y = rules.vectors[vector, PLACE, node]
        if node < count:
            force = room[STATIC, node] + room[LOSS, node]
        elif is_last:
            force = 0.0
        else:
            force = force_of(line, LineState(0.0, segment.shallow, -math.sqrt(phase.reached), 0.0))
        if force < -slack:
            bracket = Bracket(last_y, y, last, force, 0)
            if node == 0 or not last > 0.0:
                return False, 0.0
            for _ in range(_ITERATIONS):
                nearer = secant_of(bracket)
                moved = abs(nearer - y)
                y = nearer
                force = force_of(line, state_in(rules, segment, phase, y, room))
                if moved <= _NEAR_ZERO or force == 0.0 or y in (bracket.low, bracket.high):
                    break
                bracket = narrowed(bracket, y, force)
            return True, y
        if node > 0 and last < before and last <= force:
            rise = (force - last) / (y - last_y)
            fall = (before - last) / (last_y - before_y)
            # parabola through three points, with the slope at the middle one and its least value
            bend = (rise + fall) / (y - before_y)
            slope = rise - bend * (y - last_y)
            if last - 0.25 * slope * slope / bend < -slack:
                return False, 0.0
        before = last
        before_y = last_y
        last = force
        last_y = y
    return True, math.inf


@compiled
def collocate_contact(
    law: Law, manner: LineManner, rules: PhaseRules, grid: NormalGrid, room: Matrix
) -> tuple[bool, LineContact]:
    """Return whether the contact of two rigid bodies is solved to the tolerance, and the contact.

    Parameters
    ----------
    law : Law
        Their law at touch, with its memory.
    manner : LineManner
        The bodies, and what stays the same.
    rules : PhaseRules
        The Gauss rules.
    grid : NormalGrid
        Where its normal motion is written, if that is asked for.
    room : array, shape (19, M)
        Room.
    """
    grid.points[0] = 0
    line = line_under(law, manner)
    touch = law.speed * law.speed
    rounding = _ON_LEVEL * (manner.depth - law.release)
    deepest = law.touch
    square = touch
    time = 0.0
    lost = 0.0
    peak_force = force_of(line, LineState(0.0, law.touch, law.speed, 0.0))
    time_of_peak = 0.0
    unsolved = LineContact(RELEASED, LineState(0.0, 0.0, 0.0, 0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    turned = False
    for _ in range(_SEGMENTS):
        level = next_level(law, deepest, True, rounding)
        is_at_touch = deepest == law.touch
        phase = Phase(False, 0, 0.0, 0.0, 0.0, 0.0, 0.0)
        segment = Segment(TURNING, 1.0, 0.0, 0.0, 0.0, 0.0)
        if level < manner.depth - _MARGIN * (manner.depth - law.touch):
            kind = AT_TOUCH_INWARD if is_at_touch else BETWEEN_INWARD
            segment = Segment(kind, 1.0, level, deepest, square, 0.0)
            phase = solve_phase(line, rules, segment, rules.roughness, rules.sharper, room)
        if not phase.solved:
            kind = TURNING_AT_TOUCH if is_at_touch else TURNING
            segment = Segment(kind, 1.0, manner.depth, deepest, 0.0, square)
            phase = solve_phase(line, rules, segment, rules.roughness, rules.sharper, room)
            turned = True
            if not phase.solved or phase.deep > level + _ABOUT * rules.tolerance * (
                phase.deep - law.touch
            ):
                return False, unsolved
        highest, when = peak_in(line, rules, segment, phase, room)
        if grid.steps > 0:
            slower = math.sqrt(square)
            if not turned:
                slower -= math.sqrt(phase.reached)
            write_segment(
                grid,
                rules,
                segment,
                phase,
                1.0,
                line.mass * (slower + line.gravity * phase.duration),
                room,
            )
        if highest > peak_force:
            peak_force = highest
            time_of_peak = time + when
        time += phase.duration
        lost += phase.lost
        deepest = phase.deep
        square = 0.0 if turned else phase.reached
        at_end = force_of(line, LineState(0.0, deepest, math.sqrt(square), 0.0))
        if at_end > peak_force:
            peak_force = at_end
            time_of_peak = time
        if turned:
            break
    if not turned:
        return False, unsolved
    time_of_deepest = time
    plastic = energies_of(line, deepest)[1]
    law = law_remembering(law, deepest)
    line = line_under(law, manner)
    state = LineState(time, deepest, 0.0, lost)
    least_energy = 0.5 * line.mass * (rules.tolerance * manner.speed_scale) ** 2
    if (
        energy_to_part(line, state) < least_energy
        or line.gravity >= force_of(line, state) / line.mass
    ):
        return False, unsolved
    # nothing between the nodes is asked for without friction
    sharper_back = rules.sharper if grid.steps > 0 else 1.0
    for _ in range(_SEGMENTS_BACK):
        level = next_level(
            law, state.delta, False, _ABOUT * rules.tolerance * (deepest - law.release)
        )
        is_last = level == law.release
        begins_at_turn = state.rate == 0.0
        kind = TURNING if begins_at_turn else BETWEEN
        if is_last:
            kind = TURNING_AT_TOUCH if begins_at_turn else AT_TOUCH
        segment = Segment(kind, -1.0, state.delta, level, state.rate * state.rate, 0.0)
        ends_inside = manner.tension == TENSION_CUT and manner.contact_end == ENDS_AT_NO_FORCE
        roughness = rules.roughness
        if ends_inside:
            roughness = rules.roughness_inside
        phase = solve_phase(line, rules, segment, roughness, sharper_back, room)
        if not phase.solved:
            return False, unsolved
        if manner.tension == TENSION_CUT:
            certain, y = tension_in(line, rules, segment, phase, is_last, room)
            if not certain:
                return False, unsolved
            if y < math.inf:
                if phase.roughness > rules.roughness_inside:
                    phase = solve_phase(
                        line, rules, segment, rules.roughness_inside, sharper_back, room
                    )
                    if not phase.solved:
                        return False, unsolved
                    certain, y = tension_in(line, rules, segment, phase, is_last, room)
                    if not (certain and y < math.inf):
                        return False, unsolved
                pulled = state_in(rules, segment, phase, y, room)
                energy = 0.5 * line.mass * (pulled.rate * pulled.rate - state.rate * state.rate)
                fallen = potential_of(line, state.delta) - potential_of(line, pulled.delta) - energy
                vector = phase.rule * KINDS + kind
                elapsed = elapsed_at(
                    rules.vectors, rules.matrices, vector, rules.counts[phase.rule], y, room
                )
                begun = state.rate
                state = LineState(
                    state.time + elapsed, pulled.delta, pulled.rate, state.lost + fallen
                )
                if grid.steps > 0:
                    write_segment(
                        grid,
                        rules,
                        segment,
                        phase,
                        y,
                        line.mass * (begun - pulled.rate + line.gravity * elapsed),
                        room,
                    )
                if manner.contact_end != ENDS_AT_NO_FORCE:
                    glide, pushes, stays = end_of_glide(line, state)
                    if stays:
                        return False, unsolved
                    if grid.steps > 0:
                        write_glide(grid, glide)
                    state = after_glide(line, state, glide, pushes)
                    if pushes:
                        continue
                break
        if grid.steps > 0:
            faster = state.rate + math.sqrt(phase.reached)
            write_segment(
                grid,
                rules,
                segment,
                phase,
                1.0,
                line.mass * (faster + line.gravity * phase.duration),
                room,
            )
        state = LineState(
            state.time + phase.duration, level, -math.sqrt(phase.reached), state.lost + phase.lost
        )
        if is_last:
            break
    is_short = (
        manner.tension == TENSION_CUT
        and manner.contact_end == ENDS_AT_NO_FORCE
        and state.delta == law.release
    )
    if is_short or not state.rate * state.rate > _LEAST_RESTITUTION * _LEAST_RESTITUTION * touch:
        return False, unsolved
    stored = energies_of(line, state.delta)[0]
    return True, LineContact(
        RELEASED, state, deepest, time_of_deepest, peak_force, time_of_peak, plastic, stored
    )
