r"""Flight through air or a liquid at rest, whose drag slows the sphere down.

With the velocity v in one dimension or three, the acceleration g at which the sphere would fall without drag, which is less than gravity in
a liquid, and the drag a of `vibroimpact.dynamics.fluid`,

.. math:: \dot v = g - a(|v|)\, v / |v|

A flight is solved in pieces: up to its top, which ends one, and down from there. In a piece the acceleration is a polynomial through the
nodes of a Radau rule, in a time that is finest at the top, where the drag has no second derivative. Its integral gives the velocities at
the nodes, and these the next acceleration; such sweeps converge fast, as a piece is short beside the time constant of the drag. The motion
at any time, and at a touch, is that at the end of a piece that ends there. A sphere that has reached its terminal velocity to rounding
keeps it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.bodies.ball import mean_density
from vibroimpact.dynamics.collocation import collocation_rule
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.fluid import Fluid
from vibroimpact.dynamics.oblique.state import Sphere, State
from vibroimpact.dynamics.problem import Problem

_NODES, _ROOT = 12, 2
_LONGEST = 0.25  # of the time constant of the drag: length of a piece
_SWEEPS = 60
_CLOSE = 1e-13  # of the speeds: change by the last sweep, which is 10 times the error that is left
_STEADY = 1e-14  # of gravity: an acceleration that counts as none
_STILL = 1e-30  # m/s


@dataclass(frozen=True)
class Moving:
    """Motion of b spheres.

    `time`: since the start of the flight [s] (b,). `place` [m], `velocity` [m/s]: (C, b), the last component along the normal. `lost`:
    energy per mass of the sphere that drag has taken since the start [J/kg] (b,).
    """

    time: Floats
    place: Floats
    velocity: Floats
    lost: Floats

    def take(self, which: Drops | Bools) -> Moving:
        """Return the motion of some of them."""
        return Moving(self.time[which], self.place[:, which], self.velocity[:, which], self.lost[which])

    def put(self, which: Drops | Bools, others: Moving) -> Moving:
        """Return the motion with that of some of them replaced."""
        found = Moving(self.time.copy(), self.place.copy(), self.velocity.copy(), self.lost.copy())
        for name, values in vars(found).items():
            values[..., which] = getattr(others, name)
        return found


Length = Callable[[Floats, Floats], Floats]
"""Length of a piece [s] (b,), from the velocity and the displacement at its end that the acceleration makes, over the length and over its
square (C, b)."""


@dataclass(frozen=True)
class Falling:
    """What spheres fall through, and how they are pulled: `radius` [m], `density` [kg/m^3] (b,), `gravity` without drag [m/s^2] (C, b)."""

    fluid: Fluid
    radius: Floats
    density: Floats
    gravity: Floats

    def take(self, which: Drops | Bools) -> Falling:
        """Return those of some of them."""
        return Falling(self.fluid.take(which), self.radius[which], self.density[which], self.gravity[:, which])

    def acceleration(self, velocity: Floats) -> tuple[Floats, Floats]:
        """Return accelerations (..., C, b), and powers per mass that drag takes [W/kg] (..., b), at velocities (..., C, b)."""
        speed = np.sqrt((velocity**2).sum(axis=-2))
        drag = self.fluid.drag(speed, self.radius, self.density)
        return self.gravity - (drag / np.maximum(speed, _STILL))[..., None, :] * velocity, drag * speed * self.fluid.inertia(self.density)

    def longest(self, velocity: Floats) -> Floats:
        """Return the longest piece from given velocities [s] (b,); infinite where the velocity stays."""
        speed, pull = (np.sqrt((part**2).sum(axis=0)) for part in (velocity, self.gravity))

        def constant(speed: Floats) -> Floats:
            some = np.maximum(speed, _STILL)
            return np.asarray(some / self.fluid.drag(some, self.radius, self.density))

        time = constant(speed)
        for _ in range(6):  # the constant that belongs to the speed after it
            time = np.sqrt(time * constant(speed + pull * time))
        return np.where(self.keeps(velocity), np.inf, 0.5 * _LONGEST * time)

    def keeps(self, velocity: Floats) -> Bools:
        """Return which velocities (C, b) are kept: the terminal velocity, or rest without gravity."""
        left, pull, speed = (np.sqrt((part**2).sum(axis=0)) for part in (self.acceleration(velocity)[0], self.gravity, velocity))
        return np.asarray(np.where(pull > 0.0, left <= _STEADY * pull, speed <= _STILL))

    def advance(self, begin: Moving, time_map: Literal["touch", "release"], length: Length) -> Moving:
        """Return the motion at the end of a piece."""
        rule, (now, power) = collocation_rule(_NODES, time_map, _ROOT), self.acceleration(begin.velocity)
        steady, shape = self.keeps(begin.velocity), (_NODES, *now.shape)
        now = np.where(steady, 0.0, np.broadcast_to(now, shape))
        for _ in range(_SWEEPS):
            gained = (rule.integral @ now.reshape(_NODES, -1)).reshape(shape)
            time = length(gained[-1], (rule.integral_twice[-1] @ now.reshape(_NODES, -1)).reshape(now.shape[1:]))
            velocity = begin.velocity + time * gained
            before, (now, power) = now, self.acceleration(velocity)
            now = np.where(steady, 0.0, now)
            change = time * np.abs(now - before).max(axis=(0, 1))
            if not np.any(change > _CLOSE * np.sqrt((velocity**2).sum(axis=1)).max(axis=0)):
                break
        flat = now.reshape(_NODES, -1)
        gained, moved = ((part[-1] @ flat).reshape(now.shape[1:]) for part in (rule.integral, rule.integral_twice))
        return Moving(
            begin.time + time,
            begin.place + time * (begin.velocity + time * moved),
            begin.velocity + time * gained,
            begin.lost + time * (rule.integral[-1] @ power),
        )

    def rise(self, begin: Moving) -> Moving:
        """Return the motion at the end of a piece upwards, which the top of the flight ends at the latest."""
        up, longest = begin.velocity[-1], self.longest(begin.velocity)
        ends = up <= -self.acceleration(begin.velocity)[0][-1] * longest
        found = self.advance(begin, "release", lambda gained, _: np.where(ends, -up / gained[-1], longest))
        found.velocity[-1, ends] = 0.0
        return found


@dataclass(frozen=True)
class FluidFlight(Flight):
    """Flights of B drops through air or a liquid, in one dimension or in three; all arrays but those of `along` are (B,).

    `radius`, `density`: of the spheres [m], [kg/m^3]. `fluid`: what they fly through. `along`: velocities at the start [m/s] and
    accelerations without drag [m/s^2] along the plate, (2, B), or (0, B) where all motion is along the normal.
    """

    radius: Floats
    density: Floats
    fluid: Fluid
    along: tuple[Floats, Floats]

    def take(self, which: Drops) -> FluidFlight:
        """Return the flights of some of the drops."""
        motion = (self.start[which], self.gap[which], self.velocity[which], self.gravity[which])
        along = self.along[0][:, which], self.along[1][:, which]
        return FluidFlight(*motion, self.radius[which], self.density[which], self.fluid.take(which), along)

    def after(self, time: Floats) -> FluidFlight:
        """Return the flights from times on [s] (B,)."""
        moving = self._moving(time)
        along = moving.velocity[:-1], self.along[1]
        return replace(self, start=time, gap=moving.place[-1], velocity=moving.velocity[-1], along=along)

    def at(self, time: Floats) -> tuple[Floats, Floats]:
        """Return gap [m] and upward velocity [m/s] at times [s] (..., B)."""
        moving = self._moving(time)
        return moving.place[-1], moving.velocity[-1]

    def touch(self, level: Floats) -> tuple[Floats, Floats]:
        """Return time [s] and approach speed [m/s] of the next touch; the time is infinite if there is none.

        The surfaces meet where the gap has fallen to `level`.
        """
        falls, level = (self.gravity > 0.0) | (self.velocity < 0.0), level + np.zeros(len(self.start))
        while True:
            begin = self._falls[0]
            for corner in self._falls[1:]:
                above = corner.place[-1] >= level
                begin = begin.put(above, corner.take(above))
            height, down = np.maximum(begin.place[-1] - level, 0.0), -begin.velocity[-1]
            front = begin.time == self._falls[-1].time
            further = falls & front & (_time_to_fall(height, down, 0.5 * self.gravity) > self._falling.longest(begin.velocity))
            if not further.any():
                break
            self._fall_on(np.flatnonzero(further))
        found = self._falling.advance(begin, "touch", lambda _, moved: np.where(falls, _time_to_fall(height, down, -moved[-1]), 0.0))
        touch = np.where(falls, self.start + found.time, np.inf)
        self._known[:] = [(touch, found)]
        return touch, -found.velocity[-1]

    def apex(self) -> tuple[Floats, Floats]:
        """Return time [s] and gap [m] at the top of the flight; infinite without gravity, if rising."""
        never, top = (self.gravity == 0.0) & (self.velocity > 0.0), self._falls[0]
        return np.where(never, np.inf, self.start + top.time), np.where(never, np.inf, top.place[-1])

    def lost(self, time: Floats) -> Floats:
        """Return the energy per mass of the sphere that drag has taken by times [s] (..., B) [J/kg]."""
        return self._moving(time).lost

    def given(self, time: Floats) -> Floats:
        """Return the energy per mass that the sphere has given to the fluid by times [s] (..., B) [J/kg].

        This is what drag has taken, and what the fluid that moves along has gained since the start of the flight.
        """
        moving, start = self._moving(time), self._rises[0].velocity
        along = 0.5 * (self.fluid.inertia(self.density) - 1.0)
        return np.asarray(moving.lost + along * ((moving.velocity**2).sum(axis=0) - (start**2).sum(axis=0)))

    def acceleration(self, time: Floats) -> Floats:
        """Return the upward acceleration at times [s] (..., B) [m/s^2]."""
        return np.asarray(self._falling.acceleration(np.moveaxis(self._moving(time).velocity, 0, -2))[0][..., -1, :])

    def carry(self, sphere: Sphere, state: State, time: Floats) -> State:
        """Return the state along the plate at times [s] (..., B), from that at the start of the flight."""
        moving = self._moving(time)
        return State(state.position + moving.place[:-1], moving.velocity[:-1].copy(), state.spin)

    @cached_property
    def _falling(self) -> Falling:
        return Falling(self.fluid, self.radius, self.density, np.concatenate([self.along[1], -self.gravity[None]]))

    @cached_property
    def _rises(self) -> list[Moving]:
        """Motion at the start of the flight, at the end of each piece up to the top, and there."""
        velocity, none = np.concatenate([self.along[0], self.velocity[None]]), np.zeros(len(self.start))
        found = [Moving(none, np.concatenate([np.zeros_like(self.along[0]), self.gap[None]]), velocity, none)]
        while (rising := np.flatnonzero((found[-1].velocity[-1] > 0.0) & (self.gravity > 0.0))).size:
            found.append(found[-1].put(rising, self._falling.take(rising).rise(found[-1].take(rising))))
        return found

    @cached_property
    def _falls(self) -> list[Moving]:
        """Motion at the top of the flight, and at the end of each piece from there on, as far as they have been asked for."""
        return [self._rises[-1]]

    def _fall_on(self, drops: Drops) -> None:
        """Add a piece to the falls of drops."""
        begin, falling = self._falls[-1].take(drops), self._falling.take(drops)
        longest = falling.longest(begin.velocity)
        self._falls.append(self._falls[-1].put(drops, falling.advance(begin, "touch", lambda *_: longest)))

    def _moving(self, time: Floats) -> Moving:
        """Return the motion at times [s] (..., B): its arrays are (..., B) and (C, ..., B)."""
        for known, moving in self._known:
            if np.array_equal(time, known):
                return moving
        elapsed = np.where(np.isinf(time), np.nan, time - self.start)
        drop, flat = np.broadcast_to(np.arange(len(self.start)), elapsed.shape).ravel(), elapsed.ravel()
        while (short := self._short(elapsed)).size:
            self._fall_on(short)
        begin, top = self._rises[0].take(drop), self._falls[0].time[drop]
        for corner in (*self._rises[1:], *self._falls[1:]):
            passed = corner.time[drop] <= flat
            begin = begin.put(passed, corner.take(drop[passed]))
        moving, falling, since = begin, self._falling.take(drop), flat - begin.time
        rising = flat < top
        if rising.any():
            moving = moving.put(rising, falling.take(rising).advance(begin.take(rising), "release", lambda *_: since[rising]))
        if not rising.all():
            fall = ~rising
            moving = moving.put(fall, falling.take(fall).advance(begin.take(fall), "touch", lambda *_: since[fall]))
        return Moving(*(part.reshape(*part.shape[:-1], *elapsed.shape) for part in vars(moving).values()))

    def _short(self, elapsed: Floats) -> Drops:
        """Return the drops whose falls have to be followed further to reach some times since the start of the flight (..., B)."""
        front, last = self._falls[-1], np.fmax.reduce(elapsed.reshape(-1, len(self.start)))
        return np.flatnonzero(last - front.time > self._falling.longest(front.velocity))

    @cached_property
    def _known(self) -> list[tuple[Floats, Moving]]:
        """The last touch that was asked for: its time, and the motion then."""
        return []


def _time_to_fall(height: Floats, down: Floats, mean: Floats) -> Floats:
    """Return the time of a fall through a height [s], from a downward velocity and half the mean acceleration of its first part."""
    with np.errstate(divide="ignore", invalid="ignore"):
        time = 2.0 * height / (down + np.sqrt(np.maximum(down**2 + 4.0 * mean * height, 0.0)))
    return np.where(height > 0.0, time, 0.0)


def flights_of(problem: Problem, gap: Floats, velocity: Floats) -> FluidFlight:
    """Return flights through the air or the liquid of a single drop, from gaps [m] with upward velocities [m/s] (n,).

    Along the plate they begin with the velocity of the drop.
    """
    oblique, alike = problem.oblique, np.ones(len(gap))
    assert problem.fluid is not None
    velocities, gravity = (np.zeros(0), np.zeros(0)) if oblique is None else (np.array(oblique.velocity), np.array(oblique.gravity))
    mass, radius = problem.sphere.mass * alike, problem.sphere.contact_offset * alike
    part = problem.net_weight / problem.flight_inertia
    along = velocities[:, None] * alike, gravity[:, None] * part * alike
    pull = problem.gravity * part * alike
    return FluidFlight(0.0 * alike, gap, velocity, pull, radius, mean_density(mass, radius), problem.fluid, along)


def speed_of_fall(problem: Problem) -> float:
    """Return the speed at the first touch of a single drop from a height through air or a liquid [m/s]."""
    assert problem.height is not None
    gap, velocity = np.array([problem.height - problem.sphere.contact_offset]), np.array([problem.velocity], dtype=float)
    return float(flights_of(problem, gap, velocity).touch(np.zeros(1))[1][0])
