"""Rides: rigid spheres that a rigid plate carries, from an impact without rebound to
where it falls away from under them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.shaken.statement import PlateMotion
from vibroimpact.dynamics.shaken.steady import steady_phasors


@dataclass(frozen=True)
class Ride:
    """Rides of B spheres under a law without a force; arrays are (B,).

    `end` [s]: when each is launched, or its time of touch if it rebounds; infinite if it stays.
    `mass` [kg], `gravity` [m/s^2].
    """

    end: Floats
    mass: Floats
    gravity: Floats
    motion: PlateMotion

    def of(self, drop: int) -> Ride:
        """Return the ride of one sphere."""
        here = np.array([drop])
        return Ride(self.end[here], self.mass[here], self.gravity[here], self.motion)

    def surface(self, time: Floats) -> Floats:
        """Return place [m], velocity [m/s] and acceleration [m/s^2] of the plate's
        surface, upwards, at times [s] (...), (3, ...).
        """
        return self.motion.at(time, steady_phasors(self.motion, None))

    def energy(self, time: Floats) -> Floats:
        """Return the kinetic and potential energy of spheres that move with the plate [J]
        at times [s], one each.
        """
        place, velocity, _ = self.surface(time)
        return np.asarray(self.mass * (0.5 * velocity**2 + self.gravity * place))


@dataclass(frozen=True)
class RideSegment:
    """A part of the history of one drop that rides on the plate.

    `counted_at`: the time at which the work of the drive is counted, the end of a ride or the begin
    of one that does not end [s].
    """

    start: float
    end: float
    ride: Ride
    counted_at: float

    def grid(self) -> Floats:
        """Return times since the start at which the segment is well resolved [s]."""
        fastest = float(self.ride.motion.angular_frequency.max())
        return np.linspace(
            0.0,
            self.end - self.start,
            min(int(_POINTS * fastest * (self.end - self.start)) + 2, _MOST_POINTS),
        )

    def at(self, time: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """Return the motion at times [s] since the start of the segment."""
        place, velocity, acceleration = self.ride.surface(self.start + time)
        nothing = np.zeros_like(time)
        return (
            place,
            velocity,
            self.ride.mass * (self.ride.gravity + acceleration),
            nothing,
            nothing,
            nothing,
        )

    def drive_work(self, time: Floats) -> Floats:
        """Return the work of the drive beyond what is counted [J] at times [s] since the
        start of the segment.
        """
        return self.ride.energy(self.start + time) - self.ride.energy(np.array([self.counted_at]))


# of a grid, per radian of the fastest harmonic motion, and at most
_POINTS, _MOST_POINTS = 8.0, 4001
