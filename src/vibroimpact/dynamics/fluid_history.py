"""What air or a liquid has taken in the history of one drop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.bounce import Bounce
from vibroimpact.dynamics.motion.flight_in_fluid import FluidFlight
from vibroimpact.dynamics.statement.problem import Problem

_VELOCITIES = ("velocity_m_s", "velocity_x_m_s", "velocity_y_m_s")
MOTION = ("velocity_m_s", "kinetic_J")
"""Columns of the sphere that those of the fluid follow from."""


def fluid_history(
    problem: Problem, bounces: Sequence[Bounce], time: Floats, motion: Mapping[str, Floats]
) -> dict[str, Floats]:
    """Return the kinetic energy with that of the liquid, and what the fluid has taken [J] (T,).

    The liquid moves along with one drop.

    Parameters
    ----------
    problem : Problem
        The drop.
    bounces : sequence of Bounce
        Its flights and contacts.
    time : array, shape (T,)
        Times since the start of the run [s].
    motion : mapping of str to array
        The other columns then.
    """
    fluid = problem.fluid
    first_flight = bounces[0].flight
    assert fluid is not None
    assert isinstance(first_flight, FluidFlight)
    mass = float(problem.sphere.mass)
    half_added_mass = 0.5 * mass * (float(problem.flight_inertia) - 1.0)
    squares = np.zeros(len(time))
    for name in _VELOCITIES:
        if name in motion:
            squares = squares + motion[name] ** 2
    energy_of_liquid = half_added_mass * squares
    velocity_along, _ = first_flight.along
    square_at_start = float(first_flight.velocity[0] ** 2 + (velocity_along**2).sum())
    return {
        "kinetic_J": motion["kinetic_J"] + energy_of_liquid,
        f"{fluid.key}_J": _given(bounces, mass, time)
        + half_added_mass * square_at_start
        - energy_of_liquid,
    }


def _given(bounces: Sequence[Bounce], mass: float, time: Floats) -> Floats:
    """Return the energy that a sphere has given to the fluid by times [J] (T,).

    `mass`: of the sphere [kg]. The energy follows from its flights.
    """
    starts = [float(bounce.flight.start[0]) for bounce in bounces]
    bounce_of_time = np.maximum(np.searchsorted(starts, time, side="right") - 1, 0)
    given = np.zeros(len(time))
    given_before = 0.0
    for number, bounce in enumerate(bounces):
        if isinstance(bounce.flight, FluidFlight):
            inside = bounce_of_time == number
            if inside.any():
                times = np.minimum(time[inside], bounce.flight_end[0])[:, None]
                given[inside] = given_before + mass * bounce.flight.given(times)[:, 0]
            given_before += mass * float(bounce.flight.given(bounce.flight_end)[0])
    return given
