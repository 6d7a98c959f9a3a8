"""Free motion of bodies that vibrate, while the sphere flies through air or a liquid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.motion.flight_in_fluid import FluidFlight
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State


@dataclass(frozen=True)
class FluidMotion(FreeMotion):
    """Motion without contact force in which the sphere flies through air or a liquid.

    The sphere is the first coordinate. `flight`: its flight alone.
    """

    flight: FluidFlight

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (...)."""
        return self._with_sphere(super().state(time), time)

    def state_after(self, time: float) -> State:
        """Return the state at one time since the start [s]."""
        return self._with_sphere(super().state_after(time), np.array(time))

    def _with_sphere(self, state: State, time: Floats) -> State:
        """Return states, which are changed, with the sphere where it flies."""
        root_mass = 1.0 / self.system.shape[0, 0]
        gap, velocity = self.flight.at(self._flight_time(time))
        state.displacement[..., 0] = -root_mass * gap[..., 0]
        state.velocity[..., 0] = -root_mass * velocity[..., 0]
        return state

    def after(self, time: float) -> FluidMotion:
        """Return the motion from a time on [s]."""
        flight = self.flight.after(self._flight_time(np.array(time)))
        return FluidMotion(self.system, self.state_after(time), flight)

    def pull(self, time: float) -> float:
        """Return a bound of the acceleration of the approach by the fluid and gravity [m/s^2].

        It holds from a time on [s]. A rising sphere is slowed less and less, at last by gravity,
        and a falling one is accelerated by less than that.
        """
        acceleration = self.flight.acceleration(self._flight_time(np.array(time)))
        return max(float(self.system.gravity[0]), abs(float(acceleration[0])))

    def _flight_time(self, time: Floats) -> Floats:
        """Return times of the flight [s] (..., 1), of times since the start of the motion."""
        return np.asarray(self.flight.start + np.asarray(time, dtype=float)[..., None])


def free_motion(system: LinearSystem, state: State, flight: Flight) -> FreeMotion:
    """Return the motion without contact force of a system whose sphere is on a flight.

    `state`: at its start.
    """
    if isinstance(flight, FluidFlight):
        return FluidMotion(system, state, flight)
    return FreeMotion(system, state)
