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
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch


def propagate_difference(
    stretches: Sequence[VibratingStretch],
    difference: State,
    variations: Sequence[tuple[LocalContact, float]],
) -> tuple[State, Floats]:
    """Return the differences of the state at the end of stretches, and of the contact force.

    The latter is given at the nodes of the stretches [N] (P, N). The core computes both.

    Parameters
    ----------
    stretches : sequence of VibratingStretch
        Solved stretches of one contact under one law, one after the other.
    difference : State
        Difference of the state at their start between a neighbouring motion and that one, to first
        order.
    variations : sequence of (LocalContact, float)
        Contacts with the law's closing speed or a memory varied, each with the factor by which the
        change of its force counts.
    """
    first = stretches[0]
    local = first.contacts[0].local
    histories = [stretch.contacts[0] for stretch in stretches]
    solved = contact_records.Solved(
        time_map=np.array([stretch.basis.basis.time_map for stretch in stretches]),
        length=np.array([stretch.length for stretch in stretches]),
        delta=np.array([history.delta for history in histories]),
        rate=np.array([history.rate for history in histories]),
    )
    laws = contacts_of([local, *(varied for varied, _ in variations)])
    weights = np.array([weight for _, weight in variations], dtype=float)
    end, forces = propagate(
        bases_of(local.law.root),
        first.view.without_load.bodies,
        laws,
        weights,
        solved,
        difference.record,
    )
    return State(*end), forces
