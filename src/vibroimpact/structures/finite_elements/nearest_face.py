"""The nearest places on faces of elements to given points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.structures.finite_elements.surface import Faces

_STEPS = 30  # of Gauss and Newton's method
# last step in local coordinates: it is quadratic near a face that a point lies on
_CONVERGED = 1e-14
# of the distance of the furthest node from the middle of a face: how far a curved face reaches
_BULGE = 1.5


@dataclass(frozen=True)
class NearestPlace:
    """The place on faces that is nearest to a point.

    Parameters
    ----------
    distance : float
        From the point.
    position : array, shape (3,)
        Where it is.
    nodes, weights : array, shape (k,)
        Its motion is the weighted sum of the motions of nodes.
    """

    distance: float
    position: Floats
    nodes: Integers
    weights: Floats


def nearest_places(
    nodes: Floats, groups: Sequence[Faces], points: Floats, reach: float
) -> list[NearestPlace | None]:
    """Return the nearest place on faces to each point; None where no face is within `reach`.

    Parameters
    ----------
    nodes : array, shape (n, 3)
        Nodes of the mesh.
    groups : sequence of Faces
        The faces.
    points : array, shape (p, 3)
        The points.
    reach : float
        Largest distance.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.lattice import box_mesh
    >>> from vibroimpact.structures.finite_elements.surface import outer_faces
    >>> mesh = box_mesh((1.0, 1.0, 1.0), (2, 2, 2))
    >>> (found,) = nearest_places(mesh.nodes, outer_faces(mesh), np.array([[0.1, 0.2, 0.6]]), 0.2)
    >>> round(found.distance, 12), found.position.round(12).tolist()
    (0.1, [0.1, 0.2, 0.5])
    """
    from scipy.spatial import cKDTree

    nearest: list[NearestPlace | None] = [None] * len(points)
    tree = cKDTree(points)
    for faces in groups:
        face_nodes = nodes[faces.connectivity[:, faces.has_node]]
        middle = face_nodes.mean(axis=1)
        radius = _BULGE * np.linalg.norm(face_nodes - middle[:, None], axis=2).max(axis=1)
        # pairs of faces and points that may be near
        points_of_faces = tree.query_ball_point(middle, radius + reach)
        face = np.repeat(np.arange(len(points_of_faces)), [*map(len, points_of_faces)])
        point = np.array([point for near in points_of_faces for point in near], dtype=np.int64)
        if not len(point):
            continue
        local = _projected(nodes, faces, face, points[point])
        values = faces.shape_functions(local)[0]
        position = np.einsum("pk,pki->pi", values, nodes[faces.connectivity[face]])
        distance = np.linalg.norm(position - points[point], axis=1)
        for pair in np.flatnonzero(distance <= reach).tolist():
            best = nearest[point[pair]]
            if best is None or distance[pair] < best.distance:
                nearest[point[pair]] = NearestPlace(
                    distance=float(distance[pair]),
                    position=position[pair],
                    nodes=faces.connectivity[face[pair], faces.has_node],
                    weights=values[pair, faces.has_node],
                )
    return nearest


def _projected(nodes: Floats, faces: Faces, face: Integers, points: Floats) -> Floats:
    """Return the local coordinates of the place of each face nearest to its point.

    They are found by Gauss and Newton's method within the face.
    """
    face_nodes = nodes[faces.connectivity[face]]
    local = np.full((len(face), 2), 1.0 / 3.0)
    for _ in range(_STEPS):
        values, slopes = faces.shape_functions(local)
        offset = np.einsum("pk,pki->pi", values, face_nodes) - points
        tangents = slopes @ face_nodes  # (points, 2, 3)
        metric = tangents @ tangents.transpose(0, 2, 1)
        # normal equations of Gauss and Newton, regular also where the tangents are parallel
        metric += 1e-14 * np.trace(metric, axis1=1, axis2=2)[:, None, None] * np.eye(2)
        step = np.linalg.solve(metric, (tangents @ offset[:, :, None]))[:, :, 0]
        next_local = _inside(local - step, len(faces.corners))
        change = np.abs(next_local - local).max(initial=0.0)
        local = next_local
        if change < _CONVERGED:
            break
    return local


def _inside(local: Floats, corners: int) -> Floats:
    """Return the nearest local coordinates of a triangle or a square."""
    if corners == 4:
        return np.clip(local, 0.0, 1.0)
    excess = np.maximum(local.sum(axis=1) - 1.0, 0.0)  # beyond the side opposite the first corner
    clipped = np.clip(local - 0.5 * excess[:, None], 0.0, 1.0)
    return np.asarray(clipped / np.maximum(clipped.sum(axis=1), 1.0)[:, None])
