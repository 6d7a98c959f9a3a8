"""A drop that waits for what the core does not know: before each flight, and at each touch.

That is a flight through air or a liquid, the place on the plate where it ends, a law that depends
on the speed of touch, and friction.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.core import drop_records as records
from vibroimpact.dynamics.core.surface_friction_records import SlidingSphere
from vibroimpact.dynamics.core.vibrating_drops import write_flight
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.motion.impact_conditions import impact_conditions_of
from vibroimpact.dynamics.motion.law_coefficients import coefficients_of
from vibroimpact.dynamics.motion.run_rules import start_of
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion
from vibroimpact.dynamics.oblique.told_flights import ToldFlights
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

    `told`: its flights, with any motion along the plate, and `sliding` that in its impacts.
    `flown`: the flights that it has made.
    """

    waits = True

    def __init__(self, problem: Problem, system: LinearSystem, stated_mass: float) -> None:
        self.flown: list[Flown] = []
        self.sliding: list[SlidingContact] = []
        self.told = ToldFlights(problem, start_of(problem)[1])
        self.oblique = self.told.oblique
        self._asked: list[float] = []
        self._stated_mass = stated_mass
        super().__init__(problem, system, stated_mass)

    def first_flight(self) -> Flight:
        """Return the flight from the start."""
        gap, velocity = start_of(self.problem)
        return self.told.next(0.0, gap, velocity)

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

    def _next_flight(self) -> Flight:
        """Return the flight that the sphere is about to make."""
        numbers = self.drop.state
        gap = float(numbers[records.GAP])
        return self.told.next(self.time, gap, float(numbers[records.VELOCITY]))

    def _fly(self) -> None:
        """Let the drop fly to its next touch, or until a rule ends its run."""
        start = self.time
        flight = self._next_flight()
        law = self._next_law(float(self.drop.state[records.CLOSING]))
        motion, elapsed = self._to_touch(flight, float(law.touch_level))
        time, phase = self.told.end_of(flight, start + elapsed, self.impacts)
        after = motion.state_after(time - start)
        write_flight(
            self.system.record_of(0),
            self.drop,
            self.recorded.parts,
            motion.start.record,
            after.record,
            time,
        )
        along = None
        if self.oblique is not None:
            along = self.oblique.sphere, self.oblique.state
        self.flown.append(Flown(flight, motion, along))
        row = self.told.fly(flight, time)
        if phase == records.AT_TOUCH:
            self.rows.append(row)
        else:
            self.drop.state[records.END_TIME] = time
        self.now = self.now._replace(phase=phase, state=after.record)

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
        separates = self.now.phase < 0 or self.now.phase == records.END_BY_REST_SPEED
        if separates and numbers[records.VELOCITY] > 0.0:
            top = float(self._next_flight().apex()[1][0])
            row[records.REBOUND] = numbers[records.RADIUS] + top

    def _leave_dent(self, oblique: ObliqueMotion, row: Floats) -> None:
        """Forget the dent where the drop touches next beyond the radius of its last contact."""
        numbers = self.drop.state
        flight = self._next_flight()
        touch, _ = flight.touch(np.zeros(1))
        indentation = float(np.nan_to_num(row[records.INDENTATION]))
        contact_radius = np.sqrt(numbers[records.RADIUS] * indentation)  # Hertz: a^2 = R delta
        if oblique.distance(flight, touch) > contact_radius:
            numbers[records.DENT] = 0.0

    # what is told of it
    # --------------------------------------------------------------------------------------

    def restitutions_asked(self) -> list[float]:
        """Return the restitution asked of each impact."""
        return self._asked[: self.impacts]

    def recording(self) -> RecordedDrop:
        """Return its flights and impacts."""
        return replace(super().recording(), flown=self.flown, sliding=self.sliding)

    def energy_at_start(self) -> float:
        """Return the energy beside that of the fall [J], before any flight."""
        return self.told.energy_at_start()

    def end_along(self, end: float) -> float:
        """Let a drop at rest lie on the plate until the end of its run, and return that [s].

        It may leave the plate over an edge before.
        """
        if self.oblique is None or not self.is_at_rest:
            return end
        pressing = self.drop.state[[records.GRAVITY]]
        elapsed = np.array([max(end - self.time, 0.0)])
        lain = float(self.oblique.lie(pressing, elapsed)[0])
        return min(end, self.time + lain)

    def further_entries(self) -> dict[str, float]:
        """Return what is added to the entries of the energy ledger [J]."""
        return self.told.entries(self.centre()[1])

    def taken_by_friction(self) -> tuple[float, float]:
        """Return the energy that friction took, and the part of it in microslip [J]."""
        if self.oblique is None:
            return 0.0, 0.0
        return self.oblique.lost, self.oblique.microslip
