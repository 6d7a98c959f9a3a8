"""Chart of the plate's deflection: maps at six times."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Label, Line, Map, Mark, Outline, Points
from vibroimpact.charts.outlines import AT_REST, inside, on_supports
from vibroimpact.results.deflection import Deflection
from vibroimpact.results.result import Result
from vibroimpact.results.surface_grid import beyond_edge
from vibroimpact.runs.sensor_marks import sensor_marks
from vibroimpact.runs.supports import held_nodes, support_outlines
from vibroimpact.units.display import digits, multiple, text

_COLUMNS = 3
_ROWS = 2

_FINER = 3
"""Points of a map of a plate of any shape per grid step of its deflection."""

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
        x, y, height = _cut(result, deflection.x, deflection.y, height)
        map_ = Map(x, y, height, scale, diverging=True, contours=True, cells=False)
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


def _cut(result: Result, x: Floats, y: Floats, height: Floats) -> tuple[Floats, Floats, Floats]:
    """Return a map that reaches to the outline of the plate, which lies between grid points: on a
    finer grid, with NaN outside. That of a plate whose mesh was not brought stays as it is.
    """
    if result.plate_shape is None:
        return x, y, height
    fine_x, fine_y = (
        np.linspace(side[0], side[-1], _FINER * (len(side) - 1) + 1) for side in (x, y)
    )
    continued = beyond_edge(height)
    along_x = np.array([np.interp(fine_x, x, row) for row in continued])
    fine = np.array([np.interp(fine_y, y, column) for column in along_x.T]).T
    fine[~_on_plate(result.plate_shape.above, fine_x, fine_y)] = np.nan
    return fine_x, fine_y, fine


def _on_plate(outline: Floats, x: Floats, y: Floats) -> Bools:
    """Return which points of a grid lie on a plate; those on its last lines belong to it."""
    is_inside = inside(outline, x, y)
    is_inside[:, -1] = is_inside[:, -2]
    is_inside[-1] = is_inside[-2]
    return is_inside


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
    edge = _edge(deflection.x, deflection.y)
    if result.plate_shape is not None:
        edge = (result.plate_shape.above[:, 0], result.plate_shape.above[:, 1])
    marks: list[Mark] = [Line(*edge, role="main")]
    marks += [
        Outline(*outline, name="support", role="held") for outline in support_outlines(result)
    ]
    marks += held_nodes(result, (0, 1))
    marks.append(
        Points(
            np.array([deflection.contact[0]]),
            np.array([deflection.contact[1]]),
            "contact point",
            "mark",
        )
    )
    return (*marks, *sensor_marks(result, (*deflection.contact, 0.0)))


def _edge(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    return x[[0, -1, -1, 0, 0]], y[[0, 0, -1, -1, 0]]
