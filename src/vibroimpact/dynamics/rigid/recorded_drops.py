"""The flights and contacts of drops that the core followed, from what it wrote of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.contact.law import CompliantLaw, InstantaneousLaw
from vibroimpact.dynamics.core import drop_records as records
from vibroimpact.dynamics.motion.along import (
    ContactAlong,
    ImpulseAlong,
    Sphere,
    State,
    spheres_of,
)
from vibroimpact.dynamics.motion.bounce import Bounce, MadeBounces
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.motion.impact_conditions import ImpactConditions, impact_conditions_of
from vibroimpact.dynamics.rigid.rubbed_contact import RubbedContact
from vibroimpact.dynamics.statement.problem import Problem


class Start(NamedTuple):
    """B drops at their start: gaps [m] and upward velocities [m/s] (B, 2), and the members of
    `SphereState` of those that move along the plate (B, 7).
    """

    normal: Floats
    along: Floats

    def take(self, drop: int) -> Start:
        """Return the start of one drop, as that of a batch of one."""
        return Start(self.normal[[drop]], self.along[drop : drop + 1])


@dataclass(frozen=True, eq=False)
class RecordedDrops:
    """What the core wrote of the flights and contacts of B drops.

    Parameters
    ----------
    problem : Problem
        What was simulated.
    start : Start
        The drops at their start.
    impacts, flights : array of int, shape (B,)
        How many there were.
    rows : array, shape (B, R, 21 or 40)
        The columns of the impacts, of `core.drop_records`.
    end_time : array, shape (B,)
        When the runs ended [s].
    """

    problem: Problem
    start: Start
    impacts: Integers
    flights: Integers
    rows: Floats
    end_time: Floats

    def of(self, drop: int) -> RecordedDrop:
        """Return what it wrote of one drop."""
        problem = self.problem
        if problem.shape != ():
            problem = problem.take(drop)
        return RecordedDrop(
            problem=problem,
            start=self.start.take(drop),
            flights=int(self.flights[drop]),
            rows=self.rows[drop, : self.impacts[drop]].copy(),
            end_time=float(self.end_time[drop]),
        )


@dataclass(frozen=True, eq=False)
class RecordedDrop(MadeBounces[Bounce]):
    """The flights and contacts of one drop that the core followed, made where they are read.

    Parameters are those of `RecordedDrops`, of one drop.
    """

    problem: Problem
    start: Start
    flights: int
    rows: Floats
    end_time: float

    def __len__(self) -> int:
        return self.flights

    def _bounce(self, number: int) -> Bounce:
        flight = self._flight(number)
        oblique = self._along(number)
        if number == len(self.rows):
            return Bounce(flight, np.array([self.end_time]), oblique=oblique)
        touch = self.rows[number, [records.TOUCH]]
        if isinstance(self.problem.laws[0], InstantaneousLaw):
            return Bounce(flight, touch, oblique=oblique, along=self._struck_along(number))
        # only where it is needed: it loads much
        from vibroimpact.dynamics.rigid.line_contact import contact_of

        row = self.rows[number]
        speed = row[[records.APPROACH]]
        law = self._law(number, speed)
        mass = self.problem.sphere.mass * np.ones(1)
        conditions = impact_conditions_of(law, mass, self._gravity, speed)
        times = float(row[records.DURATION]), float(row[records.COMPRESSION])
        deepest = float(row[records.INDENTATION])
        return Bounce(
            flight=flight,
            flight_end=touch,
            contact=contact_of(conditions, self.problem.tolerance, deepest, times),
            oblique=oblique,
            along=self._rubbed_along(number, conditions),
        )

    def _flight(self, number: int) -> Flight:
        """Return the flight before an impact."""
        start = np.zeros(1)
        gap, velocity = self.start.normal.T
        if number > 0:
            before = self.rows[number - 1]
            start = before[[records.TOUCH]] + before[[records.DURATION]]
            gap = before[[records.RELEASE_GAP]]
            velocity = before[[records.RELEASE_VELOCITY]]
        if self.problem.fluid is None:
            return Flight(start, gap, velocity, self._gravity)
        # only where it is needed: it loads much
        from vibroimpact.dynamics.motion.flight_in_fluid import flight_of

        along = np.zeros((0, 1))
        oblique = self._along(number)
        if oblique is not None:
            along = oblique[1].velocity
        return flight_of(self.problem, start, gap, velocity, along)

    def _along(self, number: int) -> tuple[Sphere, State] | None:
        """Return the sphere, and its motion along the plate at the start of a flight, if any."""
        if self.problem.oblique is None:
            return None
        state = State.of_rows(self.start.along)
        if number > 0:
            state = _released_along(self.rows[number - 1])
        return self._sphere, state

    def _struck_along(self, number: int) -> ContactAlong | None:
        """Return the motion along the plate after an impulse, if there is any."""
        if self.problem.oblique is None:
            return None
        row = self.rows[number]
        return ImpulseAlong(_released_along(row), row[[records.FRICTION_LOST]])

    def _rubbed_along(self, number: int, conditions: ImpactConditions) -> ContactAlong | None:
        """Return the motion along the plate in a contact, if there is any."""
        if self.problem.oblique is None:
            return None
        row = self.rows[number]
        columns = row[records.ALONG :]
        before = State.of_rows(columns[[0, 1, 2, 3, 6, 7, 8]][None])
        return RubbedContact(
            conditions,
            self.problem.tolerance,
            self.problem.oblique.friction,
            self._sphere,
            before,
            row[[records.DURATION]],
        )

    @cached_property
    def _sphere(self) -> Sphere:
        return spheres_of(self.problem)

    @cached_property
    def _gravity(self) -> Floats:
        return np.asarray(self.problem.net_gravity * np.ones(1))

    def _law(self, number: int, speed: Floats) -> CompliantLaw:
        """Return the law of an impact at an approach speed [m/s], with its memory."""
        law = self.problem.law_at_touch(self.problem.law_of(number), speed)
        assert isinstance(law, CompliantLaw)
        if not self.problem.memory_lasts:
            return law
        law = law.changed(self.problem.laws[0].memories())
        dent = self.rows[number, [records.DENT_BEFORE]]
        if dent > 0.0:
            law = law.after_compression(dent)
        return law


def _released_along(row: Floats) -> State:
    """Return the state along the plate at the end of an impact, from its row."""
    place = row[[records.RELEASE_X, records.RELEASE_Y]]
    columns = row[records.ALONG :]
    return State.of_rows(np.concatenate([place, columns[[4, 5, 9, 10, 11]]])[None])
