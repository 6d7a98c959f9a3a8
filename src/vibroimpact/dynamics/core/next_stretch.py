"""The next stretch of contact of one sphere: of the length that is given, or up to its
first event.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.attempt import attempt, balance_of, basis_of, time_at, up_to_event
from vibroimpact.dynamics.core.contact_records import (
    Beginning,
    Bodies,
    Manner,
    NextStretch,
    StretchEnd,
)
from vibroimpact.dynamics.core.events import NO_EVENT
from vibroimpact.dynamics.core.records import Bases, Event, Nodes, State

_EASY = 0.01  # target roughness of the next stretch, relative to the root of the tolerance
_LEAST_GROWTH = 0.7
_MOST_GROWTH = 4.0
_TINY = 1e-300


@compiled
def length_growth(roughness: float, tolerance: float, nodes: int) -> float:
    """Return the ratio of the lengths of the next stretch and one of some roughness, 0.7 to 4.

    It follows from the convergence of the Legendre coefficients: the last one goes with the length
    to the power of the number of nodes.
    """
    ratio = (_EASY * math.sqrt(tolerance) / max(roughness, _TINY)) ** (1.0 / nodes)
    return float(min(max(ratio, _LEAST_GROWTH), _MOST_GROWTH))


@compiled
def next_stretch(
    bases: Bases,
    bodies: Bodies,
    manner: Manner,
    beginning: Beginning,
    time_map: int,
    length: float,
    trend: float,
) -> NextStretch:
    """Return the stretch of a length [s] under a map of time, or, if an event is met within it,
    that up to the first one.

    It is accepted if it is solved and resolved. `trend`: of the force at its start [N/s].
    """
    no_event = Event(NO_EVENT, 0.0, 0.0, 0)
    no_guess = Nodes(np.zeros(0), np.zeros(0), np.zeros(0))
    given = Event(NO_EVENT, 0.0, length, 0)
    basis = basis_of(bases, time_map)
    trends = np.array([trend])
    tried = attempt(basis, bodies, manner, beginning, no_guess, trends, False, given)
    if tried.event.kind == NO_EVENT:
        balance = balance_of(basis, bodies, manner, beginning, tried)
        return NextStretch(balance.resolved, tried, balance, time_map, no_event, np.inf)
    # also tried if the stretch is not resolved, as the event may be the only reason
    success, ended, ended_map, seen = up_to_event(bases, bodies, manner, beginning, tried, time_map)
    ended_basis = basis_of(bases, ended_map)
    balance = balance_of(ended_basis, bodies, manner, beginning, ended)
    if success and balance.resolved:
        return NextStretch(True, ended, balance, ended_map, seen, np.inf)
    balance = balance_of(basis, bodies, manner, beginning, tried)
    event_time = np.inf
    if balance.resolved:  # otherwise the event is not certain
        first_point = 1.0 / (len(basis.grid) - 1)
        event_time = tried.length * time_at(basis, max(tried.event.x, first_point))
    return NextStretch(False, tried, balance, time_map, no_event, event_time)


@compiled
def end_of(bases: Bases, stretch: NextStretch) -> StretchEnd:
    """Return the end of a stretch."""
    tried = stretch.tried
    path = stretch.balance.path
    forces = tried.nodes.force
    at_end = basis_of(bases, stretch.time_map).at_end
    number = len(forces)
    trend = 0.0
    largest_force = 0.0
    for node in range(number):
        trend += at_end[node] * forces[node] / tried.length
        largest_force = max(largest_force, forces[node])
    return StretchEnd(
        tried.length,
        State(path.displacement, path.speed, path.local),
        tried.sliding.end,
        tried.contact.delta[0, number],
        forces[number - 1],
        trend,
        tried.contact.closing[0, number],
        largest_force,
        tried.contact.roughness,
    )
