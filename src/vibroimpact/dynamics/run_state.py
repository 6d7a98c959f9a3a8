"""The state of a run: positions, motions and losses of its drops, and how they ended."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Drops, Floats, Integers
from vibroimpact.bodies.ball import mean_density
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.columns import (
    CARRIED_IMPACT_COLUMNS,
    OBLIQUE_IMPACT_COLUMNS,
    SHAKEN_IMPACT_COLUMNS,
)
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.flight_in_fluid import FluidFlight
from vibroimpact.dynamics.impact_rows import ImpactRows
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion
from vibroimpact.dynamics.outcome import Outcome
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.rigid.rigid_bodies import RigidBodies
from vibroimpact.dynamics.run_bodies import Bodies

_APART = 4e-15  # of the amplitude of a shaken plate: the rounding error of its place


class RunState:
    """State of a batch of B drops between impacts; arrays are (B,)."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.size = int(np.prod(problem.shape))
        self.mass = self.spread(problem.sphere.mass)
        self.radius = self.spread(problem.sphere.contact_offset)
        self.gravity = self.spread(problem.net_gravity)
        self.inertia = self.spread(problem.flight_inertia)
        self.time = np.zeros(self.size)
        self.gap, self.velocity = self._start()
        self.oblique = self._motion_along_plate()
        # flights whose tops have been computed already
        self.ahead: tuple[Drops, FluidFlight] | None = None

        self.liquid_at_start = self.energy_of_liquid(self.velocity)
        self.energy_in = self.mechanical_energy() + self.liquid_at_start
        if self.oblique is not None:
            self.energy_in = sum(self.oblique.energies(), self.energy_in)
        self.dissipated = np.zeros(self.size)
        self.plastic = np.zeros(self.size)
        self.to_fluid = np.zeros(self.size)
        self.deepest = np.zeros(self.size)

        self.moving = np.ones(self.size, dtype=bool)
        self.outcomes = np.full(self.size, Outcome.FAILED.code)
        self.end_time = np.full(self.size, np.nan)
        self.rest_time = np.full(self.size, np.nan)
        self.sag = np.zeros(self.size)
        self.stored = np.zeros(self.size)
        self.written_off = np.zeros(self.size)
        if problem.rest_speed is None:
            self.rest_speed = self.default_rest_speed()
        else:
            self.rest_speed = self.spread(problem.rest_speed)
        self.bodies = self._bodies()
        self.memories = {
            name: self.spread(value) for name, value in problem.laws[0].memories().items()
        }
        self.rows = ImpactRows((*self.bodies.columns, *self._further_columns()), self.size)

    def _start(self) -> tuple[Floats, Floats]:
        """Return gaps [m] and velocities upwards [m/s] at the start."""
        problem = self.problem
        if problem.height is not None:
            return self.spread(problem.height) - self.radius, self.spread(problem.velocity)
        # at touch: apart by the rounding error of the place of a plate that is shaken
        gap = (
            np.zeros(self.size)
            + problem.surface(0.0)[0]
            + _APART * np.abs(problem.surface_phasors).sum()
        )
        return gap, -self.spread(problem.speed)

    def _motion_along_plate(self) -> ObliqueMotion | None:
        """Return the motion along the plate, if there is any."""
        problem = self.problem
        if problem.oblique is None:
            return None
        oblique = problem.oblique.with_weight(problem.net_weight)
        return ObliqueMotion(
            oblique,
            self.mass,
            self.radius,
            self.spread(problem.sphere_inertia),
            problem.motion,
            problem.tolerance,
        )

    def _bodies(self) -> Bodies:
        """Return the bodies of the problem."""
        # a drop of rigid bodies does not load what vibrates
        if self.problem.vibrates:
            from vibroimpact.dynamics.vibrating.vibrating_bodies import VibratingBodies

            return VibratingBodies(self.problem, self.mass, self.gravity, self.oblique)
        if self.problem.shaken:
            from vibroimpact.dynamics.shaken.shaken_bodies import ShakenBodies

            return ShakenBodies(self.problem, self.mass, self.gravity)
        return RigidBodies(self.size, self.problem.tolerance)

    def _further_columns(self) -> list[str]:
        """Return the columns that the impact table has beside those of the bodies."""
        columns: list[str] = []
        if self.problem.motion is not None:
            columns.extend(SHAKEN_IMPACT_COLUMNS)
        if self.oblique is not None:
            columns.extend(OBLIQUE_IMPACT_COLUMNS)
            if self.problem.motion is not None:
                columns.extend(CARRIED_IMPACT_COLUMNS)
        if self.problem.fluid is not None:
            columns.append(f"{self.problem.fluid.key}_lost_J")
        return columns

    def spread(self, value: object) -> Floats:
        """Return a value of the problem as an array with one entry per drop."""
        return np.array(np.broadcast_to(np.asarray(value, dtype=float), (self.size,)))

    def mechanical_energy(self) -> Floats:
        """Return the kinetic and potential energy [J]."""
        return np.asarray(self.mass * (0.5 * self.velocity**2 + self.gravity * self.gap))

    def energy_of_liquid(self, velocity: Floats) -> Floats:
        """Return the kinetic energy of the liquid that moves along with the spheres [J].

        `velocity`: of these along the normal [m/s].
        """
        squares = velocity**2 + (
            0.0 if self.oblique is None else (self.oblique.state.velocity**2).sum(axis=0)
        )
        return np.asarray(0.5 * self.mass * (self.inertia - 1.0) * squares)

    def default_rest_speed(self) -> Floats:
        """Return the speed from which a drop would rise by its static indentation [m/s].

        It is at least 1e-6 of the first approach speed.
        """
        law = self.problem.law_of(0)
        least = 1e-6 * self.flights(np.arange(self.size)).touch(np.zeros(1))[1]
        if not isinstance(law, CompliantLaw):
            return np.asarray(least)
        sag = static_indentation(law, self.mass * self.gravity) - law.touch_level
        return np.asarray(np.maximum(np.sqrt(2.0 * self.gravity * sag), least))

    def law(self, drops: Drops) -> ContactLaw:
        """Return the law of the next impact of drops, with their memory of the last one."""
        law = self.problem.law_of(len(self.rows))
        if self.problem.memory_lasts:
            law = law.changed(self.memories)
        return law if len(drops) == self.size else law.take(drops)

    def law_at(self, drops: Drops, speed: Floats) -> ContactLaw:
        """Return the law of the next impact of drops at an approach speed [m/s].

        Its restitution is what a liquid leaves of it.
        """
        law = self.problem.law_at(self.law(drops), speed)
        if self.problem.liquid is None:
            return law
        radius = self.radius[drops]
        density = mean_density(self.mass[drops], radius)
        return self.problem.liquid.take(drops).around(law, speed, radius, density)

    def flights(self, drops: Drops) -> Flight:
        """Return the flights that drops are about to make."""
        fluid = self.problem.fluid
        start = self.time[drops]
        gap = self.gap[drops]
        velocity = self.velocity[drops]
        gravity = self.gravity[drops] / self.inertia[drops]
        if fluid is None:
            return Flight(start, gap, velocity, gravity)
        if self.ahead is None or not np.array_equal(self.ahead[0], drops):
            along = np.zeros((0, len(drops)))
            pull = np.zeros((0, len(drops)))
            if self.oblique is not None:
                along, pull = self.oblique.pulled(drops)
            radius = self.radius[drops]
            flights = FluidFlight(
                start,
                gap,
                velocity,
                gravity,
                radius,
                mean_density(self.mass[drops], radius),
                fluid.take(drops),
                (along, pull / self.inertia[drops]),
            )
            self.ahead = drops, flights
        return self.ahead[1]

    def next_law(self, drops: Drops) -> CompliantLaw:
        """Return the law under which drops will touch next."""
        law = self.law(drops)
        assert isinstance(law, CompliantLaw)
        return law

    def bring_to_rest(self, drops: Drops, law: ContactLaw, time: Floats, stored: Floats) -> None:
        """Put drops that have come to rest into their static indentation.

        The contact has an energy `stored` [J].
        """
        weight = self.mass[drops] * self.gravity[drops]
        energy = self.mechanical_energy()[drops] + stored
        self.rest_time[drops] = time
        for name, values in self.bodies.static_state(drops, law, weight, energy).items():
            getattr(self, name)[drops] = values

    def stop(self, drops: Drops, outcome: Outcome, time: Floats) -> None:
        """End the run of drops with one outcome, at some times [s]."""
        if drops.size:
            self.end(drops, np.full(len(drops), outcome.code), time)

    def end(self, drops: Drops, outcome: Integers, time: Floats) -> None:
        """End the run of drops, with outcomes by their codes, at some times [s]."""
        self.moving[drops] = False
        self.end_time[drops] = time
        self.outcomes[drops] = outcome
