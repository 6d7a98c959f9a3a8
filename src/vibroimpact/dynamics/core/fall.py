r"""Flight of spheres through air or a liquid at rest, in pieces by Radau collocation.

In a piece the acceleration is a polynomial through the nodes of a Radau rule, in a time that is
finest at the top of the flight. Its integral gives the velocities at the nodes, and these the next
acceleration; such sweeps converge fast, as a piece is short beside the time constant of the drag.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Array, Integers, Matrix, Vector
from vibroimpact.compiled import compiled, scalar
from vibroimpact.dynamics.core.fall_records import Corners, Falling, FallRule, FallRules, Moving

GIVEN_TIME, AT_TOP, AT_GAP = 0, 1, 2
"""What ends a piece: a given time; the top of the flight; a height fallen through."""

HIGHEST_REYNOLDS = 3e5
"""Reynolds number up to which `drag_coefficient` holds.

The boundary layer of a smooth sphere becomes turbulent above it.
"""

_SWEEPS = 60
_CLOSE = 1e-13  # of the speeds: change by the last sweep, which is 10 times the error that is left
_LONGEST = 0.25  # of the time constant of the drag: length of a piece
_STEADY = 1e-14  # of gravity: an acceleration that counts as none
STILL = 1e-30  # m/s, for a speed of zero, at which Stokes' drag is none


@scalar
def drag_coefficient(reynolds: Array) -> Array:
    r"""Return the drag coefficient of a smooth sphere at a Reynolds number.

    .. math::

        C_d = \frac{24}{Re}\left(1 + 0.15\,Re^{0.687}\right) + \frac{0.42}{1 + 42500\,Re^{-1.16}}

    Within 6 % of measurements up to a Reynolds number of 3e5.

    References
    ----------
    Clift, R. and Gauvin, W. H. (1970). The motion of particles in turbulent gas streams. Proc.
    Chemeca '70, 1, 14-28.

    Examples
    --------
    >>> round(float(drag_coefficient(1e4)), 2)
    0.42
    """
    return 24.0 / reynolds * (1.0 + 0.15 * reynolds**0.687) + 0.42 / (
        1.0 + 42500.0 * reynolds**-1.16
    )


@compiled
def drag_of(falling: Falling, drop: int, speed: float) -> float:
    """Return by how much the fluid slows a sphere down at a speed [m/s^2], as `Fluid.drag`."""
    fast = max(speed, STILL)
    coefficient = falling.coefficient[drop]
    if np.isnan(coefficient):
        coefficient = drag_coefficient(falling.reynolds[drop] * fast)
    return float(falling.drag[drop] * coefficient * fast * fast)


@compiled
def size_of(vectors: Matrix, column: int) -> float:
    """Return the magnitude of a vector in a column (C, b)."""
    squared = 0.0
    for component in range(len(vectors)):
        squared += vectors[component, column] * vectors[component, column]
    return math.sqrt(squared)


@compiled
def accelerate(
    falling: Falling, drop: int, velocity: Matrix, column: int, acceleration: Matrix, into: int
) -> float:
    """Write the acceleration of a sphere at a velocity into a column (C, .) [m/s^2];
    return the power per mass that drag takes [W/kg].
    """
    # v' = g - a(v) v/|v|
    speed = size_of(velocity, column)
    drag = drag_of(falling, drop, speed)
    part = drag / max(speed, STILL)
    for component in range(len(velocity)):
        acceleration[component, into] = (
            falling.gravity[component, drop] - part * velocity[component, column]
        )
    return float(drag * speed * falling.inertia[drop])


@compiled
def keeps(falling: Falling, drop: int, velocity: Matrix, column: int) -> bool:
    """Is a velocity kept, as the terminal one, or as rest without gravity?"""
    acceleration = np.empty((len(velocity), 1))
    accelerate(falling, drop, velocity, column, acceleration, 0)
    pull = size_of(falling.gravity, drop)
    if pull > 0.0:
        return size_of(acceleration, 0) <= _STEADY * pull
    return size_of(velocity, column) <= STILL


@compiled
def longest_piece(falling: Falling, drop: int, velocity: Matrix, column: int) -> float:
    """Return the longest piece from a velocity [s]; infinite where the velocity is kept."""
    if keeps(falling, drop, velocity, column):
        return np.inf
    speed = size_of(velocity, column)
    pull = size_of(falling.gravity, drop)
    some = max(speed, STILL)
    # the time constant v/a of a drag a at the speed v
    time = some / drag_of(falling, drop, some)
    for _ in range(6):  # the constant that belongs to the speed after it
        some = max(speed + pull * time, STILL)
        time = math.sqrt(time * some / drag_of(falling, drop, some))
    return 0.5 * _LONGEST * time


@compiled
def longest_pieces(falling: Falling, velocity: Matrix) -> Vector:
    """Return the longest pieces of all drops from velocities (C, b) [s] (b,)."""
    longest = np.empty(velocity.shape[1])
    for drop in range(len(longest)):
        longest[drop] = longest_piece(falling, drop, velocity, drop)
    return longest


@compiled
def accelerations(falling: Falling, drops: Integers, velocity: Matrix) -> Matrix:
    """Return the accelerations of drops at velocities (C, b) [m/s^2] (C, b)."""
    found = np.empty(velocity.shape)
    for column in range(len(drops)):
        accelerate(falling, drops[column], velocity, column, found, column)
    return found


@compiled
def time_to_fall(height: float, down: float, mean: float) -> float:
    """Return the time of a fall through a height [s], from a downward velocity and half
    the mean acceleration of its first part.
    """
    # h = v t + m t^2 without cancellation
    if not height > 0.0:
        return 0.0
    return 2.0 * height / (down + math.sqrt(max(down * down + 4.0 * mean * height, 0.0)))


@compiled
def follow_piece(
    rule: FallRule,
    falling: Falling,
    drop: int,
    begin: Moving,
    at: int,
    ends: int,
    first: float,
    second: float,
    moving: Moving,
    into: int,
) -> None:
    """Write the motion of a drop at the end of a piece into a column.

    Parameters
    ----------
    begin, at : Moving, int
        The motion at its start, in a column.
    ends : int
        What ends the piece: GIVEN_TIME, AT_TOP or AT_GAP.
    first, second : float
        The time [s]; or the velocity upwards at the start [m/s]; or the height that is fallen
        through [m], and the velocity downwards at the start [m/s].
    """
    components = len(begin.velocity)
    nodes = len(rule.integral)
    normal = components - 1
    steady = keeps(falling, drop, begin.velocity, at)
    now = np.zeros((components, nodes))
    before = np.zeros((components, nodes))
    velocity = np.empty((components, nodes))
    power = np.zeros(nodes)
    if not steady:
        accelerate(falling, drop, begin.velocity, at, now, 0)
        for component in range(components):
            for node in range(1, nodes):
                now[component, node] = now[component, 0]
    time = 0.0
    for _ in range(_SWEEPS):
        # the length that reaches the end under the accelerations of the last sweep
        time = first
        if ends == AT_TOP:
            gained = 0.0
            for node in range(nodes):
                gained += rule.integral[nodes - 1, node] * now[normal, node]
            time = -first / gained
        elif ends == AT_GAP:
            moved = 0.0
            for node in range(nodes):
                moved += rule.moved[node] * now[normal, node]
            time = time_to_fall(first, second, -moved)
        fastest = 0.0
        change = 0.0
        for component in range(components):
            for node in range(nodes):
                gained = 0.0
                for other in range(nodes):
                    gained += rule.integral[node, other] * now[component, other]
                velocity[component, node] = begin.velocity[component, at] + time * gained
        before[:] = now
        for node in range(nodes):
            power[node] = accelerate(falling, drop, velocity, node, now, node)
            fastest = max(fastest, size_of(velocity, node))
            for component in range(components):
                if steady:
                    now[component, node] = 0.0
                change = max(change, time * abs(now[component, node] - before[component, node]))
        if not change > _CLOSE * fastest:
            break
    moving.time[into] = begin.time[at] + time
    moving.lost[into] = begin.lost[at]
    for node in range(nodes):
        moving.lost[into] += time * rule.integral[nodes - 1, node] * power[node]
    for component in range(components):
        gained = 0.0
        moved = 0.0
        for node in range(nodes):
            gained += rule.integral[nodes - 1, node] * now[component, node]
            moved += rule.moved[node] * now[component, node]
        moving.place[component, into] = begin.place[component, at] + time * (
            begin.velocity[component, at] + time * moved
        )
        moving.velocity[component, into] = begin.velocity[component, at] + time * gained


@compiled
def room_for(components: int, columns: int) -> Moving:
    """Return room for motions."""
    return Moving(
        np.empty(columns),
        np.empty((components, columns)),
        np.empty((components, columns)),
        np.empty(columns),
    )


@compiled
def follow_pieces(
    rule: FallRule, falling: Falling, begin: Moving, ends: Integers, first: Vector, second: Vector
) -> Moving:
    """Return the motion of all drops at the end of a piece of each, as `follow_piece` does."""
    found = room_for(len(begin.velocity), len(ends))
    for drop in range(len(ends)):
        follow_piece(
            rule, falling, drop, begin, drop, ends[drop], first[drop], second[drop], found, drop
        )
    return found


@compiled
def rise(rule: FallRule, falling: Falling, begin: Moving) -> Moving:
    """Return the motion of all drops at the end of a piece upwards, which the top of the
    flight ends at the latest.
    """
    components = len(begin.velocity)
    found = room_for(components, len(begin.time))
    acceleration = np.empty((components, 1))
    for drop in range(len(begin.time)):
        up = begin.velocity[components - 1, drop]
        longest = longest_piece(falling, drop, begin.velocity, drop)
        accelerate(falling, drop, begin.velocity, drop, acceleration, 0)
        # at the first deceleration, which falls with the speed: the top comes a little later
        if up <= -acceleration[components - 1, 0] * longest:
            follow_piece(rule, falling, drop, begin, drop, AT_TOP, up, 0.0, found, drop)
            found.velocity[components - 1, drop] = 0.0
        else:
            follow_piece(rule, falling, drop, begin, drop, GIVEN_TIME, longest, 0.0, found, drop)
    return found


@compiled
def motion_at(
    rules: FallRules, falling: Falling, corners: Corners, drops: Integers, elapsed: Vector
) -> Moving:
    """Return the motion of drops at times since the starts of their flights [s] (m,)."""
    components = corners.place.shape[1]
    found = room_for(components, len(drops))
    for column in range(len(drops)):
        drop = drops[column]
        corner = 0
        for number in range(1, len(corners.time)):
            if corners.time[number, drop] <= elapsed[column]:
                corner = number
        begin = Moving(
            corners.time[corner],
            corners.place[corner],
            corners.velocity[corner],
            corners.lost[corner],
        )
        rule = rules.falling
        if elapsed[column] < corners.time[corners.top, drop]:
            rule = rules.rising
        follow_piece(
            rule,
            falling,
            drop,
            begin,
            drop,
            GIVEN_TIME,
            elapsed[column] - begin.time[drop],
            0.0,
            found,
            column,
        )
    return found
