r"""How a small difference between two drops goes through a stretch of contact: the linearised equations of motion.

The force at the nodes of a stretch solves equations whose Jacobian is at hand, and all else is linear in it: so a difference of the
state at the start gives that at the end by one more linear solve. Differences are those at equal times.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from vibroimpact.dynamics.linear_system import State
from vibroimpact.dynamics.local import LocalContact
from vibroimpact.dynamics.receptance import NODES, Receptance
from vibroimpact.dynamics.solve_vibrating import eliminated
from vibroimpact.dynamics.vibrating_stretch import VibratingStretch


def difference_through(stretch: VibratingStretch, difference: State, asides: Iterable[tuple[LocalContact, float]] = ()) -> VibratingStretch:
    """Return the difference of two drops through a stretch from that at its start, as a stretch whose states and forces are it.

    Parameters
    ----------
    stretch : VibratingStretch
        A stretch of one contact that was solved.
    difference : State
        At its start, to first order.
    asides : iterable of (LocalContact, float)
        Contacts whose laws know something a little differently, as the second drop's does, and how many times their change of force counts.
    """
    (contact,) = stretch.contacts
    seen, delta, rates = stretch.seen.without_load, contact.delta[1:], contact.rate[1:]
    here, now = Receptance(seen, stretch.spectrum, stretch.length, difference), contact.local.linearised(delta, rates)
    left = eliminated(now, here)
    missing, changed, known = here.approach[0], now.dissipative_by_rate * here.rate[0], np.zeros(NODES)
    for aside, times in asides:
        other = aside.linearised(delta, rates)
        static = times * (other.static - now.static)
        missing = missing - times * (other.approach - now.approach) - here.by_static @ static
        changed = changed + static + times * (other.dissipative - now.dissipative)
        known = known + static
    try:
        force = np.linalg.solve(left.jacobian, changed + left.push * (left.inward @ missing))
    except np.linalg.LinAlgError:
        force = np.full(NODES, np.nan)
    static = known + now.stiffness * (left.inward @ missing - left.taken @ force)
    return replace(stretch, seen=seen, start=difference, contacts=(replace(contact, static=static, dissipative=force - static),))
