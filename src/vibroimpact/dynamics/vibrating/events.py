"""What may end a stretch of contact: surfaces part, a law stops pushing, its force has a kink, or an approach turns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.dynamics.vibrating.solve_stretches import EndCondition
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

GRID = np.linspace(0.0, 1.0, 33)
"""Where in a stretch events are looked for."""

ROUNDING = 1e-11
ZERO_RATE = 1e-9  # of the speed of the motion: what turns more slowly has turned before


@dataclass(frozen=True)
class Event:
    """Something that ends a stretch, and the x at about which it does."""

    condition: EndCondition
    x: float


def first_event(stretch: VibratingStretch, speed: float, span: float) -> Event | None:
    """Return the first event in a stretch of contacts of about a speed [m/s] and a duration [s]."""
    weights = stretch.rule.weights(GRID).T
    found = (event for place in range(len(stretch.contacts)) for event in _events(stretch, place, weights, speed, span))
    return min(found, key=lambda event: event.x, default=None)


def _events(stretch: VibratingStretch, place: int, weights: Floats, speed: float, span: float) -> list[Event]:
    """Return the events of one contact, the first of each kind."""
    contact = stretch.contacts[place]
    local, law, least = contact.local, contact.local.law, contact.local.release_indentation
    delta, rate = weights @ contact.delta, weights @ contact.rate
    # of each: what falls below zero there, and where it has
    events: list[tuple[EndCondition, Floats, Bools]] = []
    above = delta - least
    events.append((EndCondition("parted", least, place), above, above < -ROUNDING * above.max()))
    if law.tension != "kept":  # what recoils fast enough makes the others pull as well
        force = np.add(*local.forces_at_indentation(delta, rate))
        slack = 1e-11 * (np.abs(contact.force).max() + stretch.system.mass[contact.number] * speed / span)
        events.append((EndCondition("no push", 0.0, place), force, force < -slack))
    for level in (float(part) for part in law.breakpoints):
        beyond = delta - level
        on_it = abs(beyond[0]) <= ROUNDING * max(abs(level), float(np.ptp(delta)))
        beyond = beyond * np.sign(beyond[1] if on_it else beyond[0])
        events.append((EndCondition("breakpoint", level, place), beyond, beyond < 0.0))
    if local.updates_memory(float(delta.max())):
        closing = weights @ stretch.closing_rates(place)
        events.append((EndCondition("turn", 0.0, place), closing, (closing < 0.0) & (np.maximum.accumulate(closing) > ZERO_RATE * speed)))
    return [Event(condition, _crossing(values, reached)) for condition, values, reached in events if reached[1:].any()]


def _crossing(values: Floats, reached: Bools) -> float:
    """Return the x where values on the grid fall below zero, by the secant through the first that is seen there and the one before."""
    last = 1 + int(reached[1:].argmax())
    before, after = values[last - 1], values[last]
    part = before / (before - after) if before > 0.0 > after else 1.0
    return float(max(GRID[last - 1] + part * GRID[1], 0.5 * GRID[1]))
