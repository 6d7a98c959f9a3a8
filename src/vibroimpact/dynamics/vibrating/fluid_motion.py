"""Free motion of bodies that vibrate, while the sphere flies through air or a liquid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.flight_in_fluid import FluidFlight
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State


@dataclass(frozen=True)
class FluidMotion(FreeMotion):
    """Motion without contact force in which the sphere, the first coordinate, flies
    through air or a liquid; `flight`: its flight alone.
    """

    flight: FluidFlight

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (...)."""
        return self._with_sphere(super().state(time), time)

    def state_after(self, time: float) -> State:
        """Return the state at one time since the start [s]."""
        return self._with_sphere(super().state_after(time), np.array(time))

    def _with_sphere(self, vibrating: State, time: Floats) -> State:
        """Return states, which are changed, with the sphere where it flies."""
        root = 1.0 / self.system.shape[0, 0]
        gap, velocity = (part[..., 0] for part in self.flight.at(self._when(time)))
        vibrating.displacement[..., 0], vibrating.velocity[..., 0] = -root * gap, -root * velocity
        return vibrating

    def after(self, time: float) -> FluidMotion:
        """Return the motion from a time on [s]."""
        return FluidMotion(
            self.system, self.state_after(time), self.flight.after(self._when(np.array(time)))
        )

    def pull(self, time: float) -> float:
        """Return a bound of the acceleration of the approach by what acts on the sphere [m/s^2],
        from a time on [s].

        A rising sphere is slowed less and less, at last by gravity, and a falling one is
        accelerated by less than that.
        """
        now = abs(float(self.flight.acceleration(self._when(np.array(time)))[0]))
        return max(float(self.system.gravity[0]), now)

    def _when(self, time: Floats) -> Floats:
        return np.asarray(self.flight.start + np.asarray(time, dtype=float)[..., None])


def free_motion(system: LinearSystem, state: State, flight: Flight) -> FreeMotion:
    """Return the motion without contact force of a system whose sphere is on a flight,
    from the state at its start.
    """
    return (
        FluidMotion(system, state, flight)
        if isinstance(flight, FluidFlight)
        else FreeMotion(system, state)
    )
