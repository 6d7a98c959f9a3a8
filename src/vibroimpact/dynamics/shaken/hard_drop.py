"""One hard sphere on a rigid plate that is shaken: flights, impacts without duration, and rides.

The plate's motion is that of the driven coordinates of a linear system, so that no touch and no
launch is stepped over.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.contact.law import InstantaneousLaw
from vibroimpact.dynamics.core.drop_records import AT_TOUCH
from vibroimpact.dynamics.core.drops import LEAST_MISSING
from vibroimpact.dynamics.core.stop_rules import is_too_slow
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.motion.progress import fraction_done
from vibroimpact.dynamics.motion.ride import Ride
from vibroimpact.dynamics.motion.run_rules import default_rest_speeds, start_of
from vibroimpact.dynamics.oblique.told_flights import ToldFlights
from vibroimpact.dynamics.shaken.recorded_drop import HardBounces
from vibroimpact.dynamics.statement.outcome import OUTCOMES, Outcome
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.drop_system import system_of
from vibroimpact.dynamics.vibrating.fluid_motion import free_motion
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.next_touch import next_touch

# in radians of the fastest harmonic motion: first time after a launch at which the gap is evaluated
_FIRST_TIME = 1e-6
_GAP = 1e-13  # of the plate's motion: a gap beyond rounding


class HardDrop:
    """One hard sphere on its way.

    `time`, `gap`, `velocity`: where it is [s], [m], upwards [m/s]. `rows`: its impacts, by the
    columns of their table. `bounces`: its flights and impacts. `outcome`, `end_time`: how and when
    its run ended. `rest_time`: when it has come to ride until then, else NaN. `dissipated`,
    `work`: energy lost in impacts, and work of the drive [J].

    Parameters
    ----------
    problem : Problem
        Of one drop.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.mass = float(problem.sphere.mass)
        self.radius = float(problem.sphere.contact_offset)
        self.gravity = float(problem.net_gravity)
        self.time = 0.0
        self.gap, self.velocity = start_of(problem)
        self.told = ToldFlights(problem, self.velocity)
        self.oblique = self.told.oblique
        self.rows: list[dict[str, float]] = []
        self.bounces = HardBounces(problem)
        self.outcome: Outcome | None = None
        self.end_time = np.nan
        self.rest_time = np.nan
        self.dissipated = 0.0
        self.work = 0.0
        self._rides_since = np.nan  # until the run ends
        self._system = system_of(problem, self.mass, self.gravity)
        fall = self.mass * (0.5 * self.velocity**2 + self.gravity * self.gap)
        self.energy_in = fall + self.told.energy_at_start()
        if problem.rest_speed is None:
            mass = np.array([self.mass])
            gravity = np.array([self.gravity])
            law = problem.law_of(0)
            self.rest_speed = float(default_rest_speeds(law, self._flight(), mass, gravity)[0])
        else:
            self.rest_speed = float(problem.rest_speed)

    def first_touch(self) -> float:
        """Return the time of the first touch [s], from the start; infinite if there is none."""
        return self._time_to_touch(self._flight())

    def follow(self, progress: Callable[[float], None] | None) -> None:
        """Follow the drop to the end of its run."""
        while self.outcome is None:
            flight = self._flight()
            self._fly(flight)
            if self.outcome is None:
                self._collide()
            if progress is not None:
                progress(self._fraction_done())
        self._end()

    def _fraction_done(self) -> float:
        """Return the fraction of the run that is done, in [0, 1]."""
        if self.outcome is not None:
            return 1.0
        velocity = np.array([self.velocity])
        rest_speed = np.array([self.rest_speed])
        return fraction_done(
            self.problem, len(self.rows), self.time, velocity, velocity, rest_speed
        )

    def _end_by(self, outcome: Outcome, time: float) -> None:
        """End the run at a time [s]."""
        self.outcome = outcome
        self.end_time = time

    # flight
    # -----------------------------------------------------------------------------------------

    def _flight(self) -> Flight:
        """Return the flight that the sphere is about to make."""
        return self.told.next(self.time, self.gap, self.velocity)

    def _fly(self, flight: Flight) -> None:
        """Let the sphere fly to its next touch, or until a rule ends its run."""
        touch = self.time + self._time_to_touch(flight)
        time, phase = self.told.end_of(flight, touch, len(self.rows))
        self.bounces.begin(flight, self.oblique, time)
        row = self.told.fly(flight, time)
        gap, velocity = flight.at(np.array([time]))
        self.gap = float(gap[0])
        self.velocity = float(velocity[0])
        self.time = time
        if phase == AT_TOUCH:
            self.rows.append(row)
        else:
            self._end_by(OUTCOMES[phase], time)

    def _time_to_touch(self, flight: Flight) -> float:
        """Return the time from the start of a flight to its touch [s]."""
        start = self._state(self.time, self.gap, self.velocity)
        free = free_motion(self._system, start, flight)
        fastest = float(self._system.angular_frequency.max())
        amplitude = float(np.abs(self.problem.surface_phasors).sum())
        least_gap = _GAP * amplitude
        approach, rate = free.motion(np.array(0.0))
        gap = abs(float(approach[0]))
        opened_in_a_radian = abs(float(rate[0])) / fastest
        if max(gap, opened_in_a_radian) > least_gap:
            return next_touch(free, 0.0, np.inf)
        # a launch: the plate falls away with the third power of time, and the gap is rounding at
        # first
        times = _FIRST_TIME / fastest * np.exp2(np.arange(20))
        approaches, _ = free.motion(times)
        is_open = -approaches[:, 0] > least_gap
        skipped = float(times[np.argmax(is_open)])
        return skipped + next_touch(free.after(skipped), 0.0, np.inf)

    def _state(self, time: float, gap: float, velocity: float) -> State:
        """Return the state of sphere and plate at a time [s]."""
        system = self._system
        omega = system.angular_frequency[1:]
        phasors = self.problem.surface_phasors * np.exp(1j * omega * time)
        if self.problem.surface_phasors.any():  # it may move along itself alone
            phasors = phasors / system.shape[0, 1:]
        root_mass = float(system.mass[0]) ** 0.5
        return State(
            displacement=np.append(-root_mass * gap, phasors.imag),
            velocity=np.append(-root_mass * velocity, omega * phasors.real),
            local=np.zeros(0),
        )

    # impact
    # -----------------------------------------------------------------------------------------

    def _law_at(self, speed: float) -> InstantaneousLaw:
        """Return the law of the next impact at an approach speed [m/s]."""
        problem = self.problem
        law = problem.law_at_touch(problem.law_of(len(self.rows) - 1), np.array([speed]))
        assert isinstance(law, InstantaneousLaw)  # others vibrate on a shaken plate
        return law.take(0)

    def _collide(self) -> None:
        """Let the sphere rebound at its touch, or ride from it on."""
        row = self.rows[-1]
        surface, surface_velocity, _ = self._surface(self.time)
        speed = surface_velocity - self.velocity
        law = self._law_at(speed)
        separation = float(law.separation_speed(speed, self.mass))
        row["impact"] = float(len(self.rows))
        row["time_s"] = self.time
        row["duration_s"] = 0.0
        row["approach_speed_m_s"] = speed
        row["separation_speed_m_s"] = separation
        row["restitution_asked"] = float(law.nominal_restitution)
        row["restitution_achieved"] = separation / speed
        row["max_indentation_m"] = 0.0
        row["plastic_work_J"] = 0.0
        row["plate_velocity_m_s"] = surface_velocity
        self.gap = surface
        self.velocity = surface_velocity + separation
        work = self._strike_along(speed + separation, row)
        ride = self._ride(separation)
        touch = self.time
        end = float(ride.end[0])
        rides = end > touch
        # the plate works on the impulse of the impact, and on the sphere that it carries
        separating = 0.0 if rides else separation
        impulse = self.mass * (speed + separating)
        work += impulse * surface_velocity
        if rides and np.isfinite(end):
            work += self._carried(ride, end) - self._carried(ride, touch)
            self.time = end
        if rides:
            self.gap, self.velocity, _ = self._surface(self.time)
        self.work += work
        row["plate_work_J"] = work
        lost = 0.5 * self.mass * (speed**2 - separation**2)
        if rides:
            lost += 0.5 * self.mass * separation**2
        row["energy_lost_J"] = lost
        self.dissipated += lost
        self.bounces.end(ride, self.oblique, row)
        row["rebound_height_m"] = self._rebound_height()
        if self.outcome is None and np.isfinite(self._rides_since):
            self._rest(row)

    def _surface(self, time: float) -> tuple[float, float, float]:
        """Return displacement [m], velocity [m/s] and acceleration of the plate's surface at a
        time [s], upwards.
        """
        displacement, velocity, acceleration = self.problem.surface(np.array(time)).tolist()
        return displacement, velocity, acceleration

    def _strike_along(self, speed_change: float, row: dict[str, float]) -> float:
        """Let friction act at the touch of a sphere whose normal speed changes [m/s].

        Return the work of friction by the plate [J].
        """
        if self.oblique is None:
            return 0.0
        time = np.array([self.time])
        row |= self.oblique.seen_from_plate(time)
        impulse = np.array([self.mass * speed_change])
        columns, work = self.oblique.strike(time, impulse, row["separation_speed_m_s"])
        row |= columns
        return work

    def _ride(self, separation: float) -> Ride:
        """Return the ride of the sphere from an impact with a separation speed [m/s].

        It rides if it separates more slowly than the rest speed and the plate presses against it,
        until the plate's acceleration is minus gravity. One that moves along the plate is not
        followed any further where it rides.
        """
        motion = self.problem.motion
        assert motion is not None  # that of a plate that is shaken
        touch = self.time
        end = touch
        is_slow = is_too_slow(separation, self.rest_speed)
        if is_slow and self._surface(touch)[2] + self.gravity > 0.0:
            end += self._time_to_launch()
            if self.oblique is not None:
                self._end_by(Outcome.RIDING, touch)
                end = touch
            elif np.isinf(end):
                self._rides_since = touch
        return Ride(np.array([end]), np.array([self.mass]), np.array([self.gravity]), motion)

    def _carried(self, ride: Ride, time: float) -> float:
        """Return the energy of a sphere that moves with the plate at a time [s], in J."""
        return float(ride.energy(np.array([time]))[0])

    def _time_to_launch(self) -> float:
        """Return how long it takes until the downward acceleration of the plate is gravity [s].

        It is infinite if the run ends before.
        """
        system = self._system
        driven = slice(1, None)
        omega = system.angular_frequency[driven]
        inside = np.zeros(len(omega), dtype=bool)
        no_elements = np.zeros(0)
        # what rises to zero is the downward acceleration less gravity: it takes the part of an
        # approach
        acceleration_system = LinearSystem(
            angular_frequency=omega,
            damping_ratio=0.0 * omega,
            shape=system.shape[:, driven] * omega**2,
            offset=np.array([-self.gravity]),
            load=0.0 * omega,
            inside=inside,
            below=~inside[None],
            rate=no_elements,
            mobility=no_elements,
            local_contact=np.zeros(0, dtype=np.intp),
        )
        state = self._state(self.time, 0.0, 0.0)
        plate = State(state.displacement[driven], state.velocity[driven], no_elements)
        run_end = self.problem.duration or np.inf
        return next_touch(FreeMotion(acceleration_system, plate), 0.0, run_end - self.time)

    def _rebound_height(self) -> float:
        """Return the height of the centre at the top of the rebound [m].

        From a shaken plate the sphere does not rise with its velocity relative to the plate.
        """
        rising = max(self.velocity, 0.0)
        if np.isfinite(self._rides_since):
            rising = 0.0
        rise = np.nan
        if self.gravity > 0.0:
            rise = 0.5 * rising**2 / self.gravity
        if self.problem.fluid is not None and rising > 0.0:
            rise = float(self._flight().apex()[1][0]) - self.gap
        return self.radius + self.gap + rise

    def _rest(self, row: dict[str, float]) -> None:
        """End the run of a sphere that rides until its end."""
        is_rest = 1.0 - row["restitution_achieved"] > LEAST_MISSING and self.gravity != 0.0
        self.rest_time = self.time if is_rest else np.nan
        self._end_by(Outcome.REST_SPEED, self.time)

    # the end
    # -----------------------------------------------------------------------------------------

    def _end(self) -> None:
        """Carry a sphere that rides until the end of the run."""
        if self.outcome is not Outcome.REST_SPEED:
            return
        if self.problem.duration is not None:
            self.end_time = max(self.end_time, self.problem.duration)
        motion = self.problem.motion
        assert motion is not None  # that of a plate that is shaken
        ride = Ride(
            np.array([self.end_time]), np.array([self.mass]), np.array([self.gravity]), motion
        )
        self.work += self._carried(ride, self.end_time) - self._carried(ride, self._rides_since)
        self.gap, self.velocity, _ = self._surface(self.end_time)

    def entries(self) -> tuple[dict[str, float], float]:
        """Return the entries of the energy ledger at the end [J], and the energy that gravity and
        the drive added [J].
        """
        entries = {
            "kinetic_J": 0.5 * self.mass * self.velocity**2,
            "potential_J": self.mass * self.gravity * self.gap,
            "contact_elastic_J": 0.0,
            "contact_dissipated_J": self.dissipated,
            "plastic_work_J": 0.0,
            "written_off_at_rest_J": 0.0,
            "drive_J": -self.work,
        }
        further = self.told.entries(self.velocity)
        for name, value in further.items():
            entries[name] = entries.get(name, 0.0) + value
        # what gravity did down the plate
        added = max(self.work, 0.0) + max(-further.get("potential_J", 0.0), 0.0)
        return entries, added
