"""The run of a batch of drops: flight, touch, contact and release, until a stop rule."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.law import CompliantLaw, ContactLaw, InstantaneousLaw
from vibroimpact.dynamics.bounce import Bounce
from vibroimpact.dynamics.contact import CAPTURED, FAILED, RIDING, Contact
from vibroimpact.dynamics.flight_in_fluid import FluidFlight
from vibroimpact.dynamics.impact_at_once import collide_at_once
from vibroimpact.dynamics.impact_conditions import ImpactConditions, impact_conditions_of
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion
from vibroimpact.dynamics.outcome import Outcome
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.progress import fraction_done
from vibroimpact.dynamics.run_state import RunState
from vibroimpact.dynamics.stop_rules import first_stops, stop_rules


class Run(RunState):
    """The run of B drops that the core does not follow from start to end."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self.stop_rules = stop_rules(self)

    def fraction_done(self) -> float:
        """Return the fraction of the run that is done, in [0, 1]."""
        moving = self.moving
        if not moving.any():
            return 1.0
        first_speed = self.rows.first["approach_speed_m_s"] if self.rows else self.velocity
        return fraction_done(
            self.problem,
            len(self.rows),
            float(self.time[moving].min()),
            first_speed[moving],
            self.velocity[moving],
            self.rest_speed[moving],
        )

    def advance(self) -> Bounce:
        """Advance all moving drops to their next touch and through one contact.

        Return both as a bounce.
        """
        drops = np.flatnonzero(self.moving)
        flight = self.flights(drops)
        touch, speed, motions = self.bodies.next_touch(drops, flight, self.law(drops))
        stopped, stop_time, outcome = first_stops(self.stop_rules, drops, flight, touch)
        self.end(drops[stopped], outcome[stopped], stop_time[stopped])
        touches = ~stopped
        flight_end = np.where(stopped, stop_time, touch)
        bounce = Bounce(drops, flight, flight_end, drops[touches], motions=motions)
        bounce = self.fly(bounce)
        if touches.any():
            bounce = self.collide(bounce, touch[touches], speed[touches])
        if isinstance(flight, FluidFlight):
            self.give_to_fluid(bounce, flight, touches)
        growth = self.bodies.growth(bounce)
        if growth.size:
            self.rows.last["sensitivity"][bounce.contact_drops] = growth
        return bounce

    def fly(self, bounce: Bounce) -> Bounce:
        """Advance drops to the end of their flights.

        Return the bounce with their motion along the plate.
        """
        drops = bounce.drops
        flight = bounce.flight
        self.bodies.pass_flight(drops, bounce.motions, bounce.flight_end - flight.start)
        if self.oblique is not None:
            bounce = replace(bounce, oblique=self.oblique.now(drops))
            self.oblique.fly(drops, flight, bounce.flight_end)
        self.gap[drops], self.velocity[drops] = flight.at(bounce.flight_end)
        self.time[drops] = bounce.flight_end
        self.ahead = None
        return bounce

    def give_to_fluid(self, bounce: Bounce, flight: FluidFlight, touches: Bools) -> None:
        """Account for the energy that drops gave to a fluid in their flights."""
        assert self.problem.fluid is not None
        mass = self.mass[bounce.drops]
        self.to_fluid[bounce.drops] += mass * flight.given(bounce.flight_end)
        if touches.any():
            lost = mass * flight.lost(bounce.flight_end)
            self.rows.last[f"{self.problem.fluid.key}_lost_J"][bounce.contact_drops] = lost[touches]

    def collide(self, bounce: Bounce, touch: Floats, speed: Floats) -> Bounce:
        """Solve the contact of drops, and write the row of the impact table.

        Return the bounce with the contact. `touch` [s], `speed` [m/s]: of the approach, of
        `bounce.contact_drops`.
        """
        drops = bounce.contact_drops
        law = self.law_at(drops, speed)
        row = self.rows.add()
        self.write_touch(drops, law, touch, speed, row)
        if isinstance(law, InstantaneousLaw):
            bounce, lost = collide_at_once(self, bounce, law, touch, speed, row)
        else:
            assert isinstance(law, CompliantLaw)
            closing = self.bodies.closing_speed(drops, speed, self.velocity[drops])
            conditions = impact_conditions_of(law, self.mass[drops], self.gravity[drops], closing)
            bounce, lost = self.solve_contact(bounce, conditions, touch, row)
            lost += row["plastic_work_J"][drops]
            law = self.problem.law_at(self.law(drops), speed)  # with its memory of this impact
        self.dissipated[drops] += lost - row["plastic_work_J"][drops]
        self.plastic[drops] += row["plastic_work_J"][drops]
        row["energy_lost_J"][drops] = lost
        self.write_rebound(drops, speed, row)
        if self.oblique is not None:
            self.leave_dents(drops, self.oblique, row)
        moving = self.moving[drops]
        if not moving.all():
            law = law.take(np.flatnonzero(moving))
        self.stop_resting(drops[moving], law, row)
        return bounce

    def write_touch(
        self, drops: Drops, law: ContactLaw, touch: Floats, speed: Floats, row: dict[str, Floats]
    ) -> None:
        """Write the columns of the touches of drops.

        `touch`: their times [s]. `speed`: their approach speeds [m/s].
        """
        row["impact"][drops] = len(self.rows)
        row["time_s"][drops] = touch
        row["approach_speed_m_s"][drops] = speed
        row["restitution_asked"][drops] = law.nominal_restitution
        if self.problem.motion is None:
            return
        _, surface_velocity, _ = self.problem.surface(touch)
        row["plate_velocity_m_s"][drops] = surface_velocity
        if self.oblique is not None:
            x, y = self.oblique.seen_from_plate(drops, touch)
            row["place_on_plate_x_m"][drops] = x
            row["place_on_plate_y_m"][drops] = y

    def write_rebound(self, drops: Drops, speed: Floats, row: dict[str, Floats]) -> None:
        """Write the restitution and the rebound of drops.

        `speed`: their approach speeds [m/s].
        """
        gravity = self.gravity[drops]
        velocity = self.velocity[drops]
        separation = row["separation_speed_m_s"][drops]
        row["restitution_achieved"][drops] = separation / speed
        rising = separation
        if self.problem.shaken:  # where it leaves, its velocity is not that relative to the plate
            leaves = ~self.bodies.rests(drops, velocity, self.rest_speed[drops])
            upward = np.maximum(velocity, 0.0) * leaves
            rising = np.where(np.isnan(separation), np.nan, upward)
        with np.errstate(divide="ignore", invalid="ignore"):
            rise = np.where(gravity > 0.0, 0.5 * rising**2 / gravity, np.nan)
        if self.problem.fluid is not None:
            _, apex = self.flights(drops).apex()
            rise = np.where(rising > 0.0, apex - self.gap[drops], rise)
        row["rebound_height_m"][drops] = self.radius[drops] + self.gap[drops] + rise

    def leave_dents(self, drops: Drops, oblique: ObliqueMotion, row: dict[str, Floats]) -> None:
        """Forget the dents of drops that touch next beyond the radius of their last contact."""
        if not self.memories:
            return
        flight = self.flights(drops)
        next_touch, _ = flight.touch(np.zeros(1))
        distance = oblique.distance(drops, flight, next_touch)
        indentation = np.nan_to_num(row["max_indentation_m"][drops])
        contact_radius = np.sqrt(self.radius[drops] * indentation)
        leaving = drops[distance > contact_radius]
        fresh = self.problem.laws[0].memories()
        for name, values in self.memories.items():
            # laws of earlier contacts refer to the previous array
            self.memories[name] = values.copy()
            self.memories[name][leaving] = self.spread(fresh[name])[leaving]

    def solve_contact(
        self, bounce: Bounce, conditions: ImpactConditions, touch: Floats, row: dict[str, Floats]
    ) -> tuple[Bounce, Floats]:
        """Return the bounce with the contact of drops, and the energy lost in it [J]."""
        drops = bounce.contact_drops
        longest_ride = self.run_end - touch
        contact, force, time_of_force = self.bodies.collide(
            drops,
            conditions,
            (self.gap[drops], self.velocity[drops]),
            (self.rest_speed[drops], longest_ride),
            row,
        )
        self.deepest[drops] = np.maximum(self.deepest[drops], contact.max_delta)
        self.time[drops] = touch + contact.duration
        self.gap[drops] = -contact.final_delta
        self.velocity[drops] = -contact.final_rate
        for name, values in contact.law.memories().items():
            # laws of earlier contacts refer to the previous array
            self.memories[name] = self.memories[name].copy()
            self.memories[name][drops] = values
        row["duration_s"][drops] = contact.duration
        row["plastic_work_J"][drops] = contact.plastic
        row["max_indentation_m"][drops] = contact.max_delta
        row["time_of_max_indentation_s"][drops] = touch + contact.time_of_max_delta
        row["max_force_N"][drops] = force
        row["time_of_max_force_s"][drops] = touch + time_of_force
        row["max_acceleration_m_s2"][drops] = np.maximum(
            force / conditions.mass - conditions.gravity, conditions.gravity
        )
        stays = self.release(drops, contact, row)
        bounce = replace(bounce, contact=contact, conditions=conditions)
        if self.oblique is not None:
            bounce = replace(bounce, oblique_contacts=self.bodies.slide(self.oblique, bounce, row))
        # what a contact stores at its end is lost with it
        return bounce, contact.dissipated + np.where(stays, 0.0, contact.stored)

    def release(self, drops: Drops, contact: Contact, row: dict[str, Floats]) -> Bools:
        """Write the separation of drops after a contact, and end the runs of those that stay.

        Return which stay in contact.
        """
        failed = contact.outcome == FAILED
        riding = contact.outcome == RIDING
        captured = contact.outcome == CAPTURED
        captured |= self.bodies.falls_back(contact, self.next_law(drops), self.gravity[drops])
        separation = self.bodies.rigid_speed(drops, -contact.final_rate)
        separation = np.where(captured, 0.0, separation)
        row["separation_speed_m_s"][drops] = np.where(failed | riding, np.nan, separation)
        energy_at_release = contact.law.elastic_energy(
            contact.law.release_level + np.zeros(len(drops))
        )
        sticks = captured & (energy_at_release > 0.0)
        at_end = riding & (self.time[drops] >= self.run_end)
        for ended, outcome in (
            (failed, Outcome.FAILED),
            (captured & ~sticks, Outcome.CAPTURED),
            (sticks, Outcome.STUCK),
            (riding & ~at_end, Outcome.RIDING),
            (at_end, Outcome.DURATION),
        ):
            self.stop(drops[ended], outcome, self.time[drops[ended]])
        if captured.any():
            law = contact.law.take(np.flatnonzero(captured))
            resting = drops[captured]
            self.bring_to_rest(resting, law, self.time[resting], contact.stored[captured])
        self.stored[drops[riding]] = contact.stored[riding]
        return np.asarray(captured | riding)

    @property
    def run_end(self) -> float:
        """Time at which the run ends at the latest [s]."""
        return np.inf if self.problem.duration is None else self.problem.duration

    def stop_resting(self, drops: Drops, law: ContactLaw, row: dict[str, Floats]) -> None:
        """Stop the drops that rest: they separate slowly or not at all, and stay so.

        They separate more slowly than the rest speed, and cannot be lifted again.
        """
        resting = self.bodies.rests(drops, self.velocity[drops], self.rest_speed[drops])
        slow = drops[resting]
        if not slow.size:
            return
        time = self.time[slow]
        _, surface_velocity, _ = self.problem.surface(time)
        speed = self.velocity[slow] - surface_velocity
        # flights are a geometric series with the ratio of the last restitution e, whose sum is that
        # of the first, 2 v/g, over 1 - e
        missing = 1.0 - row["restitution_achieved"][slow]
        with np.errstate(divide="ignore", invalid="ignore"):
            first_flight = 2.0 * speed * self.inertia[slow] / self.gravity[slow]
            limit = time + first_flight / np.where(missing > 1e-6, missing, 0.0)
        self.bring_to_rest(slow, law.take(np.flatnonzero(resting)), limit, np.zeros(len(slow)))
        self.stop(slow, Outcome.REST_SPEED, np.where(np.isfinite(limit), limit, time))
