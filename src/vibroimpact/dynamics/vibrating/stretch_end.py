"""End of a stretch of contact at an event of another contact, and the length of the next one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.roots import find_root
from vibroimpact.dynamics.core.events import NO_EVENT
from vibroimpact.dynamics.vibrating.events import along_motion
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
    """Return a stretch solved again up to a zero of a function of the state.

    The zero is an event of another contact. The result is None if that fails, or if a contact of
    the stretch has an event before.

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
    full_length = stretch.length
    length = time_of_zero(stretch, value, near)
    # Newton's method for the length, with the rate of the function by a finite difference
    for _ in range(_MOST_CORRECTIONS):
        solved = ahead.solve(time_map, length)
        if not solved.solved:
            return None
        ended = ahead.stretch(solved, ahead.balance(solved, time_map), time_map)
        step = 1e-6 * length
        at_end = value(ended.end)
        before_end = value(ended.state(np.array([length - step])))[0]
        correction = float(at_end / (at_end - before_end)) * step
        if abs(correction) <= 1e-13 * full_length:
            break
        length -= correction
        if not 0.0 < length <= 1.01 * full_length:
            return None
    return ended if solved.event.kind == NO_EVENT else None


def time_of_zero(stretch: VibratingStretch, value: Callable[[State], Floats], near: float) -> float:
    """Return when a function of the state becomes positive in a stretch [s from its start].

    `near`: the first x of `GRID` at which it is positive.
    """
    low = np.array([stretch.time_at(max(near - GRID[1], 0.0))])
    high = np.array([stretch.time_at(near)])
    return float(find_root(along_motion(stretch, value), low, high)[0])


def length_growth(stretch: VibratingStretch, tolerance: float) -> float:
    """Return the ratio of the lengths of the next stretch and this one, 0.7 to 4.

    It follows from the convergence of the Legendre coefficients: the last one goes with the length
    to the power of the number of nodes.
    """
    roughness_ratio = _EASY * tolerance**0.5 / max(stretch.roughness, 1e-300)
    growth = roughness_ratio ** (1.0 / NODES_PER_STRETCH)
    return float(min(max(growth, 0.7), 4.0))


def with_separation_loss(
    stretch: VibratingStretch, index: int, stored_energy: float
) -> VibratingStretch:
    """Return a stretch at whose end one of its contacts loses its stored energy [J]."""
    contacts = list(stretch.contacts)
    contacts[index] = replace(contacts[index], separation_loss=stored_energy)
    ended = replace(stretch, contacts=tuple(contacts))
    ended.__dict__["path"] = stretch.path  # unchanged
    ended.keep()
    return ended
