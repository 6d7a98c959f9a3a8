"""Boxes of pyramids, six to a brick, whose apexes meet in its middle; and meshes in one:
for tests of elements and of mesh files.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS
from vibroimpact.structures.finite_elements.lattice import box_mesh, merged
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh

PYRAMIDS = ("pyramid5", "pyramid13", "pyramid14")


def pyramids_of(bricks: Mesh, kind: str) -> Mesh:
    """Bricks of 27 nodes divided into pyramids; nodes of edges to the apex are halfway."""
    brick, own = ELEMENT_KINDS["hex27"], ELEMENT_KINDS[kind]
    points, connectivity = [], []
    for members in bricks.blocks[0].connectivity:
        for face in brick.faces:
            # the face as seen from inside
            corners = np.concatenate([brick.reference[list(face)][::-1], brick.reference[[26]]])
            weights = ELEMENT_KINDS["pyramid5"].basis(own.reference)[0]
            values = brick.basis(weights @ corners)[0]
            connectivity.append(np.arange(len(own.reference)) + sum(map(len, points)))
            points.append(values @ bricks.nodes[members])
    nodes, merged_connectivity = merged(np.concatenate(points), np.array(connectivity))
    return Mesh(nodes, (ElementBlock(kind, merged_connectivity),))


def pyramid_box(size: Sequence[float], counts: Sequence[int], kind: str) -> Mesh:
    """A box as `box_mesh` makes it, of pyramids."""
    return pyramids_of(box_mesh(size, counts, "hex27"), kind)


def together(*meshes: Mesh) -> Mesh:
    """Meshes in one, which share no node, with sets of each."""
    starts = np.cumsum([0, *(len(mesh.nodes) for mesh in meshes)])
    counts = np.cumsum([0, *(mesh.number_of_elements for mesh in meshes)])
    blocks = [
        replace(block, connectivity=block.connectivity + start)
        for mesh, start in zip(meshes, starts, strict=False)
        for block in mesh.blocks
    ]
    return Mesh(
        np.concatenate([mesh.nodes for mesh in meshes]),
        (ElementBlock(blocks[0].kind, np.concatenate([block.connectivity for block in blocks])),),
        {
            f"nodes{index}": np.arange(starts[index], starts[index + 1])
            for index in range(len(meshes))
        },
        {
            f"part{index}": np.arange(counts[index], counts[index + 1])
            for index in range(len(meshes))
        },
    )
