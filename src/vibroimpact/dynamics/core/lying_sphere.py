r"""A sphere that lies on the plate and slips, rolls and twists on it, from one event to the next.

With the slip s of the contact point, of which the spin makes the part w, gravity :math:`g_n` along
the normal and :math:`g` along the plate, the mass m and the moment of inertia I, the friction Q and
the moment of rolling resistance M

.. math:: \dot v = g + \frac{Q}{m},\qquad \dot w = \frac{R^2 Q + R M}{I},\qquad s = v + w

.. math:: Q = -\mu m g_n \frac{s}{|s|},\qquad M = -\mu_r R\, m g_n \frac{w}{|w|}

where s or w is zero, Q or M is what keeps it so, up to these values. A sphere that rolls thus has
:math:`\dot v = \frac57 (g - \mu_r g_n v/|v|)`, and it stays at rest where the plate is less steep
than :math:`\mu` and :math:`\mu_r`. With what friction takes from the acceleration of the contact
point, :math:`q = -Q / m_t`, what the moment adds to it, :math:`u = R M / I`, and the effective mass
:math:`m_t` of the tangential motion, 2/7 m of a solid sphere, this is

.. math:: \dot s = g + u - q,\qquad \dot w = u - \Bigl(1 - \frac{m_t}{m}\Bigr) q

Along a line q and u are constant up to the next zero of s or w. Where directions turn, each step is
one of order 8, and the motion within it is that at the end of a shorter one. The spin about the
normal, which changes neither, is integrated afterwards (`twisting`).

(K. L. Johnson, Contact Mechanics, 1985, section 8.1; the ball of billiards: G. Coriolis, 1835; the
moment: J. Ai, J.-F. Chen, J. M. Rotter and J. Y. Ooi, Powder Technol. 206:269, 2011, constant
directional torque).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.dormand_prince import (
    ERROR_OF_ORDER_3,
    ERROR_OF_ORDER_5,
    STAGE_WEIGHTS,
    STAGES,
)
from vibroimpact.dynamics.core.linear import write_row
from vibroimpact.dynamics.core.sphere_records import (
    RubbedSphere,
    SphereState,
    length_of,
    tangential_mass,
    turning_of,
)

BEGIN, IS_EVENT, IS_STRAIGHT, SLIPS, TURNS = range(5)
PLACE, SLIP, TURNING, TAKEN, TURN = range(5, 15, 2)
COLUMNS = 15
"""Columns of a motion: the begin of each part [s]; whether an event begins it, whether it goes
along a line, and whether the contact slips and the sphere spins in it; then, with two columns each,
place [m], s and w [m/s] at its begin, and along a line q and u [m/s^2].
"""

_ACROSS = 1e-12
"""Of two vectors: the part of one across the other that counts as none."""

_STOPPED = 1e-9
"""Of the slip and the spin at the start: what has ended, where directions turn."""

_RELATIVE = 1e-11
_ABSOLUTE = 1e-5
"""Errors of a step: of the slip and the spin, and of what has ended. The second is small beside
what counts as ended, however slow the motion: else the end is stepped over to and fro for ever.
"""

_SAFETY = 0.9
_SHRINKS, _GROWS = 0.2, 10.0
_FIRST_STEP = 1e-3
"""Of the time in which friction stops slip and spin."""

_FIRST_PARTS = 16
_MOST_HALVINGS = 60
_TURNS_BACK = 3
"""Steps of false position to where the centre turns back; of a line the first one is exact."""


class LyingSphere(NamedTuple):
    """What acts on a sphere that lies.

    gravity_x, gravity_y: along the plate [m/s^2]. bound, resistance: the largest q and u [m/s^2].
    share: effective mass of the tangential motion over the mass. least: slip or spin that has ended
    where directions turn [m/s].
    """

    gravity_x: float
    gravity_y: float
    bound: float
    resistance: float
    share: float
    least: float


@compiled
def is_across(x: float, y: float, other_x: float, other_y: float) -> bool:
    """Do two vectors lie along different lines?"""
    product = x * other_y - y * other_x
    return abs(product) > _ACROSS * length_of(x, y) * length_of(other_x, other_y)


@compiled
def directed(size: float, x: float, y: float, least: float) -> tuple[float, float]:
    """Return a vector of a size along another one; shorter where that is shorter than `least`, and
    none where it is none.
    """
    length = max(length_of(x, y), least)
    if length == 0.0:
        return 0.0, 0.0
    return size * x / length, size * y / length


@compiled
def at_most(size: float, x: float, y: float) -> tuple[float, float]:
    """Return a vector, or one of a size along it if it is longer."""
    length = length_of(x, y)
    if length <= size:
        return x, y
    return size * x / length, size * y / length


@compiled
def write_constant_forces(lying: LyingSphere, row: Vector) -> None:
    """Write q and u of a part along a line into its row."""
    if row[SLIPS] > 0.0:
        taken_x, taken_y = directed(lying.bound, row[SLIP], row[SLIP + 1], 0.0)
    else:
        pull_x = lying.gravity_x / lying.share
        pull_y = lying.gravity_y / lying.share
        taken_x, taken_y = at_most(lying.bound, pull_x, pull_y)
    if row[TURNS] > 0.0:
        turn_x, turn_y = directed(-lying.resistance, row[TURNING], row[TURNING + 1], 0.0)
    else:  # what leaves a sphere without spin
        rest = 1.0 - lying.share
        turn_x, turn_y = at_most(lying.resistance, rest * taken_x, rest * taken_y)
    if row[SLIPS] == 0.0:  # the slip begins where friction can't hold it
        taken_x, taken_y = at_most(lying.bound, lying.gravity_x + turn_x, lying.gravity_y + turn_y)
    row[TAKEN] = taken_x
    row[TAKEN + 1] = taken_y
    row[TURN] = turn_x
    row[TURN + 1] = turn_y


@compiled
def turning_forces(
    lying: LyingSphere, row: Vector, state: Vector
) -> tuple[float, float, float, float]:
    """Return q and u where directions turn; `state`: place, s and w (6,)."""
    slip_x = state[2]
    slip_y = state[3]
    holding = (1.0 - lying.share) * lying.bound
    if row[TURNS] == 0.0 and lying.resistance >= holding:  # the sphere stays without spin
        turn_x, turn_y = directed(holding, slip_x, slip_y, lying.least)
    else:
        turn_x, turn_y = directed(-lying.resistance, state[4], state[5], lying.least)
    if row[SLIPS] > 0.0:
        taken_x, taken_y = directed(lying.bound, slip_x, slip_y, lying.least)
    else:
        taken_x = lying.gravity_x + turn_x
        taken_y = lying.gravity_y + turn_y
    return taken_x, taken_y, turn_x, turn_y


@compiled
def advance(lying: LyingSphere, row: Vector, length: float, stages: Matrix, state: Vector) -> float:
    """Write place, s and w (6,) after a step [s] from the begin of a part where directions turn,
    and return the error of s and w over what is allowed.

    `stages`: room for the rates at the stages (13, 6).
    """
    rest = 1.0 - lying.share
    for stage in range(STAGES + 1):
        for number in range(6):
            rate = 0.0
            for earlier in range(stage):
                rate += STAGE_WEIGHTS[stage, earlier] * stages[earlier, number]
            state[number] = row[PLACE + number] + length * rate
        # v = s - w, ds/dt = g + u - q and dw/dt = u - (1 - m_t/m) q
        taken_x, taken_y, turn_x, turn_y = turning_forces(lying, row, state)
        stages[stage, 0] = state[2] - state[4]
        stages[stage, 1] = state[3] - state[5]
        stages[stage, 2] = lying.gravity_x + turn_x - taken_x
        stages[stage, 3] = lying.gravity_y + turn_y - taken_y
        stages[stage, 4] = turn_x - rest * taken_x
        stages[stage, 5] = turn_y - rest * taken_y
    of_order_5 = 0.0
    of_order_3 = 0.0
    for number in range(2, 6):
        vector = number // 2 * 2
        before = length_of(row[PLACE + vector], row[PLACE + vector + 1])
        after = length_of(state[vector], state[vector + 1])
        allowed = _ABSOLUTE * lying.least + _RELATIVE * max(before, after)
        difference_5 = 0.0
        difference_3 = 0.0
        for stage in range(STAGES + 1):
            difference_5 += ERROR_OF_ORDER_5[stage] * stages[stage, number]
            difference_3 += ERROR_OF_ORDER_3[stage] * stages[stage, number]
        of_order_5 += (difference_5 / allowed) ** 2
        of_order_3 += (difference_3 / allowed) ** 2
    # the estimate of DOP853 for the root mean square of the four components
    both = of_order_5 + 0.01 * of_order_3
    if both == 0.0:
        return 0.0
    return length * of_order_5 / math.sqrt(4.0 * both)


@compiled
def write_along_line(lying: LyingSphere, row: Vector, elapsed: float, state: Vector) -> None:
    """Write place, s, w and q (8,) a time after the begin of a part along a line [s]."""
    rest = 1.0 - lying.share
    for axis in range(2):
        pull = lying.gravity_x
        if axis == 1:
            pull = lying.gravity_y
        taken = row[TAKEN + axis]
        slip_rate = pull + row[TURN + axis] - taken
        turning_rate = row[TURN + axis] - rest * taken
        slip = row[SLIP + axis]
        turning = row[TURNING + axis]
        way = slip - turning + 0.5 * (slip_rate - turning_rate) * elapsed
        state[axis] = row[PLACE + axis] + way * elapsed
        state[2 + axis] = slip + slip_rate * elapsed
        state[4 + axis] = turning + turning_rate * elapsed
        state[6 + axis] = taken


@compiled
def write_within(
    lying: LyingSphere, row: Vector, elapsed: float, stages: Matrix, state: Vector
) -> None:
    """Write place, s, w and q (8,) a time after the begin of a part [s]."""
    if row[IS_STRAIGHT] > 0.0:
        write_along_line(lying, row, elapsed, state)
        return
    advance(lying, row, elapsed, stages, state)
    state[6], state[7], _, _ = turning_forces(lying, row, state)


@compiled
def time_to_zero(x: float, y: float, rate_x: float, rate_y: float) -> float:
    """Return the time until a vector that shrinks along its line is zero [s], else infinity."""
    length = length_of(x, y)
    if length == 0.0:
        return np.inf
    rate = (x * rate_x + y * rate_y) / length
    if rate < 0.0:
        return -length / rate
    return np.inf


@compiled
def step_along_line(lying: LyingSphere, row: Vector, longest: float) -> tuple[float, bool, bool]:
    """Return the length of a part along a line [s], and whether slip and spin end with it."""
    rest = 1.0 - lying.share
    slip_ends = np.inf
    if row[SLIPS] > 0.0 and lying.bound > 0.0:
        slip_ends = time_to_zero(
            row[SLIP],
            row[SLIP + 1],
            lying.gravity_x + row[TURN] - row[TAKEN],
            lying.gravity_y + row[TURN + 1] - row[TAKEN + 1],
        )
    spin_ends = np.inf
    if row[TURNS] > 0.0:
        spin_ends = time_to_zero(
            row[TURNING],
            row[TURNING + 1],
            row[TURN] - rest * row[TAKEN],
            row[TURN + 1] - rest * row[TAKEN + 1],
        )
    length = min(longest, min(slip_ends, spin_ends))
    return length, slip_ends <= length, spin_ends <= length


@compiled
def until_events(lying: LyingSphere, row: Vector, state: Vector) -> tuple[float, float]:
    """Return what falls to zero where the slip ends, or begins, and where the spin ends."""
    # a sphere that rolls begins to slip where g + u exceeds what friction can hold
    slips = length_of(state[2], state[3]) - lying.least
    if row[SLIPS] == 0.0:
        _, _, turn_x, turn_y = turning_forces(lying, row, state)
        slips = lying.bound - length_of(lying.gravity_x + turn_x, lying.gravity_y + turn_y)
    turns = np.inf
    if row[TURNS] > 0.0:
        turns = length_of(state[4], state[5]) - lying.least
    return slips, turns


@compiled
def step_to_event(
    lying: LyingSphere, row: Vector, length: float, stages: Matrix, state: Vector
) -> tuple[float, bool, bool]:
    """Return up to where a step goes that is not beyond an event [s], and whether the slip ends, or
    begins, there, and whether the spin ends.

    `state`: room, which has the state there afterwards.
    """
    begun_slips, begun_turns = until_events(lying, row, row[PLACE:])
    slips, turns = until_events(lying, row, state)
    changes = begun_slips >= 0.0 and slips <= 0.0
    settles = begun_turns >= 0.0 and turns <= 0.0
    if not (changes or settles):
        return length, False, False
    low = 0.0
    high = length
    # the last round writes the state at the end of the bracket that is beyond the event
    for halving in range(_MOST_HALVINGS + 1):
        tried = 0.5 * (low + high)
        if halving == _MOST_HALVINGS:
            tried = high
        advance(lying, row, tried, stages, state)
        slips, turns = until_events(lying, row, state)
        if (changes and slips <= 0.0) or (settles and turns <= 0.0):
            high = tried
        else:
            low = tried
    return high, changes and slips <= 0.0, settles and turns <= 0.0


@compiled
def adapted_step(
    lying: LyingSphere, row: Vector, length: float, stages: Matrix, state: Vector
) -> tuple[float, float]:
    """Write the state after a step whose error is allowed, and return its length and that of the
    next one [s]; `length`: to be tried.
    """
    was_too_long = False
    while True:
        error = advance(lying, row, length, stages, state)
        factor = _GROWS
        if error != 0.0:  # it goes with the eighth power of the length
            factor = _SAFETY * error ** (-1.0 / 8.0)
        factor = min(max(factor, _SHRINKS), _GROWS)
        if not error >= 1.0:
            if was_too_long:
                factor = min(factor, 1.0)
            return length, length * factor
        was_too_long = True
        length *= factor


@compiled
def with_room(motion: Matrix, parts: int) -> Matrix:
    """Return a motion with room for another part."""
    if parts < len(motion):
        return motion
    larger = np.empty((2 * parts, COLUMNS))
    for part in range(parts):
        write_row(larger, part, motion[part])
    return larger


@compiled
def goes_along_line(lying: LyingSphere, start: Vector) -> bool:
    """Do slip, spin and gravity of a sphere stay in their directions?

    They do not where gravity pulls across the slip, or where the moment acts across one of both.
    `start`: place, s and w (6,).
    """
    if lying.bound == 0.0:
        return True
    if is_across(start[2], start[3], lying.gravity_x, lying.gravity_y):
        return False
    return lying.resistance == 0.0 or not (
        is_across(start[2], start[3], start[4], start[5])
        or is_across(lying.gravity_x, lying.gravity_y, start[4], start[5])
    )


@compiled
def follow(lying: LyingSphere, start: Vector, until: float) -> Matrix:
    """Return the parts of the motion of a sphere up to a time [s]; see `COLUMNS`.

    `start`: place, s and w (6,).
    """
    resists = lying.resistance > 0.0
    row = np.zeros(COLUMNS)
    for number in range(6):
        row[PLACE + number] = start[number]
    is_straight = goes_along_line(lying, start)
    least = 0.0 if is_straight else lying.least
    slips = length_of(row[SLIP], row[SLIP + 1]) > least
    begins = True
    time = 0.0
    length = 0.0
    following = 0.0
    parts = 0
    motion = np.empty((_FIRST_PARTS, COLUMNS))
    stages = np.empty((STAGES + 1, 6))
    state = np.empty(8)
    while True:
        if begins:
            # where directions turn not what has ended in the last part
            turns = resists and length_of(row[TURNING], row[TURNING + 1]) > 2.0 * least
            if not is_straight and not slips and turns:
                turn_x, turn_y = directed(
                    -lying.resistance, row[TURNING], row[TURNING + 1], lying.least
                )
                pull = length_of(lying.gravity_x + turn_x, lying.gravity_y + turn_y)
                slips = pull > lying.bound
            if not is_straight and not (slips or turns):
                is_straight = True
                least = 0.0
            for axis in range(2):
                if not slips:  # friction takes what there is of it, from both of its parts
                    row[TURNING + axis] -= (1.0 - lying.share) * row[SLIP + axis]
                    row[SLIP + axis] = 0.0
                if resists and not turns:
                    row[TURNING + axis] = 0.0
            row[IS_STRAIGHT] = 1.0 if is_straight else 0.0
            row[SLIPS] = 1.0 if slips else 0.0
            row[TURNS] = 1.0 if turns else 0.0
            if not is_straight:
                speed = length_of(row[SLIP], row[SLIP + 1])
                speed += length_of(row[TURNING], row[TURNING + 1])
                length = _FIRST_STEP * speed / (lying.bound + lying.resistance)
        row[BEGIN] = time
        row[IS_EVENT] = 1.0 if begins else 0.0
        longest = max(until - time, 0.0)
        if is_straight:
            write_constant_forces(lying, row)
            length, slip_changes, spin_ends = step_along_line(lying, row, longest)
            write_along_line(lying, row, length, state)
        else:
            length, following = adapted_step(lying, row, min(length, longest), stages, state)
            length, slip_changes, spin_ends = step_to_event(lying, row, length, stages, state)
        motion = with_room(motion, parts)
        write_row(motion, parts, row)
        parts += 1
        time = min(time + length, until)
        if not time < until:
            return motion[:parts]
        for number in range(6):
            row[PLACE + number] = state[number]
        begins = slip_changes or spin_ends
        if is_straight:
            slips = length_of(row[SLIP], row[SLIP + 1]) > 0.0 and not slip_changes
        else:
            length = following
            slips = slips != slip_changes
        if spin_ends:
            row[TURNING] = 0.0
            row[TURNING + 1] = 0.0


@compiled
def lying_sphere(sphere: RubbedSphere, pressing: float, start: Vector) -> LyingSphere:
    """Return what acts on a sphere.

    `pressing`: gravity along the normal [m/s^2]. `start`: place, s and w (6,).
    """
    # q = mu g_n m/m_t and u = mu_r g_n m R^2/I, of which m R^2/I = (1 - m_t/m)/(m_t/m)
    share = tangential_mass(sphere) / sphere.mass
    resistance = sphere.rolling_coefficient * pressing * (1.0 - share) / share
    speed = length_of(start[2], start[3])
    if resistance > 0.0:
        speed += length_of(start[4], start[5])
    return LyingSphere(
        sphere.gravity_x,
        sphere.gravity_y,
        sphere.coefficient * pressing / share,
        resistance,
        share,
        _STOPPED * speed,
    )


@compiled
def start_of(sphere: RubbedSphere, state: SphereState) -> Vector:
    """Return place, s and w of a sphere (6,)."""
    turning_x, turning_y = turning_of(sphere, state)
    start = np.empty(6)
    start[0] = state.x
    start[1] = state.y
    start[2] = state.velocity_x + turning_x
    start[3] = state.velocity_y + turning_y
    start[4] = turning_x
    start[5] = turning_y
    # of a sphere that rolls s is rounding, whose direction says nothing
    if length_of(start[2], start[3]) <= _ACROSS * length_of(turning_x, turning_y):
        start[2] = 0.0
        start[3] = 0.0
    return start


@compiled
def part_at(motion: Matrix, time: float) -> int:
    """Return the number of the last part that has begun at a time [s]; the first column of `motion`
    has their begins.
    """
    low = 0
    high = len(motion)
    while high - low > 1:
        middle = (low + high) // 2
        if motion[middle, BEGIN] <= time:
            low = middle
        else:
            high = middle
    return low


@compiled
def time_of_turn(
    lying: LyingSphere, row: Vector, length: float, axis: int, stages: Matrix, state: Vector
) -> float:
    """Return the time after the begin of a part at which the centre turns back along an axis, or
    the length of the part [s].
    """
    low = 0.0
    high = length
    begun = row[SLIP + axis] - row[TURNING + axis]
    ended = 0.0
    turn = length
    for _ in range(_TURNS_BACK):
        write_within(lying, row, turn, stages, state)
        speed = state[2 + axis] - state[4 + axis]
        if speed * begun > 0.0:
            low = turn
            begun = speed
        else:
            high = turn
            ended = speed
        if not begun * ended < 0.0:
            break
        turn = low + (high - low) * begun / (begun - ended)
    return turn


@compiled
def is_beside(state: Vector, half: tuple[float, float]) -> bool:
    """Is the centre beside the plate?"""
    return bool(abs(state[0]) > half[0] or abs(state[1]) > half[1])


@compiled
def edge_time(lying: LyingSphere, motion: Matrix, until: float, half: tuple[float, float]) -> float:
    """Return the time at which a sphere leaves the plate, as its centre first is beyond an edge
    [s]; else its last time.

    `half`: half the sides of the plate [m].
    """
    stages = np.empty((STAGES + 1, 6))
    state = np.empty(8)
    if half[0] == np.inf:
        return until
    if is_beside(motion[0, PLACE:], half):
        return 0.0
    stations = np.empty(3)
    for part in range(len(motion)):
        row = motion[part]
        end = until
        if part + 1 < len(motion):
            end = motion[part + 1, BEGIN]
        stations[2] = end - row[BEGIN]
        for axis in range(2):
            stations[axis] = time_of_turn(lying, row, stations[2], axis, stages, state)
        if stations[0] > stations[1]:
            stations[0], stations[1] = stations[1], stations[0]
        low = 0.0
        # up to each of these the centre moves in one direction along each side
        for station in stations:
            high = station
            tried = station
            leaves = False
            for _ in range(_MOST_HALVINGS + 1):
                write_within(lying, row, tried, stages, state)
                if is_beside(state, half):
                    leaves = True
                    high = tried
                elif leaves:
                    low = tried
                else:
                    break
                tried = 0.5 * (low + high)
            if leaves:
                return float(row[BEGIN] + high)
            low = station
    return until
