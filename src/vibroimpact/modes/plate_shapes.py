"""Mode shapes of a plate seen from above.

They are maps of the displacement upwards; of a mode in its plane the deformed grid.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.cases.elastic.modes import BodyModes, contact_place
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Panel
from vibroimpact.charts.marks import Label, Line, Map, Mark, Outline, Points
from vibroimpact.charts.outlines import AT_REST, on_supports
from vibroimpact.modes.supports import held_nodes, support_outlines
from vibroimpact.modes.tables import mode_title
from vibroimpact.quoting import visible
from vibroimpact.results.surface_grid import SurfaceGrid, surface_grid
from vibroimpact.structures.finite_elements.outline import outline
from vibroimpact.structures.finite_elements.surface import place_of
from vibroimpact.structures.supports.edge import Edge

_POINTS = 12_000
"""Approximate number of grid points of a map: nodal lines between them are straight."""

_IN_PLANE = 0.2
"""Part of the largest displacement below which a mode is one in the plane.

What it moves upwards is no more than the plate's Poisson contraction.
"""

_LINES = 13
"""Lines of a deformed grid along the longer side."""

_DRAWN_DISPLACEMENT = 0.05
"""Largest displacement of a deformed grid over that side."""


def plate_panels(body: BodyModes, number: int) -> list[Panel]:
    """Return the shapes of the first modes of a plate, each relative to its largest displacement.

    Parameters
    ----------
    body : BodyModes
        The plate.
    number : int
        Number of modes.
    """
    model = body.model
    grid = surface_grid(model.mesh, _POINTS)
    x_axis = Axis("x", "m")
    y_axis = Axis("y", "m")
    scale = Axis("Displacement upwards, part of the largest")
    plate_marks = _plate_marks(body)
    is_supported = _on_supports(body, grid)
    panels = []
    for mode in range(number):
        displacements = model.displacements(mode)
        marks: list[Mark]
        if is_in_plane(displacements):
            label = Label(0.5, 0.0, "in its plane", "below", corner=True)
            marks = [_deformed_grid(grid, displacements), *plate_marks, label]
        else:
            height = grid.interpolate(displacements[:, 2])
            values = height / np.nanmax(np.abs(height))
            # small motions on a support would be drawn as lines of rest
            values[is_supported & (np.abs(values) < AT_REST)] = 0.0
            shape_map = Map(
                grid.x, grid.y, values, scale, diverging=True, contours=True, cells=False
            )
            marks = [shape_map, *plate_marks]
        panels.append(Panel(x_axis, y_axis, tuple(marks), mode_title(model, mode), picture=True))
    return panels


def is_in_plane(displacements: Floats) -> bool:
    """Return whether a plate moves in its plane.

    Parameters
    ----------
    displacements : array, shape (nodes, 3)
        Displacements of its nodes [m].
    """
    upwards = np.abs(displacements[:, 2]).max()
    return bool(upwards < _IN_PLANE * np.linalg.norm(displacements, axis=1).max())


def _on_supports(body: BodyModes, grid: SurfaceGrid) -> Bools:
    """Return which points of a grid lie on supports, but for those of edges.

    These have no width.
    """
    supports = [support for support in body.body.recipe.supports if not isinstance(support, Edge)]
    return on_supports(support_outlines(supports, body.model.mesh), grid.x, grid.y)


def _plate_marks(body: BodyModes) -> list[Mark]:
    """Return the edge of the plate, its supports, the contact point and the sensors."""
    mesh = body.model.mesh
    marks: list[Mark] = [Line(*outline(mesh))]
    for x, y in support_outlines(body.body.recipe.supports, mesh):
        marks.append(Outline(x, y, name="support", role="held"))
    held = held_nodes(body.body.recipe.supports, mesh)
    if len(held):
        marks.append(Points(held[:, 0], held[:, 1], "held nodes", "held nodes"))
    (contact_x, contact_y), _ = contact_place(body)
    marks.append(Points(np.array([contact_x]), np.array([contact_y]), "contact point"))
    sensors = sensor_places(body)
    if sensors:
        names = tuple(visible(name) for name, _, _ in sensors)
        sensor_x = np.array([x for _, x, _ in sensors])
        sensor_y = np.array([y for _, _, y in sensors])
        marks.append(Points(sensor_x, sensor_y, "sensor", "sensor", texts=names))
    return marks


def sensor_places(body: BodyModes) -> list[tuple[str, float, float]]:
    """Return name, x and y [m] of the sensors on a body."""
    return [
        (name, *place_of(body.model.mesh, position, side))
        for name, (position, side) in body.body.sensors.items()
    ]


def _deformed_grid(grid: SurfaceGrid, displacements: Floats) -> Line:
    """Return lines of a coarse grid, displaced."""
    in_plane = grid.interpolate(np.ascontiguousarray(displacements[:, :2].T))
    longer_side = float(max(np.ptp(grid.x), np.ptp(grid.y)))
    largest = np.nanmax(np.abs(in_plane))
    in_plane *= _DRAWN_DISPLACEMENT * longer_side / largest
    deformed = np.stack(np.meshgrid(grid.x, grid.y)) + in_plane  # x and y of the grid points
    step = longer_side / (_LINES - 1)
    # one line after the other, with a gap between them
    gap = np.full((2, 1), np.nan)
    pieces = []
    for row in _line_indices(grid.y, step):
        pieces += [deformed[:, row, :], gap]
    for column in _line_indices(grid.x, step):
        pieces += [deformed[:, :, column], gap]
    x, y = np.concatenate(pieces, axis=1)
    return Line(x, y, role="detail")


def _line_indices(side: Floats, step: float) -> Indices:
    """Return the indices of grid coordinates [m] that are about a step [m] apart."""
    number = 1 + round(float(np.ptp(side)) / step)
    evenly = np.linspace(0, len(side) - 1, number)
    return np.unique(evenly.round().astype(int))
