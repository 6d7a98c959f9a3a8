r"""Steps of a contact along one direction, with known normal motion: the tangential motion between
two points of a grid.

A step has the parameter :math:`\theta` from 0 to 1, and the method is that with first and second
derivatives at both ends,

.. math:: y_1 - y_0 = \tfrac12 (y_0' + y_1') + \tfrac1{12} (y_0'' - y_1''),

of order four with the error constant 1/720 (Hairer, Norsett and Wanner 1993, section II.13). With
the velocity v, the displacement s and
the integral I of `contact.friction.law`, the pace :math:`t' = dt/d\theta` and :math:`k = 2 G^*
\sqrt R / m_t`

.. math:: v' = t' (g - k I),\qquad s' = t' v,

where I follows from a linear equation in a contact that sticks, and from s in one that slips.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.cubics import cubic_at
from vibroimpact.dynamics.core.friction_records import (
    Cubic,
    Curve,
    Friction,
    NormalState,
    SlipState,
)
from vibroimpact.dynamics.core.turning_points import held_at

_TINY = 1e-150
_GAUSS_NODES = 0.5 + 0.5 * np.array([math.sqrt(0.6), 0.0, -math.sqrt(0.6)])
_GAUSS_WEIGHTS = np.array([2.5, 4.0, 2.5]) / 9.0
"""Of Gauss' quadrature with three nodes from 0 to 1, from the largest on."""


@compiled
def sliding_integral(depth: float) -> float:
    """Return the integral I of a contact that slides [m^1.5]."""
    return (2.0 / 3.0) * depth * math.sqrt(depth)


@compiled
def shortened(normal: NormalState, share: float) -> NormalState:
    """Return the normal motion for a parameter that goes from 0 to 1 in a share of the step."""
    return NormalState(
        normal.time,
        normal.pace * share,
        normal.pace_slope * share * share,
        normal.depth,
        normal.depth_slope * share,
        normal.most,
        normal.swept,
    )


@compiled
def normal_between(start: NormalState, end: NormalState, share: float) -> NormalState:
    """Return the normal motion at a share of a step."""
    time, _ = cubic_at(Cubic(start.time, start.pace, end.time, end.pace), share)
    pace, pace_slope = cubic_at(
        Cubic(start.pace, start.pace_slope, end.pace, end.pace_slope), share
    )
    depth, depth_slope = cubic_at(
        Cubic(start.depth, start.depth_slope, end.depth, end.depth_slope), share
    )
    depth = max(depth, 0.0)
    most = sliding_integral(depth)
    rest = 1.0 - share
    # from the end, where there may be little left
    bend = pace_slope * most + pace * math.sqrt(depth) * depth_slope
    bend -= end.pace_slope * end.most + end.pace * math.sqrt(end.depth) * end.depth_slope
    remaining = rest * (0.5 * (pace * most + end.pace * end.most) + rest / 12.0 * bend)
    return NormalState(time, pace, pace_slope, depth, depth_slope, most, end.swept - remaining)


@compiled
def missed_time(start: NormalState, end: NormalState) -> float:
    """Return the time of a step less the integral of the pace by the same rule [s].

    At the velocity at the start this is displacement as well: without it the two would not belong
    together in steps of next to no time.
    """
    by_pace = 0.5 * (start.pace + end.pace) + (start.pace_slope - end.pace_slope) / 12.0
    return end.time - start.time - by_pace


@compiled
def moved(
    friction: Friction,
    start: NormalState,
    end: NormalState,
    before: SlipState,
    velocity: float,
    integral: float,
) -> SlipState:
    """Return the motion at the end of a step, from velocity and integral at both ends."""
    # s'' = t'' v + t'^2 (g - k I) at both ends
    bend = start.pace_slope * before.velocity + start.pace * start.pace * (
        friction.pull - friction.stiffness * before.integral
    )
    bend -= end.pace_slope * velocity + end.pace * end.pace * (
        friction.pull - friction.stiffness * integral
    )
    displacement = before.displacement + missed_time(start, end) * before.velocity
    displacement += 0.5 * (start.pace * before.velocity + end.pace * velocity) + bend / 12.0
    return SlipState(
        velocity, displacement, integral, before.direction, before.front, before.microslip
    )


@compiled
def paced(normal: NormalState, power: float) -> tuple[float, float]:
    """Return the pace times a power of the root of the depth, and its derivative."""
    if power == 0.0:
        return normal.pace, normal.pace_slope
    depth = max(normal.depth, _TINY)
    raised = math.sqrt(depth)
    if power != 1.0:
        raised = depth ** (0.5 * power)
    slope = (
        normal.pace_slope * raised + 0.5 * power * normal.pace * raised / depth * normal.depth_slope
    )
    return normal.pace * raised, slope


@compiled
def stick(
    friction: Friction, start: NormalState, end: NormalState, before: SlipState, power: float
) -> SlipState:
    r"""Return the motion at the end of a step in which a contact sticks.

    There :math:`I = a^\gamma z` with the contact radius over the root of R, :math:`a = \sqrt D`,
    the `power` :math:`\gamma`, and
    :math:`z' = t' a^{1 - \gamma} v`.
    """
    stretch = before.integral
    if power != 0.0:
        stretch /= max(start.depth, _TINY) ** (0.5 * power)
    pull_start, pull_start_slope = paced(start, power)
    pull_end, pull_end_slope = paced(end, power)
    spring_start, spring_start_slope = paced(start, 1.0 - power)
    spring_end, spring_end_slope = paced(end, 1.0 - power)
    # where the contact ends the pace over its radius is as before
    if power > 1.0 and not end.depth > 0.0:
        spring_end = spring_start
        spring_end_slope = 0.0
    stiffness = friction.stiffness
    pull_start *= stiffness
    pull_start_slope *= stiffness
    pull_end *= stiffness
    pull_end_slope *= stiffness
    # the rule of the module, with v'' and z'' from the equations, is linear in v and z at the end:
    #   less_end v + back z = right, -forth v + less_end z = right_stretch
    less_start = 1.0 - pull_start * spring_start / 12.0
    less_end = 1.0 - pull_end * spring_end / 12.0
    right = less_start * before.velocity - (0.5 * pull_start + pull_start_slope / 12.0) * stretch
    right += friction.pull * (end.time - start.time)
    right_stretch = (
        0.5 * spring_start + spring_start_slope / 12.0
    ) * before.velocity + less_start * stretch
    right_stretch += friction.pull / 12.0 * (spring_start * start.pace - spring_end * end.pace)
    back = 0.5 * pull_end - pull_end_slope / 12.0
    forth = 0.5 * spring_end - spring_end_slope / 12.0
    determinant = less_end * less_end + back * forth
    velocity = (less_end * right - back * right_stretch) / determinant
    integral = (forth * right + less_end * right_stretch) / determinant
    if power != 0.0:
        integral *= end.depth ** (0.5 * power)
    return moved(friction, start, end, before, velocity, integral)


@compiled
def slide(friction: Friction, start: NormalState, end: NormalState, before: SlipState) -> SlipState:
    """Return the motion at the end of a step in which all of a contact slides."""
    # |I| is 2/3 D^(3/2) throughout, of which the integral over time is known
    sliding = friction.stiffness * before.direction * (end.swept - start.swept)
    velocity = before.velocity + friction.pull * (end.time - start.time) - sliding
    return moved(friction, start, end, before, velocity, before.direction * end.most)


@compiled
def slip_at_rim(
    friction: Friction, curve: Curve, start: NormalState, end: NormalState, before: SlipState
) -> SlipState:
    """Return the motion at the end of a step in which a contact slips at its rim."""
    direction = before.direction
    stiffness = friction.stiffness
    pull = friction.pull
    # the rule of the module for v and s, in which the end of the step enters through I(s) alone:
    # that is replaced by the tangent of H, and two linear equations are left
    driven = stiffness * direction
    weight = 0.5 * end.pace - end.pace_slope / 12.0
    square = end.pace * end.pace / 12.0
    flow = start.pace * before.velocity
    tangential = pull - stiffness * before.integral
    ahead = (
        before.displacement + missed_time(start, end) * before.velocity + 0.5 * flow - square * pull
    )
    ahead += (start.pace_slope * before.velocity + start.pace * start.pace * tangential) / 12.0
    grows = (
        direction * (math.sqrt(start.depth) - before.front) * start.depth_slope
        + before.front * flow
    )
    right = before.velocity + pull * (end.time - start.time)
    right -= stiffness * (
        (0.5 * start.pace + start.pace_slope / 12.0) * before.integral + start.pace / 12.0 * grows
    )
    # first with the rate at the start, then along the tangent of H at the x to which that leads
    expected = stiffness * (before.integral + grows)
    there = ahead + weight * (right - weight * expected) + square * expected
    held, front = held_at(curve, direction, end.depth - direction * there)
    tangent = end.most - held - direction * front * there
    growth = (math.sqrt(end.depth) - front) * end.depth_slope
    right -= driven * (weight * tangent - end.pace / 12.0 * growth)
    ahead += square * driven * tangent
    stiff = stiffness * front
    less = 1.0 - stiff * square
    linked = stiff * weight
    determinant = less * less + linked * weight
    velocity = (less * right - linked * ahead) / determinant
    displacement = (weight * right + less * ahead) / determinant
    integral = direction * min(tangent + direction * front * displacement, end.most)
    return SlipState(velocity, displacement, integral, direction, front, before.microslip)


@compiled
def swept_to_middle(
    curve: Curve, direction: float, start: NormalState, end: NormalState, x: Cubic
) -> float:
    """Return the integral of I over the time of a step at whose end the slip comes to the
    middle of a contact; `x`: on the way.
    """
    paces = Cubic(start.pace, start.pace_slope, end.pace, end.pace_slope)
    depths = Cubic(start.depth, start.depth_slope, end.depth, end.depth_slope)
    swept = 0.0
    for node in range(len(_GAUSS_NODES)):
        # of the distance to the end, where H has a power of 3/2; from the start on, as the curve is
        # followed inwards
        root = _GAUSS_NODES[node]
        share = 1.0 - root * root
        pace, _ = cubic_at(paces, share)
        depth, _ = cubic_at(depths, share)
        held, _ = held_at(curve, direction, cubic_at(x, share)[0])
        swept += (
            2.0 * root * _GAUSS_WEIGHTS[node] * pace * (sliding_integral(max(depth, 0.0)) - held)
        )
    return direction * swept
