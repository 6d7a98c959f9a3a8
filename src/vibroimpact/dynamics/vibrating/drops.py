"""Drops whose bodies vibrate, from a problem to the end of their runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core import drop_records as records
from vibroimpact.dynamics.core import vibrating_records
from vibroimpact.dynamics.motion.along import friction_parts
from vibroimpact.dynamics.motion.bounce import BouncesOfSeveral
from vibroimpact.dynamics.motion.columns import IMPACT_COLUMNS, VIBRATING_IMPACT_COLUMNS
from vibroimpact.dynamics.motion.ended_run import EndedRun
from vibroimpact.dynamics.motion.energy import close_ledger, ledger_holds
from vibroimpact.dynamics.motion.impact_rows import further_columns, stacked_tables, table_of
from vibroimpact.dynamics.motion.progress import of_several
from vibroimpact.dynamics.motion.rest import Rest
from vibroimpact.dynamics.statement.outcome import OUTCOMES, Outcome
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.drop_system import slices_of, system_of
from vibroimpact.dynamics.vibrating.followed_drop import FollowedDrop
from vibroimpact.dynamics.vibrating.growth import growth_of
from vibroimpact.dynamics.vibrating.recorded_drop import RecordedDrop
from vibroimpact.dynamics.vibrating.waiting_drop import WaitingDrop


@dataclass(frozen=True)
class _Ended:
    """One drop that has ended: `table`, its columns of the table of impacts (impacts,); `energy`,
    the entries of its ledger, and what gravity and adhesion `added` to it [J].
    """

    drop: FollowedDrop
    end_time: float
    table: dict[str, Floats]
    energy: dict[str, float]
    added: float
    energy_in: float
    recorded: RecordedDrop | None


def follow(
    problem: Problem, progress: Callable[[float], None] | None, *, keeps_bounces: bool
) -> EndedRun:
    """Follow the drops of a problem to the ends of their runs.

    Parameters
    ----------
    problem : Problem
        Of which a body vibrates.
    progress : callable, optional
        Called after each impact with the fraction done, in [0, 1].
    keeps_bounces : bool
        Are flights and contacts kept, from which histories are read?
    """
    alone = problem.alone()
    mass = float(alone[0].sphere.mass)
    gravity = float(alone[0].net_gravity)
    # drops of the same sphere share a system, with what is cached in it
    system = system_of(problem, mass, gravity)
    systems = {(mass, gravity): system}
    ended = []
    for number, single in enumerate(alone):
        sphere = float(single.sphere.mass), float(single.net_gravity)
        if sphere not in systems:
            systems[sphere] = system.with_sphere(sphere[0] ** -0.5, sphere[1] * sphere[0] ** 0.5)
        drop = _kind_of(single)(single, systems[sphere], mass)
        energy_in = _energy_at_start(drop)
        with drop.held:
            drop.follow(of_several(progress, number, len(alone)))
            ended.append(_ended(drop, energy_in, keeps_bounces))
    return _ended_run(problem, ended)


def drop_of(problem: Problem) -> FollowedDrop:
    """Return a single drop at its start."""
    mass = float(problem.sphere.mass)
    system = system_of(problem, mass, float(problem.net_gravity))
    return _kind_of(problem)(problem, system, mass)


def _kind_of(problem: Problem) -> type[FollowedDrop]:
    """Return the kind of a drop: it waits where it has what the core does not know."""
    waits = problem.oblique is not None or problem.fluid is not None or problem.by_speed
    return WaitingDrop if waits else FollowedDrop


def _ended(drop: FollowedDrop, energy_in: float, keeps_bounces: bool) -> _Ended:
    """Return a drop whose run has ended, with all that is told of it."""
    problem = drop.problem
    end_time = float(drop.drop.state[records.END_TIME])
    if drop.is_at_rest and problem.duration is not None:
        end_time = max(end_time, problem.duration)
    end_time = drop.end_along(end_time)
    if drop.is_at_rest:
        drop.lie_until(end_time)
    energy, added = _entries(drop)
    table = _table_of(drop)
    if _is_sensitive(problem):
        table["sensitivity"] = growth_of(drop)
    recorded = drop.recording() if keeps_bounces else None
    return _Ended(drop, end_time, table, energy, added, energy_in, recorded)


def _is_sensitive(problem: Problem) -> bool:
    """Is the growth of a small change of the drop asked for, and known?"""
    return problem.sensitivity and problem.oblique is None and problem.fluid is None


# tables
# ------------------------------------------------------------------------------------------


def _columns_of(problem: Problem) -> list[str]:
    """Return the columns of the table of impacts."""
    known = [
        name for name in VIBRATING_IMPACT_COLUMNS if name != "sensitivity" or _is_sensitive(problem)
    ]
    return known + further_columns(problem)


def _table_of(drop: FollowedDrop) -> dict[str, Floats]:
    """Return the columns of the table of impacts of one drop, but for the sensitivity."""
    rows = drop.drop.rows[: drop.impacts].T
    table = dict(zip(IMPACT_COLUMNS, rows[: len(IMPACT_COLUMNS)].copy(), strict=True))
    table["restitution_asked"] = np.array(drop.restitutions_asked())
    for column, name in _FURTHER_COLUMNS.items():
        table[name] = rows[column].copy()
    told = [name for name in _columns_of(drop.problem) if name not in {*table, "sensitivity"}]
    return table | table_of(drop.rows[: drop.impacts], told)


_FURTHER_COLUMNS = {
    vibrating_records.CLOSING_SPEED: "closing_speed_m_s",
    vibrating_records.CONTACTS: "contacts",
    vibrating_records.TO_VIBRATION: "energy_to_vibration_J",
    vibrating_records.SURFACE_VELOCITY: "plate_velocity_m_s",
    vibrating_records.DRIVE_WORK: "plate_work_J",
}


# energies
# ------------------------------------------------------------------------------------------


def _energy_at_start(drop: FollowedDrop) -> float:
    """Return the kinetic and potential energy at the start [J]."""
    numbers = drop.drop.state
    velocity = float(numbers[records.VELOCITY])
    potential = float(numbers[records.GRAVITY] * numbers[records.GAP])
    energy = float(numbers[records.MASS]) * (0.5 * velocity**2 + potential)
    return energy + drop.energy_at_start()


def _entries(drop: FollowedDrop) -> tuple[dict[str, float], float]:
    """Return the entries of the energy ledger at the end [J], and the energy that gravity and
    adhesion added to that of the start [J].
    """
    numbers = drop.drop.state
    mass = float(numbers[records.MASS])
    gravity = float(numbers[records.GRAVITY])
    stored = float(numbers[records.STORED])
    gap, velocity = drop.centre()
    entries = {
        "kinetic_J": 0.5 * mass * velocity**2,
        "potential_J": mass * gravity * gap,
        "contact_elastic_J": stored,
        "contact_dissipated_J": float(numbers[records.DISSIPATED]),
        "plastic_work_J": float(numbers[records.PLASTIC]),
        "written_off_at_rest_J": float(numbers[records.WRITTEN_OFF]),
    }
    if drop.problem.motion is not None:
        entries["drive_J"] = 0.0
    further = drop.further_entries()
    for more in (_vibration(drop), further):
        for name, value in more.items():
            entries[name] = entries.get(name, 0.0) + value
    # the stored energy is negative where it sticks
    added = mass * gravity * float(numbers[records.DEEPEST]) + max(-stored, 0.0)
    added += max(-further.get("potential_J", 0.0), 0.0)  # what gravity did down the plate
    added += max(-entries.get("drive_J", 0.0), 0.0)
    return entries, added


def _vibration(drop: FollowedDrop) -> dict[str, float]:
    """Return the entries of what vibrates [J]; local elements belong to the contact."""
    system = drop.system
    state = drop.state
    lost = drop.drop.lost
    kinetic, strain = system.energies(state)
    rigid, sphere, plate = slices_of(drop.problem)
    entries = {
        "sphere_vibration_J": kinetic[sphere].sum(),
        "sphere_strain_J": strain[sphere].sum(),
        "sphere_damping_J": lost[:-1][sphere].sum(),
        "plate_kinetic_J": kinetic[rigid].sum() + kinetic[plate].sum(),
        "plate_strain_J": strain[plate].sum(),
        "plate_damping_J": lost[:-1][plate].sum(),
        "contact_elastic_J": system.local_energy(state),
        "contact_dissipated_J": lost[-1],
    }
    if system.driven:
        entries["drive_J"] = lost[-1 - system.driven : -1].sum()
    return {name: float(value) for name, value in entries.items()}


def _ended_run(problem: Problem, ended: Sequence[_Ended]) -> EndedRun:
    """Return drops that have ended."""
    drops = [one.drop for one in ended]
    numbers = np.array([drop.drop.state for drop in drops])
    added = np.array([one.added for one in ended])
    entries = {name: np.array([one.energy[name] for one in ended]) for name in ended[0].energy}
    energy = close_ledger(np.array([one.energy_in for one in ended]), added, entries)
    codes = np.array([drop.now.phase for drop in drops])
    codes[~ledger_holds(energy, added)] = Outcome.FAILED.code
    if problem.oblique is not None:
        energy |= friction_parts(*np.array([drop.taken_by_friction() for drop in drops]).T)
    rest = Rest(
        speed=numbers[:, records.REST_SPEED],
        time=numbers[:, records.REST_TIME],
        sag=numbers[:, records.SAG],
        stored=numbers[:, records.STORED],
        written_off=numbers[:, records.WRITTEN_OFF],
        left=np.array([drop.left for drop in drops]),
        lying=tuple(drop.lying for drop in drops),
    )
    bounces = None
    if ended[0].recorded is not None:
        bounces = BouncesOfSeveral([one.recorded for one in ended if one.recorded is not None])
    return EndedRun(
        problem,
        stacked_tables([one.table for one in ended], _columns_of(problem)),
        energy,
        tuple(OUTCOMES[code] for code in codes.tolist()),
        np.array([one.end_time for one in ended]),
        rest,
        bounces,
    )
