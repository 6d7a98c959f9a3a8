"""States of a contact along the plate, and what is known of it between two of them."""

from __future__ import annotations

import math

from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.cubics import cubic_at
from vibroimpact.dynamics.core.friction_records import Cubic, Friction, NormalState, SlipState

_TINY = 1e-150
_RISES = 1e-9  # of the depth: less is rounding where the contact is largest


@compiled
def rises(normal: NormalState) -> bool:
    """Does the depth of a contact grow, beyond rounding where it is largest?"""
    return normal.depth_slope > _RISES * normal.depth


@compiled
def least_rate(friction: Friction, grows: bool) -> float:
    """Return the rate of the displacement above which all of a contact slides on, over
    that of the depth, as it grows or shrinks.
    """
    # at its bound, I = 2/3 D^(3/2), a spring that sticks has I' = (gamma/3 D' + s') sqrt(D), while
    # the bound rises by D' sqrt(D)
    power = friction.growing if grows else friction.shrinking
    return 1.0 - power / 3.0


@compiled
def slides(state: SlipState) -> bool:
    """Does all of a contact slide?"""
    return state.direction != 0.0 and state.front == 0.0


@compiled
def energy_over_mass(friction: Friction, state: SlipState, depth: float) -> float:
    """Return kinetic energy, that of the pull, and what a contact stores that slides,
    over mass and the square of kappa [J/kg].
    """
    stored = friction.sliding_energy * friction.stiffness * abs(state.integral) * depth
    return 0.5 * state.velocity * state.velocity - friction.pull * state.displacement + stored


@compiled
def in_direction(state: SlipState, direction: float, front: float) -> SlipState:
    """Return a state with another direction of slip, and another root of the depth at
    which it ends.
    """
    return SlipState(
        state.velocity, state.displacement, state.integral, direction, front, state.microslip
    )


@compiled
def begin_sliding(friction: Friction, state: SlipState, depth: float) -> SlipState:
    """Return the state of a contact of which no part sticks any more: what it has lost in
    microslip is known from its energy.
    """
    lost = state.microslip - energy_over_mass(friction, state, depth)
    return SlipState(
        state.velocity, state.displacement, state.integral, state.direction, state.front, lost
    )


@compiled
def end_sliding(friction: Friction, state: SlipState, depth: float) -> SlipState:
    """Return the state of a contact that has slid, and from now on sticks in its middle."""
    lost = state.microslip + energy_over_mass(friction, state, depth)
    return SlipState(
        state.velocity, state.displacement, state.integral, state.direction, state.front, lost
    )


@compiled
def excess_depth(
    start: NormalState,
    end: NormalState,
    before: SlipState,
    after: SlipState,
    direction: float,
    least: float,
) -> Cubic:
    """Return a part of the depth, less the displacement in a direction, through a step [m].

    Where that ceases to rise, a contact that sticks begins to slip in the direction; where it rises
    again, it ceases to.
    """
    return Cubic(
        least * start.depth - direction * before.displacement,
        least * start.depth_slope - direction * start.pace * before.velocity,
        least * end.depth - direction * after.displacement,
        least * end.depth_slope - direction * end.pace * after.velocity,
    )


@compiled
def integral_slope(normal: NormalState, state: SlipState, power: float) -> float:
    """Return the derivative of the integral of a contact that sticks; `power`: see
    `sliding_steps.stick`.
    """
    stretched = 0.5 * power * normal.depth_slope * state.integral / max(normal.depth, _TINY)
    return normal.pace * math.sqrt(normal.depth) * state.velocity + stretched


@compiled
def state_within(
    friction: Friction,
    start: NormalState,
    end: NormalState,
    before: SlipState,
    after: SlipState,
    share: float,
) -> SlipState:
    """Return the state at a share of a step, but with the integral, the direction and the
    front at its start.
    """
    begun = start.pace * (friction.pull - friction.stiffness * before.integral)
    ended = end.pace * (friction.pull - friction.stiffness * after.integral)
    velocity, _ = cubic_at(Cubic(before.velocity, begun, after.velocity, ended), share)
    path = Cubic(
        before.displacement,
        start.pace * before.velocity,
        after.displacement,
        end.pace * after.velocity,
    )
    displacement, _ = cubic_at(path, share)
    return SlipState(
        velocity, displacement, before.integral, before.direction, before.front, before.microslip
    )
