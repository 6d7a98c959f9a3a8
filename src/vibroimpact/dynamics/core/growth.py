r"""Growth of a small change of the drop from impact to impact, where bodies vibrate.

The difference of a neighbouring drop, from a slightly different height or speed, obeys the
linearised equations of motion. It is propagated along the motion that was written: in closed form
through flights, by one linear solve through each stretch of contact. Where the contact force jumps,
as when a dashpot meets the surface, the two drops meet the jump at different times: if the second
is later by :math:`\delta t`, the difference gains :math:`(f_- - f_+)\,\delta t`, with the rates f
of the state before and after (P. C. Mueller, Chaos, Solitons & Fractals 5:1671, 1995). The
equations are autonomous, so the drops need not be compared at equal times: whenever a contact
begins or ends, each drop is taken at its own time of that event.

The law of the neighbouring drop differs in its closing speed, and by what another largest
indentation makes of its coefficients.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import compiled, compressed_at, force_at, lent, levels_at
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
from vibroimpact.dynamics.core.linear import largest_of
from vibroimpact.dynamics.core.peak import nodal_value_between, peak_of_force
from vibroimpact.dynamics.core.records import (
    Bases,
    Boolean,
    Contacts,
    Integer,
    Law,
    Real,
    State,
    System,
    Vector,
)
from vibroimpact.dynamics.core.tangent import propagate
from vibroimpact.dynamics.core.vibrating_records import ImpactManner

_STEP = 1e-6  # relative: of closing speed, coefficients and indentation, for finite differences
_SMALLEST = 1e-12  # such a step where there is nothing that it could be relative to
_JUMP = 1e-6  # of the force: a smaller change is no jump
_SLOW = 0.1  # of the closing speed: lower bound of the separation speed in a relative change
_NONE = -1  # no part, no law


class Neighbour(NamedTuple):
    """How a neighbouring drop differs, per unit relative change of the drop.

    state: difference of the state. Of the law: closing, difference of its closing speed [m/s], and
    coefficients (K,), of its coefficients. is_apart: are the surfaces apart? last: the stretch that
    it comes from, or none, and force: difference of the force at its end [N]. law: number of that
    of the last contact, or none.

    Of the impact: speed of closing [m/s], and closing_speed, its difference. strongest: the stretch
    with the largest force at a node, or none, largest_force [N], and forces (N,), the differences
    at its nodes [N].
    """

    state: State
    closing: Real
    coefficients: Vector
    is_apart: Boolean
    last: Integer
    force: Real
    law: Integer
    speed: Real
    closing_speed: Real
    strongest: Integer
    largest_force: Real
    forces: Vector


class Recorded(NamedTuple):
    """The motion of a drop as it was written: the bodies, and the same without gravity and gap, for
    differences; what stays the same; the parts; and the state at their end.
    """

    bases: Bases
    bodies: Bodies
    still: Bodies
    manner: ImpactManner
    parts: Parts
    end: State


@compiled(lambda t: t.void(t.of(Recorded), t.of(State), t.vector))
def write_growth(recorded: Recorded, difference: State, growth: Floats) -> None:
    """Write the growth of a relative change of a drop by each of its impacts [-] (I,).

    The growth is the largest of the relative changes of the closing speed, of the largest force,
    and of the separation speed (relative to at least a tenth of the closing speed).

    Parameters
    ----------
    recorded : Recorded
        The motion of the drop.
    difference : State
        That of the state at the start, per unit relative change.
    growth : array, shape (I,)
        Where the growth is written.
    """
    recorded = lent(recorded)  # held by the caller
    parts = recorded.parts
    nodes = parts.force.shape[1]
    neighbour = Neighbour(
        difference,
        0.0,
        np.zeros(parts.coefficients.shape[1]),
        True,
        _NONE,
        0.0,
        _NONE,
        0.0,
        0.0,
        _NONE,
        0.0,
        np.zeros(nodes),
    )
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
            neighbour = through_stretches(recorded, neighbour, part, end)
        else:
            neighbour = through_free(recorded, neighbour, part, kind == RECOIL)
        is_last = end == parts.written[PARTS] or parts.kind[end] == FLIGHT
        if kind != FLIGHT and is_last:
            neighbour = separated(recorded, neighbour)
            growth[impact] = growth_of(recorded, neighbour, end)
            neighbour = after_impact(neighbour)
            impact += 1
        part = end


@compiled(lambda t: t.of(State)(t.of(Recorded), t.integer))
def state_at(recorded: Recorded, part: int) -> State:
    """Return the state at the start of a part, or after the last one."""
    parts = recorded.parts
    if part == parts.written[PARTS]:
        return recorded.end
    return State(
        parts.displacement[part].copy(), parts.velocity[part].copy(), parts.local[part].copy()
    )


@compiled(lambda t: t.of(Law)(t.of(Recorded), t.vector, t.real))
def law_with(recorded: Recorded, coefficients: Floats, speed: float) -> Law:
    """Return the law with some coefficients, at a closing speed [m/s]."""
    return law_at_touch(recorded.manner.addresses, coefficients, recorded.manner.series, speed)


@compiled(lambda t: t.of(State)(t.of(System), t.of(State), t.real, t.real))
def state_rates(system: System, state: State, force: float, static: float) -> State:
    """Return the time derivative of a state under a contact force and its static part [N]."""
    number = len(state.velocity)
    accelerations = np.empty(number)
    for coordinate in range(number):
        frequency = system.frequency[coordinate]
        # the static part acts on the coordinates inside the contact
        inner = system.shape[coordinate] - system.outer_shape[coordinate]
        accelerations[coordinate] = (
            system.load[coordinate]
            - system.damping[coordinate] * state.velocity[coordinate]
            - frequency * frequency * state.displacement[coordinate]
            - (system.outer_shape[coordinate] * force + inner * static)
        )
    yielding = -system.rate * state.local - system.mobility * force
    return State(state.velocity, accelerations, yielding)


@compiled(lambda t: t.of(State)(t.of(State), t.of(State), t.real))
def shifted(difference: State, rates: State, delay: float) -> State:
    """Return the difference if the neighbouring drop is taken later by a time.

    `delay`: that time per unit relative change [s].
    """
    return State(
        difference.displacement + delay * rates.displacement,
        difference.velocity + delay * rates.velocity,
        difference.local + delay * rates.local,
    )


@compiled(lambda t: t.of(Neighbour)(t.of(Neighbour), t.of(State), t.boolean, t.integer))
def moved(neighbour: Neighbour, state: State, is_apart: bool, last: int) -> Neighbour:
    """Return the neighbour with another difference of the state, after a part of the motion."""
    return Neighbour(
        state,
        neighbour.closing,
        neighbour.coefficients,
        is_apart,
        last,
        neighbour.force,
        neighbour.law,
        neighbour.speed,
        neighbour.closing_speed,
        neighbour.strongest,
        neighbour.largest_force,
        neighbour.forces,
    )


@compiled(lambda t: t.of(Neighbour)(t.of(Neighbour)))
def after_impact(neighbour: Neighbour) -> Neighbour:
    """Return the neighbour after an impact."""
    return Neighbour(
        neighbour.state,
        neighbour.closing,
        neighbour.coefficients,
        neighbour.is_apart,
        neighbour.last,
        neighbour.force,
        neighbour.law,
        0.0,
        0.0,
        _NONE,
        0.0,
        neighbour.forces,
    )


@compiled(lambda t: t.of(State)(t.of(Recorded), t.of(Neighbour), t.real, t.real))
def shifted_to_event(recorded: Recorded, neighbour: Neighbour, excess: float, rate: float) -> State:
    """Return the difference at the end of the last stretch, shifted to the event of each drop.

    The event function of the neighbouring drop exceeds that of the reference drop by `excess`, and
    grows at a rate.
    """
    parts = recorded.parts
    last = neighbour.last
    node = parts.force.shape[1] - 1
    state = state_at(recorded, last + 1)
    rates = state_rates(
        recorded.bodies.system, state, parts.force[last, node], parts.static[last, node]
    )
    return shifted(neighbour.state, rates, -excess / rate)


@compiled(lambda t: t.of(Neighbour)(t.of(Recorded), t.of(Neighbour)))
def separated(recorded: Recorded, neighbour: Neighbour) -> Neighbour:
    """Return the neighbour where each drop separates, if they come from a stretch."""
    if neighbour.last == _NONE:
        return neighbour
    excess, _ = approach_of(recorded.still.system, neighbour.state)
    closing = recorded.parts.closing[neighbour.last]
    state = shifted_to_event(recorded, neighbour, excess, closing[len(closing) - 1])
    return moved(neighbour, state, neighbour.is_apart, _NONE)


@compiled(lambda t: t.of(Neighbour)(t.of(Recorded), t.of(Neighbour), t.integer, t.boolean))
def through_free(recorded: Recorded, neighbour: Neighbour, part: int, is_inside: bool) -> Neighbour:
    """Return the neighbour after free motion, in recoil (`is_inside`) or apart."""
    if not is_inside:
        neighbour = separated(recorded, neighbour)
    length = recorded.parts.length[part]
    state = state_after(recorded.still.system, neighbour.state, length)
    return moved(neighbour, state, not is_inside, _NONE)


@compiled(lambda t: t.of(Neighbour)(t.of(Recorded), t.of(Neighbour), t.integer, t.integer))
def through_stretches(recorded: Recorded, neighbour: Neighbour, first: int, end: int) -> Neighbour:
    """Return the neighbour after stretches of contact under one law, from the first to an end."""
    parts = recorded.parts
    law = parts.law[first]
    if neighbour.is_apart:
        neighbour = touched(recorded, neighbour, first)
    elif law != neighbour.law:
        neighbour = compressed(recorded, neighbour, first)
    solved = Solved(
        parts.time_map[first:end],
        parts.length[first:end],
        parts.delta[first:end],
        parts.rate[first:end],
    )
    laws, weights = varied_laws(recorded, neighbour, law)
    state, forces = propagate(
        recorded.bases, recorded.still, laws, weights, solved, neighbour.state
    )
    strongest = neighbour.strongest
    largest_force = neighbour.largest_force
    of_strongest = neighbour.forces
    for stretch in range(first, end):
        force = largest_of(parts.force[stretch])
        if force > largest_force:
            strongest = stretch
            largest_force = force
            of_strongest = forces[stretch - first].copy()
    return Neighbour(
        state,
        neighbour.closing,
        neighbour.coefficients,
        False,
        end - 1,
        forces[len(forces) - 1, forces.shape[1] - 1],
        law,
        neighbour.speed,
        neighbour.closing_speed,
        strongest,
        largest_force,
        of_strongest,
    )


# the law of the neighbouring drop
# ---------------------------------------------------------------------------------------


@compiled(lambda t: t.real(t.vector, t.vector))
def step_along(coefficients: Floats, direction: Floats) -> float:
    """Return a small step along a direction of the coefficients; zero where this is zero."""
    steepest = 0.0
    largest = 0.0
    for number in range(len(direction)):
        largest = max(largest, abs(direction[number]))
        if coefficients[number] != 0.0:
            steepest = max(steepest, abs(direction[number] / coefficients[number]))
    if steepest > 0.0:
        return _STEP / steepest
    return _SMALLEST / largest if largest > 0.0 else 0.0


@compiled(lambda t: t.tuple(t.of(Contacts), t.vector)(t.of(Recorded), t.of(Neighbour), t.integer))
def varied_laws(recorded: Recorded, neighbour: Neighbour, law: int) -> tuple[Contacts, Floats]:
    """Return a law by its number, with its closing speed and its coefficients varied after it, and
    by what the change of the force of each counts.
    """
    coefficients = recorded.parts.coefficients[law]
    speed = recorded.parts.closing_speed[law]
    base = law_with(recorded, coefficients.copy(), speed)
    faster = base
    changed = base
    weights = np.zeros(2)
    if neighbour.closing != 0.0:
        faster = law_with(recorded, coefficients.copy(), speed * (1.0 + _STEP))
        weights[0] = neighbour.closing / (speed * _STEP)
    step = step_along(coefficients, neighbour.coefficients)
    if step > 0.0:
        changed = law_with(recorded, coefficients + step * neighbour.coefficients, speed)
        weights[1] = 1.0 / step
    laws = room_for_laws(base, 3, recorded.manner.tension)
    write_law_of(laws, 0, base)
    write_law_of(laws, 1, faster)
    write_law_of(laws, 2, changed)
    return laws, weights


@compiled(lambda t: t.of(Neighbour)(t.of(Recorded), t.of(Neighbour), t.integer))
def touched(recorded: Recorded, neighbour: Neighbour, first: int) -> Neighbour:
    """Return the neighbour where each drop touches; `first`: stretch of the contact.

    Its law has another closing speed, and what it remembers if the surface is still the same.
    """
    parts = recorded.parts
    system = recorded.bodies.system
    law = parts.law[first]
    coefficients = parts.coefficients[law]
    difference = np.zeros(len(coefficients))
    if neighbour.law != _NONE and np.array_equal(parts.coefficients[neighbour.law], coefficients):
        difference = neighbour.coefficients
    # the level at which the surfaces touch depends on the memory
    deeper = 0.0
    step = step_along(coefficients, difference)
    if step > 0.0:
        levels = levels_at(recorded.manner.addresses[2])
        touch, _, _, _, _ = levels(coefficients)
        changed, _, _, _, _ = levels(coefficients + step * difference)
        deeper = (changed - touch) / step
    start = state_at(recorded, first)
    still = recorded.still.system
    _, rate = approach_of(system, start)
    approach, _ = approach_of(still, neighbour.state)
    delay = (deeper - approach) / rate
    state = shifted(neighbour.state, state_rates(system, start, 0.0, 0.0), delay)
    # as in the closing speed of the drop itself
    closing = dashpot_rate(still, state)
    if dashpot_rate(system, start) < rate:
        _, closing = approach_of(still, state)
    is_first = neighbour.speed == 0.0
    return Neighbour(
        state,
        closing,
        difference,
        False,
        _NONE,
        neighbour.force,
        law,
        parts.closing_speed[law] if is_first else neighbour.speed,
        closing if is_first else neighbour.closing_speed,
        neighbour.strongest,
        neighbour.largest_force,
        neighbour.forces,
    )


@compiled(lambda t: t.of(Neighbour)(t.of(Recorded), t.of(Neighbour), t.integer))
def compressed(recorded: Recorded, neighbour: Neighbour, first: int) -> Neighbour:
    """Return the neighbour after a turn, at which the memory of the law changes.

    Its largest indentation differs by the difference of the approach. `first`: the next stretch.
    """
    parts = recorded.parts
    still = recorded.still.system
    if force_jumps(recorded, neighbour, first):
        neighbour = turned(recorded, neighbour)
    number = neighbour.law
    coefficients = parts.coefficients[number]
    speed = parts.closing_speed[number]
    before = law_with(recorded, coefficients.copy(), speed)
    approach, _ = approach_of(recorded.bodies.system, state_at(recorded, first))
    deepest = max(approach, before.release_level)
    remembered = after_approach(before, deepest)
    # by the largest indentation
    step = _STEP * deepest
    deeper, _ = approach_of(still, neighbour.state)
    difference = deeper / step * (after_approach(before, deepest + step) - remembered)
    # by the closing speed
    faster = law_with(recorded, coefficients.copy(), speed * (1.0 + _STEP))
    by_speed = neighbour.closing / (speed * _STEP)
    difference += by_speed * (after_approach(faster, deepest) - remembered)
    # by the memory before
    step = step_along(coefficients, neighbour.coefficients)
    if step > 0.0:
        changed = law_with(recorded, coefficients + step * neighbour.coefficients, speed)
        difference += (after_approach(changed, deepest) - remembered) / step
    return Neighbour(
        neighbour.state,
        neighbour.closing,
        difference,
        neighbour.is_apart,
        neighbour.last,
        neighbour.force,
        parts.law[first],
        neighbour.speed,
        neighbour.closing_speed,
        neighbour.strongest,
        neighbour.largest_force,
        neighbour.forces,
    )


@compiled(lambda t: t.vector(t.of(Law), t.real))
def after_approach(law: Law, approach: float) -> Floats:
    """Return the coefficients of a law after a compression to an approach of the surfaces [m]."""
    changed = law.coefficients.copy()
    compressed_at(law.addresses[3])(law_indentation(law, approach), law.coefficients, changed)
    return changed


@compiled(lambda t: t.of(Neighbour)(t.of(Recorded), t.of(Neighbour)))
def turned(recorded: Recorded, neighbour: Neighbour) -> Neighbour:
    """Return the neighbour where the approach of each drop turns, at the end of a stretch."""
    parts = recorded.parts
    last = neighbour.last
    basis = basis_of(recorded.bases, parts.time_map[last])
    closing = parts.closing[last]
    # the approach turns where its rate is zero; its second derivative is a finite difference
    weights = np.empty(len(closing))
    weights_at(basis, 1.0 - _STEP, weights)
    earlier = 0.0
    for point in range(len(closing)):
        earlier += weights[point] * closing[point]
    time = parts.length[last] * (1.0 - time_at(basis, 1.0 - _STEP))
    acceleration = (closing[len(closing) - 1] - earlier) / time
    _, excess = approach_of(recorded.still.system, neighbour.state)
    for element in range(len(recorded.still.system.mobility)):
        excess -= recorded.still.system.mobility[element] * neighbour.force
    state = shifted_to_event(recorded, neighbour, excess, acceleration)
    return moved(neighbour, state, neighbour.is_apart, last)


@compiled(lambda t: t.boolean(t.of(Recorded), t.of(Neighbour), t.integer))
def force_jumps(recorded: Recorded, neighbour: Neighbour, first: int) -> bool:
    """Does the force jump between the last stretch and the next one?"""
    parts = recorded.parts
    law = parts.law[first]
    speed = parts.closing_speed[law]
    acting = law_with(recorded, parts.coefficients[law].copy(), speed)
    delta = max(parts.delta[first, 0], acting.release)
    static, dissipative = force_at(acting.addresses[0])(
        delta, parts.rate[first, 0], speed, acting.coefficients
    )
    before = parts.force[neighbour.last, parts.force.shape[1] - 1]
    return bool(abs(static + dissipative - before) > _JUMP * abs(before))


@compiled(lambda t: t.real(t.of(Recorded), t.of(Neighbour), t.integer))
def growth_of(recorded: Recorded, neighbour: Neighbour, end: int) -> float:
    """Return the growth of a change by an impact [-]; `end`: the part after it."""
    parts = recorded.parts
    strongest = neighbour.strongest
    if strongest == _NONE:
        return math.nan
    law = parts.law[strongest]
    acting = law_with(recorded, parts.coefficients[law].copy(), parts.closing_speed[law])
    basis = basis_of(recorded.bases, parts.time_map[strongest])
    x, peak = peak_of_force(basis, acting, parts.delta[strongest], parts.rate[strongest])
    by_force = nodal_value_between(basis, neighbour.forces, x) / peak
    leaving = abs(state_at(recorded, end).velocity[0] * recorded.bodies.system.shape[0])
    by_separation = rigid_rate(recorded.still.system, neighbour.state) / max(
        leaving, _SLOW * neighbour.speed
    )
    by_closing = neighbour.closing_speed / neighbour.speed
    return float(max(abs(by_closing), abs(by_force), abs(by_separation)))
