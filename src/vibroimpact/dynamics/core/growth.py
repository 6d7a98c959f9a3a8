r"""Growth of a small change of the drop from impact to impact, where bodies vibrate.

The difference of a neighbouring drop, from a slightly different height or speed, obeys the
linearised equations of motion. It is propagated along the motion that was written: in closed form
through flights, by one linear solve through each stretch of contact. Where the contact force jumps,
as when a dashpot meets the surface, the two drops meet the jump at different times: if the second
is later by :math:`\delta t`, the difference gains :math:`(f_- - f_+)\,\delta t`, with the rates f
of the state before and after (P. C. Mueller, Chaos, Solitons & Fractals 5:1671, 1995). The
equations are autonomous, so the drops need not be compared at equal times: whenever a contact
begins or ends, each drop is taken at its own time of that event.

The law of the neighbouring drop differs in its closing speed, and in the largest indentation that
it remembers.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Integers, Vector
from vibroimpact.compiled import Lent, compiled, compressed_at, force_at, levels_at
from vibroimpact.dynamics.core.attempt import basis_of, time_at, weights_at
from vibroimpact.dynamics.core.contact_records import (
    FLIGHT,
    PARTS,
    RECOIL,
    STRETCH,
    Bodies,
    Parts,
    Solved,
)
from vibroimpact.dynamics.core.flight import approach_of, dashpot_rate, rigid_rate, state_after
from vibroimpact.dynamics.core.law import law_at_touch, law_indentation, room_for_laws, write_law_of
from vibroimpact.dynamics.core.linear import largest_of, write_all
from vibroimpact.dynamics.core.peak import nodal_value_between, peak_of_force
from vibroimpact.dynamics.core.records import (
    Bases,
    Contacts,
    Law,
    State,
    System,
)
from vibroimpact.dynamics.core.tangent import propagate

_STEP = 1e-6  # relative: of closing speed and indentations, for finite differences
_SAME = 1e-9  # relative: of indentations that are the same but for rounding
_JUMP = 1e-6  # of the force: a smaller change is no jump
_SLOW = 0.1  # of the closing speed: lower bound of the separation speed in a relative change
_NONE = -1  # no part, no law

LAST, LAW, STRONGEST = range(3)
"""Numbers of parts and laws of a neighbour, or none: of the stretch that it comes from; of the law
of the last contact; and of the stretch of the impact with the largest force at a node.
"""

CLOSING, DEEPEST, DEEPER, FORCE, SPEED, CLOSING_SPEED, LARGEST_FORCE = range(7)
"""Values of a neighbour: difference of the closing speed of the law [m/s]; the largest indentation
that the law remembers, zero without a memory, and its difference [m]; difference of the force at
the end of the last stretch [N]; of the impact the closing speed [m/s], its difference, and the
largest force at a node [N].
"""


class Neighbour(NamedTuple):
    """How a neighbouring drop differs, per unit relative change of the drop.

    displacement, velocity (n,), local (k,): differences of the state. forces (N,): of the forces at
    the nodes of the stretch with the largest one [N]. numbers (3,), values (7,): those above.
    """

    displacement: Vector
    velocity: Vector
    local: Vector
    forces: Vector
    numbers: Integers
    values: Vector


class Recorded(NamedTuple):
    """The motion of a drop as it was written: the system, and the same without gravity and gap, for
    differences; addresses and series of its law, as in `Law`; the parts; and the state at their
    end.
    """

    system: System
    still: System
    addresses: Integers
    series: Vector
    parts: Parts
    end: State


@compiled
def write_growth(
    bases: Lent[Bases],
    still: Lent[Bodies],
    recorded: Lent[Recorded],
    tension: int,
    neighbour: Lent[Neighbour],
    growth: Vector,
) -> None:
    """Write the growth of a relative change of a drop by each of its impacts [-] (I,).

    The growth is the largest of the relative changes of the closing speed, of the largest force,
    and of the separation speed (relative to at least a tenth of the closing speed).

    Parameters
    ----------
    bases, still : Bases, Bodies
        The Radau rule under the three maps of time, and the bodies without gravity and gap.
    recorded : Recorded
        The motion of the drop.
    tension : int
        Number of the law's, of `events`.
    neighbour : Neighbour
        That at the start, which is changed.
    growth : array, shape (I,)
        Where the growth is written.
    """
    parts = recorded.parts
    is_apart = True
    impact = 0
    part = 0
    while part < parts.written[PARTS]:
        kind = parts.kind[part]
        end = part + 1
        if kind == STRETCH:
            while (
                end < parts.written[PARTS]
                and parts.kind[end] == STRETCH
                and parts.law[end] == parts.law[part]
            ):
                end += 1
            if is_apart:
                touch(recorded, neighbour, part)
            elif parts.law[part] != neighbour.numbers[LAW]:
                compress(bases, recorded, neighbour, part)
            is_apart = False
            pass_stretches(bases, still, recorded, tension, neighbour, part, end)
        else:
            is_apart = kind != RECOIL
            if is_apart:
                separate(recorded, neighbour)
            fly(recorded, neighbour, part)
        is_last = end == parts.written[PARTS] or parts.kind[end] == FLIGHT
        if kind != FLIGHT and is_last:
            separate(recorded, neighbour)
            growth[impact] = growth_by_impact(bases, recorded, neighbour, end)
            neighbour.numbers[STRONGEST] = _NONE
            neighbour.values[SPEED] = 0.0
            neighbour.values[LARGEST_FORCE] = 0.0
            impact += 1
        part = end


@compiled
def state_at(recorded: Recorded, part: int) -> State:
    """Return the state at the start of a part, or after the last one."""
    parts = recorded.parts
    if part == parts.written[PARTS]:
        return recorded.end
    return State(parts.displacement[part], parts.velocity[part], parts.local[part])


@compiled
def difference_of(neighbour: Neighbour) -> State:
    """Return the difference of the state."""
    return State(neighbour.displacement, neighbour.velocity, neighbour.local)


@compiled
def put(neighbour: Neighbour, difference: State) -> None:
    """Write a difference of the state to a neighbour."""
    write_all(neighbour.displacement, difference.displacement)
    write_all(neighbour.velocity, difference.velocity)
    write_all(neighbour.local, difference.local)


@compiled
def law_with(recorded: Recorded, coefficients: Vector, speed: float) -> Law:
    """Return the law with some coefficients, at a closing speed [m/s]."""
    return law_at_touch(recorded.addresses, coefficients, recorded.series, speed)


@compiled
def shift(
    neighbour: Neighbour, system: System, state: State, force: float, static: float, delay: float
) -> None:
    """Take the neighbouring drop later by a time.

    Parameters
    ----------
    neighbour : Neighbour
        The neighbour, which is changed.
    system : System
        The bodies.
    state : State
        Of the drop at that time.
    force, static : float
        Contact force on it and its static part [N].
    delay : float
        The time per unit relative change [s].
    """
    # to first order the state goes on at its own rate for the delay
    for coordinate in range(len(state.velocity)):
        frequency = system.frequency[coordinate]
        # the static part acts on the coordinates inside the contact
        inner = system.shape[coordinate] - system.outer_shape[coordinate]
        acceleration = (
            system.load[coordinate]
            - system.damping[coordinate] * state.velocity[coordinate]
            - frequency * frequency * state.displacement[coordinate]
            - (system.outer_shape[coordinate] * force + inner * static)
        )
        neighbour.displacement[coordinate] += delay * state.velocity[coordinate]
        neighbour.velocity[coordinate] += delay * acceleration
    for element in range(len(state.local)):
        yielding = system.rate[element] * state.local[element] + system.mobility[element] * force
        neighbour.local[element] -= delay * yielding


@compiled
def shift_to_event(recorded: Recorded, neighbour: Neighbour, excess: float, rate: float) -> None:
    """Shift the difference at the end of the last stretch to the event of each drop.

    The event function of the neighbouring drop exceeds that of the reference drop by `excess`, and
    grows at a rate.
    """
    # 0 = excess + rate delay, to first order
    parts = recorded.parts
    last = neighbour.numbers[LAST]
    node = parts.force.shape[1] - 1
    state = state_at(recorded, last + 1)
    force = parts.force[last, node]
    shift(neighbour, recorded.system, state, force, parts.static[last, node], -excess / rate)


@compiled
def separate(recorded: Recorded, neighbour: Neighbour) -> None:
    """Shift the difference to the separation of each drop, if they come from a stretch."""
    last = neighbour.numbers[LAST]
    if last == _NONE:
        return
    excess, _ = approach_of(recorded.still, difference_of(neighbour))
    closing = recorded.parts.closing[last]
    shift_to_event(recorded, neighbour, excess, closing[len(closing) - 1])
    neighbour.numbers[LAST] = _NONE


@compiled
def fly(recorded: Recorded, neighbour: Neighbour, part: int) -> None:
    """Propagate the difference through a part without contact force."""
    length = recorded.parts.length[part]
    put(neighbour, state_after(recorded.still, difference_of(neighbour), length))
    neighbour.numbers[LAST] = _NONE


@compiled
def pass_stretches(
    bases: Bases,
    still: Bodies,
    recorded: Recorded,
    tension: int,
    neighbour: Neighbour,
    first: int,
    end: int,
) -> None:
    """Propagate through stretches of contact under one law, from the first one to an end.

    The other arguments are those of `write_growth`.
    """
    parts = recorded.parts
    solved = Solved(
        parts.time_map[first:end],
        parts.length[first:end],
        parts.delta[first:end],
        parts.rate[first:end],
    )
    laws, weights = varied_laws(recorded, tension, neighbour, parts.law[first])
    difference, forces = propagate(bases, still, laws, weights, solved, difference_of(neighbour))
    put(neighbour, difference)
    neighbour.numbers[LAST] = end - 1
    neighbour.values[FORCE] = forces[len(forces) - 1, forces.shape[1] - 1]
    for stretch in range(first, end):
        force = largest_of(parts.force[stretch])
        if force > neighbour.values[LARGEST_FORCE]:
            neighbour.values[LARGEST_FORCE] = force
            neighbour.numbers[STRONGEST] = stretch
            write_all(neighbour.forces, forces[stretch - first])


# the law of the neighbouring drop
# ---------------------------------------------------------------------------------------


@compiled
def after_compression(recorded: Recorded, coefficients: Vector, deepest: float) -> Vector:
    """Return the coefficients of a law after a compression to an indentation [m]."""
    changed = coefficients.copy()
    compressed_at(recorded.addresses[3])(deepest, coefficients, changed)
    return changed


@compiled
def varied_laws(
    recorded: Recorded, tension: int, neighbour: Neighbour, law: int
) -> tuple[Contacts, Vector]:
    """Return a law by its number, with its closing speed and its memory varied after it, and by
    what the change of the force of each counts.
    """
    coefficients = recorded.parts.coefficients[law]
    speed = recorded.parts.closing_speed[law]
    base = law_with(recorded, coefficients, speed)
    laws = room_for_laws(base, 3, tension)
    for contact in range(3):
        write_law_of(laws, contact, base)
    weights = np.zeros(2)
    closing = neighbour.values[CLOSING]
    if closing != 0.0:
        write_law_of(laws, 1, law_with(recorded, coefficients, speed * (1.0 + _STEP)))
        weights[0] = closing / (speed * _STEP)
    deepest = neighbour.values[DEEPEST]
    if neighbour.values[DEEPER] != 0.0:
        changed = after_compression(recorded, coefficients, deepest * (1.0 + _STEP))
        write_law_of(laws, 2, law_with(recorded, changed, speed))
        weights[1] = neighbour.values[DEEPER] / (deepest * _STEP)
    return laws, weights


@compiled
def touch(recorded: Recorded, neighbour: Neighbour, first: int) -> None:
    """Shift the difference to the touch of each drop; `first`: stretch of the contact.

    The law of the neighbour has another closing speed, and what it remembers if the surface is
    still the same.
    """
    parts = recorded.parts
    law = parts.law[first]
    coefficients = parts.coefficients[law]
    levels = levels_at(recorded.addresses[2])
    level, _, remembered, _, _ = levels(coefficients)
    if remembered < (1.0 - _SAME) * neighbour.values[DEEPEST]:  # on another surface
        neighbour.values[DEEPEST] = 0.0
        neighbour.values[DEEPER] = 0.0
    # the level at which the surfaces touch depends on the memory: by a finite difference
    lower = 0.0
    if neighbour.values[DEEPER] != 0.0:
        step = _STEP * neighbour.values[DEEPEST]
        deepest = neighbour.values[DEEPEST] + step
        changed, _, _, _, _ = levels(after_compression(recorded, coefficients, deepest))
        lower = neighbour.values[DEEPER] * (changed - level) / step
    start = state_at(recorded, first)
    _, rate = approach_of(recorded.system, start)
    approach, _ = approach_of(recorded.still, difference_of(neighbour))
    shift(neighbour, recorded.system, start, 0.0, 0.0, (lower - approach) / rate)
    # as in the closing speed of the drop itself
    closing = dashpot_rate(recorded.still, difference_of(neighbour))
    if dashpot_rate(recorded.system, start) < rate:
        _, closing = approach_of(recorded.still, difference_of(neighbour))
    neighbour.values[CLOSING] = closing
    neighbour.numbers[LAST] = _NONE
    neighbour.numbers[LAW] = law
    if neighbour.values[SPEED] == 0.0:  # the first touch of the impact
        neighbour.values[SPEED] = parts.closing_speed[law]
        neighbour.values[CLOSING_SPEED] = closing


@compiled
def compress(bases: Bases, recorded: Recorded, neighbour: Neighbour, first: int) -> None:
    """Take the change of the law's memory at a turn; `first`: the next stretch.

    The largest indentation of the neighbour differs by the difference of the approach, and, with a
    compliance in series, by that of the law.
    """
    parts = recorded.parts
    if force_jumps(recorded, neighbour, first):
        turn(bases, recorded, neighbour)
    number = neighbour.numbers[LAW]
    coefficients = parts.coefficients[number]
    speed = parts.closing_speed[number]
    before = law_with(recorded, coefficients, speed)
    approach, _ = approach_of(recorded.system, state_at(recorded, first))
    reached = max(approach, before.release_level)
    deepest = law_indentation(before, reached)
    step = _STEP * reached
    # d delta = d delta/dy dy + d delta/d v_0 dv_0 + d delta/d memory d memory
    closer, _ = approach_of(recorded.still, difference_of(neighbour))
    deeper = closer * (law_indentation(before, reached + step) - deepest) / step
    faster = law_with(recorded, coefficients, speed * (1.0 + _STEP))
    by_speed = (law_indentation(faster, reached) - deepest) / (speed * _STEP)
    deeper += neighbour.values[CLOSING] * by_speed
    if neighbour.values[DEEPER] != 0.0:
        step = _STEP * neighbour.values[DEEPEST]
        changed = after_compression(recorded, coefficients, neighbour.values[DEEPEST] + step)
        by_memory = law_indentation(law_with(recorded, changed, speed), reached) - deepest
        deeper += neighbour.values[DEEPER] * by_memory / step
    neighbour.values[DEEPEST] = deepest
    neighbour.values[DEEPER] = deeper
    neighbour.numbers[LAW] = parts.law[first]


@compiled
def turn(bases: Bases, recorded: Recorded, neighbour: Neighbour) -> None:
    """Shift the difference to the turn of the approach of each drop, at the end of a stretch."""
    parts = recorded.parts
    last = neighbour.numbers[LAST]
    basis = basis_of(bases, parts.time_map[last])
    closing = parts.closing[last]
    # the approach turns where its rate is zero; its second derivative is a finite difference
    weights = np.empty(len(closing))
    weights_at(basis, 1.0 - _STEP, weights)
    earlier = 0.0
    for point in range(len(closing)):
        earlier += weights[point] * closing[point]
    time = parts.length[last] * (1.0 - time_at(basis, 1.0 - _STEP))
    acceleration = (closing[len(closing) - 1] - earlier) / time
    _, excess = approach_of(recorded.still, difference_of(neighbour))
    for element in range(len(recorded.still.mobility)):
        excess -= recorded.still.mobility[element] * neighbour.values[FORCE]
    shift_to_event(recorded, neighbour, excess, acceleration)


@compiled
def force_jumps(recorded: Recorded, neighbour: Neighbour, first: int) -> bool:
    """Does the force jump between the last stretch and the next one?"""
    parts = recorded.parts
    law = parts.law[first]
    speed = parts.closing_speed[law]
    acting = law_with(recorded, parts.coefficients[law], speed)
    delta = max(parts.delta[first, 0], acting.release)
    static, dissipative = force_at(acting.addresses[0])(
        delta, parts.rate[first, 0], speed, acting.coefficients
    )
    before = parts.force[neighbour.numbers[LAST], parts.force.shape[1] - 1]
    return bool(abs(static + dissipative - before) > _JUMP * abs(before))


@compiled
def growth_by_impact(bases: Bases, recorded: Recorded, neighbour: Neighbour, end: int) -> float:
    """Return the growth of a change by an impact [-]; `end`: the part after it."""
    parts = recorded.parts
    strongest = neighbour.numbers[STRONGEST]
    if strongest == _NONE:
        return math.nan
    law = parts.law[strongest]
    acting = law_with(recorded, parts.coefficients[law], parts.closing_speed[law])
    basis = basis_of(bases, parts.time_map[strongest])
    x, peak = peak_of_force(basis, acting, parts.delta[strongest], parts.rate[strongest])
    by_force = nodal_value_between(basis, neighbour.forces, x) / peak
    speed = neighbour.values[SPEED]
    leaving = abs(state_at(recorded, end).velocity[0] * recorded.system.shape[0])
    separation = rigid_rate(recorded.still, difference_of(neighbour))
    by_separation = separation / max(leaving, _SLOW * speed)
    by_closing = neighbour.values[CLOSING_SPEED] / speed
    return float(max(abs(by_closing), abs(by_force), abs(by_separation)))
