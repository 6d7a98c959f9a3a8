"""Mode shapes of a plate seen from above: maps of the displacement upwards; of a mode in
its plane the deformed grid.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.cases.elastic.modes import BodyModes, contact_place
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Panel
from vibroimpact.charts.marks import Label, Line, Map, Mark, Outline, Points
from vibroimpact.charts.outlines import AT_REST, on_supports
from vibroimpact.modes.supports import support_outlines
from vibroimpact.modes.titles import mode_title
from vibroimpact.quoting import visible
from vibroimpact.results.surface_grid import SurfaceGrid, surface_grid
from vibroimpact.structures.outline import outline
from vibroimpact.structures.supports.edge import Edge
from vibroimpact.structures.surface import place_of

_POINTS = 12_000
"""Approximate number of grid points of a map: nodal lines between them are straight."""

_IN_PLANE = 0.2
"""Part of the largest displacement below which that upwards is no more than the plate's
Poisson contraction.
"""

_LINES, _EXAGGERATED = 13, 0.05
"""Lines of a deformed grid along the longer side, and its largest displacement over that side."""


def plate_panels(body: BodyModes, number: int) -> list[Panel]:
    """Return the shapes of the first modes of a plate, each relative to its largest displacement.

    Parameters
    ----------
    body : BodyModes
        The plate.
    number : int
        Number of modes.
    """
    model, grid = body.model, surface_grid(body.model.mesh, _POINTS)
    across, up, scale = (
        Axis("x", "m"),
        Axis("y", "m"),
        Axis("Displacement upwards, part of the largest"),
    )
    marked, held = _plate_marks(body), _on_supports(body, grid)
    panels = []
    for mode in range(number):
        moved = model.displacements(mode)
        marks: list[Mark]
        if is_in_plane(moved):
            marks = [
                _deformed_grid(grid, moved),
                *marked,
                Label(0.5, 0.0, "in its plane", "below", corner=True),
            ]
        else:
            height = grid.interpolate(moved[:, 2])
            values = height / np.nanmax(np.abs(height))
            values[held & (np.abs(values) < AT_REST)] = 0.0
            marks = [
                Map(grid.x, grid.y, values, scale, diverging=True, contours=True, cells=False),
                *marked,
            ]
        panels.append(Panel(across, up, tuple(marks), mode_title(model, mode), picture=True))
    return panels


def is_in_plane(moved: Floats) -> bool:
    """Return whether a plate moves in its plane, given the displacements of its nodes,
    (nodes, 3).
    """
    return bool(np.abs(moved[:, 2]).max() < _IN_PLANE * np.linalg.norm(moved, axis=1).max())


def _on_supports(body: BodyModes, grid: SurfaceGrid) -> Bools:
    """Return which points of a grid lie on supports, but for those of edges, which have
    no width.
    """
    supports = [support for support in body.body.recipe.supports if not isinstance(support, Edge)]
    return on_supports(support_outlines(supports, body.model.mesh), grid.x, grid.y)


def _plate_marks(body: BodyModes) -> list[Mark]:
    """Return the edge of the plate, its supports, the contact point and the sensors."""
    mesh, (place, _) = body.model.mesh, contact_place(body)
    marks: list[Mark] = [Line(*outline(mesh))]
    marks += [
        Outline(*one, name="support", role="held")
        for one in support_outlines(body.body.recipe.supports, mesh)
    ]
    marks.append(Points(np.array([place[0]]), np.array([place[1]]), "contact point"))
    watched = sensor_places(body)
    if watched:
        names, x, y = zip(*watched, strict=True)
        marks.append(
            Points(
                np.array(x),
                np.array(y),
                "sensor",
                "sensor",
                texts=tuple(visible(name) for name in names),
            )
        )
    return marks


def sensor_places(body: BodyModes) -> list[tuple[str, float, float]]:
    """Return name, x and y [m] of the sensors on a body."""
    return [
        (name, *place_of(body.model.mesh, spot, side))
        for name, (spot, side) in body.body.sensors.items()
    ]


def _deformed_grid(grid: SurfaceGrid, moved: Floats) -> Line:
    """Return lines of a coarse grid, displaced."""
    x, y = np.meshgrid(grid.x, grid.y)
    along = grid.interpolate(np.ascontiguousarray(moved[:, :2].T))
    size = float(max(np.ptp(grid.x), np.ptp(grid.y)))
    along *= _EXAGGERATED * size / np.nanmax(np.abs(along))
    shown = np.stack([x, y]) + along
    step = size / (_LINES - 1)
    columns, rows = (
        np.unique(
            np.linspace(0, len(side) - 1, 1 + round(float(np.ptp(side)) / step)).round().astype(int)
        )
        for side in (grid.x, grid.y)
    )
    lines = [shown[:, row, :] for row in rows] + [shown[:, :, column] for column in columns]
    gap = np.full((2, 1), np.nan)
    joined = np.concatenate([part for line in lines for part in (line, gap)], axis=1)
    return Line(joined[0], joined[1], role="detail")
