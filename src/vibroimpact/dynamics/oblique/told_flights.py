"""The flights of one drop that the core does not make: through a fluid, along the plate.

They are told to the core, or to the impacts of a hard sphere, and what they take is accounted for.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.dynamics.core.drop_records import AT_TOUCH, FreeFall
from vibroimpact.dynamics.core.stop_rules import first_end
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.motion.flight_in_fluid import FluidFlight, flight_of
from vibroimpact.dynamics.motion.run_rules import stop_rules_of
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion
from vibroimpact.dynamics.statement.problem import Problem


class ToldFlights:
    """The flights of one drop.

    `oblique`: its motion along the plate, if there is any. `to_fluid`: energy that it gave to a
    fluid so far [J].

    Parameters
    ----------
    problem : Problem
        Of one drop.
    velocity : float
        Upwards at the start [m/s].
    """

    def __init__(self, problem: Problem, velocity: float) -> None:
        self.oblique: ObliqueMotion | None = None
        if problem.oblique is not None:
            self.oblique = ObliqueMotion(problem)
        self.to_fluid = 0.0
        self._problem = problem
        self._mass = float(problem.sphere.mass)
        self._stops = stop_rules_of(problem)
        self._liquid_at_start = self.energy_of_liquid(velocity)

    def next(self, start: float, gap: float, velocity: float) -> Flight:
        """Return the flight from a time [s] on, with a gap [m] and a velocity upwards [m/s]."""
        along = np.zeros((0, 1))
        if self.oblique is not None:
            along = self.oblique.state.velocity
        return flight_of(
            self._problem, np.array([start]), np.array([gap]), np.array([velocity]), along
        )

    def end_of(self, flight: Flight, touch: float, impacts: int) -> tuple[float, int]:
        """Return when a flight ends [s], and the phase then, of `core.drop_records`.

        The surfaces touch at a time `touch` [s], unless a rule ends the run before. `impacts`: how
        many there were.
        """
        is_beside = self.oblique is not None and self.oblique.is_beside(flight, touch)
        top = float(flight.apex()[0][0])
        fall = FreeFall(float(flight.start[0]), top, touch, np.nan, is_beside)
        end, ending = first_end(self._stops, fall, impacts)
        if touch >= end:
            return end, ending
        return touch, AT_TOUCH

    def fly(self, flight: Flight, time: float) -> dict[str, float]:
        """Make a flight up to a time [s], and return what it adds to the row of the next impact."""
        end = np.array([time])
        if self.oblique is not None:
            self.oblique.fly(flight, end)
        if not isinstance(flight, FluidFlight):
            return {}
        assert self._problem.fluid is not None
        self.to_fluid += self._mass * float(flight.given(end)[0])
        return {f"{self._problem.fluid.key}_lost_J": self._mass * float(flight.lost(end)[0])}

    def energy_of_liquid(self, velocity: float) -> float:
        """Return the kinetic energy of the liquid that moves along with the sphere [J].

        `velocity`: upwards [m/s].
        """
        square = velocity**2
        if self.oblique is not None:
            square += float((self.oblique.state.velocity**2).sum())
        return 0.5 * self._mass * (float(self._problem.flight_inertia) - 1.0) * square

    def energy_at_start(self) -> float:
        """Return the energy of liquid, motion along the plate and spin, before any flight [J]."""
        energies = self.energies_along()
        moving = energies.get("kinetic_J", 0.0) + energies.get("rotation_J", 0.0)
        return self._liquid_at_start + moving

    def energies_along(self) -> dict[str, float]:
        """Return the entries of the motion along the plate in the energy ledger [J], if any."""
        if self.oblique is None:
            return {}
        return self.oblique.energies()

    def entries(self, velocity: float) -> dict[str, float]:
        """Return what flights add to the entries of the energy ledger [J].

        `velocity`: upwards at the end [m/s].
        """
        entries = self.energies_along()
        fluid = self._problem.fluid
        if fluid is not None:
            liquid = self.energy_of_liquid(velocity)
            entries["kinetic_J"] = entries.get("kinetic_J", 0.0) + liquid
            entries[f"{fluid.key}_J"] = self.to_fluid + self._liquid_at_start - liquid
        return entries
