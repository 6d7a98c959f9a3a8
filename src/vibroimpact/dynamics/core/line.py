"""The contact of two rigid bodies from touch to release: steps in the variable that suits, each of
which ends at the next event.

Compression goes through the breakpoints of the law to the deepest point, at which the law's memory
changes; restitution goes back through them to release. Where the force of a law that may not pull
becomes zero, the contact ends, or the bodies move freely within the indentation until the law
pushes again.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Matrix
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.events import ENDS_AT_NO_FORCE, TENSION_CUT
from vibroimpact.dynamics.core.law import law_remembering
from vibroimpact.dynamics.core.line_events import (
    AT_CAPTURE,
    AT_LEVEL,
    AT_NO_FORCE,
    AT_TURN,
    NO_END,
    after_glide,
    end_of_glide,
    energy_to_part,
    extreme_force,
    length_to,
    length_to_tension,
)
from vibroimpact.dynamics.core.line_records import (
    Advance,
    Line,
    LineContact,
    LineManner,
    LineState,
    LineSteps,
)
from vibroimpact.dynamics.core.line_step import (
    BY_FLOW,
    BY_RATE,
    BY_ROOT,
    FREE,
    IMPLICIT,
    advance,
    energies_of,
    force_of,
    force_trend,
    root_of,
)
from vibroimpact.dynamics.core.records import Law
from vibroimpact.dynamics.core.static import bisected_indentation

RELEASED, CAPTURED, FAILED = 0, 1, 2
"""Outcomes: released; too little energy to leave the indentation; not to be integrated."""

# of the root of the depth over the speed, times the order-th root of the tolerance
_FIRST_LENGTH = 1.7
# of the length that the error asks for, so that few steps are rejected
_SAFETY = 0.82
_LEAST_GROWTH = 0.2
_MOST_GROWTH = 4.0
# the estimated error of a step goes with these powers of its length
_ORDER = 8.0
_ORDER_IMPLICIT = 6.0
_STIFF = 2_000  # explicit steps, after which implicit ones are taken
_SHORTEST = 1e-16  # of the first length
_ON_LEVEL = 1e-14  # of the depth: as near to a breakpoint a step begins on it
_NO_FORCE = 1e-11  # of the largest force
_IMBALANCE = 1e3  # of the error of a step: of the energy of a contact
_LEAST_IMBALANCE = 1e-10
_STILL = 1e-12  # of the work of the weight
_TINY = 1e-300


@compiled
def next_level(law: Law, delta: float, compressing: bool, rounding: float) -> float:
    """Return the next indentation at which the force is not smooth [m], on the way in
    infinite if there is none, on the way out release.
    """
    if compressing:
        level = np.inf
        if law.first_breakpoint > delta + rounding:
            level = law.first_breakpoint
        if delta + rounding < law.second_breakpoint < level:
            level = law.second_breakpoint
        return level
    level = law.release
    if level < law.first_breakpoint < delta - rounding:
        level = law.first_breakpoint
    if level < law.second_breakpoint < delta - rounding:
        level = law.second_breakpoint
    return level


@compiled
def write_step(
    steps: LineSteps, variable: int, after: bool, begun: LineState, length: float
) -> None:
    """Write a step, or count it where there is no room."""
    step = steps.written[0]
    steps.written[0] += 1
    if step < len(steps.length):
        steps.variable[step] = variable
        steps.after[step] = after
        steps.begun[step, 0] = begun.time
        steps.begun[step, 1] = begun.delta
        steps.begun[step, 2] = begun.rate
        steps.begun[step, 3] = begun.lost
        steps.length[step] = length


@compiled
def line_under(law: Law, manner: LineManner) -> Line:
    """Return the two bodies under a law, with its memory."""
    depth = manner.depth - law.release
    span = depth / manner.speed_scale
    tolerance = manner.tolerance
    return Line(
        law.addresses[0],
        law.addresses[1],
        law.coefficients,
        law.speed,
        law.release,
        manner.root,
        manner.mass,
        manner.gravity,
        span,
        tolerance * depth ** (1.0 / manner.root),
        tolerance * manner.speed_scale,
        tolerance * span,
        tolerance * manner.mass * manner.speed_scale * manner.speed_scale,
    )


@compiled
def next_step(
    line: Line, state: LineState, compressing: bool, level: float, length: float, stages: Matrix
) -> tuple[int, float, Advance]:
    """Return the variable, the length and the end of a step of about a length of the flow.

    One that seems to reach the next level, or the deepest point, is first tried with the root, or
    the rate, for its variable.
    """
    # s^n is the indentation above release; slope: n s^(n - 1), slowing: dv/d tau
    root = root_of(line, state.delta)
    ahead = np.inf
    if np.isfinite(level):
        ahead = root_of(line, level) - root
    slope = 2.0 * root
    if line.root == 4:
        slope = 4.0 * root * root * root
    slowing = slope * (line.gravity - force_of(line, state) / line.mass)
    if abs(ahead) <= abs(length * state.rate):
        step = advance(line, BY_ROOT, state, ahead, stages)
        if step.error <= 1.0:
            return BY_ROOT, ahead, step
    elif compressing and state.rate <= -length * slowing:
        step = advance(line, BY_RATE, state, -state.rate, stages)
        if step.error <= 1.0:
            return BY_RATE, -state.rate, step
    return BY_FLOW, length, advance(line, BY_FLOW, state, length, stages)


@compiled
def first_end(
    line: Line,
    manner: LineManner,
    variable: int,
    begun: LineState,
    compressing: bool,
    level: float,
    length: float,
    step: Advance,
    slack: float,
    least_energy: float,
    stages: Matrix,
) -> tuple[int, float, LineState]:
    """Return what ends a step first, of `line_events`, the length up to there, and the state then.

    Parameters
    ----------
    line, manner : Line, LineManner
        The bodies.
    variable : int
        The variable of the step.
    begun : LineState
        Where it begins.
    compressing : bool
        Has the deepest point not been reached yet?
    level : float
        The next indentation at which a step has to end [m].
    length : float
        Length of the step.
    step : Advance
        Its end.
    slack : float
        A force that pulls by less is zero to rounding [N].
    least_energy : float
        Energy to part, less than which holds the bodies [J].
    stages : array, shape (4, 13)
        Room.
    """
    end = NO_END
    state = step.state
    # each end that is found shortens the step, so that the last one found is the first in time
    if variable == BY_ROOT:
        end = AT_LEVEL
    elif variable == BY_RATE:
        end = AT_TURN
    elif (state.rate < 0.0) == compressing and state.rate != 0.0:
        end = AT_TURN
        length = length_to(line, variable, begun, 0.0, length, AT_TURN, 0.0, stages)
        state = advance(line, variable, begun, length, stages).state
    is_beyond = state.delta > level
    if not compressing:
        is_beyond = state.delta <= level
    if variable != BY_ROOT and is_beyond:
        end = AT_LEVEL
        length = length_to(line, variable, begun, 0.0, length, AT_LEVEL, level, stages)
        state = advance(line, variable, begun, length, stages).state
    if manner.tension == TENSION_CUT and not compressing:
        is_seen = end == AT_LEVEL or step.least_force < -slack
        until = length_to_tension(line, variable, begun, length, slack, is_seen, stages)
        if np.isfinite(until):
            end = AT_NO_FORCE
            length = until
            state = advance(line, variable, begun, length, stages).state
    # to the last digit, so that the next step begins on the event and does not meet it again
    if end == AT_LEVEL:
        state = LineState(state.time, level, state.rate, state.lost)
    elif end == AT_TURN:
        state = LineState(state.time, state.delta, 0.0, state.lost)
    if not compressing and end in (NO_END, AT_LEVEL) and energy_to_part(line, state) < least_energy:
        end = AT_CAPTURE
        length = length_to(line, variable, begun, 0.0, length, AT_CAPTURE, least_energy, stages)
        state = advance(line, variable, begun, length, stages).state
    return end, length, state


@compiled
def sinks_to(line: Line, state: LineState, least_energy: float) -> tuple[bool, float]:
    """Has a body in compression crept to its static indentation without a turn, and which
    is that [m]?
    """
    if not energy_to_part(line, state) < least_energy:
        return False, 0.0
    weight = line.mass * line.gravity
    sag = bisected_indentation(line.force, line.coefficients, line.release, weight)
    elastic, plastic = energies_of(line, state.delta)
    elastic_there, plastic_there = energies_of(line, sag)
    kinetic = 0.5 * line.mass * state.rate * state.rate
    # the energy that is left to lose on the way to the static indentation
    left = (
        kinetic + elastic + plastic - elastic_there - plastic_there - weight * (state.delta - sag)
    )
    return kinetic < least_energy or left < max(_STILL * weight * sag, least_energy), sag


@compiled
def energy_of(line: Line, state: LineState, plastic: float) -> float:
    """Return the energy of the motion, of the law and of the weight, with what was lost
    in damping and in plastic work, `plastic` [J].
    """
    elastic, _ = energies_of(line, state.delta)
    kinetic = 0.5 * line.mass * state.rate * state.rate
    return kinetic + elastic + plastic + state.lost - line.mass * line.gravity * state.delta


@compiled
def follow_line(law: Law, manner: LineManner, steps: LineSteps) -> LineContact:
    """Follow the contact of two rigid bodies from touch until it is released, or captured.

    Parameters
    ----------
    law : Law
        Their law at touch, with its memory.
    manner : LineManner
        The bodies, and what stays the same.
    steps : LineSteps
        Room for the steps.
    """
    stages = np.empty((4, 13))
    line = line_under(law, manner)
    # a body that would leave at less than the tolerated error of its speed does not leave
    least_energy = 0.5 * line.mass * (manner.tolerance * manner.speed_scale) ** 2
    rounding = _ON_LEVEL * (manner.depth - law.release)
    first_length = _FIRST_LENGTH * manner.tolerance ** (1.0 / _ORDER) / manner.speed_scale
    length = first_length * root_of(line, manner.depth)
    shortest = _SHORTEST * length
    state = LineState(0.0, law.touch, law.speed, 0.0)
    brought = energy_of(line, state, 0.0)
    imbalance = (
        max(_IMBALANCE * manner.tolerance, _LEAST_IMBALANCE) * line.mass * manner.speed_scale**2
    )
    compressing = True
    deepest = 0.0
    time_of_deepest = 0.0
    plastic = 0.0
    force = force_of(line, state)
    trend = force_trend(line, state, force)
    peak_force = max(force, 0.0)
    time_of_peak = 0.0
    outcome = FAILED
    is_stiff = False
    steps.written[0] = 0
    for _ in range(manner.most_steps):
        level = next_level(law, state.delta, compressing, rounding)
        if is_stiff:
            variable = IMPLICIT
            tried = length
            step = advance(line, IMPLICIT, state, length, stages)
        else:
            variable, tried, step = next_step(line, state, compressing, level, length, stages)
        order = _ORDER_IMPLICIT if is_stiff else _ORDER
        wanted = _SAFETY * max(step.error, _TINY) ** (-1.0 / order)
        growth = min(max(wanted, _LEAST_GROWTH), _MOST_GROWTH)
        # steps to a level or to the turn have another length than that which the error controls
        if variable == BY_FLOW or is_stiff:
            length *= growth
        if not step.error <= 1.0:
            if length < shortest:
                break
            continue
        slack = _NO_FORCE * peak_force
        end, tried, after = first_end(
            line,
            manner,
            variable,
            state,
            compressing,
            level,
            tried,
            step,
            slack,
            least_energy,
            stages,
        )
        write_step(steps, variable, not compressing, state, tried)
        if steps.written[0] == _STIFF:
            is_stiff = True
            length = after.time - state.time
        if compressing:  # damping adds to the force there, and takes from it in restitution
            force = force_of(line, after)
            before = trend
            trend = force_trend(line, after, force)
            if before > 0.0 > trend:
                highest, when, _ = extreme_force(
                    line, variable, state, tried, before, trend, stages
                )
                if highest > peak_force:
                    peak_force = highest
                    time_of_peak = when
            if force > peak_force:
                peak_force = force
                time_of_peak = after.time
        state = after

        if not compressing:
            if end == AT_LEVEL and level == law.release:
                outcome = RELEASED
                break
            if end in (AT_TURN, AT_CAPTURE):  # it falls back before separation, or will
                outcome = CAPTURED
                break
            if end == AT_NO_FORCE:
                if manner.contact_end == ENDS_AT_NO_FORCE:
                    outcome = RELEASED
                    break
                glide, pushes, stays = end_of_glide(line, state)
                write_step(steps, FREE, True, state, glide)
                state = after_glide(line, state, glide, pushes or stays)
                if stays and not pushes:
                    outcome = CAPTURED
                    break
                if not pushes:
                    outcome = RELEASED
                    break
                if not is_stiff:
                    length = min(length, root_of(line, state.delta) / abs(state.rate))
            continue

        sinks = False
        sag = 0.0
        if end != AT_TURN:
            sinks, sag = sinks_to(line, state, least_energy)
        if end == AT_TURN or sinks:
            compressing = False
            deepest = state.delta
            time_of_deepest = state.time
            plastic = energies_of(line, deepest)[1]
            if not abs(energy_of(line, state, plastic) - brought) <= imbalance:
                break  # the law's energies are not those of its force
            law = law_remembering(law, deepest)
            line = line_under(law, manner)
            if sinks:
                deepest = max(deepest, sag)
            # held by its energy, or by a force that does not exceed the weight
            if (
                energy_to_part(line, state) < least_energy
                or line.gravity >= force_of(line, state) / line.mass
            ):
                outcome = CAPTURED
                break
            if not is_stiff:
                length = first_length * root_of(line, state.delta)
    if not abs(energy_of(line, state, plastic) - brought) <= imbalance:
        outcome = FAILED
    stored = energies_of(line, state.delta)[0]
    return LineContact(
        outcome, state, deepest, time_of_deepest, peak_force, time_of_peak, plastic, stored
    )
