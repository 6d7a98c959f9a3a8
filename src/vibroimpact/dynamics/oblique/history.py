"""Columns of the history of one drop that moves along the plate and spins."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.along import State, energy_taken
from vibroimpact.dynamics.motion.bounce import Bounce
from vibroimpact.dynamics.motion.columns import OBLIQUE_HISTORY_COLUMNS
from vibroimpact.dynamics.oblique.lying import lie
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.dynamics.statement.problem import Problem


def oblique_history(
    problem: Problem, bounce: Bounce, lost: float, time: Floats, lies_from: float
) -> dict[str, Floats]:
    """Return columns of the motion along the plate at times within a bounce.

    Parameters
    ----------
    problem : Problem
        The problem of the drop.
    bounce : Bounce
        Its flight and contact, the last one for times after it.
    lost : float
        Energy that friction took before the bounce [J].
    time : array, shape (T,)
        Times since the start [s].
    lies_from : float
        Time from which the sphere lies on the plate [s]; infinite if it does not.

    Returns
    -------
    dict of str to array
        The columns of `OBLIQUE_HISTORY_COLUMNS` (T,), and what the motion adds to "kinetic_J" and
        "potential_J".
    """
    assert problem.oblique is not None
    moving = _of_bounce(bounce, lost, time, lies_from)
    if lies_from < np.inf:
        moving = _lying(problem, bounce, moving, np.maximum(time - lies_from, 0.0))
    return _columns(problem.oblique, bounce, *moving)


Moving = tuple[State, Floats, Floats]
"""States, friction forces [N] (2, T), and energy that friction took so far [J] (T,)."""


def _of_bounce(bounce: Bounce, lost: float, time: Floats, lies_from: float) -> Moving:
    """Return the motion at times within a bounce, up to where the sphere lies; `lost`:
    energy that friction took before it [J].
    """
    assert bounce.oblique is not None
    sphere, start = bounce.oblique
    touch, time, lies = float(bounce.flight_end[0]), np.minimum(time, lies_from), time >= lies_from
    state, friction, taken = (
        bounce.flight.carry(sphere, start, np.minimum(time, touch)),
        np.zeros((2, len(time))),
        np.full(len(time), lost),
    )
    state = State(state.position, state.velocity, start.spin + np.zeros(len(time)))
    # an impulse has no duration: a sphere may lie from the time of touch on
    after = (time > touch) | lies
    if bounce.along is not None and after.any():
        in_contact, force, lost_here = bounce.along.at(time[after] - touch)
        parting = float(bounce.along.duration[0])
        later = sphere.fly(in_contact, np.maximum(time[after] - touch - parting, 0.0))
        for whole, part in zip(
            (state.position, state.velocity, state.spin),
            (later.position, later.velocity, later.spin),
            strict=True,
        ):
            whole[:, after] = part
        friction[:, after] = np.where(time[after] - touch < parting, force, 0.0)
        taken[after] += lost_here
    return state, friction, taken


def _lying(problem: Problem, bounce: Bounce, moving: Moving, elapsed: Floats) -> Moving:
    """Return the motion of a sphere that lies on the plate for some times [s]; `moving`:
    when it came to lie, the same for all of them.
    """
    assert bounce.oblique is not None
    assert problem.oblique is not None
    sphere, _ = bounce.oblique
    states, _, taken = moving
    start = states.take(np.zeros(1, dtype=np.intp))
    pressing = np.array([float(problem.net_gravity)])
    # up to the largest time: the steps of twisting depend on it
    times = np.append(elapsed, elapsed.max())[None]
    lying, friction, _ = lie(sphere, start, problem.oblique.friction, pressing, times)
    state = lying.take(np.arange(len(elapsed)))
    return state, friction[:, :-1], taken + energy_taken(sphere, start, state)


def _columns(
    oblique: Oblique, bounce: Bounce, state: State, friction: Floats, taken: Floats
) -> dict[str, Floats]:
    """Return the columns of a motion."""
    assert bounce.oblique is not None
    sphere, _ = bounce.oblique
    kinetic, rotation = sphere.kinetic(state)
    place = np.array(oblique.position, dtype=float)[:, None]
    potential = -sphere.mass * (sphere.gravity * (state.position - place)).sum(axis=0)
    values = [*state.position, *state.velocity, *state.spin, *friction, rotation, taken]
    return {
        **dict(zip(OBLIQUE_HISTORY_COLUMNS, values, strict=True)),
        "kinetic_J": kinetic,
        "potential_J": potential,
    }
