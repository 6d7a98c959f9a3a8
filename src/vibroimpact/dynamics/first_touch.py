"""The time of the first touch of a drop, before its contacts are solved."""

from __future__ import annotations

import numpy as np

from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.run_state import RunState


def first_touch(problem: Problem) -> float:
    """Return the time of the first touch of a single drop [s]; infinite if there is none.

    Parameters
    ----------
    problem : Problem
        The drop.

    Examples
    --------
    >>> from vibroimpact.bodies.body import Body
    >>> from vibroimpact.bodies.rigid_bodies import rigid_plate
    >>> from vibroimpact.contact.laws.newton import Newton
    >>> drop = Problem(
    ...     sphere=Body(mass=1.0, contact_offset=0.1),
    ...     plate=rigid_plate(),
    ...     laws=(Newton(restitution=0.5),),
    ...     height=1.1,
    ... )
    >>> round(first_touch(drop), 6)  # sqrt(2 h/g)
    0.451601
    """
    run = RunState(problem)
    drops = np.zeros(1, dtype=np.intp)
    times, _, _ = run.bodies.next_touch(drops, run.flights(drops), run.law(drops))
    return float(times[0])
