"""Drops of rigid bodies under a law without a force on a shaken plate: touch, ride and launch."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.rigid.rigid_bodies import RigidBodies
from vibroimpact.dynamics.run_bodies import Motions
from vibroimpact.dynamics.shaken.ride import Ride
from vibroimpact.dynamics.vibrating.fluid_motion import free_motion
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.next_touch import next_touch
from vibroimpact.dynamics.vibrating.vibrating_bodies import system_of

# in radians of the fastest harmonic motion: first time after a launch at which the gap is evaluated
_FIRST_TIME = 1e-6
_GAP = 1e-13  # of the plate's motion: a gap beyond rounding


class ShakenBodies(RigidBodies):
    """The bodies of B drops: a hard sphere falls on a plate that is shaken.

    `Bodies` describes the methods. The plate's motion is that of the driven coordinates of a
    `LinearSystem`, so that no touch and no launch is stepped over.

    Parameters
    ----------
    problem : Problem
        The problem, whose motion moves the surface of the plate.
    mass, gravity : array, shape (B,)
        Of the spheres [kg], [m/s^2].
    """

    def __init__(self, problem: Problem, mass: Floats, gravity: Floats) -> None:
        super().__init__(len(mass), problem.tolerance)
        self.problem = problem
        self.mass = mass
        self.gravity = gravity
        self.systems = [
            system_of(problem, drop_mass, drop_gravity)
            for drop_mass, drop_gravity in zip(mass.tolist(), gravity.tolist(), strict=True)
        ]
        # begin of a ride that lasts until the run ends [s], NaN without; work of the drive [J]
        self.rides_since = np.full(len(mass), np.nan)
        self.work = np.zeros(len(mass))

    def next_touch(
        self, drops: Drops, flight: Flight, law: ContactLaw
    ) -> tuple[Floats, Floats, Motions]:
        """Return times of touch [s], approach speeds relative to the plate [m/s], and no motions.

        Rigid bodies have none of their own.
        """
        elapsed = np.array(
            [
                self._time_to_touch(drop, flight.take(np.array([number])))
                for number, drop in enumerate(drops)
            ]
        )
        touch = flight.start + elapsed
        # the speed is not asked for where there is no touch
        evaluated_at = np.where(np.isfinite(touch), touch, flight.start)
        _, surface_velocity, _ = self.problem.surface(evaluated_at)
        _, velocity = flight.at(evaluated_at)
        return touch, surface_velocity - velocity, ()

    def _time_to_touch(self, drop: int, flight: Flight) -> float:
        """Return the time from the start of a flight to its touch [s]."""
        system = self.systems[drop]
        state = self._state(
            system, float(flight.start[0]), float(flight.gap[0]), float(flight.velocity[0])
        )
        free = free_motion(system, state, flight)
        fastest = float(system.angular_frequency.max())
        least_gap = _GAP * float(np.abs(self.problem.surface_phasors).sum())
        skipped = 0.0
        approach, rate = free.motion(np.array(0.0))
        if max(abs(float(approach[0])), abs(float(rate[0])) / fastest) <= least_gap:
            # a launch: the plate falls away with the third power of time, and the gap is rounding
            # at first
            times = _FIRST_TIME / fastest * np.exp2(np.arange(20))
            gaps = -free.motion(times)[0][:, 0]
            skipped = float(times[np.argmax(gaps > least_gap)])
            free = free.after(skipped)
        return skipped + next_touch(free, 0.0, np.inf)

    def _state(self, system: LinearSystem, time: float, gap: float, velocity: float) -> State:
        """Return the state of a drop at a time [s]."""
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

    def ride(self, drops: Drops, touch: Floats, separation: Floats, rest_speed: Floats) -> Ride:
        """Return the rides of drops from impacts at some times [s].

        `separation`: speeds after these [m/s]. A drop rides if it separates more slowly than the
        rest speed and the plate presses against it, until the plate's acceleration is minus
        gravity.
        """
        motion = self.problem.motion
        assert motion is not None  # that of a plate that is shaken
        gravity = self.gravity[drops]
        slow = (separation < rest_speed) | (separation == 0.0)
        _, _, surface_acceleration = self.problem.surface(touch)
        rides = slow & (surface_acceleration + gravity > 0.0)
        ends = touch.copy()
        for number in np.flatnonzero(rides).tolist():
            ends[number] += self._time_to_launch(drops[number], float(touch[number]))
        stays = np.isinf(ends)
        self.rides_since[drops[stays]] = touch[stays]
        return Ride(ends, self.mass[drops], gravity, motion)

    def _time_to_launch(self, drop: int, time: float) -> float:
        """Return how long it takes until the downward acceleration of the plate is gravity [s].

        It is counted from a time on, and infinite if the run ends before.
        """
        system = self.systems[drop]
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
            offset=-self.gravity[[drop]],
            load=0.0 * omega,
            inside=inside,
            below=~inside[None],
            rate=no_elements,
            mobility=no_elements,
            local_contact=np.zeros(0, dtype=np.intp),
        )
        state = self._state(system, time, 0.0, 0.0)
        plate_state = State(state.displacement[driven], state.velocity[driven], no_elements)
        run_end = self.problem.duration or np.inf
        return next_touch(FreeMotion(acceleration_system, plate_state), 0.0, run_end - time)

    def rests(self, drops: Drops, velocity: Floats, rest_speed: Floats) -> Bools:
        """Return which drops ride on the plate until the run ends."""
        return np.asarray(np.isfinite(self.rides_since[drops]))

    def static_state(
        self, drops: Drops, law: ContactLaw, weight: Floats, energy: Floats
    ) -> dict[str, Floats]:
        """Return zeros: a hard sphere does not indent the plate.

        What it loses as it comes to ride is lost in the impact.
        """
        return dict.fromkeys(("sag", "stored", "written_off"), np.zeros(len(drops)))

    def follow(
        self, drops: Drops, elapsed: Floats, sag: Floats, stored: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return the motion of the plate."""
        assert self.problem.motion is not None
        ride = Ride(elapsed, self.mass[drops], self.gravity[drops], self.problem.motion)
        since = self.rides_since[drops]
        self.work[drops] += ride.energy(since + elapsed) - ride.energy(since)
        displacement, velocity, _ = ride.surface(since + elapsed)
        return displacement, velocity, stored

    def energies(self) -> dict[str, Floats]:
        """Return minus the work of the drive."""
        return {"drive_J": -self.work}
