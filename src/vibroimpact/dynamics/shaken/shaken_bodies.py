"""Drops of rigid bodies under a law without a force, on a plate that is shaken: touches,
rides and launches of B drops.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.rigid.rigid_bodies import RigidBodies
from vibroimpact.dynamics.rigid.solve_contact import SolvesContact
from vibroimpact.dynamics.run_bodies import Motions
from vibroimpact.dynamics.shaken.ride import Ride
from vibroimpact.dynamics.vibrating.fluid_motion import free_motion
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.next_touch import next_touch
from vibroimpact.dynamics.vibrating.vibrating_bodies import system_of

# in radians of the fastest harmonic motion: first time after a launch at which the gap is looked at
_FIRST_LOOK = 1e-6
_GAP = 1e-13  # of the plate's motion: a gap beyond rounding


class ShakenBodies(RigidBodies):
    """The bodies of B drops: a hard sphere falls on a plate that is shaken. `Bodies` describes the
    methods.

    The plate's motion is that of the driven coordinates of a `LinearSystem`, so that no touch and
    no launch is stepped over.

    Parameters
    ----------
    problem : Problem
        The problem, whose motion moves the surface of the plate.
    mass, gravity : array, shape (B,)
        Of the spheres [kg], [m/s^2].
    solve_contact : SolvesContact
        Of laws that have a force; none does here.
    """

    def __init__(
        self, problem: Problem, mass: Floats, gravity: Floats, solve_contact: SolvesContact
    ) -> None:
        super().__init__(len(mass), solve_contact)
        self.problem, self.mass, self.gravity = problem, mass, gravity
        self.systems = [
            system_of(problem, *pair) for pair in zip(mass.tolist(), gravity.tolist(), strict=True)
        ]
        self.since, self.work = np.full(len(mass), np.nan), np.zeros(len(mass))

    def next_touch(
        self, drops: Drops, flight: Flight, law: ContactLaw
    ) -> tuple[Floats, Floats, Motions]:
        """Return times of touch [s], approach speeds relative to the plate [m/s], and no
        motions of bodies.
        """
        flights = [flight.take(np.array([number])) for number in range(len(drops))]
        touch = flight.start + np.array(
            [self._time_to_touch(*one) for one in zip(drops, flights, strict=True)]
        )
        when = np.where(np.isfinite(touch), touch, flight.start)
        return touch, self.problem.surface(when)[1] - flight.at(when)[1], ()

    def _time_to_touch(self, drop: int, flight: Flight) -> float:
        system = self.systems[drop]
        free = free_motion(
            system,
            self._state(
                system, *(float(part[0]) for part in (flight.start, flight.gap, flight.velocity))
            ),
            flight,
        )
        later, fastest, reach = (
            0.0,
            float(system.angular_frequency.max()),
            float(np.abs(self.problem.surface_phasors).sum()),
        )
        approach, rate = (float(part[0]) for part in free.motion(np.array(0.0)))
        if max(abs(approach), abs(rate) / fastest) <= _GAP * reach:
            # a launch: the plate falls away with the third power of time, and the gap is rounding
            # at first
            looks = _FIRST_LOOK / fastest * np.exp2(np.arange(20))
            later = float(looks[np.argmax(-free.motion(looks)[0][:, 0] > _GAP * reach)])
            free = free.after(later)
        return later + next_touch(free, 0.0, np.inf)

    def _state(self, system: LinearSystem, time: float, gap: float, velocity: float) -> State:
        """Return the state of a drop at a time [s]."""
        phasors = self.problem.surface_phasors * np.exp(1j * system.angular_frequency[1:] * time)
        if self.problem.surface_phasors.any():  # it may move along itself alone
            phasors = phasors / system.shape[0, 1:]
        root = float(system.mass[0]) ** 0.5
        return State(
            np.append(-root * gap, phasors.imag),
            np.append(-root * velocity, system.angular_frequency[1:] * phasors.real),
            np.zeros(0),
        )

    def ride(self, drops: Drops, touch: Floats, separation: Floats, rest_speed: Floats) -> Ride:
        """Return the rides of drops from impacts at some times [s] after which they separate at
        some speeds [m/s].

        A drop rides if it separates more slowly than the rest speed and the plate presses against
        it, until the plate's acceleration is minus gravity.
        """
        motion, gravity = self.problem.motion, self.gravity[drops]
        assert motion is not None  # that of a plate that is shaken
        rides = ((separation < rest_speed) | (separation == 0.0)) & (
            self.problem.surface(touch)[2] + gravity > 0.0
        )
        ends = touch.copy()
        for number in np.flatnonzero(rides).tolist():
            ends[number] += self._time_to_launch(drops[number], float(touch[number]))
        self.since[drops[np.isinf(ends)]] = touch[np.isinf(ends)]
        return Ride(ends, self.mass[drops], gravity, motion)

    def _time_to_launch(self, drop: int, time: float) -> float:
        """Return how long it takes from a time on until the downward acceleration of the plate
        reaches gravity [s].

        It is infinite if the run ends before.
        """
        system, driven = self.systems[drop], slice(1, None)
        omega, none = system.angular_frequency[driven], np.zeros(0)
        no = np.zeros(len(omega), dtype=bool)
        # what rises to zero is the downward acceleration less gravity
        pressing = LinearSystem(
            angular_frequency=omega,
            damping_ratio=0.0 * omega,
            shape=system.shape[:, driven] * omega**2,
            offset=-self.gravity[[drop]],
            load=0.0 * omega,
            inside=no,
            below=~no[None],
            rate=none,
            mobility=none,
            local_contact=np.zeros(0, dtype=np.intp),
        )
        state, until = self._state(system, time, 0.0, 0.0), (self.problem.duration or np.inf) - time
        return next_touch(
            FreeMotion(pressing, State(state.displacement[driven], state.velocity[driven], none)),
            0.0,
            until,
        )

    def rests(self, drops: Drops, velocity: Floats, rest_speed: Floats) -> Bools:
        """Return which drops ride on the plate until the run ends."""
        return np.asarray(np.isfinite(self.since[drops]))

    def static_state(
        self, drops: Drops, law: ContactLaw, weight: Floats, energy: Floats
    ) -> dict[str, Floats]:
        """Return zeros: a hard sphere does not indent the plate, and what it loses as it
        comes to ride is lost in the impact.
        """
        return dict.fromkeys(("sag", "stored", "written_off"), np.zeros(len(drops)))

    def follow(
        self, drops: Drops, elapsed: Floats, sag: Floats, stored: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return the motion of the plate."""
        assert self.problem.motion is not None
        since, ride = (
            self.since[drops],
            Ride(elapsed, self.mass[drops], self.gravity[drops], self.problem.motion),
        )
        self.work[drops] += ride.energy(since + elapsed) - ride.energy(since)
        return *ride.surface(since + elapsed)[:2], stored

    def energies(self) -> dict[str, Floats]:
        """Return minus the work of the drive."""
        return {"drive_J": -self.work}
