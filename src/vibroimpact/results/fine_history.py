"""The history that a result stores: that of the response, refined after the first visits
to resolve the highest modes.
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
    """Return the history of one drop [SI], with points added after the first visits where bodies
    have modes.

    The added points resolve the highest mode, so that peaks of the motion can be read from the
    history and the first visits be drawn enlarged. Points of all visits are sorted by time.
    """
    history = response.history(MOST_POINTS)
    impacts, plate, sphere = (
        response.impacts,
        response.problem.plate.modes,
        response.problem.sphere.modes,
    )
    # the plate is resolved over 1.5 periods of its lowest mode, the sphere over two contact
    # durations
    times = []
    for touch, duration in zip(
        impacts["time_s"][:_VISITS], impacts["duration_s"][:_VISITS], strict=True
    ):
        if plate is not None:
            times.append(
                touch + _spread(resolved_span(1.0 / float(plate.frequencies[0])), plate.frequencies)
            )
        if sphere is not None:
            times.append(touch + _spread(2.0 * float(duration), sphere.frequencies))
    extra = np.concatenate([np.zeros(0), *times])
    extra = extra[extra <= float(response.end_time[0])]
    if not len(extra):
        return history
    added = response.at(extra)
    joined = {name: np.concatenate([values, added[name]]) for name, values in history.items()}
    # stable: the two points at an event, before and after it, keep their order
    order = np.argsort(joined["time_s"], kind="stable")
    return {name: values[order] for name, values in joined.items()}


def _spread(span: float, frequencies: Floats) -> Floats:
    """Return equally spaced times from 0 [s] that resolve the highest mode; they end
    before the span where they would be too many.
    """
    step = 1.0 / (_PER_PERIOD * float(frequencies[-1]))
    return np.asarray(np.arange(min(_MOST, int(span / step) + 1)) * step)


def resolved_span(period: float) -> float:
    """Return for how long after first touch the plate's history is refined [s], given the
    period of its lowest mode [s].
    """
    return 1.5 * period
