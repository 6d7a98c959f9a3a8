"""The shape of a plate whose mesh was brought, as pictures of the set-up show it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.results.single_supports import single_supports
from vibroimpact.structures.finite_elements.mesh import Mesh

if TYPE_CHECKING:
    from vibroimpact.dynamics.response import Response

_MOST_HELD = 400
"""Held nodes that are drawn of each set."""

_AT_END = 1e-6
"""Distance of the nodes of an edge from the end of the body, relative to its extent."""


@dataclass(frozen=True)
class PlateShape:
    """Outlines of a plate of any shape, where it is held and where its sensors are [m].

    Lines are closed, and each is followed by NaN. Heights count from the upper side at the contact
    point.

    Parameters
    ----------
    above, below : array, shape (points, 2)
        x and y of the outlines of the upper side, and of what differs from it on the lower one,
        such as ribs.
    side : array, shape (points, 2)
        x and z of the outline seen along y.
    held : array, shape (nodes, 3)
        Nodes of the sets that are held, or of large sets some of them.
    levels : array, shape (supports, 2)
        Lowest and highest z that each support holds, in the order of `single_supports`.
    sensors : array, shape (sensors, 2)
        x and y of the sensors, in the order of the case.
    """

    above: Floats
    below: Floats
    side: Floats
    held: Floats
    levels: Floats
    sensors: Floats

    @property
    def low(self) -> Floats:
        """The smallest x, y and z of the plate [m], shape (3,)."""
        return np.append(np.nanmin(self.above, axis=0), np.nanmin(self.side[:, 1]))

    @property
    def high(self) -> Floats:
        """The largest x, y and z of the plate [m], shape (3,)."""
        return np.append(np.nanmax(self.above, axis=0), np.nanmax(self.side[:, 1]))


def plate_shape_of(response: Response) -> PlateShape | None:
    """Return the shape of the plate of a run; None if its mesh was not brought."""
    model = response.problem.models.get("plate")
    case: Any = response.problem.source or {}
    mesh = case.get("plate", {}).get("mesh")
    if model is None or not isinstance(mesh, Mapping) or "file" not in mesh:
        return None
    from vibroimpact.results.deflection import contact_point_of

    return plate_shape(model.mesh, case, contact_point_of(response, model))


def plate_shape(mesh: Mesh, case: Any, contact: tuple[float, float]) -> PlateShape:
    """Return the shape of a meshed plate.

    Parameters
    ----------
    mesh : Mesh
        Its mesh.
    case : ResolvedCase
        The resolved case, for supports and sensors.
    contact : tuple of two floats
        x and y of the contact point [m].

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.lattice import box_mesh
    >>> shape = plate_shape(box_mesh((0.4, 0.2, 0.01), (4, 2, 1)), {}, (0.0, 0.0))
    >>> shape.low.round(9).tolist(), shape.high.round(9).tolist()
    ([-0.2, -0.1, -0.01], [0.2, 0.1, 0.0])
    """
    # here, as they import scipy.sparse
    from vibroimpact.structures.finite_elements.outline import outline
    from vibroimpact.structures.finite_elements.surface import place_of, surface_motion

    _, positions = surface_motion(mesh, np.array([contact]))
    level = float(positions[0, 2])
    above, below, side = (
        np.column_stack(outline(mesh, view)) for view in ("above", "below", "side")
    )
    below = _hidden(below, above)
    side[:, 1] -= level
    held = [np.empty((0, 3))]
    levels = []
    for support in single_supports(case):
        nodes = mesh.nodes[_held_nodes(mesh, support)]
        levels.append([nodes[:, 2].min() - level, nodes[:, 2].max() - level])
        if support["type"] == "set":
            some = nodes[:: -(-len(nodes) // _MOST_HELD)]
            held.append(some - [0.0, 0.0, level])
    sensors = [
        place_of(mesh, _spot(sensor["position"]), sensor.get("face", "upper"))
        for sensor in case.get("sensors", ())
    ]
    return PlateShape(
        above,
        below,
        side,
        np.concatenate(held),
        np.array(levels).reshape(-1, 2),
        np.array(sensors).reshape(-1, 2),
    )


def _hidden(below: Floats, above: Floats) -> Floats:
    """Return the lines of the lower side that are not those of the upper one, each once."""
    known = {_corners(line) for line in lines_of(above)}
    pieces = [np.empty((0, 2))]
    for line in lines_of(below):
        corners = _corners(line)
        if corners not in known:
            known.add(corners)
            pieces += [line, np.full((1, 2), np.nan)]
    return np.concatenate(pieces)


def _corners(line: Floats) -> frozenset[tuple[float, float]]:
    """Return the points of a line, rounded to a ten-thousandth of its size."""
    unit = 1e-4 * max(float(np.ptp(line, axis=0).max()), 1e-300)
    return frozenset((round(x / unit), round(y / unit)) for x, y in line.tolist())


def lines_of(outline: Floats) -> list[Floats]:
    """Return the lines of an outline, which are followed by NaN.

    Examples
    --------
    >>> lines_of(np.array([[0.0, 0.0], [1.0, 0.0], [np.nan, np.nan]]))[0].tolist()
    [[0.0, 0.0], [1.0, 0.0]]
    """
    gaps = np.flatnonzero(np.isnan(outline[:, 0]))
    return [line[~np.isnan(line[:, 0])] for line in np.split(outline, gaps + 1) if len(line)]


def _spot(position: Any) -> tuple[float, float] | str:
    if isinstance(position, str):
        return position
    x, y = position[:2]
    return float(x), float(y)


def _held_nodes(mesh: Mesh, support: Mapping[str, Any]) -> Integers:
    """Return the nodes that a support holds; of one below the plate the nearest of that side."""
    from vibroimpact.structures.finite_elements.surface import lower_nodes

    if support["type"] == "set":
        return mesh.nodes_of(support["name"])
    if support["type"] == "edge":
        axis, end = support["edge"].split("-")
        along = mesh.nodes[:, "xy".index(axis)]
        extreme = {"min": along.min(), "max": along.max()}[end]
        return np.flatnonzero(np.abs(along - extreme) <= _AT_END * np.ptp(along))
    lower = lower_nodes(mesh)
    distance = np.hypot(*(mesh.nodes[lower, :2] - np.array(support["position"])).T)
    return lower[[int(np.argmin(distance))]]
