"""The history of one drop as segments, each of which gives the motion at any time within it.

A segment counts time from its own start: a contact may be a billion times shorter than the run.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.motion.impact_conditions import ImpactConditions
from vibroimpact.dynamics.motion.ride import RideSegment

Motion = tuple[Floats, Floats, Floats, Floats, Floats, Floats]
"""Gap [m], upward velocity [m/s], contact force [N], stored energy [J], and energy lost in damping
and in plastic deformation since the start [J]."""


class MotionInContact(Protocol):
    """The motion of one drop in a part of its contact."""

    @property
    def conditions(self) -> ImpactConditions:
        """Return the impact."""

    @property
    def duration(self) -> Floats:
        """Return the duration [s] (1,)."""

    @property
    def begins_at(self) -> float:
        """Return the indentation at its start [m]."""

    def grid(self) -> Floats:
        """Return times since the start at which it is well resolved [s]."""

    def at(self, time: Floats) -> tuple[Floats, Floats, Floats]:
        """Return indentation [m], its rate [m/s] and the energy dissipated [J].

        They are those at times since the start [s].
        """


@dataclass(frozen=True)
class FlightSegment:
    """Free flight of one drop."""

    start: float
    end: float
    flight: Flight

    def grid(self) -> Floats:
        """Return times since the start at which the segment is well resolved [s]."""
        return np.linspace(0.0, self.end - self.start, 49)

    def at(self, time: Floats) -> Motion:
        """Return the motion at times [s] since the start of the segment."""
        gap, velocity = self.flight.at(self.flight.start + time)
        zeros = np.zeros_like(time)
        return gap, velocity, zeros, zeros, zeros, zeros


@dataclass(frozen=True)
class ContactSegment:
    """Compression or restitution of one drop, or a part of it, and its `ImpactConditions`."""

    start: float
    end: float
    motion: MotionInContact
    conditions: ImpactConditions

    @property
    def duration(self) -> Floats:
        """Return the duration [s] (1,)."""
        return self.motion.duration

    def grid(self) -> Floats:
        """Return times since the start at which the segment is well resolved [s]."""
        return self.motion.grid()

    def at(self, time: Floats) -> Motion:
        """Return the motion at times [s] since the start of the segment."""
        law = self.conditions.law
        delta, velocity, dissipated = self.motion.at(time)
        elastic, dissipative = law.forces(delta, velocity, self.conditions.approach_speed)
        force = elastic + dissipative
        if law.tension == "cut":
            force = np.maximum(force, 0.0)
        plastic_before = law.plastic_work(np.array([self.motion.begins_at]))
        plastic = law.plastic_work(delta) - plastic_before
        return -delta, -velocity, force, law.elastic_energy(delta), dissipated, plastic


@dataclass(frozen=True)
class RestSegment:
    """The sphere at rest on the plate, in its static indentation."""

    start: float
    end: float
    sag: float
    weight: float
    stored: float
    points: int = 2
    """Number of times at which it is well resolved: more where the sphere moves on."""

    def grid(self) -> Floats:
        """Return times since the start at which the segment is well resolved [s]."""
        return np.linspace(0.0, self.end - self.start, self.points)

    def at(self, time: Floats) -> Motion:
        """Return the motion at times [s] since the start of the segment."""
        ones = np.ones_like(time)
        zeros = 0.0 * ones
        return -self.sag * ones, zeros, self.weight * ones, self.stored * ones, zeros, zeros


Segment = FlightSegment | ContactSegment | RestSegment | RideSegment
