"""The history that a result stores.

It is that of the response, refined after the first visits to resolve the highest modes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.history_grid import MOST_POINTS

if TYPE_CHECKING:
    from vibroimpact.dynamics.response import Response


_VISITS = 5
"""Number of visits after which the history is refined."""
_PER_PERIOD = 8
"""Points per period of the highest mode of a body."""
_MOST = 4000
"""Largest number of points added after one visit, for each body."""


def fine_history(response: Response) -> dict[str, Floats]:
    """Return the history of one drop [SI], refined after the first visits where bodies have modes.

    The added points resolve the highest mode, so that peaks of the motion can be read from the
    history and the first visits be drawn enlarged. Points of all visits are sorted by time.
    """
    history = response.history(MOST_POINTS)
    added_times = _times_after_visits(response)
    if not len(added_times):
        return history
    added = response.at(added_times)
    joined = {name: np.concatenate([column, added[name]]) for name, column in history.items()}
    # stable: the two points at an event, before and after it, keep their order
    order = np.argsort(joined["time_s"], kind="stable")
    return {name: column[order] for name, column in joined.items()}


def _times_after_visits(response: Response) -> Floats:
    """Return times within the run that resolve the highest modes after the first visits [s].

    The plate is resolved over 1.5 periods of its lowest mode, the sphere over two contact
    durations.
    """
    plate = response.problem.plate.modes
    sphere = response.problem.sphere.modes
    touches = response.impacts["time_s"][:_VISITS]
    durations = response.impacts["duration_s"][:_VISITS]
    times = [np.zeros(0)]
    for touch, duration in zip(touches, durations, strict=True):
        if plate is not None:
            plate_span = resolved_span(1.0 / float(plate.frequencies[0]))
            times.append(touch + _resolving_times(plate_span, plate.frequencies))
        if sphere is not None:
            sphere_span = 2.0 * float(duration)
            times.append(touch + _resolving_times(sphere_span, sphere.frequencies))
    joined = np.concatenate(times)
    return np.asarray(joined[joined <= float(response.end_time[0])])


def _resolving_times(span: float, frequencies: Floats) -> Floats:
    """Return equally spaced times from 0 [s] that resolve the highest mode.

    They end before the span where they would be too many.
    """
    step = 1.0 / (_PER_PERIOD * float(frequencies[-1]))
    return np.asarray(np.arange(min(_MOST, int(span / step) + 1)) * step)


def resolved_span(period: float) -> float:
    """Return how long the plate's history is refined after first touch [s].

    It is 1.5 times the period of the lowest mode [s].
    """
    return 1.5 * period
