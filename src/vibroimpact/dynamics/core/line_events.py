"""Where a step of the contact of two rigid bodies has to end: at an indentation, where it
turns, where it no longer pushes, and so on.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Matrix
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.line_records import Bracket, Line, LineState
from vibroimpact.dynamics.core.line_step import FREE, advance, energies_of, force_of, force_trend

NO_END, AT_LEVEL, AT_TURN, AT_NO_FORCE, AT_CAPTURE = range(5)
"""Ends of a step: none; at an indentation; at a rate of zero; at a force of zero; where
the energy no longer takes the bodies apart.
"""

LOW, HIGH = -1, 1
"""Ends of a bracket; 0 where none has been moved."""

_MOST_ITERATIONS = 100
_NEAR = 1e-15  # of the step
# shares of a step, dense towards its end, as a damped force begins to pull just before release
_PROBES = np.array([0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 0.95, 0.99, 0.999, 0.9999])
_SAMPLES = 32
_NEAR_PEAK = 1e-8  # of the span


@compiled
def distance_to(line: Line, end: int, level: float, state: LineState) -> float:
    """Return how far a state is from an end [m], [m/s], [N] or [J]; `level`: an
    indentation [m], or the least energy to part [J].
    """
    if end == AT_LEVEL:
        return state.delta - level
    if end == AT_TURN:
        return state.rate
    if end == AT_NO_FORCE:
        return force_of(line, state)
    return energy_to_part(line, state) - level


@compiled
def energy_to_part(line: Line, state: LineState) -> float:
    """Return the energy above that with which the bodies would part without speed, if
    nothing more were lost [J].
    """
    # m v^2/2 + W(delta) - W(release) - m g (delta - release), with the static work W of the law
    weight = line.mass * line.gravity
    elastic, plastic = energies_of(line, state.delta)
    barrier, _ = energies_of(line, line.release)
    return (
        0.5 * line.mass * state.rate * state.rate
        + elastic
        + plastic
        - barrier
        - weight * (state.delta - line.release)
    )


@compiled
def secant_of(bracket: Bracket) -> float:
    """Return where the secant through the ends of a bracket is zero."""
    return bracket.low + (bracket.high - bracket.low) * bracket.low_value / (
        bracket.low_value - bracket.high_value
    )


@compiled
def narrowed(bracket: Bracket, middle: float, value: float) -> Bracket:
    """Return a bracket with the value in its middle in place of that at one end.

    The value at an end that stays for the second time is halved, or it would stay for ever (the
    Illinois method).
    """
    low, high, low_value, high_value, moved = bracket
    if (value > 0.0) == (high_value > 0.0):
        if moved == HIGH:
            low_value *= 0.5
        return Bracket(low, middle, low_value, value, HIGH)
    if moved == LOW:
        high_value *= 0.5
    return Bracket(middle, high, value, high_value, LOW)


@compiled
def length_to(
    line: Line,
    variable: int,
    begun: LineState,
    low: float,
    high: float,
    end: int,
    level: float,
    stages: Matrix,
) -> float:
    """Return the length of a step to an end between two lengths, by the secant within a bracket."""
    low_value = distance_to(line, end, level, advance(line, variable, begun, low, stages).state)
    high_value = distance_to(line, end, level, advance(line, variable, begun, high, stages).state)
    if low_value == 0.0:
        return low
    if (low_value > 0.0) == (high_value > 0.0):
        return high
    bracket = Bracket(low, high, low_value, high_value, 0)
    for _ in range(_MOST_ITERATIONS):
        middle = secant_of(bracket)
        if not abs(bracket.high - bracket.low) > _NEAR * abs(bracket.high) or middle in (
            bracket.low,
            bracket.high,
        ):
            break
        value = distance_to(line, end, level, advance(line, variable, begun, middle, stages).state)
        if value == 0.0:
            return middle
        bracket = narrowed(bracket, middle, value)
    if abs(bracket.low_value) < abs(bracket.high_value):
        return bracket.low
    return bracket.high


@compiled
def length_to_tension(
    line: Line,
    variable: int,
    begun: LineState,
    length: float,
    slack: float,
    is_seen: bool,
    stages: Matrix,
) -> float:
    """Return the length of a step to where the force becomes tensile by more than `slack` [N];
    infinite where it does not.

    It is looked for at some places if it `is_seen`, and where the force has a minimum within the
    step.
    """
    if is_seen:
        before = 0.0
        for probe in range(len(_PROBES) + 1):
            share = _PROBES[probe] if probe < len(_PROBES) else 1.0
            if (
                force_of(line, advance(line, variable, begun, share * length, stages).state)
                < -slack
            ):
                return length_to(
                    line, variable, begun, before * length, share * length, AT_NO_FORCE, 0.0, stages
                )
            before = share
    # it may also pull between two probes, about a minimum
    begun_force = force_of(line, begun)
    falling = force_trend(line, begun, begun_force)
    after = advance(line, variable, begun, length, stages)
    rising = force_trend(line, after.state, after.force)
    if begun_force > 0.0 and falling < 0.0 < rising:
        least, _, deepest = extreme_force(line, variable, begun, length, falling, rising, stages)
        if least < -slack:
            return length_to(line, variable, begun, 0.0, deepest, AT_NO_FORCE, 0.0, stages)
    return np.inf


@compiled
def end_of_glide(line: Line, begun: LineState) -> tuple[float, bool, bool]:
    """Return how long bodies move freely within the indentation [s], whether the law then pushes,
    and whether they stay within.

    They stay where gravity turns them before they separate.
    """
    # free fall against gravity, v^2 = v0^2 - 2 g h: to rest where it does not come to release, or
    # by the root of h + v0 t + g t^2/2 = 0 without cancellation (v0 < 0)
    above = begun.delta - line.release
    square = begun.rate * begun.rate - 2.0 * line.gravity * above
    stays = square < 0.0
    if stays:
        length = -begun.rate / line.gravity
    else:
        parting = math.sqrt(square)
        length = 2.0 * above / (parting - begun.rate)
    no_room = np.empty((4, 0))
    before = 0.0
    for sample in range(1, _SAMPLES):  # at separation itself the force is zero to rounding
        share = sample / _SAMPLES
        time = length * share * (2.0 - share)  # dense near the end, where the force is small
        if force_of(line, advance(line, FREE, begun, time, no_room).state) > 0.0:
            if sample == 1:
                return time, True, False
            return (
                length_to(line, FREE, begun, before, time, AT_NO_FORCE, 0.0, no_room),
                True,
                False,
            )
        before = time
    return length, False, stays


@compiled
def after_glide(line: Line, begun: LineState, length: float, within: bool) -> LineState:
    """Return the state after free motion for a time [s], `within` the indentation or to
    release; the energy stored meanwhile is lost.
    """
    after = advance(line, FREE, begun, length, np.empty((4, 0))).state
    delta = after.delta if within else line.release
    # the surface recovers behind the bodies: what it stored does no work on them
    lost = energies_of(line, begun.delta)[0] - energies_of(line, delta)[0]
    return LineState(after.time, delta, after.rate, after.lost + lost)


@compiled
def extreme_force(
    line: Line,
    variable: int,
    begun: LineState,
    length: float,
    before: float,
    after: float,
    stages: Matrix,
) -> tuple[float, float, float]:
    """Return the largest or least force within a step [N], its time since touch [s], and the length
    of the step up to it.

    `before`, `after`: rates of change of the force at its start and at its end, of opposite signs
    [N/s].
    """
    bracket = Bracket(0.0, length, before, after, 0)
    force = 0.0
    when = begun.time
    middle = 0.0
    for _ in range(_MOST_ITERATIONS):
        middle = secant_of(bracket)
        step = advance(line, variable, begun, middle, stages)
        moved = abs(step.state.time - when)
        force = step.force
        when = step.state.time
        if moved <= _NEAR_PEAK * line.span or middle in (bracket.low, bracket.high):
            break
        bracket = narrowed(bracket, middle, force_trend(line, step.state, force))
    return force, when, middle
