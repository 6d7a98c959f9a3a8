"""Lines of several responses over time, and their impacts as views in which the first
touches coincide.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from vibroimpact.charts.axis import View
from vibroimpact.charts.decimation import thinned
from vibroimpact.charts.marks import Line
from vibroimpact.dynamics.response import Response
from vibroimpact.paper.measures import Timeline


def impact_views(
    responses: Sequence[Response],
    shown: Callable[[int], tuple[float, float]],
    level: float = 0.0,
    level_label: str = "",
) -> tuple[View, ...]:
    """Return the impacts that all responses have as views over the time since first touch.

    Parameters
    ----------
    responses : sequence of Response
        The responses; the places of the views are those of the first.
    shown : callable
        Function of an impact, counted from 0, that returns the times shown before and after its
        first touch [s].
    level, level_label : float and str, optional
        Value from which the vertical axis counts in the views, and its label.
    """
    views = []
    for impact in range(min(len(response.impacts["time_s"]) for response in responses)):
        touch = float(responses[0].impacts["time_s"][impact])
        (before, after) = shown(impact)
        since = f"Time since first touch of impact {impact + 1}"
        views.append(
            View(
                f"Impact {impact + 1}",
                touch - before,
                touch + after,
                touch,
                since,
                level=level,
                level_label=level_label,
            )
        )
    return tuple(views)


def longest_contact(responses: Sequence[Response], impact: int) -> float:
    """Return the longest duration of an impact, counted from 0, among responses [s]."""
    return max(float(response.impacts["duration_s"][impact]) for response in responses)


def response_line(
    timeline: Timeline, response: Response, views: Sequence[View], name: str, role: str
) -> Line:
    """Return a quantity of a response over time as a line that counts from its own first
    touches in the views.
    """
    origins = tuple(float(touch) for touch in response.impacts["time_s"][: len(views)])
    windows = [
        (view.start - view.origin + origin, view.end - view.origin + origin)
        for view, origin in zip(views, origins, strict=True)
    ]
    return Line(*thinned(*timeline(response), windows), name, role, origins=origins)
