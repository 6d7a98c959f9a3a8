"""Propagation of a small difference of the state through stretches of contact."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core import contact_records
from vibroimpact.dynamics.core.tangent import propagate
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.local import LocalContact, contacts_of
from vibroimpact.dynamics.vibrating.radau_eigenbasis import bases_of
from vibroimpact.dynamics.vibrating.recorded_motion import RecordedMotion


def propagate_difference(
    recorded: RecordedMotion,
    between: tuple[int, int],
    difference: State,
    variations: Sequence[tuple[LocalContact, float]],
) -> tuple[State, Floats]:
    """Return the differences of the state at the end of stretches, and of the contact force.

    The latter is given at the nodes of the stretches [N] (P, N). The core computes both.

    Parameters
    ----------
    recorded : RecordedMotion
        The motion of a drop.
    between : tuple of two ints
        The first of its stretches under one law, and the one after the last.
    difference : State
        Difference of the state at their start between a neighbouring motion and that one, to first
        order.
    variations : sequence of (LocalContact, float)
        Contacts with the law's closing speed or a memory varied, each with the factor by which the
        change of its force counts.
    """
    first, end = between
    parts = recorded.parts
    local = recorded.local(int(parts.law[first]))
    solved = contact_records.Solved(
        time_map=parts.time_map[first:end],
        length=parts.length[first:end],
        delta=parts.delta[first:end],
        rate=parts.rate[first:end],
    )
    laws = contacts_of([local, *(varied for varied, _ in variations)])
    weights = np.array([weight for _, weight in variations], dtype=float)
    state, forces = propagate(
        bases_of(local.law.root),
        recorded.view(first).without_load.bodies,
        laws,
        weights,
        solved,
        difference.record,
    )
    return State(*state), forces
