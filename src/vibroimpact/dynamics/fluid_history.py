"""What air or a liquid has taken in the history of one drop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.bounce import Bounce
from vibroimpact.dynamics.flight_in_fluid import FluidFlight
from vibroimpact.dynamics.problem import Problem

_VELOCITIES = ("velocity_m_s", "velocity_x_m_s", "velocity_y_m_s")
MOTION = ("velocity_m_s", "kinetic_J")
"""Columns of the sphere that those of the fluid follow from."""


def fluid_history(
    problem: Problem, bounces: Sequence[Bounce], time: Floats, motion: Mapping[str, Floats]
) -> dict[str, Floats]:
    """Return the kinetic energy with that of the liquid that moves along, and what the fluid has
    taken, of one drop [J] (T,).

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
    fluid, mass, begin = problem.fluid, float(problem.sphere.mass), bounces[0].flight
    assert fluid is not None
    assert isinstance(begin, FluidFlight)
    moving = 0.5 * mass * (float(problem.flight_inertia) - 1.0)  # of the liquid
    along = moving * sum(
        (motion[name] ** 2 for name in _VELOCITIES if name in motion), np.zeros(len(time))
    )
    at_start = moving * float(begin.velocity[0] ** 2 + (begin.along[0] ** 2).sum())
    return {
        "kinetic_J": motion["kinetic_J"] + along,
        f"{fluid.key}_J": _given(bounces, mass, time) + at_start - along,
    }


def _given(bounces: Sequence[Bounce], mass: float, time: Floats) -> Floats:
    """Return the energy that a sphere of a mass [kg] has given to the fluid by times [J]
    (T,), from its flights.
    """
    begin = np.maximum(
        np.searchsorted([float(bounce.flight.start[0]) for bounce in bounces], time, side="right")
        - 1,
        0,
    )
    found, before = np.zeros(len(time)), 0.0
    for number, bounce in enumerate(bounces):
        if isinstance(bounce.flight, FluidFlight):
            here = begin == number
            if here.any():
                found[here] = (
                    before
                    + mass
                    * bounce.flight.given(np.minimum(time[here], bounce.flight_end[0])[:, None])[
                        :, 0
                    ]
                )
            before += mass * float(bounce.flight.given(bounce.flight_end)[0])
    return found
