"""The flights and contacts of drops that the core followed, from what it wrote of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import overload

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.contact.law import CompliantLaw, InstantaneousLaw
from vibroimpact.dynamics.bounce import Bounce
from vibroimpact.dynamics.contact import CAPTURED, FAILED, RELEASED
from vibroimpact.dynamics.core import drop_records as records
from vibroimpact.dynamics.core.line_records import LineContacts
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.impact_conditions import impact_conditions_of
from vibroimpact.dynamics.problem import Problem

_ALONE = np.zeros(1, dtype=np.intp)
_NO_MOTION = np.zeros(0, dtype=np.int64)


@dataclass(frozen=True, eq=False)
class RecordedDrops:
    """What the core wrote of the flights and contacts of B drops.

    Parameters
    ----------
    problem : Problem
        What was simulated.
    start : array, shape (B, 2)
        Gaps [m] and upward velocities [m/s] at the start.
    impacts, flights : array of int, shape (B,)
        How many there were.
    rows : array, shape (B, R, 20)
        The columns of the impacts, of `core.drop_records`.
    end_time : array, shape (B,)
        When the runs ended [s].
    """

    problem: Problem
    start: Floats
    impacts: Integers
    flights: Integers
    rows: Floats
    end_time: Floats

    def of(self, drop: int) -> RecordedDrop:
        """Return what it wrote of one drop."""
        return RecordedDrop(
            problem=self.problem if self.problem.shape == () else self.problem.take(drop),
            start=self.start[drop],
            flights=int(self.flights[drop]),
            rows=self.rows[drop, : self.impacts[drop]].copy(),
            end_time=float(self.end_time[drop]),
        )


@dataclass(frozen=True, eq=False)
class RecordedDrop(Sequence[Bounce]):
    """The flights and contacts of one drop that the core followed, made where they are read.

    Parameters are those of `RecordedDrops`, of one drop.
    """

    problem: Problem
    start: Floats
    flights: int
    rows: Floats
    end_time: float

    def __len__(self) -> int:
        return self.flights

    @overload
    def __getitem__(self, index: int) -> Bounce: ...

    @overload
    def __getitem__(self, index: slice) -> list[Bounce]: ...

    def __getitem__(self, index: int | slice) -> Bounce | list[Bounce]:
        if isinstance(index, slice):
            return [self._bounce(number) for number in range(*index.indices(len(self)))]
        return self._bounce(range(len(self))[index])

    def _bounce(self, number: int) -> Bounce:
        flight = self._flight(number)
        if number == len(self.rows):
            return Bounce(_ALONE, flight, np.array([self.end_time]), _ALONE[:0])
        row = self.rows[number]
        if isinstance(self.problem.laws[0], InstantaneousLaw):
            return Bounce(_ALONE, flight, row[[records.TOUCH]], _ALONE)
        # only where it is needed: it loads much
        from vibroimpact.dynamics.rigid.line_contact import contact_of

        speed = row[[records.APPROACH]]
        law = self._law(number, speed)
        mass = self.problem.sphere.mass * np.ones(1)
        conditions = impact_conditions_of(law, mass, self._gravity, speed)
        contact = contact_of(conditions, self.problem.tolerance, _contacts_of(row))
        return Bounce(_ALONE, flight, row[[records.TOUCH]], _ALONE, contact, conditions)

    def _flight(self, number: int) -> Flight:
        """Return the flight before an impact."""
        if number == 0:
            return Flight(np.zeros(1), self.start[:1], self.start[1:], self._gravity)
        before = self.rows[number - 1]
        return Flight(
            start=before[[records.TOUCH]] + before[[records.DURATION]],
            gap=before[[records.RELEASE_GAP]],
            velocity=before[[records.RELEASE_VELOCITY]],
            gravity=self._gravity,
        )

    @cached_property
    def _gravity(self) -> Floats:
        return np.asarray(self.problem.gravity * np.ones(1))

    def _law(self, number: int, speed: Floats) -> CompliantLaw:
        """Return the law of an impact at an approach speed [m/s], with its memory."""
        law = self.problem.law_at(self.problem.law_of(number), speed)
        assert isinstance(law, CompliantLaw)
        if not self.problem.memory_lasts:
            return law
        law = law.changed(self.problem.laws[0].memories())
        if number == 0:
            return law
        return law.after_compression(self.rows[:number, [records.INDENTATION]].max(axis=0))


def _contacts_of(row: Floats) -> LineContacts:
    """Return the contact of an impact, from its row, as the core gives it."""
    separation = row[records.SEPARATION]
    outcome = CAPTURED if separation == 0.0 else RELEASED
    if np.isnan(separation):
        outcome = FAILED
    touch = row[records.TOUCH]
    ends = np.array(
        [
            row[records.DURATION],
            -row[records.RELEASE_GAP],
            -row[records.RELEASE_VELOCITY],
            row[records.DAMPED],
            row[records.INDENTATION],
            row[records.COMPRESSION],
            row[records.FORCE],
            row[records.TIME_OF_FORCE] - touch,
            row[records.PLASTIC_WORK],
            row[records.LEFT_STORED],
        ]
    )
    return LineContacts(np.array([outcome]), ends[:, None], _NO_MOTION, _NO_MOTION, np.zeros(0))
