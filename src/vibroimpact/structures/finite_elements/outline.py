"""The outline of a body seen from above, from below or from the side.

It consists of the edges that belong to one face of the side seen only, as closed lines: around the
body, its holes, and what stands on it. Faces that are seen from their outside are to the left of
their edges, from above: filled where a point is gone round at all, the lines are the silhouette.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from vibroimpact.arrays import Bools, Floats, Integers
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.surface import Faces, facing_along

View = Literal["above", "below", "side"]
"""Where a body is seen from; "side" is from -y, with x to the right."""

_DIRECTIONS = {
    "above": np.array([0.0, 0.0, 1.0]),
    "below": np.array([0.0, 0.0, -1.0]),
    "side": np.array([0.0, -1.0, 0.0]),
}
_PLANES = {"above": [0, 1], "below": [0, 1], "side": [0, 2]}
_POINTS = 5  # on an edge, which may be curved
_STRAIGHT = 1e-4
"""Largest distance of a point left out from the line, relative to the extent of the body: less than
a tenth of a pixel of a picture.
"""
_CORNERS = {
    3: np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
    4: np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
}
"""Corners of a triangle and of a quadrilateral, in the coordinates of a face."""


def outline(mesh: Mesh, view: View = "above") -> tuple[Floats, Floats]:
    """Return the outline of a mesh as closed lines, each followed by NaN.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    view : str, default "above"
        Where it is seen from: "above", "below" or "side", which is from -y.

    Returns
    -------
    x, y : array, shape (points,)
        x and y [m]; seen from the side x and z.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.lattice import box_mesh
    >>> x, y = outline(box_mesh((0.4, 0.2, 0.01), (4, 2, 1)))
    >>> sorted(zip(x[:4].round(9).tolist(), y[:4].round(9).tolist()))
    [(-0.2, -0.1), (-0.2, 0.1), (0.2, -0.1), (0.2, 0.1)]
    >>> len(x), bool(np.isnan(x[-1]))
    (6, True)
    """
    groups = facing_along(mesh, _DIRECTIONS[view])
    if not groups:
        return np.empty(0), np.empty(0)
    along = np.linspace(0.0, 1.0, _POINTS)[:, None]
    ends = []
    edges = []
    for faces, is_free in zip(groups, _free_sides(groups), strict=True):
        corners = _CORNERS[len(faces.corners)]
        for side, start in enumerate(corners):
            following = (side + 1) % len(corners)
            local = start + along * (corners[following] - start)
            values, _ = faces.shape_functions(local)
            with_free_side = faces.connectivity[is_free[:, side]]
            nodes = mesh.nodes[with_free_side][..., _PLANES[view]]
            edges.append(np.einsum("qk,eki->eqi", values, nodes))
            ends.append(with_free_side[:, [faces.corners[side], faces.corners[following]]])
    loops = _loops(np.concatenate(ends), np.concatenate(edges))
    tolerance = _STRAIGHT * float(mesh.extent.max())
    gap = np.full((1, 2), np.nan)
    pieces = [piece for loop in loops for piece in (_without_straight(loop, tolerance), gap)]
    x, y = np.concatenate(pieces).T
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


def _loops(ends: Integers, edges: Floats) -> list[Floats]:
    """Return edges joined to closed lines, whose last point is the first.

    Parameters
    ----------
    ends : array, shape (edges, 2)
        The nodes where each edge starts and ends.
    edges : array, shape (edges, points, 2)
        The points of each edge [m].
    """
    starting: dict[int, list[int]] = {}
    for edge, start in enumerate(ends[:, 0].tolist()):
        starting.setdefault(start, []).append(edge)
    loops = []
    for first, start in enumerate(ends[:, 0].tolist()):
        if first not in starting[start]:
            continue  # it is part of a line already
        chain = []
        edge = first
        while True:
            starting[int(ends[edge, 0])].remove(edge)
            chain.append(edges[edge])
            following = starting.get(int(ends[edge, 1]))
            if not following:
                break
            edge = following[0]
        loops.append(np.concatenate([*chain, edges[first][:1]]))
    return loops


def _without_straight(line: Floats, tolerance: float) -> Floats:
    """Return a closed line (points, 2) without the points on straight lines between others.

    The method is that of Ramer, Douglas and Peucker.
    """
    farthest = int(np.argmax(np.hypot(*(line - line[0]).T)))
    kept = {0, farthest, len(line) - 1}
    chords = [(0, farthest), (farthest, len(line) - 1)]
    while chords:
        first, last = chords.pop()
        if last - first < 2:
            continue
        chord = line[last] - line[first]
        offset = line[first + 1 : last] - line[first]
        part = np.clip(offset @ chord / max(float(chord @ chord), 1e-300), 0.0, 1.0)
        distance = np.hypot(*(offset - part[:, None] * chord).T)
        bend = int(np.argmax(distance))
        if distance[bend] > tolerance:
            middle = first + 1 + bend
            kept.add(middle)
            chords += [(first, middle), (middle, last)]
    return line[sorted(kept)]
