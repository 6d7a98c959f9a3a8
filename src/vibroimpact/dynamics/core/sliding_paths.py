r"""The sliding of contacts with tangential compliance along one direction, driven by their normal
motion.

With the displacement s over kappa and the integral I (`contact.friction.law`)

.. math:: \ddot s = -\frac{2 G^* \sqrt R}{m_t}\, I + \frac{g_t}{\kappa}

for the effective mass :math:`m_t` of the tangential motion, 2/7 of that of a solid sphere. A
contact that slides from first touch on is not integrated before it may stick: until then the normal
impulse gives its velocity.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.cubics import cubic_at
from vibroimpact.dynamics.core.friction_records import (
    HERTZ,
    KAPPA,
    RADIUS,
    SPRING,
    Cubic,
    Curve,
    Friction,
    NormalState,
    Rubbing,
    SlipState,
)
from vibroimpact.dynamics.core.normal_records import (
    FORCE,
    FORCE_SLOPE,
    IMPULSE,
    PACE,
    PACE_SLOPE,
    TIME,
    NormalPath,
)
from vibroimpact.dynamics.core.sliding import MOST_CHANGES, advance_step, join, settle
from vibroimpact.dynamics.core.sliding_steps import shortened, sliding_integral
from vibroimpact.dynamics.core.slip_states import begin_sliding, least_rate, slides
from vibroimpact.dynamics.core.turning_points import add_rim, new_curve

VELOCITY, DISPLACEMENT, FRICTION_FORCE = range(3)
"""Rows of its sliding."""

_LEAST = 1e-9
_MOST = 1e6
"""Bounds of kappa in slip per depth: contacts with less friction slide freely, and those
with more stick.
"""

_PRESSED = 1e-7
"""Part of the largest normal force below which it is the error of the normal motion."""

_MOST_TURNING = 0.2
_MOST_PARTS = 64
"""Angle by which the free oscillation of a contact that sticks turns in a step at most
[rad], and parts of a step for that at most.
"""


@compiled
def write_grid(normal: Matrix, hertz: float, largest: float, grid: Matrix) -> None:
    """Write the normal motion of a contact at G points (G, 7), in the order of `NormalState`.

    Parameters
    ----------
    normal : array, shape (6, G)
        Time, pace, its slope, force, its slope, and impulse.
    hertz : float
        Hertz's stiffness of the bodies [N/m^1.5].
    largest : float
        The largest normal force [N].
    grid : array, shape (G, 7)
        Room.
    """
    points = len(grid)
    per_force = (2.0 / 3.0) / hertz  # 2/3 of the depth to the power 3/2 is the integral
    ends = False
    pressed_so_far = -np.inf
    for point in range(points):
        force = normal[FORCE, point]
        depth = 0.0
        depth_slope = 0.0
        if force > _PRESSED * largest:
            depth = (force / hertz) ** (2.0 / 3.0)
            depth_slope = (2.0 / 3.0) * depth * normal[FORCE_SLOPE, point] / force
        elif 0 < point < points - 1:
            ends = True
        pressed_so_far = max(pressed_so_far, normal[IMPULSE, point])
        grid[point, 0] = normal[TIME, point]
        grid[point, 1] = normal[PACE, point]
        grid[point, 2] = normal[PACE_SLOPE, point]
        grid[point, 3] = depth
        grid[point, 4] = depth_slope
        grid[point, 5] = per_force * force
        grid[point, 6] = per_force * pressed_so_far
    if not ends:
        return
    for point in range(points - 1):  # no cubic to zero falls below it
        if not grid[point + 1, 3] > 0.0:
            grid[point, 4] = max(grid[point, 4], -3.0 * grid[point, 3])
    for point in range(1, points):
        if not grid[point - 1, 3] > 0.0:
            grid[point, 4] = min(grid[point, 4], 3.0 * grid[point, 3])


@compiled
def normal_at(grid: Matrix, point: int) -> NormalState:
    """Return the normal motion at a point of the grid."""
    row = grid[point]
    return NormalState(row[0], row[1], row[2], row[3], row[4], row[5], row[6])


@compiled
def normal_of_part(start: NormalState, end: NormalState, part: int, parts: int) -> NormalState:
    """Return the normal motion at the start of one of some equal parts of a step, for a
    parameter that goes from 0 to 1 in a part.
    """
    share = part / parts
    per_part = 1.0 / parts
    time, pace = cubic_at(Cubic(start.time, start.pace, end.time, end.pace), share)
    pace, pace_slope = cubic_at(
        Cubic(start.pace, start.pace_slope, end.pace, end.pace_slope), share
    )
    depth, depth_slope = cubic_at(
        Cubic(start.depth, start.depth_slope, end.depth, end.depth_slope), share
    )
    swept, _ = cubic_at(
        Cubic(start.swept, start.pace * start.most, end.swept, end.pace * end.most), share
    )
    depth = max(depth, 0.0)
    return NormalState(
        time,
        pace * per_part,
        pace_slope * per_part * per_part,
        depth,
        depth_slope * per_part,
        sliding_integral(depth),
        swept,
    )


@compiled
def write_slide(friction: Friction, grid: Matrix, steps: Vector, slip: float, path: Matrix) -> None:
    """Write velocity, displacement and integral (3, G) of a contact every point of which slips all
    the time.

    So it is where nowhere the displacement grows more slowly than the depth, or shrinks faster than
    a part of it. `slip`: at first touch.
    """
    displacement = 0.0
    velocity = slip
    rate = 0.0
    bend = 0.0
    normal = normal_at(grid, 0)
    for point in range(len(grid)):
        before = normal
        velocity_before = velocity
        normal = normal_at(grid, point)
        velocity = slip + friction.pull * normal.time - friction.stiffness * normal.swept
        rate_before = rate
        bend_before = bend
        rate = normal.pace * velocity
        bend = normal.pace_slope * velocity + normal.pace * normal.pace * (
            friction.pull - friction.stiffness * normal.most
        )
        if point:
            by_pace = (
                0.5 * (before.pace + normal.pace) + (before.pace_slope - normal.pace_slope) / 12.0
            )
            displacement += (
                normal.time - before.time - steps[point - 1] * by_pace
            ) * velocity_before
            displacement += steps[point - 1] * (
                0.5 * (rate + rate_before) + (bend_before - bend) / 12.0
            )
        path[VELOCITY, point] = velocity
        path[DISPLACEMENT, point] = displacement
        path[FRICTION_FORCE, point] = normal.most


@compiled
def first_point_to_stick(
    friction: Friction, grid: Matrix, steps: Vector, rounding: float, path: Matrix
) -> int:
    """Return the last point up to which a contact certainly slides: 0 if it sticks from first touch
    on, -1 if it slides throughout.

    `rounding`: error of the rate of the depth at release, as a part of the largest.
    """
    steepest = 0.0
    for point in range(len(grid)):
        steepest = max(steepest, grid[point, 4])
    if grid[0, 3] > 0.0:  # its force jumps at touch, where nothing has moved yet
        return 0
    for point in range(len(grid)):
        normal = normal_at(grid, point)
        least = least_rate(friction, normal.depth_slope > 0.0) * normal.depth_slope
        if path[VELOCITY, point] * normal.pace < least - rounding * steepest:
            first = max(point - 1, 0)
            if steps[max(first - 1, 0)] == 0.0:
                first -= 1
            return first
    return -1


@compiled
def follow_slip(
    friction: Friction,
    curve: Curve,
    grid: Matrix,
    steps: Vector,
    first: int,
    parts: int,
    path: Matrix,
) -> float:
    """Write the motion of a contact from a point on, and return the energy lost in microslip, over
    mass and the square of kappa [J/kg].

    Parameters
    ----------
    friction : Friction
        Law and bodies.
    curve : Curve
        Its turning points, with none but that of the middle.
    grid, steps : array, shape (G, 7), (G - 1,)
        Normal motion.
    first : int
        The point up to which it slides; 0 if it sticks from first touch on.
    parts : int
        Steps in each of the grid's.
    path : array, shape (3, G)
        Velocity, displacement and integral, known up to the first point.
    """
    if first == 0:  # from touch on nothing is stretched
        path[FRICTION_FORCE, 0] = 0.0
        if friction.at_rim:
            add_rim(curve, grid[0, 3], 0.0, 0.0)
    # what is lost while it sticks is the energy with which that begins, less that with which that
    # ends (`begin_sliding`)
    direction = 0.0
    microslip = 0.5 * path[VELOCITY, 0] ** 2
    if first > 0:
        direction = 1.0
        microslip = 0.0
    state = SlipState(
        path[VELOCITY, first],
        path[DISPLACEMENT, first],
        path[FRICTION_FORCE, first],
        direction,
        0.0,
        microslip,
    )
    begins = True
    for point in range(first, len(steps)):
        start = normal_at(grid, point)
        end = normal_at(grid, point + 1)
        if steps[point] == 0.0:
            state = join(friction, curve, start, end, state)
            begins = True
        else:
            part_start = shortened(start, 1.0 / parts)
            if begins and start.depth > 0.0:
                state = settle(friction, curve, part_start, state)
            for part in range(parts):
                is_last = part + 1 == parts
                if is_last:
                    part_end = shortened(end, 1.0 / parts)
                else:
                    part_end = normal_of_part(start, end, part + 1, parts)
                state = advance_step(friction, curve, part_start, part_end, state)
                part_start = part_end
            begins = False
        path[VELOCITY, point + 1] = state.velocity
        path[DISPLACEMENT, point + 1] = state.displacement
        path[FRICTION_FORCE, point + 1] = state.integral
    if not slides(state):  # what is stored at the end is lost
        state = begin_sliding(friction, state, 0.0)
    return state.microslip


@compiled
def parts_of_step(friction: Friction, grid: Matrix) -> int:
    """Return into how many parts the steps of a contact are divided, a power of two, so
    that what sticks turns by a small angle in each.
    """
    deepest = 0.0
    slowest = 0.0
    for point in range(len(grid)):
        slowest = max(slowest, grid[point, 1])
        deepest = max(deepest, grid[point, 3])
    turning = math.sqrt(friction.stiffness * math.sqrt(deepest)) * slowest
    parts = 1
    while parts < _MOST_PARTS and parts * _MOST_TURNING < turning:
        parts *= 2
    return parts


@compiled
def slide_elastically(
    rubbing: Rubbing,
    coefficients: Vector,
    slip: float,
    pull: float,
    mass: float,
    normal: NormalPath,
    path: Matrix,
) -> float:
    """Follow the sliding of a contact, and return the energy lost while a part of it sticks [J].

    Parameters
    ----------
    rubbing : Rubbing
        The law.
    coefficients : array, shape (5,)
        Of it in this contact; see `friction_records`.
    slip : float
        Slip velocity at first touch [m/s].
    pull : float
        Acceleration along the direction [m/s^2].
    mass : float
        Effective mass of the tangential motion [kg].
    normal : NormalPath
        The normal motion.
    path : array, shape (3, G)
        Room for slip velocities [m/s], displacements [m] and friction forces [N].
    """
    rows = normal.rows
    points = rows.shape[1]
    largest = 0.0
    for point in range(points):
        largest = max(largest, rows[FORCE, point])
    grid = np.empty((points, 7))
    hertz = coefficients[HERTZ]
    write_grid(rows, hertz, largest, grid)
    duration = rows[TIME, points - 1]
    deepest = (largest / hertz) ** (2.0 / 3.0)
    scale = (abs(slip) + abs(pull) * duration) * duration / deepest
    kappa = min(max(coefficients[KAPPA], _LEAST * scale), _MOST * scale)
    if kappa == 0.0:
        kappa = 1.0
    # of the integral: none where friction is below the least
    spring = 0.0
    if not coefficients[KAPPA] < kappa:
        spring = coefficients[SPRING] * math.sqrt(coefficients[RADIUS])
    friction = Friction(
        rubbing.growing,
        rubbing.shrinking,
        rubbing.at_rim,
        rubbing.sliding_energy,
        spring / mass,
        pull / kappa,
    )
    write_slide(friction, grid, normal.steps, slip / kappa, path)
    microslip = 0.0
    if spring > 0.0:
        first = first_point_to_stick(friction, grid, normal.steps, rubbing.rounding, path)
        if first >= 0:
            parts = parts_of_step(friction, grid)
            # in each part of a step the rim is added once, twice where the contact ceases to slip
            curve = new_curve(2 * (MOST_CHANGES + 2) * parts * points)
            lost = follow_slip(friction, curve, grid, normal.steps, first, parts, path)
            microslip = mass * kappa * kappa * lost
    for point in range(points):
        path[VELOCITY, point] *= kappa
        path[DISPLACEMENT, point] *= kappa
        path[FRICTION_FORCE, point] *= spring * kappa
    return microslip
