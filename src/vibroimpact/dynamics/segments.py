"""The history of one drop as a row of segments, each of which can be asked at any time within it.

A segment counts time from its own start: a contact may be a billion times shorter than the run.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.collocation import collocation_rule
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.glide import Glide
from vibroimpact.dynamics.plane_motion import PlaneMotion
from vibroimpact.dynamics.stretch import Stretch

Motion = tuple[Floats, Floats, Floats, Floats, Floats, Floats]
"""Gap [m], upward velocity [m/s], contact force [N], stored energy [J], and energy lost in damping and in
plastic deformation since the start [J]."""


@dataclass(frozen=True)
class FlightSegment:
    """Free flight of one drop."""

    start: float
    end: float
    flight: Flight

    def grid(self) -> Floats:
        """Times since its start that draw the segment well [s]."""
        return np.linspace(0.0, self.end - self.start, 49)

    def at(self, time: Floats) -> Motion:
        """Return the motion at times [s] since the start of the segment."""
        gap, velocity = self.flight.at(self.flight.start + time)
        nothing = np.zeros_like(time)
        return gap, velocity, nothing, nothing, nothing, nothing


@dataclass(frozen=True)
class StretchSegment:
    """One solved stretch of contact of one drop: a `Stretch` and an `Encounter` of one."""

    start: float
    end: float
    stretch: Stretch
    encounter: Encounter

    @property
    def duration(self) -> Floats:
        """How long it lasts [s], (1,)."""
        return self.stretch.duration

    def grid(self) -> Floats:
        """Times since its start that draw the segment well [s]."""
        return np.asarray(self.stretch.duration[0] * self.stretch.rule.map_time(np.linspace(0.0, 1.0, 61)))

    def at(self, time: Floats) -> Motion:
        """Return the motion at times [s] since the start of the segment."""
        stretch, rule, law = self.stretch, self.stretch.rule, self.encounter.law
        x = rule.unmap_time(time / stretch.duration[0])
        delta, velocity = self.motion(x)
        # the power is a product of two that N nodes resolve: it takes 2 N
        finer = collocation_rule(2 * len(rule.nodes), rule.time_map, rule.root)
        node_delta, node_velocity = self.motion(finer.nodes)
        _, at_nodes = law.forces(node_delta, node_velocity, self.encounter.approach_speed)
        lost = stretch.duration[0] * finer.integrate(x, at_nodes * node_velocity)
        return _in_contact(self.encounter, float(stretch.delta[0]), delta, velocity, lost)

    def motion(self, x: Floats) -> tuple[Floats, Floats]:
        """Return the indentation [m] and its rate [m/s] at places x of the rule."""
        stretch, rule, duration = self.stretch, self.stretch.rule, self.stretch.duration[0]
        delta = stretch.delta[0] + duration * rule.integrate(x, stretch.node_velocity[:, 0])
        velocity = stretch.velocity[0] + duration * rule.integrate(x, stretch.node_acceleration[:, 0])
        return np.maximum(delta, self.encounter.floor), velocity


@dataclass(frozen=True)
class PlaneSegment:
    """A way through the indentation of one drop that was solved in the phase plane: a `PlaneMotion` and an `Encounter` of one."""

    start: float
    end: float
    motion: PlaneMotion
    encounter: Encounter

    @property
    def duration(self) -> Floats:
        """How long it lasts [s], (1,)."""
        return self.motion.duration

    def grid(self) -> Floats:
        """Times since its start that draw the segment well [s]."""
        return self.motion.grid()

    def at(self, time: Floats) -> Motion:
        """Return the motion at times [s] since the start of the segment."""
        delta, velocity, lost = self.motion.at(time, self.encounter)
        return _in_contact(self.encounter, self.motion.start, delta, velocity, lost)


def _in_contact(encounter: Encounter, start: float, delta: Floats, velocity: Floats, lost: Floats) -> Motion:
    """Return the motion of one drop in contact, that began at an indentation [m], from its indentation, its rate and what is lost."""
    law = encounter.law
    elastic, dissipative = law.forces(delta, velocity, encounter.approach_speed)
    force = elastic + dissipative
    if law.tension == "cut":
        force = np.maximum(force, 0.0)
    return -delta, -velocity, force, law.elastic_energy(delta), lost, law.plastic_work(delta) - law.plastic_work(np.array([start]))


@dataclass(frozen=True)
class GlideSegment:
    """Free motion of one drop inside an indentation."""

    start: float
    end: float
    glide: Glide
    law: CompliantLaw

    @property
    def duration(self) -> Floats:
        """How long it lasts [s], (1,)."""
        return self.glide.duration

    def grid(self) -> Floats:
        """Times since its start that draw the segment well [s]."""
        return np.linspace(0.0, float(self.glide.duration[0]), 17)

    def at(self, time: Floats) -> Motion:
        """Return the motion at times [s] since the start of the segment."""
        delta, velocity = (part[:, 0] for part in self.glide.at(time[:, None]))
        stored = self.law.elastic_energy(delta)
        nothing = np.zeros_like(time)
        return -delta, -velocity, nothing, stored, self.law.elastic_energy(self.glide.delta) - stored, nothing


@dataclass(frozen=True)
class RestSegment:
    """The sphere at rest on the plate, in its static indentation."""

    start: float
    end: float
    sag: float
    weight: float
    stored: float

    def grid(self) -> Floats:
        """Times since its start that draw the segment well [s]."""
        return np.array([0.0, self.end - self.start])

    def at(self, time: Floats) -> Motion:
        """Return the motion at times [s] since the start of the segment."""
        same = np.ones_like(time)
        return -self.sag * same, 0.0 * same, self.weight * same, self.stored * same, 0.0 * same, 0.0 * same


Segment = FlightSegment | StretchSegment | PlaneSegment | GlideSegment | RestSegment
