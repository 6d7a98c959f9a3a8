"""Tangent problem of a stretch of contact: propagation of a small difference of the state by the linearised equations of motion.

The nodal forces of a stretch solve equations whose Jacobian is known, and all other quantities are linear in the forces. A difference of
the state at the start gives that at the end by one more linear solve. Differences are taken at equal times.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core.law import linearise
from vibroimpact.dynamics.core.path import stretch_path
from vibroimpact.dynamics.core.receptance import surface_motion
from vibroimpact.dynamics.core.tangent import force_differences
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch


def propagate_difference(
    stretch: VibratingStretch, difference: State, variations: Sequence[tuple[LocalContact, float]]
) -> tuple[State, Floats]:
    """Return the difference of the state at the end of a stretch of one contact, and of the contact force at its nodes [N] (N,).

    Parameters
    ----------
    stretch : VibratingStretch
        The solved stretch.
    difference : State
        Difference of the state at its start between a neighbouring motion and that one, to first order.
    variations : sequence of (LocalContact, float)
        Contacts with the law's closing speed or a memory varied, each with the factor by which the change of its force counts.
    """
    (contact,), basis = stretch.contacts, stretch.basis.basis
    view = stretch.view.without_load
    delta, rate = contact.delta[1:], contact.rate[1:]
    motion = surface_motion(basis, view.surfaces, view.start(difference), stretch.length)
    linear = _linearised(contact.local, delta, rate)
    # a varied closing speed or memory changes the forces of the law and its approach at fixed indentations and rates
    static, dissipative, approach = np.zeros((3, len(delta)))
    for varied, weight in variations:
        change = weight * (_linearised(varied, delta, rate) - linear)
        static += change[0]
        dissipative += change[1]
        approach += change[2]
    force, static = force_differences(motion, linear, approach, static, dissipative)
    state = (difference.displacement, difference.velocity, difference.local)
    path = stretch_path(basis, view.surfaces, view.coordinates, *state, stretch.length, force, static)
    return State(path.displacement, path.speed, path.local), force


def _linearised(local: LocalContact, delta: Floats, rate: Floats) -> Floats:
    """Return forces, approach and derivatives of a law at the nodes (7, N), as `linearise` gives them."""
    linear = np.empty((7, len(delta)))
    law, coefficients, speed, release, _, series = (array[0] for array in local.record)
    linearise(law, coefficients, speed, release, series, delta, rate, linear)
    return linear
