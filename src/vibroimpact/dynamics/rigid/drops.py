"""Drops of rigid bodies along the normal, which the core follows from start to end."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import ExitStack

import numpy as np

from vibroimpact.arrays import Drops as Indices
from vibroimpact.arrays import Floats
from vibroimpact.compiled import interpreted, law_addresses
from vibroimpact.contact.law import CompliantLaw, ContactLaw, InstantaneousLaw
from vibroimpact.dynamics.columns import IMPACT_COLUMNS
from vibroimpact.dynamics.core import drop_records as records
from vibroimpact.dynamics.core import stop_rules
from vibroimpact.dynamics.core.drop_records import ContactManner, DropManner, Drops, StopRules
from vibroimpact.dynamics.core.drops import follow_drops
from vibroimpact.dynamics.core.line_records import LineManner
from vibroimpact.dynamics.core.normal_records import NormalGrid
from vibroimpact.dynamics.core.phase_records import PhaseRules
from vibroimpact.dynamics.energy import close_ledger, ledger_holds
from vibroimpact.dynamics.law_coefficients import coefficients_of
from vibroimpact.dynamics.outcome import OUTCOMES, Outcome
from vibroimpact.dynamics.problem import MOST_IMPACTS, Problem
from vibroimpact.dynamics.progress import fraction_done
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.rest import Rest
from vibroimpact.dynamics.rigid.line_contact import collocates, common_manner, gauss_rules
from vibroimpact.dynamics.rigid.phase_rules import normal_grid
from vibroimpact.dynamics.rigid.recorded_drops import RecordedDrops

_FIRST_ROOM = 8  # impacts of a drop; the room doubles
_FEW = 200
"""Fewer impacts than these without a force take less time in plain Python than numba takes to load.
"""

_UNTIL_REST = 50  # about so many impacts of a drop

_NO_CONTACTS = ContactManner(
    manner=LineManner(2, 0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0),
    rules=PhaseRules(
        tolerance=0.0,
        roughness=0.0,
        roughness_inside=0.0,
        sharper=0.0,
        root=2,
        counts=np.zeros(0, dtype=np.int64),
        vectors=np.zeros((0, 0, 0)),
        matrices=np.zeros((0, 0, 0)),
        onward=np.zeros((0, 0, 0)),
    ),
    grid=NormalGrid(
        steps=0,
        derivatives=np.zeros((0, 0, 0)),
        values=np.zeros((0, 0, 0)),
        integrals=np.zeros((0, 0, 0)),
        own=np.zeros((0, 0, 0)),
        room=np.zeros((0, 0)),
        motion=np.zeros((0, 0)),
        extent=np.zeros(2, dtype=np.int64),
    ),
    collocates=False,
    addresses=np.zeros(4, dtype=np.int64),
)
"""What takes the place of the contacts of a law without a force."""

_OUTCOMES = np.array([Outcome(ending).code for ending in records.ENDINGS])
"""Codes of outcomes by the numbers of endings."""

_AT_REST = np.array([Outcome(ending).at_rest for ending in records.ENDINGS])


def follow(
    problem: Problem, progress: Callable[[float], None] | None, keeps_bounces: bool
) -> Response:
    """Return the response of the drops of a problem, with arrays of a batch.

    Parameters
    ----------
    problem : Problem
        Of rigid bodies at rest, whose spheres fall along the normal.
    progress : callable, optional
        Called after each impact with the fraction done, in [0, 1].
    keeps_bounces : bool
        Are flights and contacts kept, from which histories are read?
    """
    with ExitStack() as held:  # laws of other packages, which the core calls
        if _is_quick(problem):
            held.enter_context(interpreted())
        drops = _at_start(problem, held)
        manner = _manner_of(problem)
        energy_in = _mechanical_energy(drops.state.T)
        start = drops.state[:, [records.GAP, records.VELOCITY]]
        while True:
            room = drops.rows.shape[1]
            pause = room if progress is None else min(int(drops.impacts.max()) + 1, room)
            follow_drops(manner, drops, pause)
            if progress is not None:
                progress(_fraction_done(problem, drops))
            moving = drops.phases < 0
            if not moving.any():
                break
            if drops.impacts[moving].max() == room:
                drops = _with_more_room(drops)
            if manner.waits:
                _take_laws_at_touch(problem, drops, held)
    return _response_of(problem, drops, energy_in, start if keeps_bounces else None)


def _is_quick(problem: Problem) -> bool:
    """Are the drops of a problem computed sooner than the compiler is loaded?"""
    if not isinstance(problem.laws[0], InstantaneousLaw):
        return False
    size = math.prod(problem.shape)
    return size == 1 or size * (problem.impacts or _UNTIL_REST) < _FEW


def _at_start(problem: Problem, held: ExitStack) -> Drops:
    """Return the drops of a problem at their start."""
    size = math.prod(problem.shape)
    state = np.zeros((size, records.STATES))
    state[:, records.MASS] = problem.sphere.mass
    state[:, records.RADIUS] = problem.sphere.contact_offset
    state[:, records.GRAVITY] = problem.gravity
    state[:, records.REST_SPEED] = np.nan if problem.rest_speed is None else problem.rest_speed
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
            [held.enter_context(coefficients_of(law, size)) for law in _laws(problem)], axis=1
        )
    room = min(problem.impacts or MOST_IMPACTS, _FIRST_ROOM)
    rows = np.full((size, room, records.COLUMNS), np.nan)
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


def _laws(problem: Problem) -> list[ContactLaw]:
    """Return the laws of the impacts of a problem, of which the last one goes on.

    Where the memory lasts, that of the first law at the start is that of all.
    """
    if not problem.memory_lasts:
        return list(problem.laws)
    memories = problem.laws[0].memories()
    return [law.changed(memories) for law in problem.laws]


def _manner_of(problem: Problem) -> DropManner:
    """Return what stays the same for all drops of a problem."""
    has_force = isinstance(problem.laws[0], CompliantLaw)
    return DropManner(
        contacts=_contact_manner(problem),
        has_force=has_force,
        lasts=problem.memory_lasts,
        waits=bool(problem.by_speed) or not has_force,
        stops=_stop_rules(problem),
    )


def _contact_manner(problem: Problem) -> ContactManner:
    """Return how the contacts of a problem are solved; of a law without a force there are none."""
    law = problem.laws[0]
    if not isinstance(law, CompliantLaw):
        return _NO_CONTACTS
    return ContactManner(
        manner=common_manner(law, problem.tolerance),
        rules=gauss_rules(law, problem.tolerance),
        grid=normal_grid(0),
        collocates=collocates(law, problem.tolerance),
        addresses=law_addresses(type(law)),
    )


def _stop_rules(problem: Problem) -> StopRules:
    """Return the rules that can end a run; of two that end it at one time the first counts."""
    rules: list[tuple[int, float, int]] = []
    if problem.duration is not None:
        rules.append((stop_rules.AT_TIME, problem.duration, records.END_BY_DURATION))
    if problem.impacts is not None:
        rules.append((stop_rules.AFTER_IMPACTS, problem.impacts, records.END_BY_IMPACTS))
    else:
        rules.append((stop_rules.AFTER_IMPACTS, MOST_IMPACTS, records.END_AT_LIMIT))
    kinds, values, endings = zip(*rules, strict=True)
    return StopRules(np.array(kinds), np.array(values, dtype=float), np.array(endings))


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
    if problem.by_speed:
        drops.rows[touching, number, records.ASKED] = law.nominal_restitution


def _law_at(problem: Problem, number: int, drops: Indices, speed: Floats) -> ContactLaw:
    """Return the law of an impact, counted from 0, of some drops at their approach speeds [m/s]."""
    laws = _laws(problem)
    law = laws[min(number, len(laws) - 1)]
    return problem.law_at(law.take(drops), speed)


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


def _mechanical_energy(state: Floats) -> Floats:
    """Return the kinetic and potential energy of drops [J]."""
    velocity = state[records.VELOCITY]
    potential = state[records.GRAVITY] * state[records.GAP]
    return np.asarray(state[records.MASS] * (0.5 * velocity**2 + potential))


def _response_of(
    problem: Problem, drops: Drops, energy_in: Floats, start: Floats | None
) -> Response:
    """Return the response of drops that have ended.

    `start`: gaps [m] and upward velocities [m/s] at the start, where bounces are kept.
    """
    state = drops.state.T.copy()  # which all that is told of the drops holds
    end_time = state[records.END_TIME]
    at_rest = _AT_REST[drops.phases]
    if problem.duration is not None:
        end_time[at_rest] = np.maximum(end_time, problem.duration)[at_rest]
    energy, added = _ledger(state, energy_in, at_rest)
    holds = ledger_holds(energy, added)
    codes = np.where(holds, _OUTCOMES[drops.phases], Outcome.FAILED.code)
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
    if start is not None:
        bounces = RecordedDrops(problem, start, drops.impacts, drops.flights, drops.rows, end_time)
    return Response(problem, _table(problem, drops), energy, outcomes, end_time, rest, bounces)


def _table(problem: Problem, drops: Drops) -> dict[str, Floats]:
    """Return the columns of the impact table, (B, impacts)."""
    most = int(drops.impacts.max())
    table = drops.rows[:, :most, : len(IMPACT_COLUMNS)].transpose(2, 0, 1).copy()
    if not problem.by_speed:
        happened = np.isfinite(table[records.IMPACT])
        for number, law in enumerate(problem.laws):
            asked = np.reshape(law.nominal_restitution, (-1, 1))
            table[records.ASKED, :, number:] = np.where(happened[:, number:], asked, np.nan)
    return dict(zip(IMPACT_COLUMNS, table, strict=True))


def _ledger(state: Floats, energy_in: Floats, at_rest: Floats) -> tuple[dict[str, Floats], Floats]:
    """Return the energy ledger [J], and the energy that gravity and adhesion added [J].

    It was added to that of the start.
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
    return close_ledger(energy_in, added, entries), added
