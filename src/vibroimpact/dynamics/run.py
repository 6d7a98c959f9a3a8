"""The run of a batch of drops: flight, touch, contact and release, until a stop rule."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Drops, Floats
from vibroimpact.bodies.ball import mean_density
from vibroimpact.contact.law import CompliantLaw, ContactLaw, InstantaneousLaw
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.bodies import Bodies
from vibroimpact.dynamics.columns import CARRIED_IMPACT_COLUMNS, OBLIQUE_IMPACT_COLUMNS, SHAKEN_IMPACT_COLUMNS
from vibroimpact.dynamics.contact import CAPTURED, FAILED, RIDING
from vibroimpact.dynamics.encounter import Encounter, encounter_of
from vibroimpact.dynamics.energy import CLOSURE_LIMIT, WRITE_OFF_LIMIT, close_ledger
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.flight_in_fluid import FluidFlight
from vibroimpact.dynamics.impact_rows import ImpactRows
from vibroimpact.dynamics.leg import Leg
from vibroimpact.dynamics.oblique.motion import ObliqueMotion
from vibroimpact.dynamics.outcome import OUTCOMES, Outcome
from vibroimpact.dynamics.problem import MOST_IMPACTS, Problem
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.rest import Rest
from vibroimpact.dynamics.rigid.bodies import RigidBodies
from vibroimpact.dynamics.rigid.solve_contact import SolvesContact


class Run:
    """State of a batch of B drops between impacts; arrays are (B,). `solve_contact`: solver of contacts of rigid bodies."""

    def __init__(self, problem: Problem, solve_contact: SolvesContact) -> None:
        self.problem = problem
        self.size = int(np.prod(problem.shape))
        self.mass, self.radius = self.spread(problem.sphere.mass), self.spread(problem.sphere.contact_offset)
        self.gravity, self.inertia = self.spread(problem.net_gravity), self.spread(problem.flight_inertia)
        self.time, self.gap, self.velocity = np.zeros(self.size), np.zeros(self.size), np.zeros(self.size)
        if problem.height is not None:
            self.gap, self.velocity = self.spread(problem.height) - self.radius, self.spread(problem.velocity)
        else:
            self.velocity = -self.spread(problem.speed)
            # at touch: apart by the rounding error of the place of a plate that is shaken
            self.gap = self.gap + problem.surface(0.0)[0] + 4e-15 * np.abs(problem.surface_phasors).sum()
        self.oblique = None
        if problem.oblique is not None:
            inertia = self.spread(problem.sphere_inertia)
            self.oblique = ObliqueMotion(problem.oblique.with_weight(problem.net_weight), self.mass, self.radius, inertia, problem.motion)
        self.ahead: tuple[Drops, FluidFlight] | None = None  # flights whose tops have been computed already
        self.liquid_at_start = self.energy_of_liquid(self.velocity)
        self.energy_in = self.mechanical_energy() + self.liquid_at_start
        if self.oblique is not None:
            self.energy_in = sum(self.oblique.energies(), self.energy_in)
        self.dissipated, self.plastic, self.deepest, self.to_fluid = (np.zeros(self.size) for _ in range(4))
        self.moving = np.ones(self.size, dtype=bool)
        self.outcomes = np.full(self.size, Outcome.FAILED.code)
        self.end_time, self.rest_time = np.full(self.size, np.nan), np.full(self.size, np.nan)
        self.sag, self.stored, self.written_off = np.zeros(self.size), np.zeros(self.size), np.zeros(self.size)
        self.rest_speed = self.default_rest_speed() if problem.rest_speed is None else self.spread(problem.rest_speed)
        self.bodies = self.moving_bodies(solve_contact) if problem.vibrates or problem.shaken else RigidBodies(self.size, solve_contact)
        self.memories = {name: self.spread(value) for name, value in problem.laws[0].memories().items()}
        further = (
            *(() if problem.motion is None else SHAKEN_IMPACT_COLUMNS),
            *(() if self.oblique is None else OBLIQUE_IMPACT_COLUMNS),
            *(() if self.oblique is None or problem.motion is None else CARRIED_IMPACT_COLUMNS),
            *(() if problem.fluid is None else [f"{problem.fluid.key}_lost_J"]),
        )
        self.rows = ImpactRows((*self.bodies.columns, *further), self.size)

    def moving_bodies(self, solve_contact: SolvesContact) -> Bodies:
        """Return the bodies of the problem, of which one vibrates or is shaken."""
        # a drop of rigid bodies does not load what vibrates
        if not self.problem.vibrates:
            from vibroimpact.dynamics.shaken.bodies import ShakenBodies

            return ShakenBodies(self.problem, self.mass, self.gravity, solve_contact)
        from vibroimpact.dynamics.vibrating.bodies import VibratingBodies

        return VibratingBodies(self.problem, self.mass, self.gravity, self.oblique)

    def spread(self, value: object) -> Floats:
        """Return a value of the problem as an array with one entry per drop."""
        return np.array(np.broadcast_to(np.asarray(value, dtype=float), (self.size,)))

    def mechanical_energy(self) -> Floats:
        """Return the kinetic and potential energy [J]."""
        return np.asarray(self.mass * (0.5 * self.velocity**2 + self.gravity * self.gap))

    def energy_of_liquid(self, velocity: Floats) -> Floats:
        """Return the kinetic energy of the liquid that moves along with the spheres [J], at their velocities along the normal [m/s]."""
        squares = velocity**2 + (0.0 if self.oblique is None else (self.oblique.state.velocity**2).sum(axis=0))
        return np.asarray(0.5 * self.mass * (self.inertia - 1.0) * squares)

    def default_rest_speed(self) -> Floats:
        """Return the speed from which a drop would rise by its static indentation [m/s], at least 1e-6 of the first approach speed."""
        law = self.problem.law_of(0)
        least = 1e-6 * self.flights(np.arange(self.size)).touch(np.zeros(1))[1]
        if not isinstance(law, CompliantLaw):
            return np.asarray(least)
        sag = static_indentation(law, self.mass * self.gravity) - law.touch_level
        return np.asarray(np.maximum(np.sqrt(2.0 * self.gravity * sag), least))

    def fraction_done(self) -> float:
        """Return the fraction of the run that is done, in [0, 1]."""
        if not self.moving.any():
            return 1.0
        done = len(self.rows) / (self.problem.impacts or MOST_IMPACTS)
        if self.problem.duration is not None:
            done = max(done, float(self.time[self.moving].min()) / self.problem.duration)
        # up to rest: the logarithm of the speed falls about linearly
        if self.problem.impacts is None and self.rows and not self.problem.shaken:
            first = self.rows.first["approach_speed_m_s"][self.moving]
            slowed = np.log(first / self.velocity[self.moving]) / np.log(first / self.rest_speed[self.moving])
            done = max(done, float(np.nanmin(np.clip(slowed, 0.0, 1.0), initial=1.0)))
        return done

    def law(self, drops: Drops) -> ContactLaw:
        """Return the law of the next impact of drops, with their memory of the last one."""
        law = self.problem.law_of(len(self.rows))
        if self.problem.same_spot and isinstance(law, CompliantLaw) and law.lasting:
            law = law.changed(self.memories)
        return law if len(drops) == self.size else law.take(drops)

    def law_at(self, drops: Drops, speed: Floats) -> ContactLaw:
        """Return the law of the next impact of drops at an approach speed [m/s], with what a liquid leaves of its restitution."""
        law, liquid, radius = self.problem.law_at(self.law(drops), speed), self.problem.liquid, self.radius[drops]
        return law if liquid is None else liquid.take(drops).around(law, speed, radius, mean_density(self.mass[drops], radius))

    # one flight and one contact --------------------------------------------------------------------

    def flights(self, drops: Drops) -> Flight:
        """Return the flights that drops are about to make."""
        fluid, now = (
            self.problem.fluid,
            (self.time[drops], self.gap[drops], self.velocity[drops], self.gravity[drops] / self.inertia[drops]),
        )
        if fluid is None:
            return Flight(*now)
        if self.ahead is None or not np.array_equal(self.ahead[0], drops):
            none = np.zeros((0, len(drops)))
            velocity, pull = (none, none) if self.oblique is None else self.oblique.pulled(drops)
            sphere = self.radius[drops], mean_density(self.mass[drops], self.radius[drops])
            flights = FluidFlight(*now, *sphere, fluid.take(drops), (velocity, pull / self.inertia[drops]))
            self.ahead = drops, flights
        return self.ahead[1]

    def advance(self) -> Leg:
        """Advance all moving drops to their next touch and through one contact, and return both as a leg."""
        drops = np.flatnonzero(self.moving)
        flight, law = self.flights(drops), self.law(drops)
        touch, speed, motions = self.bodies.next_touch(drops, flight, law)
        end = np.inf if self.problem.duration is None else self.problem.duration
        last, outcome = np.full(len(drops), end), Outcome.IMPACTS
        if len(self.rows) in (self.problem.impacts, MOST_IMPACTS):
            last = np.minimum(np.minimum(flight.apex()[0], touch), end)  # a plate that is shaken may come sooner
            outcome = Outcome.IMPACTS if len(self.rows) == self.problem.impacts else Outcome.LIMIT
        by_time = last == end
        last = np.maximum(last, flight.start)  # a contact under way at the end of the run is finished first
        gone = np.isinf(touch) & np.isinf(last)
        fell = np.zeros_like(gone) if self.oblique is None else self.oblique.beside(drops, flight, touch) & (touch < last)
        last = np.where(fell, touch, last)
        stops = (touch >= last) | gone
        self.stop(drops[stops], outcome, last[stops])
        self.stop(drops[stops & by_time & ~fell], Outcome.DURATION, last[stops & by_time & ~fell])
        self.stop(drops[fell], Outcome.FELL, touch[fell])
        self.stop(drops[gone], Outcome.LEFT, flight.start[gone])
        leg = Leg(drops, flight, np.where(gone, flight.start, np.where(stops, last, touch)), drops[~stops], motions=motions)
        self.bodies.pass_flight(drops, motions, leg.flight_end - flight.start)
        if self.oblique is not None:
            leg = replace(leg, oblique=self.oblique.now(drops))
            self.oblique.fly(drops, flight, leg.flight_end)
        self.gap[drops], self.velocity[drops] = flight.at(leg.flight_end)
        self.time[drops], self.ahead = leg.flight_end, None
        if not stops.all():
            leg = self.collide(leg, touch[~stops], speed[~stops])
        if isinstance(flight, FluidFlight):
            assert self.problem.fluid is not None
            self.to_fluid[drops] += self.mass[drops] * flight.given(leg.flight_end)
            if not stops.all():
                lost = self.mass[drops] * flight.lost(leg.flight_end)
                self.rows.last[f"{self.problem.fluid.key}_lost_J"][leg.contact_drops] = lost[~stops]
        growth = self.bodies.growth(leg)
        if growth.size:
            self.rows.last["sensitivity"][leg.contact_drops] = growth
        return leg

    def collide(self, leg: Leg, touch: Floats, speed: Floats) -> Leg:
        """Solve the contact of drops, write the row of the impact table, and return the leg with the contact."""
        drops, law = leg.contact_drops, self.law_at(leg.contact_drops, speed)
        row = self.rows.add()
        row["impact"][drops], row["time_s"][drops], row["approach_speed_m_s"][drops] = len(self.rows), touch, speed
        row["restitution_asked"][drops] = _nominal_restitution(law)
        if self.problem.motion is not None:
            row["plate_velocity_m_s"][drops] = self.problem.surface(touch)[1]
            if self.oblique is not None:
                row["place_on_plate_x_m"][drops], row["place_on_plate_y_m"][drops] = self.oblique.seen_from_plate(drops, touch)
        if isinstance(law, InstantaneousLaw):
            (place, velocity, _), separation = self.problem.surface(touch), law.separation_speed(speed, self.mass[drops])
            self.time[drops], self.gap[drops], self.velocity[drops] = touch, place, velocity + separation
            row["separation_speed_m_s"][drops] = separation
            row["duration_s"][drops] = row["max_indentation_m"][drops] = row["plastic_work_J"][drops] = 0.0
            lost, along = 0.5 * self.mass[drops] * (speed**2 - separation**2), np.zeros(len(drops))
            if self.oblique is not None:
                contacts, along = self.oblique.collide_at_once(drops, touch, self.mass[drops] * (speed + separation), row)
                leg = replace(leg, oblique_contacts=contacts)
            if self.problem.shaken:
                leg, lost = self.ride(leg, touch, speed, (lost, along), row)
        else:
            assert isinstance(law, CompliantLaw)
            closing = self.bodies.closing_speed(drops, speed, self.velocity[drops])
            leg, lost = self.solve_contact(leg, encounter_of(law, self.mass[drops], self.gravity[drops], closing), touch, row)
            lost += row["plastic_work_J"][drops]
            law = self.problem.law_at(self.law(drops), speed)  # with its memory of this impact
        self.dissipated[drops] += lost - row["plastic_work_J"][drops]
        self.plastic[drops] += row["plastic_work_J"][drops]
        separation = row["separation_speed_m_s"][drops]
        rising = separation
        if self.problem.shaken:  # where it leaves, its velocity is not that relative to the plate
            leaves = ~self.bodies.rests(drops, self.velocity[drops], self.rest_speed[drops])
            rising = np.where(np.isnan(separation), np.nan, np.maximum(self.velocity[drops], 0.0) * leaves)
        row["restitution_achieved"][drops] = separation / speed
        row["energy_lost_J"][drops] = lost
        with np.errstate(divide="ignore", invalid="ignore"):
            rise = np.where(self.gravity[drops] > 0.0, 0.5 * rising**2 / self.gravity[drops], np.nan)
        if self.problem.fluid is not None:
            rise = np.where(rising > 0.0, self.flights(drops).apex()[1] - self.gap[drops], rise)
        row["rebound_height_m"][drops] = self.radius[drops] + self.gap[drops] + rise
        if self.oblique is not None:
            self.leave_dents(drops, row)
        moving = self.moving[drops]
        self.stop_resting(drops[moving], law if moving.all() else law.take(np.flatnonzero(moving)), row)
        return leg

    def ride(self, leg: Leg, touch: Floats, speed: Floats, energies: tuple[Floats, Floats], row: dict[str, Floats]) -> tuple[Leg, Floats]:
        """Let drops that hardly rebound from a shaken plate ride on it; return the leg with the rides, and the energy lost [J].

        `speed`: at which they met the plate [m/s]. `energies`: lost in the impact without what is lost as they come to ride, and the work
        of friction by the plate [J]. A sphere that moves along the plate is not followed any further where it rides.
        """
        from vibroimpact.dynamics.shaken.bodies import ShakenBodies

        assert isinstance(self.bodies, ShakenBodies)
        drops, separation = leg.contact_drops, row["separation_speed_m_s"][leg.contact_drops]
        (lost, along), ride = energies, self.bodies.ride(drops, touch, separation, self.rest_speed[drops])
        if self.oblique is not None:
            self.stop(drops[ride.end > touch], Outcome.RIDING, touch[ride.end > touch])
            ride = replace(ride, end=touch)
        rides, end = ride.end > touch, np.where(np.isfinite(ride.end), ride.end, touch)
        work = (
            along + ride.mass * (speed + np.where(rides, 0.0, separation)) * ride.surface(touch)[1] + ride.energy(end) - ride.energy(touch)
        )
        self.bodies.work[drops] += work
        row["plate_work_J"][drops] = work
        carried = drops[rides]
        self.time[carried], (self.gap[carried], self.velocity[carried], _) = end[rides], ride.surface(end[rides])
        return replace(leg, ride=ride), lost + np.where(rides, 0.5 * ride.mass * separation**2, 0.0)

    def leave_dents(self, drops: Drops, row: dict[str, Floats]) -> None:
        """Forget the dents of drops that move on by more than the radius of their contact before they touch again."""
        assert self.oblique is not None
        if not self.memories:
            return
        flight = self.flights(drops)
        away = self.oblique.distance(drops, flight, flight.touch(np.zeros(1))[0])
        gone = drops[away > np.sqrt(self.radius[drops] * np.nan_to_num(row["max_indentation_m"][drops]))]
        fresh = self.problem.laws[0].memories()
        for name, values in self.memories.items():
            self.memories[name] = values.copy()  # laws of earlier contacts refer to the previous array
            self.memories[name][gone] = self.spread(fresh[name])[gone]

    def solve_contact(self, leg: Leg, encounter: Encounter, touch: Floats, row: dict[str, Floats]) -> tuple[Leg, Floats]:
        """Return the leg with the contact of drops, and the energy lost in it [J]."""
        drops = leg.contact_drops
        until = (np.inf if self.problem.duration is None else self.problem.duration) - touch
        place, limits = (self.gap[drops], self.velocity[drops]), (self.rest_speed[drops], until)
        contact, force, when = self.bodies.collide(drops, encounter, place, limits, row)
        self.deepest[drops] = np.maximum(self.deepest[drops], contact.max_delta)
        self.time[drops] = touch + contact.duration
        self.gap[drops], self.velocity[drops] = -contact.final_delta, -contact.final_rate
        row["duration_s"][drops], row["plastic_work_J"][drops] = contact.duration, contact.plastic
        row["max_indentation_m"][drops], row["time_of_max_indentation_s"][drops] = contact.max_delta, touch + contact.time_of_max_delta
        row["max_force_N"][drops], row["time_of_max_force_s"][drops] = force, touch + when
        row["max_acceleration_m_s2"][drops] = np.maximum(force / encounter.mass - encounter.gravity, encounter.gravity)
        for name, values in contact.law.memories().items():
            self.memories[name] = self.memories[name].copy()  # laws of earlier contacts refer to the previous array
            self.memories[name][drops] = values
        leaving = self.bodies.rigid_speed(drops, -contact.final_rate)
        failed, captured, riding = (contact.outcome == outcome for outcome in (FAILED, CAPTURED, RIDING))
        captured |= self.bodies.falls_back(contact, self.next_law(drops), self.gravity[drops])
        row["separation_speed_m_s"][drops] = np.where(failed | riding, np.nan, np.where(captured, 0.0, leaving))
        stored = contact.stored
        sticks = captured & (contact.law.elastic_energy(contact.law.release_level + np.zeros(len(drops))) > 0.0)
        at_end = riding & (self.time[drops] >= (np.inf if self.problem.duration is None else self.problem.duration))
        ends = ((failed, Outcome.FAILED), (captured & ~sticks, Outcome.CAPTURED), (sticks, Outcome.STUCK))
        for these, outcome in (*ends, (riding & ~at_end, Outcome.RIDING), (at_end, Outcome.DURATION)):
            self.stop(drops[these], outcome, self.time[drops[these]])
        if captured.any():
            self.bring_to_rest(drops[captured], contact.law.take(np.flatnonzero(captured)), self.time[drops[captured]], stored[captured])
        self.stored[drops[riding]] = stored[riding]
        leg = replace(leg, contact=contact, encounter=encounter)
        if self.oblique is not None:
            leg = replace(leg, oblique_contacts=self.bodies.slide(self.oblique, leg, row))
        return leg, contact.dissipated + np.where(captured | riding, 0.0, stored)

    def next_law(self, drops: Drops) -> CompliantLaw:
        """Return the law under which drops will touch next."""
        law = self.law(drops)
        assert isinstance(law, CompliantLaw)
        return law

    def stop_resting(self, drops: Drops, law: ContactLaw, row: dict[str, Floats]) -> None:
        """Stop the drops that separate more slowly than the rest speed, or not at all, and cannot be lifted again."""
        resting = self.bodies.rests(drops, self.velocity[drops], self.rest_speed[drops])
        slow = drops[resting]
        if not slow.size:
            return
        with np.errstate(divide="ignore", invalid="ignore"):
            # flights are a geometric series with the ratio of the last restitution
            missing = 1.0 - row["restitution_achieved"][slow]
            speed = self.velocity[slow] - self.problem.surface(self.time[slow])[1]
            limit = self.time[slow] + 2.0 * speed * self.inertia[slow] / self.gravity[slow] / np.where(missing > 1e-6, missing, 0.0)
        self.bring_to_rest(slow, law.take(np.flatnonzero(resting)), limit, np.zeros(len(slow)))
        self.stop(slow, Outcome.REST_SPEED, np.where(np.isfinite(limit), limit, self.time[slow]))

    def bring_to_rest(self, drops: Drops, law: ContactLaw, time: Floats, stored: Floats) -> None:
        """Put drops that have come to rest, with energy `stored` in the contact [J], into their static indentation."""
        weight, energy = self.mass[drops] * self.gravity[drops], self.mechanical_energy()[drops] + stored
        self.rest_time[drops] = time
        for name, values in self.bodies.static_state(drops, law, weight, energy).items():
            getattr(self, name)[drops] = values

    def stop(self, drops: Drops, outcome: Outcome, time: Floats) -> None:
        """End the run of drops."""
        if not drops.size:
            return
        self.moving[drops], self.end_time[drops], self.outcomes[drops] = False, time, outcome.code

    # the end of the run ----------------------------------------------------------------------------

    def response(self, legs: Sequence[Leg]) -> Response:
        """Return the response with its history; that of a single drop without the axis of the batch."""
        response = replace(self.batch(), legs=legs)
        return response.squeezed() if self.problem.shape == () else response

    def batch(self) -> Response:
        """Return the response of the batch without a history."""
        fluid, at_rest = self.problem.fluid, np.array([outcome.at_rest for outcome in OUTCOMES])[self.outcomes]
        if self.problem.duration is not None:
            self.end_time[at_rest] = np.maximum(self.end_time, self.problem.duration)[at_rest]
        along = {} if self.oblique is None else self.lie_on_plate(self.oblique, np.flatnonzero(at_rest))
        final_gap, final_velocity = self.final_motion(np.flatnonzero(at_rest))
        vibration, liquid = self.bodies.energies(), self.energy_of_liquid(final_velocity)
        added = self.mass * self.gravity * self.deepest + np.maximum(-self.stored, 0.0)  # the stored energy is negative where it sticks
        if self.oblique is not None:
            added += np.maximum(-along["potential_J"], 0.0)  # what gravity did down the plate
        if self.problem.motion is not None:
            vibration = {"drive_J": np.zeros(self.size), **vibration}
            added += np.maximum(-vibration["drive_J"], 0.0)
        energy = close_ledger(
            self.energy_in,
            added,
            {
                "kinetic_J": 0.5 * self.mass * final_velocity**2 + liquid + along.pop("kinetic_J", 0.0),
                "potential_J": self.mass * self.gravity * final_gap + along.pop("potential_J", 0.0),
                "contact_elastic_J": self.stored + vibration.pop("local_J", 0.0),
                "contact_dissipated_J": self.dissipated + vibration.pop("local_damping_J", 0.0),
                "plastic_work_J": self.plastic,
                "written_off_at_rest_J": self.written_off,
                **vibration,
                **along,
                **({} if fluid is None else {f"{fluid.key}_J": self.to_fluid + self.liquid_at_start - liquid}),
            },
        )
        energy |= {} if self.oblique is None else self.oblique.friction_parts()
        closes = energy["closure_relative"] <= CLOSURE_LIMIT
        self.outcomes[~(closes & (self.written_off >= -WRITE_OFF_LIMIT * (self.energy_in + added)))] = Outcome.FAILED.code
        return Response(
            self.problem,
            self.rows.table(),
            energy,
            tuple(OUTCOMES[code] for code in self.outcomes.tolist()),
            self.end_time,
            Rest(self.rest_speed, self.rest_time, self.sag, self.stored, self.written_off, self.bodies.left, tuple(self.bodies.lying)),
            None,
        )

    def lie_on_plate(self, oblique: ObliqueMotion, at_rest: Drops) -> dict[str, Floats]:
        """Follow drops at rest along the plate, over whose edge they may leave it; return the entries of the ledger for that motion."""
        if at_rest.size:
            lain = oblique.lie(at_rest, self.gravity[at_rest], np.maximum(self.end_time - self.time, 0.0)[at_rest])
            self.end_time[at_rest] = np.minimum(self.end_time[at_rest], self.time[at_rest] + lain)
        kinetic, rotation, potential = oblique.energies()
        return {"kinetic_J": kinetic, "potential_J": potential, "rotation_J": rotation, "friction_J": oblique.lost}

    def final_motion(self, at_rest: Drops) -> tuple[Floats, Floats]:
        """Return gap [m] and upward velocity [m/s] at the end of the run."""
        gap, velocity = self.gap.copy(), self.velocity.copy()
        lain, parts = np.maximum(self.end_time - self.time, 0.0)[at_rest], (self.sag[at_rest], self.stored[at_rest])
        gap[at_rest], velocity[at_rest], self.stored[at_rest] = self.bodies.follow(at_rest, lain, *parts)
        return gap, velocity


def _nominal_restitution(law: ContactLaw) -> Floats | float:
    """Return the restitution that a law is given, or NaN."""
    asked = getattr(law, "restitution", None)
    return np.nan if asked is None else asked
