"""Structured meshes of solid elements from blocks, each a lattice of points in three directions.

Three by three by three points make one brick of 27 nodes; elements of the other kinds use some of
them. Neighbouring blocks must have the same points on their common face, and their directions must
ascend alike along it, so that the tetrahedra of both sides divide it along the same diagonal.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations

import numpy as np
from scipy.sparse import coo_array

from vibroimpact.arrays import Floats, Integers
from vibroimpact.structures.element_kinds import ELEMENT_KINDS
from vibroimpact.structures.mesh import ElementBlock, Mesh

_SAME = 1e-7  # of the largest extent: distance within which points coincide
_BRICK = np.rint(2.0 * ELEMENT_KINDS["hex27"].reference).astype(np.int64)


def _tetrahedra(order: int) -> Integers:
    """Return the six tetrahedra of a brick that share its diagonal, as indices into its
    27 nodes.
    """
    index = {tuple(corner): number for number, corner in enumerate(_BRICK.tolist())}
    found = []
    for path in permutations(range(3)):
        corners = [np.zeros(3, dtype=np.int64)]
        for axis in path:
            corners.append(corners[-1] + 2 * np.eye(3, dtype=np.int64)[axis])
        if np.linalg.det(np.array(corners[1:]) - corners[0]) < 0.0:
            corners[1], corners[2] = corners[2], corners[1]
        reference = ELEMENT_KINDS["tet4" if order == 1 else "tet10"].reference
        at = corners[0] + reference @ (np.array(corners[1:]) - corners[0])
        found.append([index[tuple(int(value) for value in point)] for point in np.rint(at)])
    return np.array(found)


def _wedges(order: int) -> Integers:
    """Return the two wedges of a brick on either side of a diagonal plane, as indices
    into its 27 nodes.
    """
    index = {tuple(corner): number for number, corner in enumerate(_BRICK.tolist())}
    reference = ELEMENT_KINDS["wedge6" if order == 1 else "wedge15"].reference
    halves = (
        np.array([[2, 0, 0], [2, 2, 0], [0, 0, 2]]),
        np.array([[2, 2, 0], [0, 2, 0], [0, 0, 2]]),
    )
    return np.array(
        [
            [index[tuple(int(value) for value in point)] for point in np.rint(reference @ half)]
            for half in halves
        ]
    )


_TAKEN = {
    "hex8": np.arange(8)[None],
    "hex20": np.arange(20)[None],
    "hex27": np.arange(27)[None],
    "tet4": _tetrahedra(1),
    "tet10": _tetrahedra(2),
    "wedge6": _wedges(1),
    "wedge15": _wedges(2),
}
SOLID_KINDS = ("hex8", "hex20", "hex27", "tet4", "tet10")
"""Kinds of solid elements of which a case may ask for a mesh; a block can be meshed with
wedges too.
"""


def mesh_of_blocks(blocks: Sequence[Floats], kind: str) -> Mesh:
    """Return a mesh of solid elements from blocks.

    Parameters
    ----------
    blocks : sequence of arrays, shape (2 a + 1, 2 b + 1, 2 c + 1, 3)
        Points [m] of each block of a x b x c bricks.
    kind : str
        "hex8", "hex20", "hex27", "tet4", "tet10", "wedge6" or "wedge15".

    Returns
    -------
    Mesh
        Mesh in which coincident points are one node.

    Examples
    --------
    >>> x, y, z = np.meshgrid(*[np.linspace(0.0, 1.0, 3)] * 3, indexing="ij")
    >>> mesh_of_blocks([np.stack([x, y, z], axis=-1)], "tet10").number_of_elements
    6
    """
    bricks, points, start = [], [], 0
    for block in blocks:
        lattice = _right_handed(block)
        number = np.arange(start, start + lattice[..., 0].size).reshape(lattice.shape[:3])
        first = number[:-1:2, :-1:2, :-1:2].ravel()
        strides = np.array([lattice.shape[1] * lattice.shape[2], lattice.shape[2], 1])
        bricks.append(first[:, None] + _BRICK @ strides)
        points.append(lattice.reshape(-1, 3))
        start += lattice[..., 0].size
    connectivity = np.concatenate(bricks)[:, _TAKEN[kind]].reshape(-1, _TAKEN[kind].shape[1])
    nodes, connectivity = merged(np.concatenate(points), connectivity)
    return Mesh(nodes, (ElementBlock(kind, connectivity),))


def merged(points: Floats, connectivity: Integers) -> tuple[Floats, Integers]:
    """Return nodes and connectivity after merging coincident points and removing unused ones."""
    # imported late: modes that are stored do not need it
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    used, connectivity = np.unique(connectivity, return_inverse=True)
    points = points[used]
    near = cKDTree(points).query_pairs(
        _SAME * float(np.ptp(points, axis=0).max()), output_type="ndarray"
    )
    graph = coo_array(
        (np.ones(len(near)), (near[:, 0], near[:, 1])), shape=(len(points), len(points))
    )
    same = connected_components(graph, directed=False)[1].astype(np.int64)
    _, first = np.unique(same, return_index=True)
    return points[first], same[connectivity]


def box_mesh(size: Sequence[float], counts: Sequence[int], kind: str = "hex20") -> Mesh:
    """Return a mesh of a box, centred at the origin.

    Parameters
    ----------
    size : sequence of three floats
        Length, width and height [m].
    counts : sequence of three ints
        Number of bricks along each direction.
    kind : str, default "hex20"
        Kind of element.

    Examples
    --------
    >>> box_mesh((0.52, 0.42, 0.008), (60, 48, 1)).nodes.shape
    (20703, 3)
    """
    axes = [
        np.linspace(-0.5 * length, 0.5 * length, 2 * count + 1)
        for length, count in zip(size, counts, strict=True)
    ]
    return mesh_of_blocks([np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)], kind)


def _right_handed(block: Floats) -> Floats:
    """Return the block, with its first two directions exchanged if needed for positive volumes."""
    middle = tuple(size // 4 * 2 for size in block.shape[:3])
    at = block[middle]
    sides = []
    for axis in range(3):
        step = np.array(middle)
        step[axis] += 1
        sides.append(block[tuple(step)] - at)
    return block if np.linalg.det(np.array(sides)) > 0.0 else block.transpose(1, 0, 2, 3)
