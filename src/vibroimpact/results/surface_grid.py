"""Interpolation of nodal values of a mesh onto a regular grid over its upper side."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Bools, Floats, Integers
from vibroimpact.structures.finite_elements.mesh import Mesh

if TYPE_CHECKING:
    from scipy.sparse import csr_array

_Values = TypeVar("_Values", bound=NDArray[np.floating[Any]])

POINTS = 3000
"""Approximate number of grid points by default."""

# number of grid points along one side
_FEWEST = 11
_MOST = 241
# tolerance of barycentric coordinates and grid steps: a point on the edge of a triangle counts as
# inside it
_EDGE = 1e-6
# subdivisions of a face per grid step: the triangles between the subdivision points are flat
_SUBDIVISIONS_PER_STEP = 3
# area of a triangle below which it is degenerate, in squares of the grid step
_NO_AREA = 1e-9


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
        """Return nodal values (..., nodes) at the grid points, (..., rows, columns).

        The values at points outside the body are NaN.
        """
        flat = values.reshape(-1, values.shape[-1])
        at_points = np.asarray((self.weights @ flat.T).T).reshape(-1, *self.on_body.shape)
        at_points[:, ~self.on_body] = np.nan
        return np.asarray(at_points.reshape(*values.shape[:-1], *self.on_body.shape))


def surface_grid(mesh: Mesh, points: int = POINTS) -> SurfaceGrid:
    """Return a regular grid over the upper side of a mesh.

    One of its points is the middle of the bounding box. The faces of that side are subdivided into
    triangles smaller than the grid steps, and each grid point is interpolated in the uppermost
    triangle that contains it. This avoids the inverse mapping to element coordinates, and the mesh
    may have any outline and holes.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    points : int
        Approximate number of grid points.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.lattice import box_mesh
    >>> grid = surface_grid(box_mesh((1.0, 1.0, 0.1), (3, 3, 1)))
    >>> grid.on_body.shape, bool(grid.on_body.all())
    ((55, 55), True)
    """
    from scipy.sparse import csr_array

    low = mesh.nodes.min(axis=0)[:2]
    high = mesh.nodes.max(axis=0)[:2]
    span = high - low
    # steps as equal as possible along x and y; odd numbers, for a point in the middle
    sides = np.sqrt(points * span / span[::-1])
    columns, rows = (2 * int(np.clip(side, _FEWEST, _MOST) / 2) + 1 for side in sides)
    x = np.linspace(low[0], high[0], columns)
    y = np.linspace(low[1], high[1], rows)
    step = np.array([x[1] - x[0], y[1] - y[0]])

    vertices, from_nodes, triangles = _surface_triangles(mesh, step)
    grid_position = (vertices[:, :2] - low) / step
    height, corners, shares = _uppermost(vertices, grid_position, triangles, (rows, columns))
    point_numbers = np.repeat(np.arange(len(height)), 3)
    from_vertices = csr_array(
        (shares.ravel(), (point_numbers, corners.ravel())), shape=(len(height), len(vertices))
    )
    on_body = np.isfinite(height).reshape(rows, columns)
    return SurfaceGrid(x, y, csr_array(from_vertices @ from_nodes), on_body)


def beyond_edge(values: _Values, steps: int = 2) -> _Values:
    """Return values on a grid that are continued outside of the body, where they are NaN.

    A picture cuts them along the outline, which lies between grid points.

    Parameters
    ----------
    values : array, shape (..., rows, columns)
        The values.
    steps : int, default 2
        Number of grid steps by which they are continued, by the mean of their neighbours.

    Examples
    --------
    >>> beyond_edge(np.array([[1.0, 3.0, np.nan, np.nan, np.nan]])).tolist()
    [[1.0, 3.0, 3.0, 3.0, nan]]
    """
    rows, columns = values.shape[-2:]
    continued = values.copy()
    for _ in range(steps):
        padding = [(0, 0)] * (values.ndim - 2) + [(1, 1), (1, 1)]
        around = np.pad(continued, padding, constant_values=np.nan)
        is_known = np.isfinite(around)
        total = np.zeros_like(continued)
        count = np.zeros(continued.shape, dtype=int)
        for row in range(3):
            for column in range(3):
                window = (..., slice(row, row + rows), slice(column, column + columns))
                total += np.where(is_known[window], around[window], 0.0)
                count += is_known[window]
        outside = np.isnan(continued) & (count > 0)
        continued[outside] = total[outside] / count[outside]
    return continued


def _uppermost(
    vertices: Floats, grid_position: Floats, triangles: Integers, shape: tuple[int, int]
) -> tuple[Floats, Integers, Floats]:
    """Return in which triangle each grid point is interpolated: the uppermost one that contains it.

    Parameters
    ----------
    vertices : array, shape (vertices, 3)
        Corners of the triangles [m].
    grid_position : array, shape (vertices, 2)
        Their x and y in grid steps from the first grid point.
    triangles : array, shape (triangles, 3)
        Triangles as numbers of vertices.
    shape : tuple of two ints
        Rows and columns of the grid.

    Returns
    -------
    height : array, shape (rows * columns,)
        Height of the surface [m]; minus infinity at points outside the body.
    corners : array, shape (rows * columns, 3)
        Numbers of the three vertices around each point.
    shares : array, shape (rows * columns, 3)
        Barycentric coordinates of each point in them.
    """
    rows, columns = shape
    highest = np.full(columns * rows, -np.inf)
    corners = np.zeros((len(highest), 3), dtype=np.int64)
    shares = np.zeros((len(highest), 3))
    # the grid points in the bounding rectangle of each triangle, as (column, row)
    first = np.ceil(grid_position[triangles].min(axis=1) - _EDGE).astype(int)
    last = np.floor(grid_position[triangles].max(axis=1) + _EDGE).astype(int)
    last_on_grid = np.minimum(last, (columns - 1, rows - 1))
    # small triangles cover few grid points: a loop over these offsets tests all triangles at once
    reach = (last - first).max(axis=0, initial=-1) + 1
    for column in range(reach[0]):
        for row in range(reach[1]):
            point = first + np.array([column, row])
            in_rectangle = (point <= last_on_grid).all(axis=1) & (point >= 0).all(axis=1)
            tested = np.flatnonzero(in_rectangle)
            share = _barycentric(grid_position[triangles[tested]], point[tested])
            inside = share.min(axis=1) >= -_EDGE
            containing = tested[inside]
            share = share[inside]
            height = np.einsum("tk,tk->t", share, vertices[triangles[containing], 2])
            # of triangles at the same grid point the uppermost is assigned last
            order = np.argsort(height, kind="stable")
            containing = containing[order]
            share = share[order]
            height = height[order]
            index = point[containing, 1] * columns + point[containing, 0]
            higher = height > highest[index]
            index = index[higher]
            highest[index] = height[higher]
            corners[index] = triangles[containing[higher]]
            shares[index] = share[higher]
    return highest, corners, shares


def _barycentric(corners: Floats, point: Integers) -> Floats:
    """Return the barycentric coordinates of points in triangles, (triangles, 3).

    They are -1 for triangles of zero area. Corners (triangles, 3, 2) and points (triangles, 2) are
    in grid steps.
    """
    # Cramer's rule for: point = corner 0 + second * a + third * b
    a = corners[:, 1] - corners[:, 0]
    b = corners[:, 2] - corners[:, 0]
    offset = point - corners[:, 0]
    determinant = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]  # twice the area
    degenerate = np.abs(determinant) < _NO_AREA
    determinant = np.where(degenerate, 1.0, determinant)
    second = (offset[:, 0] * b[:, 1] - offset[:, 1] * b[:, 0]) / determinant
    third = (a[:, 0] * offset[:, 1] - a[:, 1] * offset[:, 0]) / determinant
    share = np.stack([1.0 - second - third, second, third], axis=1)
    share[degenerate] = -1.0
    return share


def _surface_triangles(mesh: Mesh, step: Floats) -> tuple[Floats, csr_array, Integers]:
    """Return the upper faces as flat triangles, smaller than the steps of a grid (2,) [m].

    Returns
    -------
    vertices : array, shape (vertices, 3)
        Subdivision points of the faces [m].
    from_nodes : sparse array, shape (vertices, nodes)
        Interpolation of nodal values to the vertices.
    triangles : array, shape (triangles, 3)
        Triangles as numbers of vertices.
    """
    from scipy.sparse import csr_array, vstack

    from vibroimpact.structures.finite_elements.surface import facing

    vertices = []
    interpolations = []
    triangles = []
    vertex_count = 0
    for group in facing(mesh, "upper"):
        corners = mesh.nodes[group.connectivity[:, list(group.corners)], :2]
        size = np.ptp(corners, axis=1) / step  # in grid steps
        subdivisions = np.maximum(1, np.ceil(_SUBDIVISIONS_PER_STEP * size.max(axis=1))).astype(int)
        # faces with the same number of subdivisions share one lattice of reference points
        for fineness in np.unique(subdivisions):
            faces = group.connectivity[subdivisions == fineness]
            reference_points, reference_triangles = _lattice(len(group.corners), int(fineness))
            weights = group.shape_functions(reference_points)[0]
            face_vertices = np.einsum("qk,eki->eqi", weights, mesh.nodes[faces]).reshape(-1, 3)
            vertices.append(face_vertices)

            rows = np.repeat(np.arange(len(face_vertices)), weights.shape[1])
            columns = np.repeat(faces, len(reference_points), axis=0).ravel()
            entries = np.tile(weights.ravel(), len(faces))
            shape = (len(face_vertices), len(mesh.nodes))
            interpolations.append(csr_array((entries, (rows, columns)), shape=shape))

            # each face has its own copy of the reference points
            offsets = len(reference_points) * np.arange(len(faces))[:, None, None]
            face_triangles = (reference_triangles[None] + offsets).reshape(-1, 3)
            triangles.append(face_triangles + vertex_count)
            vertex_count += len(face_vertices)
    return np.concatenate(vertices), csr_array(vstack(interpolations)), np.concatenate(triangles)


def _lattice(corners: int, fineness: int) -> tuple[Floats, Integers]:
    """Return lattice points on a reference face, and the triangles between them.

    The lattice has `fineness` steps along each side of a face of three or four corners; the
    triangles are numbers of points.
    """
    first_index, second_index = np.meshgrid(
        np.arange(fineness + 1), np.arange(fineness + 1), indexing="ij"
    )
    a = first_index.ravel()
    b = second_index.ravel()
    if corners == 3:
        in_triangle = a + b <= fineness
        a = a[in_triangle]
        b = b[in_triangle]
    # beyond the face the number is -1: triangles with such a corner are left out
    number = np.full((fineness + 2, fineness + 2), -1)
    number[a, b] = np.arange(len(a))
    lower = np.stack([number[a, b], number[a + 1, b], number[a, b + 1]], axis=1)
    upper = np.stack([number[a + 1, b], number[a + 1, b + 1], number[a, b + 1]], axis=1)
    triangles = np.concatenate([lower, upper])
    return np.stack([a, b], axis=1) / fineness, triangles[(triangles >= 0).all(axis=1)]
