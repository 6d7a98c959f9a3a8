"""Interpolation of nodal values of a mesh onto a regular grid over its upper side."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Bools, Floats, Integers
from vibroimpact.structures.mesh import Mesh

if TYPE_CHECKING:
    from scipy.sparse import csr_array

POINTS = 3000
"""Approximate number of grid points by default."""

_FEWEST, _MOST = 11, 241  # points along one side
# tolerance of barycentric coordinates and grid steps: a point on the edge of a triangle counts as
# inside it
_EDGE = 1e-6
# subdivisions of a face per grid step: the triangles between the subdivision points are flat
_FINE = 3


@dataclass(frozen=True)
class SurfaceGrid:
    """Regular grid over the upper side of a mesh, with interpolation weights.

    `x`, `y`: grid coordinates [m], (columns,) and (rows,). `weights`: interpolation matrix (rows *
    columns, nodes), grid points in row-major order. `on_body`: mask of the grid points that lie on
    the body, (rows, columns).
    """

    x: Floats
    y: Floats
    weights: csr_array
    on_body: Bools

    def interpolate(self, values: Floats) -> Floats:
        """Return nodal values (..., nodes) interpolated to the grid points (..., rows,
        columns); NaN outside the body.
        """
        flat = values.reshape(-1, values.shape[-1])
        found = np.asarray((self.weights @ flat.T).T).reshape(-1, *self.on_body.shape)
        found[:, ~self.on_body] = np.nan
        return np.asarray(found.reshape(*values.shape[:-1], *self.on_body.shape))


def surface_grid(mesh: Mesh, points: int = POINTS) -> SurfaceGrid:
    """Return a regular grid over the upper side of a mesh, with a grid point at the middle of its
    bounding box.

    The faces of that side are subdivided into triangles smaller than the grid steps, and each grid
    point is interpolated in the uppermost triangle that contains it. This avoids the inverse
    mapping to element coordinates, and the mesh may have any outline and holes.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    points : int
        Approximate number of grid points.

    Examples
    --------
    >>> from vibroimpact.structures.lattice import box_mesh
    >>> grid = surface_grid(box_mesh((1.0, 1.0, 0.1), (3, 3, 1)))
    >>> grid.on_body.shape, bool(grid.on_body.all())
    ((55, 55), True)
    """
    from scipy.sparse import csr_array

    low, high = mesh.nodes.min(axis=0)[:2], mesh.nodes.max(axis=0)[:2]
    span = high - low
    sides = np.sqrt(points * span / span[::-1])
    columns, rows = (2 * int(np.clip(side, _FEWEST, _MOST) / 2) + 1 for side in sides)
    x, y = np.linspace(low[0], high[0], columns), np.linspace(low[1], high[1], rows)
    step = np.array([x[1] - x[0], y[1] - y[0]])
    at, motion, triangles = _triangles(mesh, step)
    corner = (at[:, :2] - low) / step  # in grid steps
    found = np.full(columns * rows, -np.inf)
    nodes, weight = np.zeros((len(found), 3), dtype=np.int64), np.zeros((len(found), 3))
    first = np.ceil(corner[triangles].min(axis=1) - _EDGE).astype(int)
    last = np.floor(corner[triangles].max(axis=1) + _EDGE).astype(int)
    # small triangles cover few grid points: a loop over these offsets tests all triangles at once
    reach = (last - first).max(axis=0, initial=-1) + 1
    for column in range(reach[0]):
        for row in range(reach[1]):
            point = first + np.array([column, row])
            here = np.flatnonzero(
                (point <= np.minimum(last, (columns - 1, rows - 1))).all(axis=1)
                & (point >= 0).all(axis=1)
            )
            share = _shares(corner[triangles[here]], point[here])
            inside = share.min(axis=1) >= -_EDGE
            here, share = here[inside], share[inside]
            height = np.einsum("tk,tk->t", share, at[triangles[here], 2])
            # of triangles at the same grid point the uppermost is assigned last
            order = np.argsort(height, kind="stable")
            index, height = (point[here, 1] * columns + point[here, 0])[order], height[order]
            higher = height > found[index]
            index = index[higher]
            found[index], nodes[index], weight[index] = (
                height[higher],
                triangles[here[order][higher]],
                share[order][higher],
            )
    rows_of = np.repeat(np.arange(len(found)), 3)
    chosen = csr_array((weight.ravel(), (rows_of, nodes.ravel())), shape=(len(found), len(at)))
    return SurfaceGrid(x, y, csr_array(chosen @ motion), np.isfinite(found).reshape(rows, columns))


def _shares(corner: Floats, point: Integers) -> Floats:
    """Return the barycentric coordinates of points in triangles, (triangles, 3); -1 for
    triangles of zero area.
    """
    a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    to = point - corner[:, 0]
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    flat = np.abs(area) < 1e-9
    area = np.where(flat, 1.0, area)
    second = (to[:, 0] * b[:, 1] - to[:, 1] * b[:, 0]) / area
    third = (a[:, 0] * to[:, 1] - a[:, 1] * to[:, 0]) / area
    share = np.stack([1.0 - second - third, second, third], axis=1)
    share[flat] = -1.0
    return share


def _triangles(mesh: Mesh, step: Floats) -> tuple[Floats, csr_array, Integers]:
    """Return subdivision points of the upper faces, their interpolation matrix from the nodes, and
    the triangles between them.

    The points have shape (points, 3) [m], the matrix (points, nodes), and the triangles, as point
    numbers, (triangles, 3).
    """
    from scipy.sparse import csr_array, vstack

    from vibroimpact.structures.surface import facing

    points, motions, triangles, start = [], [], [], 0
    for group in facing(mesh, "upper"):
        corner = mesh.nodes[group.connectivity[:, list(group.corners)], :2]
        size = np.ptp(corner, axis=1) / step
        # faces with the same number of subdivisions share one lattice of reference points
        for fine in np.unique(cuts := np.maximum(1, np.ceil(_FINE * size.max(axis=1))).astype(int)):
            nodes = group.connectivity[cuts == fine]
            local, pattern = _lattice(len(group.corners), int(fine))
            weights = group.shape_functions(local)[0]
            at = np.einsum("qk,eki->eqi", weights, mesh.nodes[nodes]).reshape(-1, 3)
            rows = np.repeat(np.arange(len(at)), weights.shape[1])
            columns = np.repeat(nodes, len(local), axis=0).ravel()
            values = np.tile(weights.ravel(), len(nodes))
            points.append(at)
            motions.append(csr_array((values, (rows, columns)), shape=(len(at), len(mesh.nodes))))
            triangles.append(
                (pattern[None] + len(local) * np.arange(len(nodes))[:, None, None]).reshape(-1, 3)
                + start
            )
            start += len(at)
    return np.concatenate(points), csr_array(vstack(motions)), np.concatenate(triangles)


def _lattice(corners: int, fine: int) -> tuple[Floats, Integers]:
    """Return lattice points on a reference face, `fine` steps along each side, and the
    triangles between them as point numbers.
    """
    a, b = (
        side.ravel()
        for side in np.meshgrid(np.arange(fine + 1), np.arange(fine + 1), indexing="ij")
    )
    if corners == 3:
        a, b = a[a + b <= fine], b[a + b <= fine]
    number = np.full((fine + 2, fine + 2), -1)
    number[a, b] = np.arange(len(a))
    lower = np.stack([number[a, b], number[a + 1, b], number[a, b + 1]], axis=1)
    upper = np.stack([number[a + 1, b], number[a + 1, b + 1], number[a, b + 1]], axis=1)
    triangles = np.concatenate([lower, upper])
    return np.stack([a, b], axis=1) / fine, triangles[(triangles >= 0).all(axis=1)]
