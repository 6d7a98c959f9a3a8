"""Columns of the history of one drop that moves along the plate and spins."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.columns import OBLIQUE_HISTORY_COLUMNS
from vibroimpact.dynamics.leg import Leg
from vibroimpact.dynamics.oblique.state import State
from vibroimpact.dynamics.oblique.statement import Oblique


def oblique_history(oblique: Oblique, legs: Sequence[Leg], lost: Floats, time: Floats) -> dict[str, Floats]:
    """Return columns of the motion along the plate at times within the run.

    Parameters
    ----------
    oblique : Oblique
        What the drop has at the start.
    legs : sequence of Leg
        Its flights and contacts.
    lost : array, shape (impacts,)
        Energy that friction took in each contact [J].
    time : array, shape (T,)
        Times since the start [s], in order.

    Returns
    -------
    dict of str to array
        The columns of `OBLIQUE_HISTORY_COLUMNS` (T,), and what the motion adds to "kinetic_J" and "potential_J".
    """
    found = {name: np.zeros(len(time)) for name in (*OBLIQUE_HISTORY_COLUMNS, "kinetic_J", "potential_J")}
    begin = np.searchsorted([float(leg.flight.start[0]) for leg in legs], time, side="right") - 1
    so_far = np.concatenate([[0.0], np.cumsum(lost)])
    for number in np.unique(np.maximum(begin, 0)).tolist():
        here = np.flatnonzero(np.maximum(begin, 0) == number)
        for name, values in _of_leg(oblique, legs[number], float(so_far[number]), time[here]).items():
            found[name][here] = values
    return found


def _of_leg(oblique: Oblique, leg: Leg, lost: float, time: Floats) -> dict[str, Floats]:
    """Return the columns at times within a leg, or in the rest that follows it, and energy lost to friction before it [J]."""
    assert leg.oblique is not None
    sphere, start = leg.oblique
    touch = float(leg.flight_end[0])
    state, friction, taken = sphere.fly(start, time - float(leg.flight.start[0])), np.zeros((2, len(time))), np.full(len(time), lost)
    state = State(state.position, state.velocity, start.spin + np.zeros(len(time)))
    after = time > touch
    if leg.oblique_contacts and after.any():
        ((_, contact),) = leg.oblique_contacts
        in_contact, force = contact.at(time[after] - touch)
        parting = float(contact.sliding.time[-1, 0])
        later = sphere.fly(in_contact, np.maximum(time[after] - touch - parting, 0.0))
        for whole, part in zip((state.position, state.velocity, state.spin), (later.position, later.velocity, later.spin), strict=True):
            whole[:, after] = part
        friction[:, after] = np.where(time[after] - touch < parting, force, 0.0)
        before = contact.before
        work = sphere.mass * (sphere.gravity * (in_contact.position - before.position)).sum(axis=0)
        taken[after] += sum(sphere.kinetic(before)) + work - sum(sphere.kinetic(in_contact))
    kinetic, rotation = sphere.kinetic(state)
    place = np.array(oblique.position, dtype=float)[:, None]
    potential = -sphere.mass * (sphere.gravity * (state.position - place)).sum(axis=0)
    values = [*state.position, *state.velocity, *state.spin, *friction, rotation, taken]
    return {**dict(zip(OBLIQUE_HISTORY_COLUMNS, values, strict=True)), "kinetic_J": kinetic, "potential_J": potential}
