"""The flights and impacts of a drop whose bodies vibrate, made where they are read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core import drop_records as records
from vibroimpact.dynamics.core.contact_records import FLIGHT
from vibroimpact.dynamics.motion.along import Sphere, State
from vibroimpact.dynamics.motion.bounce import Bounce, MadeBounces
from vibroimpact.dynamics.motion.contact import Contact
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion
from vibroimpact.dynamics.vibrating.recorded_motion import PiecesOfImpact, RecordedMotion
from vibroimpact.dynamics.vibrating.sliding_contact import SlidingContact


@dataclass(frozen=True, kw_only=True)
class VibratingBounce(Bounce):
    """A bounce of a drop whose bodies vibrate; `motion`: theirs in the flight."""

    motion: FreeMotion


class Flown(NamedTuple):
    """A flight that was made: that of the sphere, the motion of all bodies, and the motion along
    the plate at its start, where there is any.
    """

    flight: Flight
    motion: FreeMotion
    along: tuple[Sphere, State] | None


@dataclass(frozen=True, eq=False)
class RecordedDrop(MadeBounces[VibratingBounce]):
    """The flights and impacts of one drop.

    Parameters
    ----------
    problem : Problem
        What was simulated.
    recorded : RecordedMotion
        Its motion.
    rows : array, shape (R, 28)
        The columns of its impacts, of `core.vibrating_records`.
    flown : sequence of Flown
        Its flights, of one that waited for them.
    sliding : sequence of SlidingContact
        The motion along the plate in its impacts, where there is any.
    """

    problem: Problem
    recorded: RecordedMotion
    rows: Floats
    flown: Sequence[Flown] = ()
    sliding: Sequence[SlidingContact] = ()

    def __len__(self) -> int:
        return int(np.count_nonzero(self.recorded.parts.kind == FLIGHT))

    def _bounce(self, number: int) -> VibratingBounce:
        flight, motion = self.flight(number)
        oblique = self.flown[number].along if self.flown else None
        if number == len(self.rows):
            end = np.array([self._end_of_flight(number)])
            return VibratingBounce(flight, end, motion=motion, oblique=oblique)
        along = self.sliding[number] if self.sliding else None
        return VibratingBounce(
            flight=flight,
            flight_end=self.rows[number, [records.TOUCH]],
            contact=self._contact(number),
            motion=motion,
            oblique=oblique,
            along=along,
        )

    def _part_of_flight(self, number: int) -> int:
        """Return the number of the part that is a flight."""
        first_parts = self.recorded.first_parts
        if number < len(first_parts):
            return first_parts[number] - 1
        return len(self.recorded) - 1

    def _end_of_flight(self, number: int) -> float:
        part = self._part_of_flight(number)
        return float(self.recorded.parts.start[part] + self.recorded.parts.length[part])

    def flight(self, number: int) -> tuple[Flight, FreeMotion]:
        """Return the flight of the sphere before an impact, and the motion of all bodies."""
        if self.flown:
            return self.flown[number].flight, self.flown[number].motion
        part = self._part_of_flight(number)
        state = self.recorded.start(part)
        root_mass = float(self.problem.sphere.mass) ** 0.5
        flight = Flight(
            start=self.recorded.parts.start[[part]],
            gap=-state.displacement[:1] / root_mass,
            velocity=-state.velocity[:1] / root_mass,
            gravity=np.array([float(self.problem.net_gravity)]),
        )
        return flight, FreeMotion(self.recorded.system, state)

    def _contact(self, number: int) -> Contact:
        """Return the contact of an impact."""
        recorded = self.recorded
        first_laws = [*recorded.first_laws, len(recorded.parts.origin)]
        law = recorded.local(first_laws[number + 1] - 1).law
        return Contact(PiecesOfImpact(recorded, recorded.parts_of(number)), law)
