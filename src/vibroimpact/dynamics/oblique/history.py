"""Columns of the history of one drop that moves along the plate and spins."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.columns import OBLIQUE_HISTORY_COLUMNS
from vibroimpact.dynamics.leg import Leg
from vibroimpact.dynamics.oblique.rolling import LyingSpheres
from vibroimpact.dynamics.oblique.state import State, energy_taken
from vibroimpact.dynamics.oblique.statement import Oblique
from vibroimpact.dynamics.problem import Problem


def oblique_history(problem: Problem, legs: Sequence[Leg], lost: Floats, time: Floats, lies_from: float) -> dict[str, Floats]:
    """Return columns of the motion along the plate at times within the run.

    Parameters
    ----------
    problem : Problem
        The problem of the drop.
    legs : sequence of Leg
        Its flights and contacts.
    lost : array, shape (impacts,)
        Energy that friction took in each contact [J].
    time : array, shape (T,)
        Times since the start [s].
    lies_from : float
        Time from which the sphere lies on the plate [s]; infinite if it does not.

    Returns
    -------
    dict of str to array
        The columns of `OBLIQUE_HISTORY_COLUMNS` (T,), and what the motion adds to "kinetic_J" and "potential_J".
    """
    oblique = problem.oblique
    assert oblique is not None
    found = {name: np.zeros(len(time)) for name in (*OBLIQUE_HISTORY_COLUMNS, "kinetic_J", "potential_J")}
    begin = np.searchsorted([float(leg.flight.start[0]) for leg in legs], time, side="right") - 1
    so_far = np.concatenate([[0.0], np.cumsum(lost)])
    for number in np.unique(np.maximum(begin, 0)).tolist():
        here = np.flatnonzero(np.maximum(begin, 0) == number)
        moving = _of_leg(legs[number], float(so_far[number]), np.minimum(time[here], lies_from))
        if lies_from < np.inf:
            moving = _lying(problem, legs[number], moving, np.maximum(time[here] - lies_from, 0.0))
        for name, values in _columns(oblique, legs[number], *moving).items():
            found[name][here] = values
    return found


Moving = tuple[State, Floats, Floats]
"""States, friction forces [N] (2, T), and energy that friction took so far [J] (T,)."""


def _of_leg(leg: Leg, lost: float, time: Floats) -> Moving:
    """Return the motion at times within a leg; `lost`: energy that friction took before it [J]."""
    assert leg.oblique is not None
    sphere, start = leg.oblique
    touch = float(leg.flight_end[0])
    state, friction, taken = leg.flight.carry(sphere, start, np.minimum(time, touch)), np.zeros((2, len(time))), np.full(len(time), lost)
    state = State(state.position, state.velocity, start.spin + np.zeros(len(time)))
    after = time > touch
    if leg.oblique_contacts and after.any():
        ((_, contact),) = leg.oblique_contacts
        in_contact, force, lost_here = contact.at(time[after] - touch)
        parting = float(contact.duration[0])
        later = sphere.fly(in_contact, np.maximum(time[after] - touch - parting, 0.0))
        for whole, part in zip((state.position, state.velocity, state.spin), (later.position, later.velocity, later.spin), strict=True):
            whole[:, after] = part
        friction[:, after] = np.where(time[after] - touch < parting, force, 0.0)
        taken[after] += lost_here
    return state, friction, taken


def _lying(problem: Problem, leg: Leg, moving: Moving, elapsed: Floats) -> Moving:
    """Return the motion of a sphere that lies on the plate for some times [s]; `moving`: when it came to lie, the same for all of them."""
    assert leg.oblique is not None
    assert problem.oblique is not None
    (sphere, _), (states, _, taken), same = leg.oblique, moving, np.zeros(len(elapsed), dtype=np.intp)
    start, pressing = states.take(same[:1]), np.array([float(problem.gravity)])
    lying = LyingSpheres(sphere, start, problem.oblique.friction, pressing, elapsed.max(keepdims=True))
    state, friction = lying.at(same, elapsed)
    return state, friction, taken + energy_taken(sphere, start, state)


def _columns(oblique: Oblique, leg: Leg, state: State, friction: Floats, taken: Floats) -> dict[str, Floats]:
    """Return the columns of a motion."""
    assert leg.oblique is not None
    sphere, _ = leg.oblique
    kinetic, rotation = sphere.kinetic(state)
    place = np.array(oblique.position, dtype=float)[:, None]
    potential = -sphere.mass * (sphere.gravity * (state.position - place)).sum(axis=0)
    values = [*state.position, *state.velocity, *state.spin, *friction, rotation, taken]
    return {**dict(zip(OBLIQUE_HISTORY_COLUMNS, values, strict=True)), "kinetic_J": kinetic, "potential_J": potential}
