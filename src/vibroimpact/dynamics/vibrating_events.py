"""What may end a stretch of contact of bodies that vibrate: they part, the law stops pushing, its force has a kink, or they turn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.collocation import Floats
from vibroimpact.dynamics.vibrating_stretch import VibratingStretch

GRID = np.linspace(0.0, 1.0, 33)
"""Where in a stretch events are looked for."""

ROUNDING = 1e-11
_STILL = 1e-9  # of the speed of the motion: what turns more slowly has turned before


@dataclass(frozen=True)
class Event:
    """Something that ends a stretch: its name, the x after it, and what becomes positive there, at the nodes of a stretch."""

    name: str
    x: float
    rises: Callable[[VibratingStretch], Floats]


def first_event(stretch: VibratingStretch, speed: float, span: float) -> Event | None:
    """Return the first event in a stretch of a contact of about a speed [m/s] and a duration [s]."""
    local, floor = stretch.local, stretch.local.release_level
    weights = stretch.rule.weights(GRID).T
    approach, rate = weights @ stretch.approach, weights @ stretch.rate
    events: list[tuple[str, NDArray[np.bool_], Callable[[VibratingStretch], Floats]]] = []
    out = approach < floor - ROUNDING * (approach.max() - floor)
    out[0] = False
    events.append(("parted", out, lambda other: floor - other.approach))
    if local.law.tension != "kept":  # what recoils fast enough makes the others pull as well
        static, dissipative = local.forces(np.maximum(approach, floor), rate)
        pulls = static + dissipative < -1e-11 * (np.abs(stretch.force).max() + stretch.around.mass * speed / span)
        pulls[0] = False
        events.append(("no push", pulls, lambda other: -other.force))
    for level in local.breakpoints:
        begun = approach[0] - level
        on_it = abs(begun) <= ROUNDING * max(abs(level), float(np.ptp(approach)))
        side = np.sign(approach[1] - level if on_it else begun)
        crossed = (approach - level) * side < 0.0
        crossed[0] = False
        events.append(("breakpoint", crossed, partial(_crossing, side, level)))
    if local.after_compression(float(approach.max())) is not local:
        closing = weights @ stretch.closing
        turned = (closing < 0.0) & (np.maximum.accumulate(closing) > _STILL * speed)
        events.append(("turn", turned, lambda other: -other.closing))
    seen = [Event(name, float(GRID[where.argmax()]), rises) for name, where, rises in events if where.any()]
    return min(seen, key=lambda event: event.x, default=None)


def _crossing(side: float, level: float, stretch: VibratingStretch) -> Floats:
    """Return what becomes positive where the approach, from one side, crosses a level."""
    return -side * (stretch.approach - level)
