"""The sliding of a contact along one direction: it sticks, slips at its rim or slides, from point
to point of its normal motion.

Where it begins or ceases to slip or to slide within a step, that place is located and the contact
takes the rest of the step from there. A contact of Cattaneo and Mindlin slips at its rim while its
middle sticks (`at_rim`); one with a single spring sticks, or all of it slides.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.cubics import cubic_at, share_at, turn_of
from vibroimpact.dynamics.core.friction_records import (
    Cubic,
    Curve,
    Friction,
    NormalState,
    SlipState,
)
from vibroimpact.dynamics.core.sliding_steps import (
    moved,
    normal_between,
    shortened,
    slide,
    slip_at_rim,
    stick,
    swept_to_middle,
)
from vibroimpact.dynamics.core.slip_states import (
    begin_sliding,
    end_sliding,
    excess_depth,
    in_direction,
    integral_slope,
    least_rate,
    rises,
    slides,
    state_within,
)
from vibroimpact.dynamics.core.turning_points import (
    add_rim,
    begin_at_rim,
    end_slip,
    held_at,
    middle_of,
)

MOST_CHANGES = 6
"""Changes of a contact in one step at most."""

_TINY = 1e-150
_SAME = 1e-6
"""Relative difference below which the depths where two parts of a contact meet are the same."""

_NEAR = 0.25
"""Part of the way of the slip to the middle of a contact that is left where its force is
not smooth any more.
"""

_DIP = 1e-3
"""Part of the bound by which the force of a spring exceeds it within a step, so that it
slides there; less is an error of interpolation.
"""

_ROUNDS = 3
"""How often the place at which a spring begins to slide at the end of a contact is mended."""


@compiled
def last_slide(
    friction: Friction, start: NormalState, end: NormalState, before: SlipState, power: float
) -> tuple[float, float]:
    """Return where a spring begins to slide in the step at whose end the contact ends, as a share
    of it, and in which direction.

    Towards the end the integral goes like a power of the radius, which falls evenly to zero, and is
    more than its bound at last.
    """
    depths = Cubic(start.depth, start.depth_slope, end.depth, end.depth_slope)
    depth = start.depth
    integral = before.integral
    share = 0.0
    for _ in range(_ROUNDS):
        # |I| goes with a^power, its bound with a^3: they meet where 2/3 a^(3 - power) is |I| over
        # a^power now
        rim = (1.5 * abs(integral) / max(depth, _TINY) ** (0.5 * power)) ** (1.0 / (3.0 - power))
        share = share_at(depths, min(rim * rim, start.depth))
        there = normal_between(start, end, share)
        depth = there.depth
        integral = stick(
            friction, shortened(start, share), shortened(there, share), before, power
        ).integral
    direction = -1.0 if integral < 0.0 else 1.0
    return share, direction


@compiled
def friction_reserve(
    start: NormalState,
    end: NormalState,
    before: SlipState,
    after: SlipState,
    direction: float,
    power: float,
) -> Cubic:
    """Return by how much the integral of a spring in a direction is below its bound
    through a step [m^1.5]; `power`: see `stick`.
    """
    return Cubic(
        start.most - direction * before.integral,
        math.sqrt(start.depth) * start.depth_slope
        - direction * integral_slope(start, before, power),
        end.most - direction * after.integral,
        math.sqrt(end.depth) * end.depth_slope - direction * integral_slope(end, after, power),
    )


@compiled
def spring_slides(
    friction: Friction,
    start: NormalState,
    end: NormalState,
    before: SlipState,
    after: SlipState,
    power: float,
) -> tuple[float, float]:
    """Return the share of a step after which a spring that sticks begins to slide, infinite if it
    does not, and the direction.

    The direction is 0 where the spring sticks on, but begins to shrink.
    """
    share = np.inf
    direction = -1.0 if after.integral < 0.0 else 1.0
    if end.depth <= 0.0:  # where the contact ends all of it slides
        share, direction = last_slide(friction, start, end, before, power)
    elif direction * after.integral > end.most:
        share = share_at(friction_reserve(start, end, before, after, direction, power), 0.0)
    else:
        for sign in (1.0, -1.0):
            reserve = friction_reserve(start, end, before, after, sign, power)
            turn = turn_of(reserve)
            lowest, _ = cubic_at(reserve, turn)
            # it would have slid on the way
            if reserve.slope < 0.0 < reserve.end_slope and lowest < -_DIP * max(
                start.most, end.most
            ):
                falling = Cubic(reserve.value, turn * reserve.slope, lowest, 0.0)
                share = turn * share_at(falling, 0.0)
                direction = sign
    if friction.growing != friction.shrinking and rises(start) and end.depth_slope < 0.0:
        turn = turn_of(Cubic(start.depth, start.depth_slope, end.depth, end.depth_slope))
        if turn < share:
            return turn, 0.0
    return share, direction


@compiled
def rim_slips(
    start: NormalState, end: NormalState, before: SlipState, after: SlipState
) -> tuple[float, float]:
    """Return the share of a step after which a contact that sticks begins to slip at its
    rim, infinite if never, and the direction.
    """
    share = np.inf
    direction = 1.0
    if abs(end.pace * after.velocity) > end.depth_slope:
        for sign in (1.0, -1.0):
            excess = excess_depth(start, end, before, after, sign, 1.0)
            if excess.end_slope < 0.0:
                turn = turn_of(excess)
                if turn < share:
                    share = turn
                    direction = sign
    return share, direction


@compiled
def begin_slip(
    friction: Friction, curve: Curve, normal: NormalState, state: SlipState, direction: float
) -> SlipState:
    """Return the state of a contact that has stuck and begins to slip, or sticks on where
    the direction is 0.
    """
    if not friction.at_rim:
        state = in_direction(state, direction, 0.0)
        if direction == 0.0:
            return state
        return begin_sliding(friction, state, normal.depth)
    add_rim(curve, normal.depth, state.displacement, state.integral)
    begin_at_rim(curve)
    state = in_direction(state, direction, math.sqrt(normal.depth))
    if state.front == 0.0:
        return begin_sliding(friction, state, normal.depth)
    return state


@compiled
def cease_to_slip(
    friction: Friction, curve: Curve, normal: NormalState, state: SlipState
) -> SlipState:
    """Return the state of a contact that has slipped and sticks from now on."""
    direction = state.direction
    has_slid = slides(state)
    held = 0.0
    if friction.at_rim:
        front = 0.0
        if not has_slid:
            begin_at_rim(curve)
            held, front = held_at(curve, direction, normal.depth - direction * state.displacement)
        end_slip(
            curve,
            direction,
            held,
            front,
            normal.depth,
            state.displacement,
            direction * (normal.most - held),
        )
    state = SlipState(
        state.velocity,
        state.displacement,
        direction * (normal.most - held),
        0.0,
        0.0,
        state.microslip,
    )
    if has_slid:
        return end_sliding(friction, state, normal.depth)
    return state


@compiled
def turn_back(friction: Friction, curve: Curve, normal: NormalState, state: SlipState) -> SlipState:
    """Return the state of a contact that ceases to slip at its rim; one that shrinks
    slips in the other direction.
    """
    direction = state.direction
    state = cease_to_slip(friction, curve, normal, state)
    if friction.at_rim and normal.depth_slope < 0.0:
        begin_at_rim(curve)
        state = in_direction(state, -direction, math.sqrt(normal.depth))
    return state


@compiled
def settle(friction: Friction, curve: Curve, start: NormalState, state: SlipState) -> SlipState:
    """Return the state with which a part of a contact begins, whose rates may be others
    than at the end of the part before.
    """
    rate = start.pace * state.velocity
    if state.direction == 0.0:
        if friction.at_rim and abs(rate) > start.depth_slope:
            direction = -1.0 if rate < 0.0 else 1.0
            return begin_slip(friction, curve, start, state, direction)
        return state
    least = 1.0
    if not friction.at_rim:
        least = least_rate(friction, start.depth_slope > 0.0)
    if state.direction * rate < least * start.depth_slope:
        return turn_back(friction, curve, start, state)
    return state


@compiled
def jump_of_spring(
    friction: Friction, curve: Curve, start: NormalState, end: NormalState, state: SlipState
) -> SlipState:
    """Return the state of a spring that stretches, or shrinks, with a depth that jumps."""
    power = friction.shrinking
    if end.depth > start.depth:
        power = friction.growing
    ratio = 1.0
    if start.depth > 0.0:
        ratio = end.depth / start.depth
    # Q goes with the power of the contact radius, which is the root of the depth
    integral = state.integral * ratio ** (0.5 * power)
    is_over = abs(integral) > end.most
    had_slid = slides(state)
    direction = state.direction
    if is_over:
        direction = 1.0 if integral > 0.0 else -1.0
    integral = min(max(integral, -end.most), end.most)
    state = SlipState(state.velocity, state.displacement, integral, direction, 0.0, state.microslip)
    if is_over and not had_slid:
        return begin_sliding(friction, state, end.depth)
    return state


@compiled
def jump_of_rim(
    friction: Friction, curve: Curve, start: NormalState, end: NormalState, state: SlipState
) -> SlipState:
    """Return the state of a contact whose rim jumps: it sticks as it grows, and slips in
    the direction in which it slips deeper.
    """
    if end.depth > start.depth:
        add_rim(curve, end.depth, state.displacement, state.integral)
        return state
    direction = state.direction
    has_slid = slides(state)
    if direction == 0.0:
        begin_at_rim(curve)
        _, forward = held_at(curve, 1.0, end.depth - state.displacement)
        begin_at_rim(curve)
        _, backward = held_at(curve, -1.0, end.depth + state.displacement)
        direction = 1.0 if forward <= backward else -1.0
    held = 0.0
    front = 0.0
    if not has_slid:
        begin_at_rim(curve)
        held, front = held_at(curve, direction, end.depth - direction * state.displacement)
    state = SlipState(
        state.velocity,
        state.displacement,
        direction * (end.most - held),
        direction,
        front,
        state.microslip,
    )
    if not has_slid and front == 0.0:
        return begin_sliding(friction, state, end.depth)
    return state


@compiled
def join(
    friction: Friction, curve: Curve, start: NormalState, end: NormalState, state: SlipState
) -> SlipState:
    """Return the state after a jump of the depth, where two parts of a contact meet."""
    if abs(end.depth - start.depth) <= _SAME * max(start.depth, end.depth):
        return state
    if end.depth > start.depth and state.direction != 0.0:
        state = cease_to_slip(friction, curve, start, state)
    if friction.at_rim:
        return jump_of_rim(friction, curve, start, end, state)
    return jump_of_spring(friction, curve, start, end, state)


@compiled
def advance_sticking(
    friction: Friction,
    curve: Curve,
    start: NormalState,
    end: NormalState,
    before: SlipState,
    stays: bool,
) -> tuple[SlipState, float]:
    """Take a contact that sticks to the end of a step, or to where it changes; return that share of
    the step, infinite at the end.

    `stays`: it does not change any more.
    """
    grows = rises(start) or end.depth_slope > 0.0
    power = friction.shrinking
    if grows:
        power = friction.growing
    after = stick(friction, start, end, before, power)
    if friction.at_rim:
        share, direction = rim_slips(start, end, before, after)
    else:
        share, direction = spring_slides(friction, start, end, before, after, power)
    if stays or not np.isfinite(share):
        if friction.at_rim:
            add_rim(curve, end.depth, after.displacement, after.integral)
        return after, np.inf
    integrals = Cubic(
        before.integral,
        integral_slope(start, before, power),
        after.integral,
        integral_slope(end, after, power),
    )
    integral, _ = cubic_at(integrals, share)
    state = state_within(friction, start, end, before, after, share)
    state = SlipState(state.velocity, state.displacement, integral, 0.0, 0.0, state.microslip)
    return begin_slip(friction, curve, normal_between(start, end, share), state, direction), share


@compiled
def advance_sliding(
    friction: Friction,
    curve: Curve,
    start: NormalState,
    end: NormalState,
    before: SlipState,
    stays: bool,
) -> tuple[SlipState, float]:
    """Take a contact all of which slides to the end of a step, or to where it ceases to;
    as `advance_sticking`.
    """
    after = slide(friction, start, end, before)
    least = 1.0
    if not friction.at_rim:
        least = least_rate(friction, rises(start) or end.depth_slope > 0.0)
    goes_on = (
        before.direction * end.pace * after.velocity >= least * end.depth_slope or end.depth <= 0.0
    )
    if stays or goes_on:
        return after, np.inf
    share = turn_of(excess_depth(start, end, before, after, before.direction, least))
    state = state_within(friction, start, end, before, after, share)
    return turn_back(friction, curve, normal_between(start, end, share), state), share


@compiled
def mended_near_middle(
    friction: Friction,
    curve: Curve,
    start: NormalState,
    end: NormalState,
    before: SlipState,
    after: SlipState,
) -> SlipState:
    """Return the state at the end of a step of a contact that slips nearly to its middle,
    near where the force is not smooth.
    """
    direction = before.direction
    begin_at_rim(curve)
    excess = excess_depth(start, end, before, after, direction, 1.0)
    swept = swept_to_middle(curve, direction, start, end, excess)
    velocity = (
        before.velocity + friction.pull * (end.time - start.time) - friction.stiffness * swept
    )
    mended = moved(friction, start, end, before, velocity, after.integral)
    held, front = held_at(curve, direction, end.depth - direction * mended.displacement)
    integral = direction * (end.most - held)
    return SlipState(
        mended.velocity, mended.displacement, integral, direction, front, before.microslip
    )


@compiled
def arrived_at_middle(
    friction: Friction,
    curve: Curve,
    start: NormalState,
    known: NormalState,
    before: SlipState,
    excess: Cubic,
    share: float,
) -> SlipState:
    """Return the state of a contact whose slip comes to its middle at a share of a step;
    `known`: the normal motion there.
    """
    direction = before.direction
    there, slope = cubic_at(excess, share)
    begin_at_rim(curve)
    x = Cubic(excess.value, excess.slope * share, there, slope * share)
    swept = swept_to_middle(curve, direction, shortened(start, share), shortened(known, share), x)
    velocity = (
        before.velocity + friction.pull * (known.time - start.time) - friction.stiffness * swept
    )
    displacement = direction * (known.depth - middle_of(curve, direction))
    state = SlipState(
        velocity, displacement, direction * known.most, direction, 0.0, before.microslip
    )
    return begin_sliding(friction, state, known.depth)


@compiled
def advance_slipping(
    friction: Friction,
    curve: Curve,
    start: NormalState,
    end: NormalState,
    before: SlipState,
    stays: bool,
) -> tuple[SlipState, float]:
    """Take a contact that slips at its rim to the end of a step, or to where it changes;
    as `advance_sticking`.
    """
    direction = before.direction
    after = slip_at_rim(friction, curve, start, end, before)
    begun_x = start.depth - direction * before.displacement
    x = end.depth - direction * after.displacement
    middle = middle_of(curve, direction)
    arrives = x <= middle
    if not arrives and x - middle < _NEAR * (begun_x - middle):
        after = mended_near_middle(friction, curve, start, end, before, after)
    is_turned = direction * end.pace * after.velocity < end.depth_slope and end.depth > 0.0
    # x falls while it slips: where it rises the slip turns; below the middle all of the contact
    # slides; the slip ends at the rim, and begins there in the other direction
    leaves = after.front * after.front > end.depth
    if stays or not (is_turned or arrives or leaves):
        return after, np.inf
    excess = excess_depth(start, end, before, after, direction, 1.0)
    share = turn_of(excess) if is_turned else np.inf
    if leaves:
        slipped = start.depth - before.front * before.front
        slipped_at_end = end.depth - after.front * after.front
        share = min(share, min(max(slipped / max(slipped - slipped_at_end, _TINY), 0.0), 1.0))
    arrival = share_at(excess, middle) if arrives else np.inf
    if arrival < share:
        known = normal_between(start, end, arrival)
        return arrived_at_middle(friction, curve, start, known, before, excess, arrival), arrival
    state = state_within(friction, start, end, before, after, share)
    return turn_back(friction, curve, normal_between(start, end, share), state), share


@compiled
def advance_step(
    friction: Friction, curve: Curve, start: NormalState, end: NormalState, state: SlipState
) -> SlipState:
    """Return the state at the end of a step, from change to change."""
    # after each change the rest of the step is a step of its own
    for changes in range(MOST_CHANGES + 1):
        stays = changes == MOST_CHANGES
        if state.direction == 0.0:
            state, share = advance_sticking(friction, curve, start, end, state, stays)
        elif state.front == 0.0:
            state, share = advance_sliding(friction, curve, start, end, state, stays)
        else:
            state, share = advance_slipping(friction, curve, start, end, state, stays)
        if not np.isfinite(share):
            break
        known = normal_between(start, end, share)
        start = shortened(known, 1.0 - share)
        end = shortened(end, 1.0 - share)
    return state
