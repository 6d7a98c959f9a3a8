"""Parts of a mesh that share no node and are not joined, and the one of them at a place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import coo_array

from vibroimpact.arrays import Bools, Integers
from vibroimpact.structures.mesh import ElementBlock, Mesh
from vibroimpact.structures.stated_materials import StatedMaterials
from vibroimpact.structures.surface import Side, Spot, place_of, surface_motion

_MOST_NAMED = 3


def part_of_nodes(mesh: Mesh) -> Integers:
    """Return a number for each node, equal for nodes that elements or joints connect."""
    # imported late: modes that are stored do not need it
    from scipy.sparse.csgraph import connected_components

    pairs = [
        (
            np.repeat(block.connectivity[:, 0], block.connectivity.shape[1] - 1),
            block.connectivity[:, 1:].ravel(),
        )
        for block in mesh.blocks
    ]
    if mesh.joints is not None:
        pairs.append(mesh.joints.pairs)
    start, end = (np.concatenate(side) for side in zip(*pairs, strict=True))
    number = len(mesh.nodes)
    found = connected_components(
        coo_array((np.ones(len(start)), (start, end)), shape=(number, number)), directed=False
    )[1]
    return np.asarray(found, dtype=np.int64)


def used_nodes(mesh: Mesh) -> Integers:
    """Return the nodes that elements have, in ascending order."""
    return np.unique(np.concatenate([block.connectivity.ravel() for block in mesh.blocks]))


def number_of_parts(mesh: Mesh) -> int:
    """Return the number of parts of a mesh that share no node and are not joined.

    Examples
    --------
    >>> from vibroimpact.structures.lattice import box_mesh
    >>> number_of_parts(box_mesh((1.0, 1.0, 1.0), (2, 2, 2)))
    1
    """
    return len(np.unique(part_of_nodes(mesh)[used_nodes(mesh)]))


def part_at(mesh: Mesh, spot: Spot, side: Side) -> Mesh:
    """Return the part of a mesh at a spot on one side, outermost there; with a remark on the parts
    that are left out.

    Parameters
    ----------
    mesh : Mesh
        A mesh of one or several parts that share no node and are not joined.
    spot : tuple of two floats, str or None
        x and y [m], the name of a set, or None for the highest or lowest node.
    side : str
        "upper" or "lower".

    Raises
    ------
    InputError
        If the spot is not on the body, or the mesh has no set of that name.
    """
    labels = part_of_nodes(mesh)
    parts = np.unique(labels[used_nodes(mesh)])
    if len(parts) == 1:
        return mesh
    if spot is None:  # of a curved surface, the highest or lowest node may be beside the faces
        height = np.where(np.isin(labels, parts), mesh.nodes[:, 2], np.nan)
        touched = int(np.nanargmax(height) if side == "upper" else np.nanargmin(height))
    else:
        motion = surface_motion(mesh, np.array([place_of(mesh, spot, side)]), side)[0][[2]]
        touched = int(motion.indices[np.abs(motion.data).argmax()]) // mesh.dofs_per_node
    chosen = labels == labels[touched]
    others = [extent_text(mesh, labels == part) for part in parts if part != labels[touched]]
    more = f" and {len(others) - _MOST_NAMED} more" if len(others) > _MOST_NAMED else ""
    remark = (
        f"the mesh file holds {len(parts)} parts that share no node and are not joined; "
        "the body is the one at the contact point, "
        f"{extent_text(mesh, chosen)}, and {', '.join(others[:_MOST_NAMED])}{more} are left out: "
        "to join parts, tie them in the file (*TIE, RBE2) or merge their coincident nodes"
    )
    found = _with_nodes(mesh, chosen)
    return replace(found, remarks=(*found.remarks, remark))


def extent_text(mesh: Mesh, chosen: Bools) -> str:
    """Return in words where chosen nodes are."""
    at = mesh.nodes[chosen]
    rounding = 1e-9 * np.abs(at).max(initial=0.0)
    low, high = (
        np.where(np.abs(end) > rounding, end, 0.0) for end in (at.min(axis=0), at.max(axis=0))
    )
    axes = (
        f"{name} {first:.4g} to {last:.4g}"
        for name, first, last in zip("xyz", low, high, strict=True)
    )
    return f"{', '.join(axes)} m"


def _with_nodes(mesh: Mesh, chosen: Bools) -> Mesh:
    """Return the elements of a mesh whose nodes are chosen, with the sets and materials
    that concern them.
    """
    places = np.cumsum(chosen) - 1
    blocks, kept = [], []
    for block in mesh.blocks:
        inside = chosen[block.connectivity[:, 0]]
        kept.append(inside)
        if inside.any():
            blocks.append(ElementBlock(block.kind, places[block.connectivity[inside]]))
    elements = np.concatenate(kept)
    numbers = np.cumsum(elements) - 1
    node_sets = {
        name: places[nodes[chosen[nodes]]]
        for name, nodes in mesh.node_sets.items()
        if chosen[nodes].any()
    }
    element_sets = {
        name: numbers[of[elements[of]]]
        for name, of in mesh.element_sets.items()
        if elements[of].any()
    }
    stated = mesh.stated
    if stated is not None:
        used, of_elements = np.unique(stated.of_elements[elements], return_inverse=True)
        without = int(used[0] < 0)
        materials_left = tuple(stated.materials[index] for index in used[without:])
        stated = StatedMaterials(materials_left, of_elements - without) if materials_left else None
    materials = mesh.element_materials[elements] if mesh.materials else mesh.element_materials
    return replace(
        mesh,
        nodes=mesh.nodes[chosen],
        blocks=tuple(blocks),
        node_sets=node_sets,
        element_sets=element_sets,
        element_materials=materials,
        stated=stated,
        joints=None if mesh.joints is None else mesh.joints.of_nodes(chosen),
    )
