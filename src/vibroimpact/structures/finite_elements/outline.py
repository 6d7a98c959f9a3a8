"""The outline of a body seen from above.

It consists of the edges that belong to one face of its upper side only.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.surface import Faces, facing

_POINTS = 5  # on an edge, which may be curved
_CORNERS = {
    3: np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
    4: np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
}
"""Corners of a triangle and of a quadrilateral, in the coordinates of a face."""


def outline(mesh: Mesh) -> tuple[Floats, Floats]:
    """Return x and y [m] along the free edges of the upper side of a mesh, edge by edge.

    Each edge is followed by NaN.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh
    >>> x, y = outline(plate_mesh((0.5, 0.4), 0.2))
    >>> on_edge = np.isclose(abs(x), 0.25) | np.isclose(abs(y), 0.2) | np.isnan(x)
    >>> float(np.nanmin(x).round(9)), float(np.nanmax(y).round(9)), bool(on_edge.all())
    (-0.25, 0.2, True)
    """
    groups = facing(mesh, "upper")
    if not groups:
        return np.empty(0), np.empty(0)
    along = np.linspace(0.0, 1.0, _POINTS)[:, None]
    edges = []
    for faces, is_free in zip(groups, _free_sides(groups), strict=True):
        corners = _CORNERS[len(faces.corners)]
        for side, start in enumerate(corners):
            end = corners[(side + 1) % len(corners)]
            local = start + along * (end - start)
            values, _ = faces.shape_functions(local)
            with_free_side = faces.connectivity[is_free[:, side]]
            points = np.einsum("qk,eki->eqi", values, mesh.nodes[with_free_side, :2])
            gap = np.full_like(points[:, :1], np.nan)
            followed_by_gap = np.concatenate([points, gap], axis=1)
            edges.append(followed_by_gap.reshape(-1, 2))
    x, y = np.concatenate(edges).T
    return np.ascontiguousarray(x), np.ascontiguousarray(y)


def _free_sides(groups: list[Faces]) -> list[Bools]:
    """Return which sides of faces belong to no other face, (faces, sides), by group."""
    sides = []  # the two corners of each side, by group
    for faces in groups:
        start = faces.connectivity[:, list(faces.corners)]
        end = np.roll(start, -1, axis=1)
        sides.append(np.sort(np.stack([start, end], axis=-1), axis=-1))
    _, number_of_side, faces_of_side = np.unique(
        np.concatenate([side.reshape(-1, 2) for side in sides]),
        axis=0,
        return_inverse=True,
        return_counts=True,
    )
    is_free = faces_of_side[number_of_side.ravel()] == 1
    ends = np.cumsum([side.shape[0] * side.shape[1] for side in sides])[:-1]
    return [
        free.reshape(side.shape[:2])
        for free, side in zip(np.split(is_free, ends), sides, strict=True)
    ]
