"""The outline of a body seen from above: the edges that belong to one face of its upper
side only.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.structures.mesh import Mesh
from vibroimpact.structures.surface import facing

_POINTS = 5  # on an edge, which may be curved
_CORNERS = {
    3: np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
    4: np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
}
"""Corners of a triangle and of a quadrilateral, in the coordinates of a face."""


def outline(mesh: Mesh) -> tuple[Floats, Floats]:
    """Return x and y [m] along the free edges of the upper side of a mesh, edge by edge, each
    followed by NaN.

    Examples
    --------
    >>> from vibroimpact.structures.plate_mesh import plate_mesh
    >>> x, y = outline(plate_mesh((0.5, 0.4), 0.2))
    >>> on_edge = np.isclose(abs(x), 0.25) | np.isclose(abs(y), 0.2) | np.isnan(x)
    >>> float(np.nanmin(x).round(9)), float(np.nanmax(y).round(9)), bool(on_edge.all())
    (-0.25, 0.2, True)
    """
    sides = []  # of each group of faces: the two corners of each of its sides
    groups = facing(mesh, "upper")
    for faces in groups:
        corner = faces.connectivity[:, list(faces.corners)]
        sides.append(np.sort(np.stack([corner, np.roll(corner, -1, axis=1)], axis=-1), axis=-1))
    if not sides:
        return np.empty(0), np.empty(0)
    _, same, count = np.unique(
        np.concatenate([side.reshape(-1, 2) for side in sides]),
        axis=0,
        return_inverse=True,
        return_counts=True,
    )
    alone = np.split(
        count[same.ravel()] == 1, np.cumsum([side.shape[0] * side.shape[1] for side in sides])[:-1]
    )
    along = np.linspace(0.0, 1.0, _POINTS)[:, None]
    edges = []
    for faces, side, free in zip(groups, sides, alone, strict=True):
        corner = _CORNERS[len(faces.corners)]
        for number, (begin, end) in enumerate(
            zip(corner, np.roll(corner, -1, axis=0), strict=True)
        ):
            nodes = mesh.nodes[faces.connectivity[free.reshape(side.shape[:2])[:, number]], :2]
            at = np.einsum(
                "qk,eki->eqi", faces.shape_functions(begin + along * (end - begin))[0], nodes
            )
            edges.append(
                np.concatenate([at, np.full_like(at[:, :1], np.nan)], axis=1).reshape(-1, 2)
            )
    x, y = np.concatenate(edges).T
    return np.ascontiguousarray(x), np.ascontiguousarray(y)
