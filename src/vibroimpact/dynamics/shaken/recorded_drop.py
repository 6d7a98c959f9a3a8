"""The flights and impacts of a hard sphere on a shaken plate, made where they are read.

A run may have a hundred thousand of them, of which only numbers are kept.
"""

from __future__ import annotations

from array import array

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.along import ImpulseAlong, Sphere, State
from vibroimpact.dynamics.motion.bounce import Bounce, MadeBounces
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.motion.flight_in_fluid import flight_of
from vibroimpact.dynamics.motion.ride import Ride
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion
from vibroimpact.dynamics.statement.problem import Problem

_START, _GAP, _VELOCITY, _END, _RIDE_END, _FRICTION_LOST = range(6)
_BEFORE = slice(6, 13)
_AFTER = slice(13, 20)
_NUMBERS = 20
"""Of a bounce: start of the flight [s], gap [m] and velocity [m/s] then; its end, and that of the
ride after it [s], NaN without an impact; what friction took in this [J]; the members of
`SphereState` at the start of the flight and after the impact.
"""


class HardBounces(MadeBounces[Bounce]):
    """The flights and impacts of one drop.

    Parameters
    ----------
    problem : Problem
        What is simulated.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._numbers = array("d")
        self._sphere: Sphere | None = None

    def begin(self, flight: Flight, oblique: ObliqueMotion | None, end: float) -> None:
        """Add a flight that ends at a time [s]; `oblique`: as it begins."""
        numbers = np.full(_NUMBERS, np.nan)
        numbers[[_START, _GAP, _VELOCITY]] = flight.start[0], flight.gap[0], flight.velocity[0]
        numbers[_END] = end
        if oblique is not None:
            self._sphere = oblique.sphere
            numbers[_BEFORE] = oblique.state.rows[0]
        self._numbers.extend(numbers.tolist())

    def end(self, ride: Ride, oblique: ObliqueMotion | None, row: dict[str, float]) -> None:
        """Add the impact after the last flight; `row`: its columns."""
        first = len(self._numbers) - _NUMBERS
        self._numbers[first + _RIDE_END] = float(ride.end[0])
        if oblique is not None:
            self._numbers[first + _FRICTION_LOST] = row["friction_lost_J"]
            for place, value in enumerate(oblique.state.rows[0].tolist()):
                self._numbers[first + _AFTER.start + place] = value

    def __len__(self) -> int:
        return len(self._numbers) // _NUMBERS

    def _bounce(self, number: int) -> Bounce:
        first = number * _NUMBERS
        numbers = np.array(self._numbers[first : first + _NUMBERS])
        oblique = None
        along = np.zeros((0, 1))
        if self._sphere is not None:
            before = State.of_rows(numbers[None, _BEFORE])
            oblique = self._sphere, before
            along = before.velocity
        flight = flight_of(
            self._problem, numbers[[_START]], numbers[[_GAP]], numbers[[_VELOCITY]], along
        )
        end = numbers[[_END]]
        if np.isnan(numbers[_RIDE_END]):
            return Bounce(flight, end, oblique=oblique)
        along_in_impact = None
        if self._sphere is not None:
            after = State.of_rows(numbers[None, _AFTER])
            along_in_impact = ImpulseAlong(after, numbers[[_FRICTION_LOST]])
        ride = self._ride(numbers[[_RIDE_END]])
        return Bounce(flight, end, oblique=oblique, along=along_in_impact, ride=ride)

    def _ride(self, end: Floats) -> Ride:
        """Return a ride that ends at a time [s] (1,)."""
        problem = self._problem
        motion = problem.motion
        assert motion is not None  # that of a plate that is shaken
        mass = np.array([float(problem.sphere.mass)])
        return Ride(end, mass, np.array([float(problem.net_gravity)]), motion)
