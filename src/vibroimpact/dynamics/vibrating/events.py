"""Detection of the events that end a stretch of contact: separation, zero force, a breakpoint of the law, a turn of the approach."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.dynamics.collocation import Map
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.radau_eigenbasis import GRID, radau_eigenbasis
from vibroimpact.dynamics.vibrating.solve_stretch import EndCondition
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

ROUNDING = 1e-11  # relative to an indentation or a duration
_ON_LEVEL = 1e-10  # relative to an indentation: a stretch that begins so near to a breakpoint begins on it; ends are solved to 1e-11
ZERO_RATE = 1e-9  # of the speed of the motion: a slower approach counts as having turned already


@dataclass(frozen=True)
class Event:
    """An event within a stretch: its end condition, and x at about which it is met."""

    condition: EndCondition
    x: float


@dataclass(frozen=True)
class OtherEvent:
    """Event of a contact that is not part of a stretch: its function of the state, positive after the event, and the action it causes."""

    value: Callable[[State], Floats]
    act: Callable[[], object]
    x: float = np.inf


def first_event(stretch: VibratingStretch, speed: float, span: float) -> Event | None:
    """Return the first event in a stretch of contacts of about a speed [m/s] and a duration [s], or None."""
    weights = _weights_on_grid(stretch.rule.time_map, stretch.rule.root)
    found = (event for place in range(len(stretch.contacts)) for event in _events(stretch, place, weights, speed, span))
    return min(found, key=lambda event: event.x, default=None)


@cache
def _weights_on_grid(time_map: Map, root: int) -> Floats:
    """Return the weights of the values at the start and the nodes of a stretch for interpolation on `GRID`."""
    return radau_eigenbasis(time_map, root).rule.weights(GRID).T


def _events(stretch: VibratingStretch, place: int, weights: Floats, speed: float, span: float) -> list[Event]:
    """Return the events of one contact, the first of each kind."""
    contact = stretch.contacts[place]
    local, law, least = contact.local, contact.local.law, contact.local.release_indentation
    delta, rate = weights @ contact.delta, weights @ contact.rate
    # for each condition: the function whose zero is the event, and a mask of where it has fallen below zero
    events: list[tuple[EndCondition, Floats, Bools]] = []
    above = delta - least
    events.append((EndCondition("parted", least, place), above, above < -ROUNDING * above.max()))
    if law.tension != "kept":  # also a law without tension gives a negative force where the surfaces recoil fast enough
        force = np.add(*local.forces_at_indentation(delta, rate))
        slack = 1e-11 * (np.abs(contact.force).max() + stretch.system.mass[contact.number] * speed / span)
        events.append((EndCondition("no push", 0.0, place), force, force < -slack))
    for level in (float(part) for part in law.breakpoints):
        beyond = delta - level
        on_it = abs(beyond[0]) <= _ON_LEVEL * max(abs(level), float(np.ptp(delta)))
        beyond = beyond * np.sign(beyond[1] if on_it else beyond[0])
        events.append((EndCondition("breakpoint", level, place), beyond, beyond < 0.0))
    if local.updates_memory(float(delta.max())):
        closing = weights @ contact.closing
        events.append((EndCondition("turn", 0.0, place), closing, (closing < 0.0) & (np.maximum.accumulate(closing) > ZERO_RATE * speed)))
    return [Event(condition, _crossing(values, reached)) for condition, values, reached in events if reached[1:].any()]


def _crossing(values: Floats, reached: Bools) -> float:
    """Return the x where grid values fall below zero, by the secant through the first masked point and the one before."""
    last = 1 + int(reached[1:].argmax())
    before, after = values[last - 1], values[last]
    part = before / (before - after) if before > 0.0 > after else 1.0
    return float(max(GRID[last - 1] + part * GRID[1], 0.5 * GRID[1]))


def first_crossing(values: Floats) -> float | None:
    """Return the x of the first grid point at which values have become positive, or None."""
    crossed = (values[1:] > 0.0) & (values[:-1] <= 0.0)
    return float(GRID[1:][crossed][0]) if crossed.any() else None
