r"""Flight through air or a liquid at rest, whose drag slows the sphere down.

With the velocity v in one dimension or three, the acceleration g at which the sphere would fall
without drag, which is less than gravity in a liquid, and the drag a of
`vibroimpact.dynamics.fluids.fluid`,

.. math:: \dot v = g - a(|v|)\, v / |v|

A flight is solved in pieces: up to its top, which ends one, and down from there. In a piece the
acceleration is a polynomial through the nodes of a Radau rule, in a time that is finest at the top,
where the drag has no second derivative. Its integral gives the velocities at the nodes, and these
the next acceleration; such sweeps converge fast, as a piece is short beside the time constant of
the drag. The motion at any time, and at a touch, is that at the end of a piece that ends there. A
sphere that has reached its terminal velocity to rounding keeps it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.bodies.ball import mean_density
from vibroimpact.dynamics.core import fall
from vibroimpact.dynamics.core.fall_records import Corners, Falling, FallRule, FallRules, Moving
from vibroimpact.dynamics.fluids.fluid import Fluid
from vibroimpact.dynamics.motion.along import Sphere, State
from vibroimpact.dynamics.motion.collocation import collocation_rule
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.statement.problem import Problem

_NODES = 12
_ROOT = 2  # of the time from the top, in which the motion is smooth


def _taken(moving: Moving, drops: Drops | Bools) -> Moving:
    """Return the motion of some of the spheres."""
    return Moving(*(np.ascontiguousarray(array[..., drops]) for array in moving))


def _put(moving: Moving, drops: Drops | Bools, others: Moving) -> Moving:
    """Return the motion with that of some of the spheres replaced."""
    replaced = Moving(*(array.copy() for array in moving))
    for array, values in zip(replaced, others, strict=True):
        array[..., drops] = values
    return replaced


def _falling_of(falling: Falling, drops: Drops) -> Falling:
    """Return what some of the spheres fall through."""
    return Falling(*(np.ascontiguousarray(array[..., drops]) for array in falling))


@cache
def _rules() -> FallRules:
    """Return the rules of pieces up to the top of a flight, and down from there."""
    rules = [collocation_rule(_NODES, time_map, _ROOT) for time_map in ("release", "touch")]
    return FallRules(
        *(
            FallRule(np.ascontiguousarray(rule.integral), rule.integral_twice[-1].copy())
            for rule in rules
        )
    )


@dataclass(frozen=True)
class FluidFlight(Flight):
    """Flights of B drops through air or a liquid, in one dimension or in three.

    All arrays but those of `along` are (B,). `radius`, `density`: of the spheres [m], [kg/m^3].
    `fluid`: what they fly through. `along`: velocities at the start [m/s] and accelerations without
    drag [m/s^2] along the plate, (2, B), or (0, B) where all motion is along the normal.
    """

    radius: Floats
    density: Floats
    fluid: Fluid
    along: tuple[Floats, Floats]

    def after(self, time: Floats) -> FluidFlight:
        """Return the flights from times on [s] (B,)."""
        moving = self._moving(time)
        along = moving.velocity[:-1], self.along[1]
        return replace(
            self, start=time, gap=moving.place[-1], velocity=moving.velocity[-1], along=along
        )

    def at(self, time: Floats) -> tuple[Floats, Floats]:
        """Return gap [m] and upward velocity [m/s] at times [s] (..., B)."""
        moving = self._moving(time)
        return moving.place[-1], moving.velocity[-1]

    def touch(self, level: Floats) -> tuple[Floats, Floats]:
        """Return time [s] and approach speed [m/s] of the next touch.

        The time is infinite if there is none. The surfaces meet where the gap has fallen to
        `level`.
        """
        falls = (self.gravity > 0.0) | (self.velocity < 0.0)
        level = level + np.zeros(len(self.start))
        while True:
            # the last end of a piece above the level
            begin = self._falls[0]
            for corner in self._falls[1:]:
                above = corner.place[-1] >= level
                begin = _put(begin, above, _taken(corner, above))
            height = np.maximum(begin.place[-1] - level, 0.0)
            fall_speed = -begin.velocity[-1]
            # drops that have to be followed by another piece before they can touch
            at_front = begin.time == self._falls[-1].time
            shortest_fall = _time_to_fall(height, fall_speed, 0.5 * self.gravity)
            longest_piece = fall.longest_pieces(self._falling, begin.velocity)
            further = falls & at_front & (shortest_fall > longest_piece)
            if not further.any():
                break
            self._fall_on(np.flatnonzero(further))
        ends = np.where(falls, fall.AT_GAP, fall.GIVEN_TIME)
        motion = fall.follow_pieces(
            _rules().falling, self._falling, begin, ends, np.where(falls, height, 0.0), fall_speed
        )
        touch = np.where(falls, self.start + motion.time, np.inf)
        self._known[:] = [(touch, motion)]
        return touch, -motion.velocity[-1]

    def apex(self) -> tuple[Floats, Floats]:
        """Return time [s] and gap [m] at the top of the flight.

        They are infinite without gravity, if rising.
        """
        never = (self.gravity == 0.0) & (self.velocity > 0.0)
        top = self._falls[0]
        time = np.where(never, np.inf, self.start + top.time)
        gap = np.where(never, np.inf, top.place[-1])
        return time, gap

    def lost(self, time: Floats) -> Floats:
        """Return the energy per mass that drag has taken by times [s] (..., B) [J/kg].

        The mass is that of the sphere.
        """
        return self._moving(time).lost

    def given(self, time: Floats) -> Floats:
        """Return the energy per mass given to the fluid by times [s] (..., B) [J/kg].

        The mass is that of the sphere. The energy is what drag has taken, and what the fluid that
        moves along has gained since the start of the flight.
        """
        moving = self._moving(time)
        start_velocity = self._rises[0].velocity
        gain_of_squares = (moving.velocity**2).sum(axis=0) - (start_velocity**2).sum(axis=0)
        half_added_mass = 0.5 * (self.fluid.inertia(self.density) - 1.0)
        return np.asarray(moving.lost + half_added_mass * gain_of_squares)

    def acceleration(self, time: Floats) -> Floats:
        """Return the upward acceleration at times [s] (..., B) [m/s^2]."""
        velocity = self._moving(time).velocity
        flat = np.ascontiguousarray(velocity.reshape(len(velocity), -1))
        accelerations = fall.accelerations(self._falling, self._drops(velocity[0]), flat)
        return np.asarray(accelerations[-1].reshape(velocity.shape[1:]))

    def carry(self, sphere: Sphere, state: State, time: Floats) -> State:
        """Return the state along the plate at times [s] (..., B).

        It follows from that at the start of the flight.
        """
        moving = self._moving(time)
        return State(state.position + moving.place[:-1], moving.velocity[:-1].copy(), state.spin)

    @cached_property
    def _falling(self) -> Falling:
        """What the spheres fall through, as the core takes it."""
        fluid = self.fluid
        ones = np.ones(len(self.start))
        coefficient = fluid.constant_coefficient
        if coefficient is None:
            coefficient = np.nan  # it follows from the Reynolds number
        _, acceleration_along = self.along
        return Falling(
            reynolds=fluid.reynolds_number(ones, self.radius),
            drag=fluid.drag_by_square(self.radius, self.density) * ones,
            coefficient=coefficient * ones,
            inertia=fluid.inertia(self.density) * ones,
            # in the order that the core takes
            gravity=np.ascontiguousarray(np.concatenate([acceleration_along, -self.gravity[None]])),
        )

    @cached_property
    def _rises(self) -> list[Moving]:
        """Motion at the start of the flight, at the end of each piece up to the top, and there."""
        velocity = np.ascontiguousarray(np.concatenate([self.along[0], self.velocity[None]]))
        place = np.zeros(velocity.shape)
        place[-1] = self.gap
        zeros = np.zeros(len(self.start))
        pieces = [Moving(zeros, place, velocity, zeros)]
        while True:
            last = pieces[-1]
            rising = np.flatnonzero((last.velocity[-1] > 0.0) & (self.gravity > 0.0))
            if not rising.size:
                return pieces
            higher = fall.rise(
                _rules().rising, _falling_of(self._falling, rising), _taken(last, rising)
            )
            pieces.append(_put(last, rising, higher))

    @cached_property
    def _falls(self) -> list[Moving]:
        """Motion at the top of the flight, and at the end of each piece from there on.

        It reaches as far as it has been asked for.
        """
        return [self._rises[-1]]

    def _fall_on(self, drops: Drops) -> None:
        """Add a piece to the falls of drops."""
        begin = _taken(self._falls[-1], drops)
        falling = _falling_of(self._falling, drops)
        longest = fall.longest_pieces(falling, begin.velocity)
        ends = np.full(len(drops), fall.GIVEN_TIME)
        end = fall.follow_pieces(_rules().falling, falling, begin, ends, longest, longest)
        self._falls.append(_put(self._falls[-1], drops, end))

    def _moving(self, time: Floats) -> Moving:
        """Return the motion at times [s] (..., B): its arrays are (..., B) and (C, ..., B)."""
        for known, moving in self._known:
            if np.array_equal(time, known):
                return moving
        elapsed = np.where(np.isinf(time), np.nan, time - self.start)
        drops = self._drops(elapsed)
        while (short := self._short(elapsed)).size:
            self._fall_on(short)
        moving = fall.motion_at(_rules(), self._falling, self._corners, drops, elapsed.ravel())
        return Moving(*(part.reshape(*part.shape[:-1], *elapsed.shape) for part in moving))

    def _drops(self, times: Floats) -> Drops:
        """Return the drops that times (..., B) belong to, of all times in order."""
        return np.tile(np.arange(len(self.start)), times.size // len(self.start))

    @property
    def _corners(self) -> Corners:
        """Motion at the start and at the ends of all pieces that have been asked for."""
        pieces = [*self._rises, *self._falls[1:]]
        if len(self._stacked) != 1 or len(self._stacked[0].time) != len(pieces):
            time, place, velocity, lost = (np.stack(parts) for parts in zip(*pieces, strict=True))
            self._stacked[:] = [Corners(time, place, velocity, lost, len(self._rises) - 1)]
        return self._stacked[0]

    @cached_property
    def _stacked(self) -> list[Corners]:
        """Cache of `_corners`."""
        return []

    def _short(self, elapsed: Floats) -> Drops:
        """Return the drops whose falls have to be followed further to reach some times.

        Times are since the start of the flight (..., B).
        """
        front = self._falls[-1]
        last = np.fmax.reduce(elapsed.reshape(-1, len(self.start)))
        longest = fall.longest_pieces(self._falling, front.velocity)
        return np.flatnonzero(last - front.time > longest)

    @cached_property
    def _known(self) -> list[tuple[Floats, Moving]]:
        """The last touch that was asked for: its time, and the motion then."""
        return []


def _time_to_fall(height: Floats, fall_speed: Floats, half_acceleration: Floats) -> Floats:
    """Return the time of a fall through a height [s].

    `half_acceleration`: half the mean of its first part.
    """
    root = np.sqrt(np.maximum(fall_speed**2 + 4.0 * half_acceleration * height, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        time = 2.0 * height / (fall_speed + root)
    return np.where(height > 0.0, time, 0.0)


def flight_of(
    problem: Problem, start: Floats, gap: Floats, velocity: Floats, along: Floats
) -> Flight:
    """Return flights of the sphere of a single drop: in a vacuum, or through its air or liquid.

    Parameters
    ----------
    problem : Problem
        The drop.
    start, gap, velocity : array, shape (n,)
        Starts [s], gaps [m] and upward velocities [m/s] then.
    along : array, shape (2, n) or (0, n)
        Velocities along the plate then [m/s]; (0, n) where all motion is along the normal.
    """
    ones = np.ones(len(gap))
    inertia = problem.flight_inertia
    gravity = problem.net_gravity / inertia * ones
    if problem.fluid is None:
        return Flight(start, gap, velocity, gravity)
    pull = np.zeros((0, len(gap)))
    if problem.oblique is not None:
        pull_along = np.array(problem.oblique.gravity) * problem.net_weight / inertia
        pull = pull_along[:, None] * ones
    mass = problem.sphere.mass * ones
    radius = problem.sphere.contact_offset * ones
    return FluidFlight(
        start=start,
        gap=gap,
        velocity=velocity,
        gravity=gravity,
        radius=radius,
        density=mean_density(mass, radius),
        fluid=problem.fluid,
        along=(along, pull),
    )


def speed_of_fall(problem: Problem) -> float:
    """Return the speed at the first touch of a drop from a height through air or a liquid [m/s]."""
    assert problem.height is not None
    gap = np.array([problem.height - problem.sphere.contact_offset])
    velocity = np.array([problem.velocity], dtype=float)
    _, speed = first_flights(problem, gap, velocity).touch(np.zeros(1))
    return float(speed[0])


def first_flights(problem: Problem, gap: Floats, velocity: Floats) -> Flight:
    """Return flights of the sphere of a single drop from its start.

    They start from gaps [m] with upward velocities [m/s] (n,). Along the plate they begin with the
    velocity of the drop.
    """
    ones = np.ones(len(gap))
    along = np.zeros((0, len(gap)))
    if problem.oblique is not None:
        along = np.array(problem.oblique.velocity)[:, None] * ones
    return flight_of(problem, 0.0 * ones, gap, velocity, along)
