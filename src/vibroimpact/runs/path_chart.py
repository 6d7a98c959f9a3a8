"""Chart of the path of the sphere over the plate, seen from above."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Label, Line, Mark, Outline, Points
from vibroimpact.charts.outlines import disc
from vibroimpact.results.result import Result
from vibroimpact.runs.setup import dimension, drawn_radius
from vibroimpact.runs.supports import plate_extent, plate_outline
from vibroimpact.units.display import brief

_APART = 0.04
"""Distance of an impact from the last one that is numbered, as a part of the extent of
the picture, from which it has its number too.
"""

_ROOM = 0.06


def moves_over(history: Mapping[str, Floats]) -> bool:
    """Return whether the sphere changes its place over the plate in a history."""
    return any(
        np.ptp(history[column]) > 0.0
        for column in ("position_x_m", "position_y_m")
        if column in history
    )


def path_chart(result: Result, history: Mapping[str, Floats], caption: str) -> Chart:
    """Return the chart of the path of the sphere's centre over the plate, to scale, with the places
    of the impacts.

    Parameters
    ----------
    result : Result
        The result.
    history : dict of str to array
        The history that is drawn.
    caption : str
        The caption.
    """
    x = history["position_x_m"]
    y = history["position_y_m"]
    places = np.stack([result.impacts["position_x_m"], result.impacts["position_y_m"]], axis=-1)
    radius = drawn_radius(result)
    extent = plate_extent(result)
    marks: list[Mark] = []
    if extent is not None:
        (left, right), (front, back) = extent.x, extent.y
        marks.append(plate_outline(result, extent))
    else:
        (left, right), (front, back) = (
            (float(along.min()), float(along.max())) for along in (x, y)
        )
    size = max(right - left, back - front)
    marks += [
        Line(x, y, "path of the centre", "detail"),
        Outline(*disc(float(x[-1]), float(y[-1]), radius), role="sphere"),
        Points(
            places[:, 0],
            places[:, 1],
            "impact",
            "mark",
            tuple(f"impact {number + 1}" for number in range(len(places))),
        ),
    ]
    last = np.full(2, np.inf)
    for number, place in enumerate(places):
        if np.hypot(*(place - last)) >= _APART * size:
            marks.append(
                Label(
                    float(place[0]), float(place[1]) + 0.3 * _APART * size, str(number + 1), "above"
                )
            )
            last = place
    low = min(front, float(y.min()) - radius) - _ROOM * size
    beside = max(right, float(x.max()) + radius) + _ROOM * size
    if right > left:
        marks += dimension((left, low), (right, low), brief(right - left, "m"), "below")
    if back > front:
        marks += dimension((beside, front), (beside, back), brief(back - front, "m"), "left")
    panel = Panel(Axis("x", "m"), Axis("y", "m"), tuple(marks), picture=True)
    return Chart("path", "Path over the plate", ((panel,),), caption, height=3.4)
