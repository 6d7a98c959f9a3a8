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
from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh

_SAME = 1e-7  # of the largest extent: distance within which points coincide
# the 27 nodes of a brick as points of the lattice, counted from its first corner
_BRICK = np.rint(2.0 * ELEMENT_KINDS["hex27"].reference).astype(np.int64)


def _tetrahedra(order: int) -> Integers:
    """Return the six tetrahedra around a diagonal of a brick, as indices into its 27 nodes."""
    kind = "tet4" if order == 1 else "tet10"
    reference = ELEMENT_KINDS[kind].reference
    steps = 2.0 * np.eye(3)  # along the edges of the brick
    tetrahedra = []
    # each path along three edges, from the first corner to the opposite one, is one tetrahedron
    for path in permutations(range(3)):
        corners = np.cumsum(steps[list(path)], axis=0)  # after the first one, which is zero
        if np.linalg.det(corners) < 0.0:  # for a positive volume
            corners = corners[[1, 0, 2]]
        tetrahedra.append(_brick_nodes_at(reference @ corners))
    return np.array(tetrahedra)


def _brick_nodes_at(points: Floats) -> list[int]:
    """Return the indices of the nodes of a brick that lie at points of its lattice, (n, 3)."""
    index = {tuple(node): number for number, node in enumerate(_BRICK.tolist())}
    return [index[tuple(int(step) for step in point)] for point in np.rint(points)]


def _wedges(order: int) -> Integers:
    """Return the two wedges beside a diagonal plane of a brick, as indices into its 27 nodes."""
    kind = "wedge6" if order == 1 else "wedge15"
    reference = ELEMENT_KINDS[kind].reference
    # images of the three reference directions; the wedges share their first corner
    halves = (
        np.array([[2, 0, 0], [2, 2, 0], [0, 0, 2]]),
        np.array([[2, 2, 0], [0, 2, 0], [0, 0, 2]]),
    )
    return np.array([_brick_nodes_at(reference @ half) for half in halves])


# the elements that a brick is divided into, as indices into its 27 nodes
_ELEMENTS_OF_BRICK = {
    "hex8": np.arange(8)[None],
    "hex20": np.arange(20)[None],
    "hex27": np.arange(27)[None],
    "tet4": _tetrahedra(1),
    "tet10": _tetrahedra(2),
    "wedge6": _wedges(1),
    "wedge15": _wedges(2),
}
SOLID_KINDS = ("hex8", "hex20", "hex27", "tet4", "tet10")
"""Kinds of solid elements of which a case may ask for a mesh.

A block can be meshed with wedges too.
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
    bricks = []  # the 27 points of each brick, by block
    points = []
    number_of_points = 0  # of the blocks so far
    for block in blocks:
        lattice = _right_handed(block)
        size = lattice[..., 0].size
        block_numbers = np.arange(number_of_points, number_of_points + size)
        point_numbers = block_numbers.reshape(lattice.shape[:3])
        # every second point along each direction is the first corner of a brick
        first_corners = point_numbers[:-1:2, :-1:2, :-1:2].ravel()
        strides = np.array([lattice.shape[1] * lattice.shape[2], lattice.shape[2], 1])
        bricks.append(first_corners[:, None] + _BRICK @ strides)
        points.append(lattice.reshape(-1, 3))
        number_of_points += size
    elements = _ELEMENTS_OF_BRICK[kind]
    connectivity = np.concatenate(bricks)[:, elements].reshape(-1, elements.shape[1])
    nodes, connectivity = merged(np.concatenate(points), connectivity)
    return Mesh(nodes, (ElementBlock(kind, connectivity),))


def merged(points: Floats, connectivity: Integers) -> tuple[Floats, Integers]:
    """Return nodes and connectivity after merging coincident points and removing unused ones."""
    # imported late: modes that are stored do not need it
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    used, connectivity = np.unique(connectivity, return_inverse=True)
    points = points[used]
    tolerance = _SAME * float(np.ptp(points, axis=0).max())
    coincident_pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    # points that coincide, also by way of others, are one component of the graph of the pairs
    graph = coo_array(
        (np.ones(len(coincident_pairs)), (coincident_pairs[:, 0], coincident_pairs[:, 1])),
        shape=(len(points), len(points)),
    )
    node_of_point = connected_components(graph, directed=False)[1].astype(np.int64)
    _, first_points = np.unique(node_of_point, return_index=True)
    return points[first_points], node_of_point[connectivity]


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
    edges = []  # from the middle point to the next one along each direction
    for axis in range(3):
        neighbour = np.array(middle)
        neighbour[axis] += 1
        edges.append(block[tuple(neighbour)] - block[middle])
    is_right_handed = np.linalg.det(np.array(edges)) > 0.0
    if is_right_handed:
        return block
    return block.transpose(1, 0, 2, 3)
