"""End of a stretch of contact: solving it again up to an event of another contact, and
choosing the length of the next one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.roots import find_root
from vibroimpact.dynamics.core.events import NO_EVENT
from vibroimpact.dynamics.vibrating.coasting import along_motion
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.radau_eigenbasis import GRID, NODES_PER_STRETCH
from vibroimpact.dynamics.vibrating.solve_stretch import StretchAhead
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

_EASY = 0.01  # target roughness of the next stretch, relative to the root of the tolerance
_MOST_CORRECTIONS = 8  # of the length of a stretch that ends at a zero of a function


def solve_to_zero(
    ahead: StretchAhead,
    stretch: VibratingStretch,
    time_map: int,
    value: Callable[[State], Floats],
    near: float,
) -> VibratingStretch | None:
    """Return a stretch solved again up to a zero of a function of the state, as at an event of
    another contact.

    None if that fails, or if one of its own contacts has an event before.

    Parameters
    ----------
    ahead : StretchAhead
        What was solved.
    stretch : VibratingStretch
        The solution.
    time_map : int
        Its map of time.
    value : callable
        The function.
    near : float
        First x of `GRID` at which it is positive.
    """
    rule, full_length = stretch.rule, stretch.length
    low, high = (
        full_length * float(rule.map_time(np.array([x]))[0])
        for x in (max(near - GRID[1], 0.0), near)
    )
    length = float(find_root(along_motion(stretch, value), np.array([low]), np.array([high]))[0])
    # Newton's method for the length, with the rate of the function by a finite difference
    for _ in range(_MOST_CORRECTIONS):
        solved = ahead.solve(time_map, length)
        if not solved.solved:
            return None
        ended = ahead.stretch(solved, ahead.balance(solved, time_map), time_map)
        step = 1e-6 * length
        now, before = value(ended.end), value(ended.state(np.array([length - step])))[0]
        missing = float(now / (now - before)) * step
        if abs(missing) <= 1e-13 * full_length:
            break
        length -= missing
        if not 0.0 < length <= 1.01 * full_length:
            return None
    return ended if solved.event.kind == NO_EVENT else None


def length_growth(stretch: VibratingStretch, tolerance: float) -> float:
    """Return the ratio of the lengths of the next stretch and this one, 0.7 to 4, from
    the convergence of its Legendre coefficients.
    """
    return float(
        min(
            max(
                (_EASY * tolerance**0.5 / max(stretch.roughness, 1e-300))
                ** (1.0 / NODES_PER_STRETCH),
                0.7,
            ),
            4.0,
        )
    )


def with_separation_loss(stretch: VibratingStretch, place: int, held: float) -> VibratingStretch:
    """Return a stretch at whose end a contact loses its stored energy [J]."""
    contacts = list(stretch.contacts)
    contacts[place] = replace(contacts[place], separation_loss=held)
    found = replace(stretch, contacts=tuple(contacts))
    found.__dict__["motion"] = stretch.motion  # unchanged
    found.keep()
    return found
