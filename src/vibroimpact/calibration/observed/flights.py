"""Vertical flights of a sphere between impacts, and those in a vacuum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from vibroimpact.arrays import Floats


class ReturnFlight(NamedTuple):
    """A flight from the plate back to the plate.

    Height [m], time of ascent and duration [s], and the speed on return [m/s].
    """

    height: Floats
    rise_time: Floats
    duration: Floats
    return_speed: Floats


class EndSpeeds(NamedTuple):
    """The initial and final speeds of a flight [m/s], and their slopes by its duration [m/s^2]."""

    start: Floats
    end: Floats
    start_slope: Floats
    end_slope: Floats


class Flights(Protocol):
    """Vertical flights of a sphere.

    Heights are measured from its position in touch with the plate, depths from the apex.
    """

    @property
    def gravity(self) -> float:
        """Acceleration of gravity [m/s^2]."""

    def speed_after_fall(self, height: Floats) -> tuple[Floats, Floats]:
        """Return the speed after a fall from rest through a height [m/s], and its slope [1/s]."""

    def speed_to_rise(self, height: Floats) -> tuple[Floats, Floats]:
        """Return the initial speed needed to rise by a height [m/s], and its slope [1/s]."""

    def depth_at(self, time: Floats) -> tuple[Floats, Floats]:
        """Return the depth below the apex [m] at times from it [s], and downward velocity [m/s].

        Times before the apex are negative.
        """

    def end_speeds(self, time: Floats) -> EndSpeeds:
        """Return the initial and final speeds of flights of given durations [s]."""

    def flight(self, speed: Floats) -> ReturnFlight:
        """Return the flights with given initial speeds [m/s]."""


@dataclass(frozen=True)
class VacuumFlights:
    """Flights in a vacuum, which are parabolas.

    Parameters
    ----------
    gravity : float
        Acceleration [m/s^2], > 0.

    Examples
    --------
    >>> [round(float(value), 3) for value in VacuumFlights(9.8).flight(np.array(4.9))]
    [1.225, 0.5, 1.0, 4.9]
    """

    gravity: float

    def speed_after_fall(self, height: Floats) -> tuple[Floats, Floats]:
        """Return the speed after a fall from rest through a height [m/s], and its slope [1/s]."""
        speed = np.sqrt(2.0 * self.gravity * height)
        return speed, self.gravity / speed

    speed_to_rise = speed_after_fall

    def depth_at(self, time: Floats) -> tuple[Floats, Floats]:
        """Return the depth below the apex [m] at times from it [s], and downward velocity [m/s]."""
        return 0.5 * self.gravity * time**2, self.gravity * time

    def end_speeds(self, time: Floats) -> EndSpeeds:
        """Return the initial and final speeds of flights of given durations [s]."""
        speed = 0.5 * self.gravity * time
        slope = np.full_like(time, 0.5 * self.gravity)
        return EndSpeeds(start=speed, end=speed, start_slope=slope, end_slope=slope)

    def flight(self, speed: Floats) -> ReturnFlight:
        """Return the flights with given initial speeds [m/s]."""
        return ReturnFlight(
            height=0.5 * speed**2 / self.gravity,
            rise_time=speed / self.gravity,
            duration=2.0 * speed / self.gravity,
            return_speed=speed,
        )


def vacuum_height(flights: Flights, height: Floats) -> tuple[Floats, Floats]:
    """Return the rise in a vacuum [m] of a sphere that rises by a height, and its slope.

    The slope is the derivative with respect to that height.

    Examples
    --------
    >>> round(float(vacuum_height(VacuumFlights(9.8), np.array(0.5))[0]), 9)
    0.5
    """
    speed, slope = flights.speed_to_rise(height)
    return 0.5 * speed**2 / flights.gravity, speed * slope / flights.gravity
