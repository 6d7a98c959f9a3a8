"""The history of one drop as a sequence of segments, each of which gives the motion at any time
within it.

A segment counts time from its own start: a contact may be a billion times shorter than the run.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.impact_conditions import ImpactConditions
from vibroimpact.dynamics.shaken.ride import RideSegment

Motion = tuple[Floats, Floats, Floats, Floats, Floats, Floats]
"""Gap [m], upward velocity [m/s], contact force [N], stored energy [J], and energy lost in damping
and in plastic deformation since the start [J]."""


class MotionInContact(Protocol):
    """The motion of one drop in a part of its contact."""

    @property
    def duration(self) -> Floats:
        """Return the duration [s] (1,)."""

    @property
    def begins_at(self) -> float:
        """Return the indentation at its start [m]."""

    def grid(self) -> Floats:
        """Return times since the start at which it is well resolved [s]."""

    def at(self, time: Floats, conditions: ImpactConditions) -> tuple[Floats, Floats, Floats]:
        """Return indentation [m], its rate [m/s] and the energy dissipated since the
        start [J] at times since then [s].
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
        nothing = np.zeros_like(time)
        return gap, velocity, nothing, nothing, nothing, nothing


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
        delta, velocity, lost = self.motion.at(time, self.conditions)
        law, begun = self.conditions.law, np.array([self.motion.begins_at])
        elastic, dissipative = law.forces(delta, velocity, self.conditions.approach_speed)
        force = elastic + dissipative
        if law.tension == "cut":
            force = np.maximum(force, 0.0)
        return (
            -delta,
            -velocity,
            force,
            law.elastic_energy(delta),
            lost,
            law.plastic_work(delta) - law.plastic_work(begun),
        )


@dataclass(frozen=True)
class RestSegment:
    """The sphere at rest on the plate, in its static indentation."""

    start: float
    end: float
    sag: float
    weight: float
    stored: float
    points: int = 2
    """Number of times at which it is well resolved: more where the sphere moves on along
    the plate.
    """

    def grid(self) -> Floats:
        """Return times since the start at which the segment is well resolved [s]."""
        return np.linspace(0.0, self.end - self.start, self.points)

    def at(self, time: Floats) -> Motion:
        """Return the motion at times [s] since the start of the segment."""
        same = np.ones_like(time)
        return (
            -self.sag * same,
            0.0 * same,
            self.weight * same,
            self.stored * same,
            0.0 * same,
            0.0 * same,
        )


Segment = FlightSegment | ContactSegment | RestSegment | RideSegment
