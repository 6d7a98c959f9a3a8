"""Flights of rigid drops through air or a liquid, between the contacts that the core solves."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.bodies.ball import mean_density
from vibroimpact.dynamics.core import drop_records as records
from vibroimpact.dynamics.core.drop_records import DropManner, Drops, FreeFall, ObliqueDrops
from vibroimpact.dynamics.core.drops import write_touch_gaps
from vibroimpact.dynamics.core.stop_rules import first_end
from vibroimpact.dynamics.fluids.fluid import Fluid
from vibroimpact.dynamics.motion.along import State, spheres_of
from vibroimpact.dynamics.motion.flight_in_fluid import FluidFlight
from vibroimpact.dynamics.motion.run_rules import default_rest_speeds
from vibroimpact.dynamics.statement.problem import Problem


class FluidDrops:
    """What B drops have that fly through a fluid.

    `to_fluid`: energy that they gave to it so far [J] (B,). `lost`: energy that its drag took in
    the flight before each impact [J] (B, R).

    Parameters
    ----------
    problem : Problem
        What is simulated.
    drops : Drops
        The drops at their start.
    oblique : ObliqueDrops or None
        Their motion along the plate, if they have any.
    """

    def __init__(self, problem: Problem, drops: Drops, oblique: ObliqueDrops | None) -> None:
        assert problem.fluid is not None
        size = len(drops.phases)
        self.fluid: Fluid = problem.fluid
        self.to_fluid = np.zeros(size)
        self.lost = np.full((size, drops.rows.shape[1]), np.nan)
        self._oblique = oblique
        self._sphere = None if oblique is None else spheres_of(problem)
        self._mass = drops.state[:, records.MASS]
        self._inertia = drops.state[:, records.INERTIA]
        self._lasts = problem.memory_lasts
        self._half = np.full((2, 1), np.inf)
        if oblique is not None:
            self._half = np.array([[oblique.half_x], [oblique.half_y]])
        self._give_rest_speeds(problem, drops)
        self.liquid_at_start = self.energy_of_liquid(drops.state[:, records.VELOCITY])

    def _give_rest_speeds(self, problem: Problem, drops: Drops) -> None:
        """Give drops a rest speed unless they have one."""
        if problem.rest_speed is not None:
            return
        flights = self.flights(drops, np.arange(len(drops.phases)))
        state = drops.state.T
        drops.state[:, records.REST_SPEED] = default_rest_speeds(
            problem.law_of(0), flights, state[records.MASS], state[records.GRAVITY]
        )

    def flights(self, drops: Drops, numbers: Indices) -> FluidFlight:
        """Return the flights that some drops are about to make."""
        state = drops.state[numbers].T
        velocity = np.zeros((0, len(numbers)))
        pull = velocity
        if self._oblique is not None and self._sphere is not None:
            velocity = State.of_rows(self._oblique.along[numbers]).velocity
            pull = self._sphere.take(numbers).gravity / state[records.INERTIA]
        mass = state[records.MASS]
        radius = state[records.RADIUS]
        return FluidFlight(
            start=state[records.TIME],
            gap=state[records.GAP],
            velocity=state[records.VELOCITY],
            gravity=state[records.GRAVITY] / state[records.INERTIA],
            radius=radius,
            density=mean_density(mass, radius),
            fluid=self.fluid.take(numbers),
            along=(velocity, pull),
        )

    def fly(self, drops: Drops, manner: DropManner) -> None:
        """Let drops fly to their next touches, or until a rule ends their runs."""
        flying = np.flatnonzero(drops.phases == records.IN_FLIGHT)
        if not flying.size:
            return
        gaps = np.empty(len(drops.phases))
        write_touch_gaps(manner, drops, gaps)
        flight = self.flights(drops, flying)
        touch, speed = flight.touch(gaps[flying])
        top, _ = flight.apex()
        is_beside = self._is_beside(flight, flying, touch)
        time = np.empty(len(flying))
        for number, drop in enumerate(flying.tolist()):
            fall = FreeFall(
                float(flight.start[number]),
                float(top[number]),
                float(touch[number]),
                float(speed[number]),
                bool(is_beside[number]),
            )
            end, ending = first_end(manner.stops, fall, int(drops.impacts[drop]))
            time[number] = min(end, fall.touch)
            drops.phases[drop] = records.AT_TOUCH
            if fall.touch >= end:
                drops.phases[drop] = ending
                drops.state[drop, records.END_TIME] = end
        self._put(drops, flying, flight, time)
        drops.state[flying, records.CLOSING] = speed

    def _is_beside(self, flight: FluidFlight, numbers: Indices, time: Floats) -> Floats:
        """Return which drops will be beside the plate at times of their flights [s]."""
        if self._oblique is None or self._sphere is None:
            return np.zeros(len(numbers), dtype=bool)
        here = State.of_rows(self._oblique.along[numbers])
        with np.errstate(invalid="ignore"):
            place = flight.carry(self._sphere.take(numbers), here, time).position
        return np.asarray(np.isfinite(time) & (np.abs(place) > self._half).any(axis=0))

    def _put(self, drops: Drops, numbers: Indices, flight: FluidFlight, time: Floats) -> None:
        """Put drops where they are at times of their flights [s]."""
        if self._oblique is not None and self._sphere is not None:
            here = State.of_rows(self._oblique.along[numbers])
            there = flight.carry(self._sphere.take(numbers), here, time)
            self._oblique.along[numbers] = there.rows
        gap, velocity = flight.at(time)
        drops.state[numbers, records.GAP] = gap
        drops.state[numbers, records.VELOCITY] = velocity
        drops.state[numbers, records.TIME] = time
        drops.flights[numbers] += 1
        mass = drops.state[numbers, records.MASS]
        self.to_fluid[numbers] += mass * flight.given(time)
        touches = drops.phases[numbers] == records.AT_TOUCH
        if touches.any():
            lost = mass * flight.lost(time)
            touching = numbers[touches]
            self._make_room(drops)
            self.lost[touching, drops.impacts[touching]] = lost[touches]

    def _make_room(self, drops: Drops) -> None:
        """Make room for as many impacts as the drops have."""
        more = drops.rows.shape[1] - self.lost.shape[1]
        if more > 0:
            self.lost = np.pad(self.lost, ((0, 0), (0, more)), constant_values=np.nan)

    def leave(self, drops: Drops, numbers: Indices) -> None:
        """Take account of what the core does not know of impacts that drops have just had."""
        last = drops.impacts[numbers] - 1
        rising = drops.rows[numbers, last, records.SEPARATION] > 0.0
        if not rising.any():
            return
        risen = numbers[rising]
        flight = self.flights(drops, risen)
        _, top = flight.apex()
        radius = drops.state[risen, records.RADIUS]
        drops.rows[risen, last[rising], records.REBOUND] = radius + top
        if self._oblique is not None and self._sphere is not None and self._lasts:
            self._leave_dents(drops, risen, flight)

    def _leave_dents(self, drops: Drops, numbers: Indices, flight: FluidFlight) -> None:
        """Forget the dents of drops that touch next beyond the radius of their last contact."""
        assert self._oblique is not None  # they move along the plate
        assert self._sphere is not None
        touch, _ = flight.touch(np.zeros(1))
        start = State.of_rows(self._oblique.along[numbers])
        with np.errstate(invalid="ignore"):  # of flights without another touch
            end = flight.carry(self._sphere.take(numbers), start, touch)
            moved_x, moved_y = end.position - start.position
            distance = np.nan_to_num(np.hypot(moved_x, moved_y))
        impacts = drops.impacts[numbers]
        last = impacts - 1
        indentation = np.nan_to_num(drops.rows[numbers, last, records.INDENTATION])
        # Hertz: a^2 = R delta
        contact_radius = np.sqrt(drops.state[numbers, records.RADIUS] * indentation)
        leaving = distance > contact_radius
        drops.state[numbers[leaving], records.DENT] = 0.0
        last_law = drops.laws.shape[1] - 1
        fresh = drops.laws[numbers, np.minimum(impacts, last_law)]
        drops.coefficients[numbers[leaving]] = fresh[leaving]

    def lost_before_impacts(self, most: int) -> Floats:
        """Return what drag took in the flights before the first impacts [J] (B, most)."""
        missing = max(most - self.lost.shape[1], 0)
        lost = np.pad(self.lost, ((0, 0), (0, missing)), constant_values=np.nan)
        return lost[:, :most]

    def energy_of_liquid(self, velocity: Floats) -> Floats:
        """Return the kinetic energy of the liquid that moves along with the spheres [J] (B,).

        `velocity`: of these along the normal [m/s].
        """
        squares = velocity**2
        if self._oblique is not None:
            along = State.of_rows(self._oblique.along).velocity
            squares = squares + (along**2).sum(axis=0)
        return np.asarray(0.5 * self._mass * (self._inertia - 1.0) * squares)
