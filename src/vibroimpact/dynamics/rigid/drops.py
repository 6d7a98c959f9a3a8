"""Drops of rigid bodies on a plate whose surface does not move, followed to their ends."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import ExitStack
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Drops as Indices
from vibroimpact.arrays import Floats
from vibroimpact.compiled import interpreted
from vibroimpact.contact.law import CompliantLaw, ContactLaw, InstantaneousLaw
from vibroimpact.dynamics.core import drop_records as records
from vibroimpact.dynamics.core.drop_records import DropManner, Drops, ObliqueDrops
from vibroimpact.dynamics.core.drops import follow_drops
from vibroimpact.dynamics.core.line_records import ContactManner
from vibroimpact.dynamics.core.oblique_drops import follow_oblique_drops
from vibroimpact.dynamics.core.sphere_records import SphereState
from vibroimpact.dynamics.motion.along import State, energy_taken, friction_parts, spheres_of
from vibroimpact.dynamics.motion.columns import IMPACT_COLUMNS, OBLIQUE_IMPACT_COLUMNS
from vibroimpact.dynamics.motion.ended_run import EndedRun
from vibroimpact.dynamics.motion.energy import close_ledger, ledger_holds
from vibroimpact.dynamics.motion.law_coefficients import coefficients_of
from vibroimpact.dynamics.motion.progress import fraction_done
from vibroimpact.dynamics.motion.rest import Rest
from vibroimpact.dynamics.motion.run_rules import IS_AT_REST, laws_of, stop_rules_of
from vibroimpact.dynamics.oblique.lying import lie
from vibroimpact.dynamics.rigid.fluid_drops import FluidDrops
from vibroimpact.dynamics.rigid.line_contact import NO_CONTACTS, contact_manner
from vibroimpact.dynamics.rigid.recorded_drops import RecordedDrops, Start
from vibroimpact.dynamics.rigid.rubbed_contact import (
    friction_coefficients,
    friction_steps,
    rubbing_of,
)
from vibroimpact.dynamics.statement.outcome import OUTCOMES, Outcome
from vibroimpact.dynamics.statement.problem import MOST_IMPACTS, Problem

_FIRST_ROOM = 8  # impacts of a drop; the room doubles
_FEW = 200
"""Fewer impacts than these without a force take less time in plain Python than numba takes to load.
"""

_UNTIL_REST = 50  # about so many impacts of a drop


def follow(
    problem: Problem, progress: Callable[[float], None] | None, *, keeps_bounces: bool
) -> EndedRun:
    """Follow the drops of a problem to the ends of their runs.

    Parameters
    ----------
    problem : Problem
        Of rigid bodies, on a plate whose surface does not move.
    progress : callable, optional
        Called after each impact with the fraction done, in [0, 1].
    keeps_bounces : bool
        Are flights and contacts kept, from which histories are read?
    """
    with ExitStack() as held:  # laws of other packages, which the core calls
        if _is_quick(problem):
            held.enter_context(interpreted())
        drops = _at_start(problem, held)
        oblique = _along_at_start(problem, held)
        manner = _manner_of(problem)
        start = _start_of(drops, oblique)
        in_fluid = None
        if problem.fluid is not None:
            in_fluid = FluidDrops(problem, drops, oblique)
        energy_in = _energy_of(problem, drops, start)
        while True:
            room = drops.rows.shape[1]
            pause = room
            if progress is not None:  # which is called after each impact
                pause = min(int(drops.impacts.max()) + 1, room)
            impacts_before = drops.impacts.copy()
            if oblique is None:
                follow_drops(manner, drops, pause)
            else:
                follow_oblique_drops(manner, drops, oblique, pause)
            if in_fluid is not None:
                in_fluid.leave(drops, np.flatnonzero(drops.impacts > impacts_before))
            if progress is not None:
                progress(_fraction_done(problem, drops))
            moving = drops.phases < 0
            if not moving.any():
                break
            if drops.impacts[moving].max() == room:
                drops = _with_more_room(drops)
            if in_fluid is not None:
                in_fluid.fly(drops, manner)
            if manner.waits:
                _take_laws_at_touch(problem, drops, held)
    ended = _Ended(problem, drops, oblique, in_fluid, energy_in, start)
    return _ended_run(ended, keeps_bounces=keeps_bounces)


class _Ended(NamedTuple):
    """Drops whose runs have ended: what they have of a motion along the plate and in a fluid, where
    there are any, their energy at the start [J], and their start.
    """

    problem: Problem
    drops: Drops
    oblique: ObliqueDrops | None
    in_fluid: FluidDrops | None
    energy_in: Floats
    start: Start


def _is_quick(problem: Problem) -> bool:
    """Are the drops of a problem computed sooner than the compiler is loaded?"""
    if not isinstance(problem.laws[0], InstantaneousLaw) or problem.fluid is not None:
        return False
    size = math.prod(problem.shape)
    return size == 1 or size * (problem.impacts or _UNTIL_REST) < _FEW


def _at_start(problem: Problem, held: ExitStack) -> Drops:
    """Return the drops of a problem at their start."""
    size = math.prod(problem.shape)
    state = np.zeros((size, records.STATES))
    state[:, records.MASS] = problem.sphere.mass
    state[:, records.RADIUS] = problem.sphere.contact_offset
    state[:, records.GRAVITY] = problem.net_gravity
    state[:, records.INERTIA] = problem.flight_inertia
    state[:, records.REST_SPEED] = np.nan
    if problem.rest_speed is not None:
        state[:, records.REST_SPEED] = problem.rest_speed
    state[:, records.REST_TIME] = np.nan
    state[:, records.END_TIME] = np.nan
    if problem.height is None:
        state[:, records.VELOCITY] = -np.asarray(problem.speed)
    else:
        state[:, records.GAP] = problem.height - state[:, records.RADIUS]
        state[:, records.VELOCITY] = problem.velocity
    laws = np.zeros((size, 1, 1))
    if isinstance(problem.laws[0], CompliantLaw):
        laws = np.stack(
            [held.enter_context(coefficients_of(law, size)) for law in laws_of(problem)], axis=1
        )
    room = min(problem.impacts or MOST_IMPACTS, _FIRST_ROOM)
    columns = records.COLUMNS
    if problem.oblique is not None:
        columns = records.OBLIQUE_COLUMNS
    rows = np.full((size, room, columns), np.nan)
    return Drops(
        phases=np.full(size, records.AT_START),
        impacts=np.zeros(size, dtype=np.int64),
        flights=np.zeros(size, dtype=np.int64),
        state=state,
        rows=rows,
        laws=laws,
        at_touch=np.zeros(laws[:, 0].shape),
        coefficients=np.zeros(laws[:, 0].shape),
    )


def _along_at_start(problem: Problem, held: ExitStack) -> ObliqueDrops | None:
    """Return what the drops of a problem have at their start that move along the plate."""
    oblique = problem.oblique
    if oblique is None:
        return None
    size = math.prod(problem.shape)
    law = oblique.friction
    along = np.empty((size, len(SphereState._fields)))
    for column, value in enumerate([*oblique.position, *oblique.velocity, *oblique.spin]):
        along[:, column] = value
    half_x, half_y = _half_sides(problem)
    return ObliqueDrops(
        rubbing=rubbing_of(law),
        half_x=half_x,
        half_y=half_y,
        spheres=spheres_of(problem).rows(law),
        along=along,
        friction=held.enter_context(friction_coefficients(law, size)),
        taken=np.zeros((size, 2)),
    )


def _manner_of(problem: Problem) -> DropManner:
    """Return what stays the same for all drops of a problem."""
    has_force = isinstance(problem.laws[0], CompliantLaw)
    return DropManner(
        contacts=_contact_manner(problem),
        has_force=has_force,
        lasts=problem.memory_lasts,
        waits=bool(problem.by_speed) or problem.liquid is not None or not has_force,
        is_told_flights=problem.fluid is not None,
        stops=stop_rules_of(problem),
    )


def _half_sides(problem: Problem) -> tuple[float, float]:
    """Return half the sides of the plate [m], infinite where it has no edges."""
    if problem.oblique is None or problem.oblique.size is None:
        return np.inf, np.inf
    length, width = problem.oblique.size
    return 0.5 * length, 0.5 * width


def _contact_manner(problem: Problem) -> ContactManner:
    """Return how the contacts of a problem are solved; of a law without a force there are none."""
    law = problem.laws[0]
    if not isinstance(law, CompliantLaw):
        return NO_CONTACTS
    steps = 0
    if problem.oblique is not None and problem.oblique.friction is not None:
        steps = friction_steps(problem.tolerance)
    return contact_manner(law, problem.tolerance, steps)


def _take_laws_at_touch(problem: Problem, drops: Drops, held: ExitStack) -> None:
    """Give drops that wait at their touch what the law is at their approach speed.

    That is its coefficients, or the separation speed where it has no force.
    """
    touching = np.flatnonzero(drops.phases == records.AT_TOUCH)
    if not touching.size:
        return
    number = int(drops.impacts[touching[0]])  # the same of all that move
    speed = drops.state[touching, records.CLOSING]
    law = _law_at(problem, number, touching, speed)
    if isinstance(law, InstantaneousLaw):
        separation = law.separation_speed(speed, drops.state[touching, records.MASS])
        drops.at_touch[touching, 0] = separation
    else:
        drops.at_touch[touching] = held.enter_context(coefficients_of(law, len(touching)))
    if _is_asked_at_touch(problem):
        drops.rows[touching, number, records.ASKED] = law.nominal_restitution


def _law_at(problem: Problem, number: int, drops: Indices, speed: Floats) -> ContactLaw:
    """Return the law of an impact, counted from 0, of some drops at their approach speeds [m/s]."""
    laws = laws_of(problem)
    law = laws[min(number, len(laws) - 1)].take(drops)
    if problem.liquid is not None:  # whose mass that moves along differs by drop
        problem = problem.take(drops)
    return problem.law_at_touch(law, speed)


def _is_asked_at_touch(problem: Problem) -> bool:
    """Is the restitution asked of an impact known only at the speed of its touch?"""
    return bool(problem.by_speed) or problem.liquid is not None


def _with_more_room(drops: Drops) -> Drops:
    """Return drops with room for twice as many impacts."""
    more = np.full_like(drops.rows, np.nan)
    return drops._replace(rows=np.concatenate([drops.rows, more], axis=1))


def _fraction_done(problem: Problem, drops: Drops) -> float:
    """Return the fraction of the run that is done, in [0, 1]."""
    moving = drops.phases < 0
    if not moving.any():
        return 1.0
    number = int(drops.impacts.max())
    rows = drops.rows[moving]
    return fraction_done(
        problem,
        number,
        float(drops.state[moving, records.TIME].min()),
        rows[:, 0, records.APPROACH],
        rows[:, max(number - 1, 0), records.RELEASE_VELOCITY],
        drops.state[moving, records.REST_SPEED],
    )


def _start_of(drops: Drops, oblique: ObliqueDrops | None) -> Start:
    """Return drops as they are at their start."""
    along = np.zeros((len(drops.phases), 0))
    if oblique is not None:
        along = oblique.along.copy()
    return Start(drops.state[:, [records.GAP, records.VELOCITY]], along)


def _energy_of(problem: Problem, drops: Drops, start: Start) -> Floats:
    """Return the kinetic and potential energy of drops at their start [J]."""
    state = drops.state.T
    velocity = state[records.VELOCITY]
    potential = state[records.GRAVITY] * state[records.GAP]
    energy = np.asarray(state[records.MASS] * (0.5 * velocity**2 + potential))
    if problem.oblique is None:
        return energy
    kinetic, rotation = spheres_of(problem).kinetic(State.of_rows(start.along))
    return np.asarray(energy + kinetic + rotation)


def _ended_run(ended: _Ended, *, keeps_bounces: bool) -> EndedRun:
    """Return drops that have ended."""
    problem = ended.problem
    drops = ended.drops
    oblique = ended.oblique
    state = drops.state.T.copy()  # which all that is told of the drops holds
    end_time = state[records.END_TIME]
    at_rest = IS_AT_REST[drops.phases]
    if problem.duration is not None:
        end_time[at_rest] = np.maximum(end_time, problem.duration)[at_rest]
    along: dict[str, Floats] = {}
    if oblique is not None:
        _lie(problem, drops, oblique, end_time)
        along = _entries_along(problem, oblique)
    energy, added = _ledger(ended, state, at_rest, along)
    holds = ledger_holds(energy, added)
    if oblique is not None:
        energy |= friction_parts(*oblique.taken.T)
    codes = np.where(holds, drops.phases, Outcome.FAILED.code)
    size = len(codes)
    rest = Rest(
        speed=state[records.REST_SPEED],
        time=state[records.REST_TIME],
        sag=state[records.SAG],
        stored=state[records.STORED],
        written_off=state[records.WRITTEN_OFF],
        left=np.full(size, np.nan),
        lying=(None,) * size,
    )
    outcomes = tuple([OUTCOMES[code] for code in codes.tolist()])
    bounces = None
    if keeps_bounces:
        bounces = RecordedDrops(
            problem, ended.start, drops.impacts, drops.flights, drops.rows, end_time
        )
    return EndedRun(problem, _table(ended), energy, outcomes, end_time, rest, bounces)


def _lie(problem: Problem, drops: Drops, oblique: ObliqueDrops, end_time: Floats) -> None:
    """Let drops at rest lie on the plate until their runs end [s], or they leave it over an edge,
    with which their runs end.
    """
    resting = np.flatnonzero(IS_AT_REST[drops.phases])
    if not resting.size:
        return
    assert problem.oblique is not None
    time = drops.state[resting, records.TIME]
    sphere = spheres_of(problem).take(resting)
    before = State.of_rows(oblique.along[resting])
    friction = problem.oblique.friction
    law = friction
    if friction is not None:
        law = friction.take(resting)
    elapsed = np.maximum(end_time[resting] - time, 0.0)
    pressing = drops.state[resting, records.GRAVITY]
    half = _half_sides(problem)
    after, _, times = lie(sphere, before, law, pressing, elapsed[:, None], half)
    oblique.taken[resting, records.RUBBED] += energy_taken(sphere, before, after)
    oblique.along[resting] = after.rows
    end_time[resting] = np.minimum(end_time[resting], time + times[:, 0])


def _entries_along(problem: Problem, oblique: ObliqueDrops) -> dict[str, Floats]:
    """Return what the motion along the plate adds to the energy ledger [J]."""
    assert problem.oblique is not None
    sphere = spheres_of(problem)
    state = State.of_rows(oblique.along)
    kinetic, rotation = sphere.kinetic(state)
    none = np.zeros(len(kinetic))
    place = np.array([value + none for value in problem.oblique.position])
    fallen = (sphere.gravity * (state.position - place)).sum(axis=0)
    return {
        "kinetic_J": kinetic,
        "potential_J": -sphere.mass * fallen,
        "rotation_J": rotation,
        "friction_J": oblique.taken[:, records.RUBBED],
    }


def _table(ended: _Ended) -> dict[str, Floats]:
    """Return the columns of the impact table, (B, impacts)."""
    problem = ended.problem
    drops = ended.drops
    most = int(drops.impacts.max())
    rows = drops.rows[:, :most]
    table = rows[:, :, : len(IMPACT_COLUMNS)].transpose(2, 0, 1).copy()
    happened = np.isfinite(table[records.IMPACT])
    if not _is_asked_at_touch(problem):
        for number, law in enumerate(problem.laws):
            asked = np.reshape(law.nominal_restitution, (-1, 1))
            table[records.ASKED, :, number:] = np.where(happened[:, number:], asked, np.nan)
    columns = dict(zip(IMPACT_COLUMNS, table, strict=True))
    if problem.motion is not None:  # along the plate, which does not move its surface
        columns["plate_velocity_m_s"] = np.where(happened, 0.0, np.nan)
        columns["plate_work_J"] = np.full(happened.shape, np.nan)
    if problem.oblique is not None:
        end = records.ALONG + len(OBLIQUE_IMPACT_COLUMNS)
        along = rows[:, :, records.ALONG : end].transpose(2, 0, 1).copy()
        columns |= dict(zip(OBLIQUE_IMPACT_COLUMNS, along, strict=True))
    if problem.fluid is not None and ended.in_fluid is not None:
        columns[f"{problem.fluid.key}_lost_J"] = ended.in_fluid.lost_before_impacts(most)
    return columns


def _ledger(
    ended: _Ended, state: Floats, at_rest: Floats, along: dict[str, Floats]
) -> tuple[dict[str, Floats], Floats]:
    """Return the energy ledger [J], and the energy that gravity and adhesion added [J].

    It was added to that of the start.

    Parameters
    ----------
    ended : _Ended
        The drops.
    state : array, shape (18, B)
        Their numbers, of `core.drop_records`.
    at_rest : array of bool, shape (B,)
        Which have come to rest.
    along : dict of str to array
        The entries of the motion along the plate.
    """
    mass = state[records.MASS]
    gravity = state[records.GRAVITY]
    stored = state[records.STORED]
    gap = np.where(at_rest, -state[records.SAG], state[records.GAP])
    velocity = np.where(at_rest, 0.0, state[records.VELOCITY])
    # the stored energy is negative where it sticks
    added = mass * gravity * state[records.DEEPEST] + np.maximum(-stored, 0.0)
    entries = {
        "kinetic_J": 0.5 * mass * velocity**2,
        "potential_J": mass * gravity * gap,
        "contact_elastic_J": stored,
        "contact_dissipated_J": state[records.DISSIPATED],
        "plastic_work_J": state[records.PLASTIC],
        "written_off_at_rest_J": state[records.WRITTEN_OFF],
    }
    if ended.problem.motion is not None:
        entries["drive_J"] = np.zeros(len(mass))
    if along:
        added += np.maximum(-along["potential_J"], 0.0)  # what gravity did down the plate
    for name, values in along.items():
        if name in entries:
            values = entries[name] + values
        entries[name] = values
    energy_in = ended.energy_in
    in_fluid = ended.in_fluid
    if in_fluid is not None:
        assert ended.problem.fluid is not None
        energy_in = energy_in + in_fluid.liquid_at_start
        liquid = in_fluid.energy_of_liquid(velocity)
        entries["kinetic_J"] = entries["kinetic_J"] + liquid
        given = in_fluid.to_fluid + in_fluid.liquid_at_start - liquid
        entries[f"{ended.problem.fluid.key}_J"] = given
    return close_ledger(energy_in, added, entries), added
