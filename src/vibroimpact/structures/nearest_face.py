"""The nearest places on faces of elements to given points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.structures.surface import Faces

_STEPS = 30
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
    >>> from vibroimpact.structures.lattice import box_mesh
    >>> from vibroimpact.structures.surface import outer_faces
    >>> mesh = box_mesh((1.0, 1.0, 1.0), (2, 2, 2))
    >>> (found,) = nearest_places(mesh.nodes, outer_faces(mesh), np.array([[0.1, 0.2, 0.6]]), 0.2)
    >>> round(found.distance, 12), found.position.round(12).tolist()
    (0.1, [0.1, 0.2, 0.5])
    """
    from scipy.spatial import cKDTree

    found: list[NearestPlace | None] = [None] * len(points)
    tree = cKDTree(points)
    for faces in groups:
        at = nodes[faces.connectivity[:, faces.has_node]]
        middle = at.mean(axis=1)
        radius = _BULGE * np.linalg.norm(at - middle[:, None], axis=2).max(axis=1)
        near = tree.query_ball_point(middle, radius + reach)
        face = np.repeat(np.arange(len(near)), [len(one) for one in near])
        point = np.concatenate(
            [np.zeros(0, dtype=np.int64), *(np.array(one, dtype=np.int64) for one in near)]
        )
        if not len(point):
            continue
        local = _projected(nodes, faces, face, points[point])
        values = faces.shape_functions(local)[0]
        position = np.einsum("pk,pki->pi", values, nodes[faces.connectivity[face]])
        distance = np.linalg.norm(position - points[point], axis=1)
        for index in np.flatnonzero(distance <= reach).tolist():
            which, before = int(point[index]), found[int(point[index])]
            if before is None or distance[index] < before.distance:
                members = faces.connectivity[face[index], faces.has_node]
                found[which] = NearestPlace(
                    float(distance[index]), position[index], members, values[index, faces.has_node]
                )
    return found


def _projected(nodes: Floats, faces: Faces, face: Integers, points: Floats) -> Floats:
    """Return the local coordinates of the place of each face nearest to its point, by
    Gauss and Newton's method within the face.
    """
    at = nodes[faces.connectivity[face]]
    local = np.full((len(face), 2), 1.0 / 3.0)
    for _ in range(_STEPS):
        values, slopes = faces.shape_functions(local)
        apart = np.einsum("pk,pki->pi", values, at) - points
        along = slopes @ at  # tangents, (points, 2, 3)
        metric = along @ along.transpose(0, 2, 1)
        metric += 1e-14 * np.trace(metric, axis1=1, axis2=2)[:, None, None] * np.eye(2)
        step = np.linalg.solve(metric, (along @ apart[:, :, None]))[:, :, 0]
        moved = _inside(local - step, len(faces.corners))
        change = np.abs(moved - local).max(initial=0.0)
        local = moved
        if change < _CONVERGED:
            break
    return local


def _inside(local: Floats, corners: int) -> Floats:
    """Return the nearest local coordinates of a triangle or a square."""
    if corners == 4:
        return np.clip(local, 0.0, 1.0)
    over = np.maximum(local.sum(axis=1) - 1.0, 0.0)
    found = np.clip(local - 0.5 * over[:, None], 0.0, 1.0)
    return np.asarray(found / np.maximum(found.sum(axis=1), 1.0)[:, None])
