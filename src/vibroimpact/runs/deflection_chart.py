"""Chart of the plate's deflection: maps at six times."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Label, Line, Map, Mark, Outline, Points
from vibroimpact.charts.outlines import AT_REST, on_supports
from vibroimpact.quoting import shortened, visible
from vibroimpact.results.deflection import Deflection
from vibroimpact.results.result import Result
from vibroimpact.runs.supports import Extent, plate_extent, support_outlines
from vibroimpact.units.display import digits, multiple, text

_COLUMNS = 3
_ROWS = 2

_MOST_NAMED = 12
"""Places of sensors that are named; the names of more would cover each other."""

_MOST_LETTERS = 20
_FEWEST_LETTERS = 8
"""Letters of a name: the most, and the fewest to which it is shortened."""

_ACROSS = 38
_SHAPE = 1.6
"""Letters that fit across a map in print, and its length over its width from which on a
map is narrower than its place.
"""

_ROUNDING = 1e-9
"""Relative to the largest deflection of all maps: smaller values are drawn as zero."""


def deflection_chart(result: Result, caption: str) -> Chart:
    """Return the chart of the plate's deflection from above at six times after first
    touch, all on one colour scale.
    """
    deflection = result.deflection
    assert deflection is not None  # checked by the caller
    touch = float(result.impacts["time_s"][0])
    frames = chosen_frames(result, deflection)
    across = Axis("x", "m")
    up = Axis("y", "m")
    scale = Axis("Deflection, upwards", "m")
    most = float(np.nanmax(np.abs(deflection.height[frames])))
    held = on_supports(support_outlines(result, edges=False), deflection.x, deflection.y)
    unit = multiple("m", most)
    panels = []
    for frame in frames:
        height = deflection.height[frame].astype(float)
        size = np.abs(height)
        height[(size <= _ROUNDING * most) | (held & (size < AT_REST * np.nanmax(size)))] = 0.0
        low, high = (digits(float(pick(height)) / unit.size, 2) for pick in (np.nanmin, np.nanmax))
        title = f"{text(float(deflection.time[frame]) - touch, 's', 3)} after first touch"
        least_and_most = Label(0.5, 0.0, f"{low} to {high} {unit.unit}", "below", corner=True)
        map_ = Map(
            deflection.x, deflection.y, height, scale, diverging=True, contours=True, cells=False
        )
        panels.append(
            Panel(across, up, (map_, *plate_marks(result), least_and_most), title, picture=True)
        )
    rows = tuple(
        tuple(panels[start : start + _COLUMNS]) for start in range(0, len(panels), _COLUMNS)
    )
    shape = float(np.clip(np.ptp(deflection.y) / np.ptp(deflection.x), 0.2, 1.6))
    return Chart(
        "deflection", "Deflection of the plate from above", rows, caption, height=2.3 * shape + 0.2
    )


def chosen_frames(result: Result, deflection: Deflection) -> list[int]:
    """Return the indices of the frames drawn: in mid-contact, at release, and up to the
    last at geometrically growing times.
    """
    touch, duration = (float(result.impacts[name][0]) for name in ("time_s", "duration_s"))
    after = float(deflection.time[-1]) - touch
    wanted = touch + np.append(
        0.5 * duration, np.geomspace(min(duration, 0.3 * after), after, _COLUMNS * _ROWS - 1)
    )
    return sorted({int(np.abs(deflection.time - time).argmin()) for time in wanted})


def plate_marks(result: Result) -> tuple[Mark, ...]:
    """Return what is marked on the plate seen from above: its edge, its supports, the
    contact point and the sensors.
    """
    deflection = result.deflection
    assert deflection is not None  # checked by the caller
    marks: list[Mark] = [Line(*_edge(deflection.x, deflection.y), role="main")]
    marks += [
        Outline(*outline, name="support", role="held") for outline in support_outlines(result)
    ]
    marks.append(
        Points(
            np.array([deflection.contact[0]]),
            np.array([deflection.contact[1]]),
            "contact point",
            "mark",
        )
    )
    return (*marks, *sensor_marks(result))


def _edge(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    return x[[0, -1, -1, 0, 0]], y[[0, 0, -1, -1, 0]]


def sensor_marks(result: Result) -> tuple[Mark, ...]:
    """Return the sensors seen from above, with the names of those that stand apart; of
    many none.
    """
    placed = sensor_places(result)
    if not placed:
        return ()
    names, x, y = zip(*placed, strict=True)
    marks: list[Mark] = [
        Points(
            np.array(x),
            np.array(y),
            "sensor",
            "sensor",
            texts=tuple(shortened(visible(name), 60) for name in names),
        )
    ]
    together: dict[tuple[float, float], list[str]] = {}
    for name, *place in placed:
        together.setdefault((place[0], place[1]), []).append(name)
    if len(together) <= _MOST_NAMED:
        labels = (
            _label(place, visible(", ".join(names)), plate_extent(result))
            for place, names in together.items()
        )
        marks += [label for label in labels if label.words]
    return tuple(marks)


def _label(place: tuple[float, float], name: str, extent: Extent | None) -> Label:
    """Return the name of a sensor on the side where the edge is farther, no longer than
    what fits there; none where too little does.
    """
    if extent is None:
        return Label(*place, shortened(name, _MOST_LETTERS), "left")
    (left, right), (front, back) = extent.x, extent.y
    before = place[0] - left
    after = right - place[0]
    across = _ACROSS * min(1.0, _SHAPE * (right - left) / (back - front))
    room = min(int(across * max(before, after) / (right - left)) - 1, _MOST_LETTERS)
    side = "left" if before <= after else "right"
    if len(name) <= room:
        return Label(*place, name, side)
    if room < _FEWEST_LETTERS:
        return Label(*place, "", side)
    return Label(*place, shortened(name, room), side)


def sensor_places(result: Result) -> list[tuple[str, float, float]]:
    """Return name, x and y [m] of the sensors whose positions the case gives as coordinates."""
    sensors = result.case.get("sensors", [])
    placed = [(sensor["name"], sensor["position"]) for sensor in sensors]
    return [
        (name, float(place[0]), float(place[1]))
        for name, place in placed
        if not isinstance(place, str)
    ]
