"""A drop that waits for what the core does not know: before each flight, and at each touch.

That is a flight through air or a liquid, the place on the plate where it ends, a law that depends
on the speed of touch, and friction.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.bodies.ball import mean_density
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.core import drop_records as records
from vibroimpact.dynamics.core.drop_records import FreeFall
from vibroimpact.dynamics.core.stop_rules import first_end
from vibroimpact.dynamics.core.surface_friction_records import SlidingSphere
from vibroimpact.dynamics.core.vibrating_drops import write_flight
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.motion.flight_in_fluid import FluidFlight, flight_of
from vibroimpact.dynamics.motion.impact_conditions import impact_conditions_of
from vibroimpact.dynamics.motion.law_coefficients import coefficients_of
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion, motion_along
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.drop_system import system_of
from vibroimpact.dynamics.vibrating.fluid_motion import free_motion
from vibroimpact.dynamics.vibrating.followed_drop import FollowedDrop
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem
from vibroimpact.dynamics.vibrating.next_touch import next_touch
from vibroimpact.dynamics.vibrating.recorded_drop import Flown, RecordedDrop
from vibroimpact.dynamics.vibrating.sliding_contact import SlidingContact, sliding_contact
from vibroimpact.dynamics.vibrating.surface_friction import (
    NO_FRICTION,
    surface_friction_at_touch,
)

_SAME_POSITION = 1e-12
"""Distance of positions on the plate at which the contact is the same [m]."""

_MOST_POSITIONS = 8
"""Number of corrections of the position where a sphere touches a plate that deflects."""


class WaitingDrop(FollowedDrop):
    """One drop that is told its flights, and its law and friction at touch.

    `oblique`: its motion along the plate, if there is any, and `sliding` that in its impacts.
    `flown`: its flights. `to_fluid`: energy that it gave to a fluid so far [J].
    """

    waits = True

    def __init__(self, problem: Problem, system: LinearSystem, stated_mass: float) -> None:
        self.flown: list[Flown] = []
        self.sliding: list[SlidingContact] = []
        self.to_fluid = 0.0
        self._asked: list[float] = []
        self.oblique = motion_along(problem)
        self._stated_mass = stated_mass
        super().__init__(problem, system, stated_mass)
        self._liquid_at_start = self.energy_of_liquid()

    def first_flight(self) -> Flight:
        """Return the flight from the start."""
        flight = super().first_flight()
        return self._flight(0.0, float(flight.gap[0]), float(flight.velocity[0]))

    def first_touch(self) -> float:
        """Return the time of the first touch [s], from the start; infinite if there is none."""
        level = float(self._next_law(0.0).touch_level)
        return self._to_touch(self.first_flight(), level)[1]

    def go_on(self, one_impact: bool) -> None:
        """Follow the drop to its next touch, or through its impact."""
        phase = self.now.phase
        if phase == records.IN_FLIGHT:
            self._fly()
            return
        if phase == records.AT_TOUCH:
            self._touch_down()
        before = self.impacts
        super().go_on(one_impact=True)
        if self.impacts > before:
            self._note_impacts()
            self._leave()

    # flight
    # -------------------------------------------------------------------------------------

    def _flight(self, start: float, gap: float, velocity: float) -> Flight:
        """Return the flight of the sphere from a time [s], a gap [m] and a velocity [m/s] on."""
        along = np.zeros((0, 1))
        if self.oblique is not None:
            along = self.oblique.state.velocity
        return flight_of(
            self.problem, np.array([start]), np.array([gap]), np.array([velocity]), along
        )

    def _fly(self) -> None:
        """Let the drop fly to its next touch, or until a rule ends its run."""
        drop = self.drop
        numbers = drop.state
        start = self.time
        flight = self._flight(start, float(numbers[records.GAP]), float(numbers[records.VELOCITY]))
        law = self._next_law(float(numbers[records.CLOSING]))
        motion, elapsed = self._to_touch(flight, float(law.touch_level))
        touch = start + elapsed
        top = float(flight.apex()[0][0])
        is_beside = False
        along = None
        if self.oblique is not None:
            is_beside = self.oblique.is_beside(flight, touch)
            along = self.oblique.sphere, self.oblique.state
        fall = FreeFall(start, top, touch, 0.0, is_beside)
        end, ending = first_end(self.manner.stops, fall, self.impacts)
        time = min(end, touch)
        after = motion.state_after(time - start)
        record = self.system.record_of(0)
        write_flight(record, drop, motion.start.record, after.record, time)
        self.flown.append(Flown(flight, motion, along))
        if self.oblique is not None:
            self.oblique.fly(flight, np.array([time]))
        phase = records.AT_TOUCH
        if touch >= end:
            phase = ending
            numbers[records.END_TIME] = end
        self._give_to_fluid(flight, time, touches=phase == records.AT_TOUCH)
        self.now = self.now._replace(phase=phase, state=after.record)

    def _give_to_fluid(self, flight: Flight, time: float, *, touches: bool) -> None:
        """Take account of the energy that a flight up to a time [s] gave to a fluid."""
        row: dict[str, float] = {}
        if isinstance(flight, FluidFlight):
            assert self.problem.fluid is not None
            mass = float(self.problem.sphere.mass)
            self.to_fluid += mass * float(flight.given(np.array([time]))[0])
            lost = mass * float(flight.lost(np.array([time]))[0])
            row[f"{self.problem.fluid.key}_lost_J"] = lost
        if touches:
            self.rows.append(row)

    def _to_touch(self, flight: Flight, level: float) -> tuple[FreeMotion, float]:
        """Return the free motion of the bodies, and the time until the surfaces touch [s].

        They touch where the sphere is over the plate at that time. `level`: gap at touch with sign
        reversed [m].
        """
        problem = self.problem
        if self.oblique is None or problem.at_place is None or problem.plate_at_place is None:
            motion = self._free(flight)
            return motion, next_touch(motion, level, np.inf)
        time = float((flight.touch(np.zeros(1))[0] - flight.start)[0])
        position = self._over_plate(flight, time)
        # a fixed-point iteration: the deflection of the plate where the sphere falls changes the
        # time a little, and the time the position
        for _ in range(_MOST_POSITIONS):
            contact_point = position
            plate = problem.plate_at_place(contact_point)
            self._put_contact(problem.on_plate(plate, problem.quasi_static))
            time = next_touch(self._free(flight), level, np.inf)
            if not np.isfinite(time):
                break
            previous = position
            position = self._over_plate(flight, time)
            moved = abs(position[0] - previous[0]), abs(position[1] - previous[1])
            if max(moved) <= _SAME_POSITION:
                break
        self._put_contact(problem.at_place(contact_point))
        return self._free(flight), time

    def _free(self, flight: Flight) -> FreeMotion:
        """Return the free motion of the bodies while the sphere is on a flight."""
        return free_motion(self.system, self.state, flight)

    def _over_plate(self, flight: Flight, time: float) -> tuple[float, float]:
        """Return where the sphere is over the plate at a time since the start of a flight [s]."""
        assert self.oblique is not None
        return self.oblique.place_on_plate(flight, flight.start + time)

    def _put_contact(self, problem: Problem) -> None:
        """Move the contact to the position on the plate for which a problem is stated."""
        mass = float(problem.sphere.mass)
        gravity = float(problem.net_gravity)
        # all drops have what drives the plate in common, and with it the mass of the first
        system = system_of(problem, self._stated_mass, gravity)
        self.system = system.with_sphere(mass**-0.5, gravity * mass**0.5)
        self.series = problem.quasi_static
        self.manner = self.manner._replace(series=self.series.coefficients)

    # contact
    # -------------------------------------------------------------------------------------

    def law_of(self, impact: int, speed: float, dent: float) -> CompliantLaw:
        """Return the law of an impact; its restitution is what a liquid leaves of it."""
        law = super().law_of(impact, speed, dent)
        problem = self.problem
        if problem.liquid is None:
            return law
        radius = np.array([float(problem.sphere.contact_offset)])
        density = mean_density(np.array([float(problem.sphere.mass)]), radius)
        around = problem.liquid.around(law, np.array([speed]), radius, density)
        assert isinstance(around, CompliantLaw)
        return around.take(0)

    def _next_law(self, speed: float) -> CompliantLaw:
        """Return the law of the next impact at an approach speed [m/s]."""
        return self.law_of(self.impacts, speed, float(self.drop.state[records.DENT]))

    def _touch_down(self) -> None:
        """Give the drop its law at the speed of its touch, and its friction."""
        law = self._next_law(float(self.drop.state[records.CLOSING]))
        self.drop.coefficients[:] = self.held.enter_context(coefficients_of(law, 1))[0]
        self._asked.append(float(np.ravel(law.nominal_restitution)[0]))
        self.sphere = self._friction_at_touch(law)
        if self.problem.motion is not None and self.oblique is not None:
            self.rows[-1] |= self.oblique.seen_from_plate(np.array([self.time]))

    def _friction_at_touch(self, law: CompliantLaw) -> SlidingSphere:
        """Return the friction at first touch."""
        if self.oblique is None or self.oblique.law is None:
            return NO_FRICTION
        friction = self.oblique.law
        if not isinstance(friction, CompliantFriction):
            return NO_FRICTION
        # at the depth of a contact of rigid bodies
        closing = self.system.outer_rates(self.state)
        mass = self.drop.state[[records.MASS]]
        conditions = impact_conditions_of(law, mass, self.drop.state[[records.GRAVITY]], closing)
        force, _ = law.forces(conditions.depth, np.zeros(1), closing)
        along = self.system.along
        assert along is not None  # there is friction
        return surface_friction_at_touch(
            friction, float(force[0]), self.oblique.sphere, self.oblique.state, len(along)
        )

    def _leave(self) -> None:
        """Take account of what the core does not know of an impact that has ended."""
        row = self.drop.rows[self.impacts - 1]
        if self.oblique is not None:
            self._leave_along(self.oblique, row)
        if self.problem.fluid is not None:
            self._rise_in_fluid(row)

    def _leave_along(self, oblique: ObliqueMotion, row: Floats) -> None:
        """Put the drop into its motion along the plate after an impact, and write its columns."""
        impact = self.impacts - 1
        sliding = sliding_contact(oblique, self.recorded, impact, float(row[records.DURATION]))
        self.sliding.append(sliding)
        after, lost, microslip = sliding.end
        self.rows[-1] |= oblique.finish(
            after, float(lost[0]), float(microslip[0]), float(row[records.SEPARATION])
        )
        if self.problem.memory_lasts:
            self._leave_dent(oblique, row)

    def _rise_in_fluid(self, row: Floats) -> None:
        """Write how high a drop rises through a fluid."""
        numbers = self.drop.state
        gap = float(numbers[records.GAP])
        if self.now.phase >= 0 or not numbers[records.VELOCITY] > 0.0:
            return
        flight = self._flight(self.time, gap, float(numbers[records.VELOCITY]))
        row[records.REBOUND] = numbers[records.RADIUS] + float(flight.apex()[1][0])

    def _leave_dent(self, oblique: ObliqueMotion, row: Floats) -> None:
        """Forget the dent where the drop touches next beyond the radius of its last contact."""
        numbers = self.drop.state
        flight = self._flight(
            self.time, float(numbers[records.GAP]), float(numbers[records.VELOCITY])
        )
        touch, _ = flight.touch(np.zeros(1))
        distance = oblique.distance(flight, touch)
        indentation = float(np.nan_to_num(row[records.INDENTATION]))
        if distance > np.sqrt(numbers[records.RADIUS] * indentation):
            numbers[records.DENT] = 0.0

    # what is told of it
    # --------------------------------------------------------------------------------------

    def restitutions_asked(self) -> list[float]:
        """Return the restitution asked of each impact."""
        return self._asked[: self.impacts]

    def recording(self) -> RecordedDrop:
        """Return its flights and impacts."""
        return replace(super().recording(), flown=self.flown, sliding=self.sliding)

    def lie_along(self, end: float) -> float:
        """Let a drop at rest lie on the plate until the end of its run, and return that [s].

        It may leave the plate over an edge before.
        """
        assert self.oblique is not None  # it moves along the plate
        if not self.is_at_rest:
            return end
        pressing = self.drop.state[[records.GRAVITY]]
        elapsed = np.array([max(end - self.time, 0.0)])
        lain = float(self.oblique.lie(pressing, elapsed)[0])
        return min(end, self.time + lain)

    def energies_along(self) -> dict[str, float]:
        """Return the entries of the motion along the plate in the energy ledger [J]."""
        assert self.oblique is not None  # it moves along the plate
        return self.oblique.energies()

    def energy_of_liquid(self) -> float:
        """Return the kinetic energy of the liquid that moves along with the sphere [J]."""
        _, velocity = self.centre()
        square = velocity**2
        if self.oblique is not None:
            square += float((self.oblique.state.velocity**2).sum())
        inertia = float(self.problem.flight_inertia)
        return 0.5 * float(self.problem.sphere.mass) * (inertia - 1.0) * square

    def energy_along(self) -> float:
        """Return the kinetic energy along the plate and of the spin [J]."""
        if self.oblique is None:
            return 0.0
        energies = self.oblique.energies()
        return energies["kinetic_J"] + energies["rotation_J"]

    def energy_to_fluid(self) -> float:
        """Return the energy that a fluid has taken [J]."""
        return self.to_fluid + self._liquid_at_start - self.energy_of_liquid()

    def taken_by_friction(self) -> tuple[float, float]:
        """Return the energy that friction took, and the part of it in microslip [J]."""
        if self.oblique is None:
            return 0.0, 0.0
        return self.oblique.lost, self.oblique.microslip
