r"""How a small difference between two drops goes through a stretch of contact: the linearised equations of motion.

The force at the nodes of a stretch solves equations whose Jacobian is at hand, and all else is linear in it: so a difference of the
state at the start gives that at the end by one more linear solve. Differences are those at equal times.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from vibroimpact.dynamics.local import LocalContact
from vibroimpact.dynamics.oscillators import State
from vibroimpact.dynamics.vibrating_stretch import NODES, VibratingStretch, force_jacobian, impedance_of, receptance, unforced


def difference_through(stretch: VibratingStretch, difference: State, asides: Iterable[tuple[LocalContact, float]] = ()) -> VibratingStretch:
    """Return the difference of two drops through a stretch from that at its start, as a stretch whose states and forces are it.

    Parameters
    ----------
    stretch : VibratingStretch
        A stretch that was solved.
    difference : State
        At its start, to first order.
    asides : iterable of (LocalContact, float)
        Contacts whose laws know something a little differently, as the second drop's does, and how many times their change of force counts.
    """
    around, local, at, length = replace(stretch.around, gravity=0.0), stretch.local, stretch.spectrum, stretch.length
    impedance = impedance_of(around.oscillators, length * at.values)
    approach, rate = unforced(around.oscillators, at, length, difference, 0.0, impedance)
    held, reached, rates = (
        stretch.approach[1:] > local.release_level,
        np.maximum(stretch.approach[1:], local.release_level),
        stretch.rate[1:],
    )
    now = local.linearised(reached, rates)
    jacobian, slopes = force_jacobian(now, held, *receptance(around, at, length, impedance))
    static, dissipative = slopes[0] * approach, slopes[1] * approach + slopes[2] * rate
    for aside, times in asides:
        other = aside.forces(reached, rates, now.delta)
        static, dissipative = static + times * (other[0] - now.static), dissipative + times * (other[1] - now.dissipative)
    try:
        forces = np.linalg.solve(jacobian, np.concatenate([static, dissipative]))
    except np.linalg.LinAlgError:
        forces = np.full(2 * NODES, np.nan)
    return replace(stretch, around=around, start=difference, static=forces[:NODES], dissipative=forces[NODES:])
