"""End of a stretch of contact: solving it again up to its first event, and choosing the length of the next one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.roots import find_root
from vibroimpact.dynamics.collocation import Map
from vibroimpact.dynamics.vibrating.events import Event, first_event
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.radau_eigenbasis import GRID, NODES_PER_STRETCH, radau_eigenbasis
from vibroimpact.dynamics.vibrating.recoil import along_motion
from vibroimpact.dynamics.vibrating.solve_stretch import StretchProblem
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

_EASY = 0.01  # target roughness of the next stretch, relative to the root of the tolerance
_MOST_CORRECTIONS = 8  # of the length of a stretch that ends at a zero of a function
_MOST_ATTEMPTS = 4  # solutions per stretch, until no earlier event is found
_BEFORE_END = 0.98  # in x: an event beyond is the one at the end
_AT_END = 1e-12  # relative: an event may lie so far beyond the end of the first solution


def solve_to_event(
    stretch: VibratingStretch, event: Event, tolerance: float, energy: float, speed: float, span: float
) -> tuple[Event, VibratingStretch] | None:
    """Return the first event of a stretch, and the stretch solved up to it; None if that fails.

    An event of a solution that is not resolved may be spurious, or preceded by another one.

    Parameters
    ----------
    stretch : VibratingStretch
        The stretch with the event.
    event : Event
        Its first event.
    tolerance : float
        Relative error allowed at the end.
    energy, speed, span : float
        Energy [J] and speed [m/s] of the motion, and approximate duration of a contact [s].
    """
    for _ in range(_MOST_ATTEMPTS):
        ended = _problem_to_event(stretch, event).solve()
        if not ended.solved or not 0.0 < ended.length <= (1.0 + _AT_END) * stretch.length:
            return None
        before = first_event(ended, speed, span)
        if before is None or before.x > _BEFORE_END:
            return (event, ended) if ended.resolved(tolerance, energy) else None
        stretch, event = ended, before
    return None


def solve_to_zero(
    stretch: VibratingStretch, value: Callable[[State], Floats], near: float, problem: Callable[[float], StretchProblem]
) -> VibratingStretch | None:
    """Return a stretch solved again up to a zero of a function of the state, as at an event of another contact; None if that fails.

    Parameters
    ----------
    stretch : VibratingStretch
        The stretch in which the function becomes positive.
    value : callable
        The function.
    near : float
        First x of `GRID` at which it is positive.
    problem : callable
        The problem of a stretch of a length [s] from the same state.
    """
    rule, full_length = stretch.rule, stretch.length
    low, high = (full_length * float(rule.map_time(np.array([x]))[0]) for x in (max(near - GRID[1], 0.0), near))
    length = float(find_root(along_motion(stretch, value), np.array([low]), np.array([high]))[0])
    # Newton's method for the length, with the rate of the function by a finite difference
    for _ in range(_MOST_CORRECTIONS):
        ended = problem(length).solve()
        if not ended.solved:
            return None
        step = 1e-6 * length
        now, before = value(ended.end), value(ended.state(np.array([length - step])))[0]
        missing = float(now / (now - before)) * step
        if abs(missing) <= 1e-13 * full_length:
            return ended
        length -= missing
        if not 0.0 < length <= 1.01 * full_length:
            return None
    return ended


def length_before_event(stretch: VibratingStretch, event: Event, tolerance: float, energy: float) -> float:
    """Return an upper bound of the length of a stretch whose event was not found [s].

    It ends short of the event if the stretch is resolved; otherwise the event is not certain, and the bound is the whole length.
    """
    near = max(event.x, GRID[1]) if stretch.resolved(tolerance, energy) else 1.0
    return stretch.length * float(stretch.rule.map_time(np.array([near]))[0])


def length_growth(stretch: VibratingStretch, tolerance: float) -> float:
    """Return the ratio of the lengths of the next stretch and this one, 0.7 to 4, from the convergence of its Legendre coefficients."""
    return float(min(max((_EASY * tolerance**0.5 / max(stretch.roughness, 1e-300)) ** (1.0 / NODES_PER_STRETCH), 0.7), 4.0))


def with_separation_loss(stretch: VibratingStretch, place: int, held: float) -> VibratingStretch:
    """Return a stretch at whose end a contact loses its stored energy [J]."""
    contacts = list(stretch.contacts)
    contacts[place] = replace(contacts[place], separation_loss=held)
    found = replace(stretch, contacts=tuple(contacts))
    found.__dict__["motion"] = stretch.motion  # unchanged
    found.keep()
    return found


def _problem_to_event(stretch: VibratingStretch, event: Event) -> StretchProblem:
    """Return the problem of a stretch that ends at an event of another, with that solution as the initial guess."""
    rule, contacts = stretch.rule, stretch.contacts
    time_map: Map = "touch" if rule.time_map == "touch" else "release" if event.condition.name in ("parted", "no push") else "inside"
    part = float(rule.map_time(np.array([event.x]))[0])
    to = radau_eigenbasis(time_map, rule.root).rule
    weights = rule.weights(rule.unmap_time(part * to.time)).T
    delta = np.stack([weights @ contact.delta for contact in contacts])
    force = np.stack(
        [np.add(*contact.local.forces_at_indentation(row, weights @ contact.rate)) for contact, row in zip(contacts, delta, strict=True)]
    )
    laws, begun = [contact.local for contact in contacts], [float(contact.delta[0]) for contact in contacts]
    length = part * stretch.length
    return StretchProblem(stretch.view, laws, time_map, length, stretch.start, begun, guess=(delta, force), end_condition=event.condition)
