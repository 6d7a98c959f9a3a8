"""The history as it is kept: that of the response, and after each of the first visits points close enough for the fastest modes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.history_grid import MOST_POINTS

if TYPE_CHECKING:
    from vibroimpact.dynamics.response import Response


_VISITS = 5
"""How many visits are followed closely."""
_PER_PERIOD = 8
"""Points a period of the highest mode of a body."""
_MOST = 4000
"""Points after one visit."""


def fine_history(response: Response) -> dict[str, Floats]:
    """Return the history of one drop, fine enough to find the peaks of the plate's motion and to enlarge the first visits."""
    history = response.history(MOST_POINTS)
    impacts, plate, sphere = response.impacts, response.problem.plate.modes, response.problem.sphere.modes
    times = []
    for touch, duration in zip(impacts["time_s"][:_VISITS], impacts["duration_s"][:_VISITS], strict=True):
        if plate is not None:
            times.append(touch + _spread(resolved_span(1.0 / float(plate.frequencies[0])), plate.frequencies))
        if sphere is not None:
            times.append(touch + _spread(2.0 * float(duration), sphere.frequencies))
    wanted = np.concatenate([np.zeros(0), *times])
    wanted = wanted[wanted <= float(response.end_time[0])]
    if not len(wanted):
        return history
    added = response.at(wanted)
    joined = {name: np.concatenate([values, added[name]]) for name, values in history.items()}
    order = np.argsort(joined["time_s"], kind="stable")  # the two sides of an event keep their order
    return {name: values[order] for name, values in joined.items()}


def _spread(span: float, frequencies: Floats) -> Floats:
    """Return times from 0 to a span [s] that show the highest mode; fewer than that where they would be too many."""
    step = 1.0 / (_PER_PERIOD * float(frequencies[-1]))
    return np.asarray(np.arange(min(_MOST, int(span / step) + 1)) * step)


def resolved_span(period: float) -> float:
    """Return how long a plate is followed closely after first touch [s], whose lowest mode has a period [s]."""
    return 1.5 * period
