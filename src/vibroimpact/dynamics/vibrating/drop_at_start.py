"""A drop whose bodies vibrate, stated for the core at its start."""

from __future__ import annotations

from contextlib import ExitStack

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import law_addresses
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.core import drop_records as records
from vibroimpact.dynamics.core.contact_records import OF_IMPACT, Manner, Peaks, Progress
from vibroimpact.dynamics.core.events import ENDS, TENSIONS
from vibroimpact.dynamics.core.records import Law
from vibroimpact.dynamics.core.vibrating_records import (
    VIBRATING_COLUMNS,
    ImpactManner,
    Now,
    VibratingDrop,
)
from vibroimpact.dynamics.motion.law_coefficients import coefficients_of
from vibroimpact.dynamics.motion.run_rules import laws_of, start_of, stop_rules_of
from vibroimpact.dynamics.statement.problem import MOST_IMPACTS, Problem
from vibroimpact.dynamics.vibrating.drop_system import driven_state_of
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.surface_friction import NO_FRICTION, longest_with_friction

MOST_STEPS = 5_000
"""Largest number of stretches of contact in an impact, some ten seconds' work."""

MOST_STEPS_TO_A_TIME = 20_000
"""That number where the run has an end in time."""

_FIRST_ROOM = 8  # impacts of a drop; the room doubles


def manner_of(problem: Problem, longest: float, *, waits: bool) -> ImpactManner:
    """Return what stays the same through the run of a drop; `longest`: length of a stretch [s]."""
    law = first_law_of(problem)
    most_steps = MOST_STEPS
    run_end = np.inf
    if problem.duration is not None:
        most_steps = MOST_STEPS_TO_A_TIME
        run_end = problem.duration
    return ImpactManner(
        addresses=law_addresses(type(law)),
        series=problem.quasi_static.coefficients,
        tension=TENSIONS.index(law.tension),
        contact_end=ENDS.index(law.contact_end),
        tolerance=problem.tolerance,
        lasts=problem.memory_lasts,
        recovers=not law.lasting,
        longest=longest,
        of_contact=longest_with_friction(problem.tolerance),
        most_steps=most_steps,
        run_end=run_end,
        waits=waits,
        stops=stop_rules_of(problem),
    )


def first_law_of(problem: Problem) -> CompliantLaw:
    """Return the law of the first impact."""
    law = problem.laws[0]
    assert isinstance(law, CompliantLaw)  # the problem has seen to it
    return law


def state_of(problem: Problem, system: LinearSystem, stated_mass: float) -> State:
    """Return the state of a drop at its start.

    `stated_mass`: of the sphere for which what drives the plate was stated [kg].
    """
    gap, velocity_up = start_of(problem)
    displacement, velocity = driven_state_of(problem, stated_mass, system.number)
    root_mass = float(problem.sphere.mass) ** 0.5
    displacement[0] = -root_mass * gap
    velocity[0] = -root_mass * velocity_up
    return State(displacement, velocity, np.zeros(len(system.rate)))


def drop_at_start(problem: Problem, system: LinearSystem, held: ExitStack) -> VibratingDrop:
    """Return a drop as the core has it at its start, without a rest speed unless that is given.

    Parameters
    ----------
    problem : Problem
        Of one drop.
    system : LinearSystem
        Its bodies.
    held : ExitStack
        Where laws of other packages are kept while the core uses them.
    """
    laws = np.concatenate([held.enter_context(coefficients_of(law, 1)) for law in laws_of(problem)])
    room = min(problem.impacts or MOST_IMPACTS, _FIRST_ROOM)
    return VibratingDrop(
        counts=np.zeros(1, dtype=np.int64),
        state=_numbers_at_start(problem),
        lost=np.zeros(system.number + 1),
        lost_in_impact=np.zeros(system.number + 1),
        rows=np.full((room, VIBRATING_COLUMNS), np.nan),
        laws=laws,
        coefficients=laws[0].copy(),
    )


def _numbers_at_start(problem: Problem) -> Floats:
    """Return the numbers of a drop at its start (18,)."""
    gap, velocity = start_of(problem)
    numbers = np.zeros(records.STATES)
    numbers[records.MASS] = problem.sphere.mass
    numbers[records.RADIUS] = problem.sphere.contact_offset
    numbers[records.GRAVITY] = problem.net_gravity
    numbers[records.GAP] = gap
    numbers[records.VELOCITY] = velocity
    numbers[records.REST_SPEED] = np.nan
    if problem.rest_speed is not None:
        numbers[records.REST_SPEED] = problem.rest_speed
    numbers[records.REST_TIME] = np.nan
    numbers[records.END_TIME] = np.nan
    numbers[records.INERTIA] = problem.flight_inertia
    return numbers


def now_at_start(problem: Problem, drop: VibratingDrop, state: State) -> Now:
    """Return where a drop is at its start; of a contact there is nothing yet."""
    manner = Manner(0, 0, 0.0, 0.0, 0.0, problem.tolerance, 0.0, np.inf, np.inf, 0)
    progress = Progress(
        time=0.0,
        next_length=np.inf,
        delta=0.0,
        force=np.inf,
        trend=0.0,
        closing=np.inf,
        fresh=True,
        pushes=True,
        steps=0,
        law=OF_IMPACT,
        plastic=0.0,
        largest_force=0.0,
        deepest=0.0,
        peaks=Peaks(0.0, 0.0, 0.0, 0.0),
        sphere=NO_FRICTION,
    )
    law = Law(
        addresses=law_addresses(type(problem.laws[0])),
        coefficients=drop.coefficients.copy(),
        series=problem.quasi_static.coefficients,
        speed=0.0,
        touch=0.0,
        release=0.0,
        release_level=0.0,
        memory_level=0.0,
        first_breakpoint=0.0,
        second_breakpoint=0.0,
        jump=0.0,
    )
    return Now(
        phase=records.IN_FLIGHT,
        state=state.record,
        begun=state.record,
        law=law,
        manner=manner,
        progress=progress,
        contacts=0,
    )


def tangential_period(system: LinearSystem, state: State) -> float:
    """Return about the period with which the plate is moved along itself under friction [s].

    It is infinite where the plate is not moved so. Friction turns with the slip. A stretch of many
    periods would meet it at too few instants, and yet close its balance of energy.
    """
    if system.along is None or not system.driven:
        return np.inf
    driven = slice(-system.driven, None)
    omega = system.angular_frequency[driven]
    speeds = np.abs(system.along[:2, driven]) * np.hypot(
        state.velocity[driven], omega * state.displacement[driven]
    )
    acceleration = float(np.linalg.norm(speeds * omega))
    speed = float(np.linalg.norm(speeds))
    if not acceleration > 0.0:
        return np.inf
    return 2.0 * np.pi * speed / acceleration
