"""The plate in motion with ball, supports and sensors: what the page and the animation draw."""

from __future__ import annotations

from typing import Any

import numpy as np

from vibroimpact.charts.decimation import rounded
from vibroimpact.results.deflection import Deflection
from vibroimpact.results.result import Result
from vibroimpact.results.surface_grid import beyond_edge
from vibroimpact.runs.chart_data import touch_height
from vibroimpact.runs.oblique_chart import moves_along
from vibroimpact.runs.sensor_marks import sensor_places
from vibroimpact.runs.supports import support_outlines

HEIGHT = 0.16
"""Largest drawn deflection, relative to the longer side of the plate."""

_STEP = 3e-4
"""Largest step of drawn deflections, relative to the largest one: a thirtieth of a pixel."""

_FRAMES = 240
"""Frames of a whole run."""


def exaggeration(deflection: Deflection) -> float:
    """Return the factor by which the deflection is exaggerated: 1, 2 or 5 times a power
    of ten; 1 if there is no deflection.
    """
    largest = float(np.nanmax(np.abs(deflection.height)))
    if largest == 0.0:
        return 1.0
    wanted = HEIGHT * float(max(np.ptp(deflection.x), np.ptp(deflection.y))) / largest
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(
        max((step * power for step in (1.0, 2.0, 5.0) if step * power <= wanted), default=power)
    )


def scene_of(result: Result) -> dict[str, Any]:
    """Return what a page draws of the plate in motion, with arrays in SI units.

    Parameters
    ----------
    result : Result
        Result with a deflection.

    Returns
    -------
    dict
        `x`, `y`: lines of the grid; `height`: deflections, (frames, rows, columns); `time`: of the
        frames, since first touch; `sphere` and `contact_height`: height of the sphere's centre and
        of the contact point in each frame; `contact`: its place; `radius`; `exaggeration` of the
        deflection, `gap_scale` of the gap between them; `supports`: their outlines; `sensors`:
        their names and places. Of a plate whose mesh was brought also `outline`, x and y of the
        closed lines around it, each followed by NaN, with heights a little beyond them; and `held`,
        the held nodes of sets.
    """
    deflection = result.deflection
    assert deflection is not None  # checked by the caller
    height = deflection.height
    shape = {}
    if result.plate_shape is not None:
        height = beyond_edge(height)
        shape = {"outline": result.plate_shape.above, "held": result.plate_shape.held}
    return {
        "x": deflection.x,
        "y": deflection.y,
        "height": rounded(height, _STEP),
        **shape,
        "time": deflection.time - float(result.impacts["time_s"][0]),
        "sphere": deflection.sphere_position,
        "contact_height": deflection.contact_deflection,
        "contact": list(deflection.contact),
        "radius": touch_height(result),
        "exaggeration": exaggeration(deflection),
        "gap_scale": 1.0,
        "supports": [np.column_stack(outline) for outline in support_outlines(result)],
        "sensors": [{"name": name, "x": x, "y": y} for name, x, y in sensor_places(result)],
    }


def rigid_scene(result: Result) -> dict[str, Any]:
    """Return what a page draws of a ball that bounces on a plate that does not bend, over the whole
    run; the same as `scene_of` otherwise.

    Parameters
    ----------
    result : Result
        Result of one drop on a plate that does not deform.
    """
    size = [float(side) for side in result.case.get("plate", {}).get("size", ())]
    radius = touch_height(result)
    if not np.isfinite(radius):  # it never touches
        radius = float(result.case.get("sphere", {}).get("radius", 0.025))
    half = (8.0 * radius, 8.0 * radius)
    if size:
        half = (0.5 * size[0], 0.5 * size[1])
    position = result.case.get("drop", {}).get("position", (0.0, 0.0))
    history = result.history
    time = np.linspace(0.0, float(history["time_s"][-1]), _FRAMES)
    # the lowest points lie between the frames: of a bounce at least its first touch is seen
    time = np.union1d(time, result.impacts["time_s"][:_FRAMES])
    height = np.interp(time, history["time_s"], history["position_m"])
    surface = np.interp(
        time, history["time_s"], history.get("surface_m", np.zeros_like(history["time_s"]))
    )
    reach = 1.1 * max(half)
    first_touch = 0.0
    if len(result.impacts["time_s"]):
        first_touch = float(result.impacts["time_s"][0])
    path = {}
    if moves_along(history):
        path["path"] = [
            np.interp(time, history["time_s"], history[f"position_{axis}_m"]) for axis in "xy"
        ]
    return {
        "x": np.array([-half[0], half[0]]),
        "y": np.array([-half[1], half[1]]),
        "height": np.repeat(surface[:, None], 4, axis=1).astype(np.float32),
        "time": time - first_touch,
        "sphere": height,
        "contact_height": surface,
        "contact": [float(position[0]), float(position[1])],
        **path,
        "radius": radius,
        "exaggeration": 1.0,
        "gap_scale": min(1.0, reach / max(float(height.max()) - radius, 1e-300)),
        "supports": [np.column_stack(outline) for outline in support_outlines(result)],
        "sensors": [{"name": name, "x": x, "y": y} for name, x, y in sensor_places(result)],
    }
