"""One drop whose bodies vibrate, as the core follows it, and what is decided for it on the way.

The core asks whether a sphere rests whose force is near its weight, which takes the modes of the
sphere on its contact. A drop that waits (`waiting_drop`) is told more.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from functools import partial

import numpy as np

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.core import drop_records as records
from vibroimpact.dynamics.core.contact_records import FLIGHT
from vibroimpact.dynamics.core.drops import default_rest_speed, end_by_bounces
from vibroimpact.dynamics.core.parts import has_room
from vibroimpact.dynamics.core.vibrating_drops import follow_vibrating_drop, next_flight
from vibroimpact.dynamics.core.vibrating_records import (
    FIRST_LAW,
    FIRST_PART,
    HELD,
    IMPACTS,
    IN_CONTACT,
    NEAR_REST,
)
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.motion.progress import fraction_done
from vibroimpact.dynamics.motion.run_rules import start_of
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.contact_view import contact_view
from vibroimpact.dynamics.vibrating.drop_at_start import (
    drop_at_start,
    first_law_of,
    manner_of,
    now_at_start,
    state_of,
    tangential_period,
)
from vibroimpact.dynamics.vibrating.drop_system import centre_of
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.radau_eigenbasis import bases_of
from vibroimpact.dynamics.vibrating.recorded_drop import RecordedDrop
from vibroimpact.dynamics.vibrating.recorded_motion import ImpactOn, RecordedMotion, room_for_parts
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion
from vibroimpact.dynamics.vibrating.room import with_more_room
from vibroimpact.dynamics.vibrating.sphere_at_rest import Equilibria
from vibroimpact.dynamics.vibrating.surface_friction import NO_FRICTION


class FollowedDrop:
    """One drop on its way.

    `drop`, `now`: as the core has them. `held`: laws of other packages, which the core calls as
    long as it is open. `recorded`: its motion. `rows`: of a drop that waits, what the core does not
    know of its impacts, by the columns of their table. `system`, `series`: the bodies with the
    contact where it is, and the compliance in series with the law there. `lying`: how it moves on
    once it has come to rest. `left`: energy above equilibrium at rest or on a ride [J], else NaN.

    Parameters
    ----------
    problem : Problem
        Of one drop.
    system : LinearSystem
        Its bodies.
    stated_mass : float
        Mass of the sphere for which what drives the plate was stated [kg].
    """

    waits = False

    def __init__(self, problem: Problem, system: LinearSystem, stated_mass: float) -> None:
        self.problem = problem
        self.system = system
        self.series = problem.quasi_static
        self.held = ExitStack()
        state = state_of(problem, system, stated_mass)
        self.drop = drop_at_start(problem, system, self.held)
        self.now = now_at_start(problem, self.drop, state)
        self.manner = manner_of(problem, tangential_period(system, state), waits=self.waits)
        self.recorded = RecordedMotion(
            system, room_for_parts(system, self.drop.laws.shape[1]), state
        )
        self.rows: list[dict[str, float]] = []
        self.sphere = NO_FRICTION
        self.lying: RestMotion | None = None
        self.left = np.nan
        self._bases = bases_of(first_law_of(problem).root)
        self._equilibria = Equilibria(system)
        if problem.rest_speed is None:
            _, approach_speed = self.first_flight().touch(np.zeros(1))
            self.drop.state[records.REST_SPEED] = default_rest_speed(
                self.manner.addresses,
                self.drop.laws[0],
                self.drop.state[records.MASS],
                self.drop.state[records.GRAVITY],
                approach_speed[0],
            )

    def first_flight(self) -> Flight:
        """Return the flight from the start."""
        gap, velocity = start_of(self.problem)
        gravity = np.array([self.problem.net_gravity], dtype=float)
        return Flight(np.zeros(1), np.array([gap]), np.array([velocity]), gravity)

    def first_touch(self) -> float:
        """Return the time of the first touch [s], from the start; infinite if there is none."""
        record = self.system.record_of(0)
        return float(next_flight(record, self.manner, self.drop, self.now.state).touch)

    @property
    def impacts(self) -> int:
        """How many impacts there were."""
        return int(self.drop.counts[IMPACTS])

    @property
    def time(self) -> float:
        """Up to when it has been followed [s]."""
        return float(self.drop.state[records.TIME])

    @property
    def state(self) -> State:
        """The state of its bodies."""
        return State(*self.now.state)

    def follow(self, progress: Callable[[float], None] | None) -> None:
        """Follow the drop to the end of its run."""
        while self.now.phase < 0:
            impacts = self.impacts
            self._make_room()
            self.go_on(progress is not None)
            self._note_impacts()
            if self.now.phase == NEAR_REST:
                self._decide()
            if progress is not None and (self.impacts > impacts or self.now.phase >= 0):
                progress(self._fraction_done())
        self._end()

    def go_on(self, one_impact: bool) -> None:
        """Follow the drop in the core; `one_impact`: at most through the next impact."""
        pause = len(self.drop.rows)
        if one_impact:
            pause = self.impacts + 1
        self.now = follow_vibrating_drop(
            self._bases,
            contact_view(self.system, (0,)).bodies,
            self.manner,
            self.drop,
            self.recorded.parts,
            self.sphere,
            self.now,
            pause,
        )

    def law_of(self, impact: int, speed: float, dent: float) -> CompliantLaw:
        """Return the law of an impact, counted from 0.

        `speed`: of approach [m/s]. `dent`: the deepest indentation where it falls [m].
        """
        problem = self.problem
        law = problem.law_at_touch(problem.law_of(impact), np.array([speed])).take(0)
        assert isinstance(law, CompliantLaw)  # the problem has seen to it
        if not problem.memory_lasts:
            return law
        law = law.changed(problem.laws[0].memories())
        if dent > 0.0:
            law = law.after_compression(dent)
        return law

    def _make_room(self) -> None:
        """Make room for further impacts and parts where it is used up."""
        drop = self.drop
        if self.impacts == len(drop.rows):
            rows = np.concatenate([drop.rows, np.full_like(drop.rows, np.nan)])
            self.drop = drop._replace(rows=rows)
        recorded = self.recorded
        if not has_room(recorded.parts):
            recorded.parts = with_more_room(recorded.parts)

    def _note_impacts(self) -> None:
        """Note what the impacts have met that there were since the last time."""
        recorded = self.recorded
        recorded.end = self.state
        drop = self.drop
        in_contact = self.now.phase in (IN_CONTACT, NEAR_REST, HELD)
        number = self.impacts + in_contact
        for impact in range(len(recorded.impacts), number):
            row = drop.rows[impact]
            recorded.first_parts.append(int(row[FIRST_PART]))
            recorded.first_laws.append(int(row[FIRST_LAW]))
            speed = float(row[records.APPROACH])
            dent = float(row[records.DENT_BEFORE])
            if impact == self.impacts:  # it is under way
                speed = float(drop.state[records.CLOSING])
                dent = float(drop.state[records.DENT])
            law = partial(self.law_of, impact, speed, dent)
            recorded.impacts.append(ImpactOn(self.system, self.series, law, self.sphere))

    def _decide(self) -> None:
        """Tell the core whether the contact holds the sphere for good."""
        progress = self.now.progress
        local = self.recorded.local(progress.law)
        holds = self._equilibria.holds(local, self.state, progress.force)
        phase = HELD if holds else IN_CONTACT
        self.now = self.now._replace(phase=phase)

    def _fraction_done(self) -> float:
        """Return the fraction of the run that is done, in [0, 1]."""
        if self.now.phase >= 0:
            return 1.0
        rows = self.drop.rows
        return fraction_done(
            self.problem,
            self.impacts,
            self.time,
            rows[0, [records.APPROACH]],
            rows[self.impacts - 1, [records.RELEASE_VELOCITY]],
            self.drop.state[[records.REST_SPEED]],
        )

    # the end
    # -------------------------------------------------------------------------------------

    @property
    def is_at_rest(self) -> bool:
        """Whether it has come to rest."""
        return self.lying is not None

    @property
    def _stays(self) -> bool:
        """Whether its last impact ended in contact: at rest or on a ride."""
        parts = self.recorded
        ended_in_flight = int(parts.parts.kind[len(parts) - 1]) == FLIGHT
        return not ended_in_flight and self.now.phase != records.END_FAILED

    def _end(self) -> None:
        """Let a drop that has come to rest lie, or take account of what is left on a ride."""
        if not self._stays:
            return
        phase = self.now.phase
        local = self.recorded.local(self.now.progress.law)
        stored = float(self.drop.rows[self.impacts - 1, records.LEFT_STORED])
        if phase in (records.END_RIDING, records.END_BY_DURATION):
            if not self.system.driven:
                self.left = self._equilibria.of(local)[0].excess(self.state, stored)
            return
        numbers = self.drop.state
        numbers[records.REST_TIME] = self.time
        if phase == records.END_BY_REST_SPEED:
            row = self.drop.rows[self.impacts - 1]
            numbers[records.REST_TIME] = end_by_bounces(numbers, row)
        self.lying = self._equilibria.rest_from(local, self.state, stored)
        numbers[records.SAG] = self.lying.equilibrium.sag
        numbers[records.STORED] = self.lying.equilibrium.stored
        numbers[records.WRITTEN_OFF] = self.lying.written_off
        if not self.system.driven:
            self.left = self.lying.excess

    def lie_until(self, end: float) -> None:
        """Let a drop at rest oscillate until the end of its run [s]."""
        assert self.lying is not None  # it has come to rest
        time = np.array([max(end - self.time, 0.0)])
        state = self.lying.state(time).take(0)
        self.drop.lost[:] += self.lying.lost_by(time)[0]
        self.drop.state[records.STORED] = self.lying.stored(time)[0]
        self.now = self.now._replace(state=state.record)

    # what is told of it
    # --------------------------------------------------------------------------------------

    def centre(self) -> tuple[float, float]:
        """Return the gap below the sphere [m], and its velocity upwards [m/s]."""
        depth, fall_speed = centre_of(self.state, float(self.problem.sphere.mass))
        return -float(depth), -float(fall_speed)

    def restitutions_asked(self) -> list[float]:
        """Return the restitution asked of each impact."""
        laws = [self.problem.law_of(impact) for impact in range(self.impacts)]
        return [float(np.ravel(law.nominal_restitution)[0]) for law in laws]

    def recording(self) -> RecordedDrop:
        """Return its flights and impacts."""
        self.recorded.keep_written()
        return RecordedDrop(
            problem=self.problem,
            recorded=self.recorded,
            rows=self.drop.rows[: self.impacts].copy(),
        )

    def energy_at_start(self) -> float:
        """Return the energy beside that of the fall [J], before any flight."""
        return 0.0

    def end_along(self, end: float) -> float:
        """Return the end of the run [s], which a motion along the plate may end before."""
        return end

    def further_entries(self) -> dict[str, float]:
        """Return what is added to the entries of the energy ledger [J]."""
        return {}

    def taken_by_friction(self) -> tuple[float, float]:
        """Return the energy that friction took, and the part of it in microslip [J]."""
        return 0.0, 0.0
