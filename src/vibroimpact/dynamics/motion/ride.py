"""Rides: rigid spheres that a rigid plate carries, from an impact without rebound to a launch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.statement.plate_motion import PlateMotion
from vibroimpact.dynamics.statement.steady import steady_phasors

_POINTS_PER_RADIAN = 8.0  # of a grid, of the fastest harmonic motion
_MOST_POINTS = 4001


@dataclass(frozen=True)
class Ride:
    """The ride of a sphere under a law without a force; arrays are (1,).

    `end` [s]: when it is launched, or its time of touch if it rebounds; infinite if it stays.
    `mass` [kg], `gravity` [m/s^2].
    """

    end: Floats
    mass: Floats
    gravity: Floats
    motion: PlateMotion

    def surface(self, time: Floats) -> Floats:
        """Return the motion of the plate's surface upwards at times [s] (...), (3, ...).

        It is its displacement [m], velocity [m/s] and acceleration [m/s^2].
        """
        return self.motion.at(time, steady_phasors(self.motion, None))

    def energy(self, time: Floats) -> Floats:
        """Return the energy of spheres that move with the plate [J] at times [s], one each.

        It is kinetic and potential.
        """
        displacement, velocity, _ = self.surface(time)
        return np.asarray(self.mass * (0.5 * velocity**2 + self.gravity * displacement))


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
        duration = self.end - self.start
        fastest = float(self.ride.motion.angular_frequency.max())
        points = min(int(_POINTS_PER_RADIAN * fastest * duration) + 2, _MOST_POINTS)
        return np.linspace(0.0, duration, points)

    def at(self, time: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """Return the motion at times [s] since the start of the segment, as `segments.Motion`."""
        displacement, velocity, acceleration = self.ride.surface(self.start + time)
        force = self.ride.mass * (self.ride.gravity + acceleration)
        zeros = np.zeros_like(time)
        return displacement, velocity, force, zeros, zeros, zeros

    def drive_work(self, time: Floats) -> Floats:
        """Return the work of the drive beyond what is counted [J] at times [s].

        These are since the start of the segment.
        """
        counted = self.ride.energy(np.array([self.counted_at]))
        return self.ride.energy(self.start + time) - counted
