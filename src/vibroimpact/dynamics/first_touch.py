"""The time of the first touch of a drop, before its contacts are solved."""

from __future__ import annotations

import numpy as np

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.motion.flight_in_fluid import first_flights
from vibroimpact.dynamics.motion.run_rules import start_of
from vibroimpact.dynamics.statement.problem import Problem


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
    # a drop loads only what it needs
    if problem.vibrates:
        from vibroimpact.dynamics.vibrating.drops import drop_of

        return drop_of(problem).first_touch()
    if problem.shaken:
        from vibroimpact.dynamics.shaken.hard_drop import HardDrop

        return HardDrop(problem).first_touch()
    gap, velocity = start_of(problem)
    law = problem.law_of(0)
    level = 0.0
    if isinstance(law, CompliantLaw):
        level = -law.touch_level
    flight = first_flights(problem, np.array([gap]), np.array([velocity]))
    touch, _ = flight.touch(np.array([level]))
    return float(touch[0])
