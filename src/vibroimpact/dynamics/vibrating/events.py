"""Events of contacts that are not part of a stretch of others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.radau_eigenbasis import GRID

ZERO_RATE = 1e-9  # of the speed of the motion: a slower approach counts as having turned already


@dataclass(frozen=True)
class OtherEvent:
    """Event of a contact that is not part of a stretch: its function of the state,
    positive after the event, and the action it causes.
    """

    value: Callable[[State], Floats]
    act: Callable[[], object]
    x: float = np.inf


def first_crossing(values: Floats) -> float | None:
    """Return the x of the first grid point at which values have become positive, or None."""
    crossed = (values[1:] > 0.0) & (values[:-1] <= 0.0)
    return float(GRID[1:][crossed][0]) if crossed.any() else None
