"""Parts of a mesh that share no node and are not joined, and the one of them at a place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy.sparse import coo_array

from vibroimpact.arrays import Bools, Integers
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh
from vibroimpact.structures.finite_elements.stated_materials import StatedMaterials
from vibroimpact.structures.finite_elements.surface import Side, Spot, place_of, surface_motion

_MOST_NAMED = 3  # parts in a remark


def part_of_nodes(mesh: Mesh) -> Integers:
    """Return a number for each node, equal for nodes that elements or joints connect."""
    # imported late: modes that are stored do not need it
    from scipy.sparse.csgraph import connected_components

    starts = []
    ends = []
    for block in mesh.blocks:  # connect the first node of each element with the others
        other_nodes = block.connectivity[:, 1:]
        starts.append(np.repeat(block.connectivity[:, 0], other_nodes.shape[1]))
        ends.append(other_nodes.ravel())
    if mesh.joints is not None:
        followers, movers = mesh.joints.pairs
        starts.append(followers)
        ends.append(movers)
    start = np.concatenate(starts)
    end = np.concatenate(ends)
    number_of_nodes = len(mesh.nodes)
    graph = coo_array((np.ones(len(start)), (start, end)), shape=(number_of_nodes, number_of_nodes))
    labels = connected_components(graph, directed=False)[1]
    return np.asarray(labels, dtype=np.int64)


def used_nodes(mesh: Mesh) -> Integers:
    """Return the nodes that elements have, in ascending order."""
    return np.unique(np.concatenate([block.connectivity.ravel() for block in mesh.blocks]))


def number_of_parts(mesh: Mesh) -> int:
    """Return the number of parts of a mesh that share no node and are not joined.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.lattice import box_mesh
    >>> number_of_parts(box_mesh((1.0, 1.0, 1.0), (2, 2, 2)))
    1
    """
    return len(np.unique(part_of_nodes(mesh)[used_nodes(mesh)]))


def part_at(mesh: Mesh, spot: Spot, side: Side) -> Mesh:
    """Return the part of a mesh that is outermost at a spot on one side.

    It has a remark on the parts that are left out.

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
    touched_part = labels[_touched_node(mesh, np.isin(labels, parts), spot, side)]
    chosen = labels == touched_part
    others = [extent_text(mesh, labels == part) for part in parts if part != touched_part]
    more = ""
    if len(others) > _MOST_NAMED:
        more = f" and {len(others) - _MOST_NAMED} more"
    remark = (
        f"the mesh file holds {len(parts)} parts that share no node and are not joined; "
        "the body is the one at the contact point, "
        f"{extent_text(mesh, chosen)}, and {', '.join(others[:_MOST_NAMED])}{more} are left out: "
        "to join parts, tie them in the file (*TIE, RBE2) or merge their coincident nodes"
    )
    part = _with_nodes(mesh, chosen)
    return replace(part, remarks=(*part.remarks, remark))


def _touched_node(mesh: Mesh, is_used: Bools, spot: Spot, side: Side) -> int:
    """Return a node near a spot on one side, of those that elements have."""
    if spot is None:  # of a curved surface, the highest or lowest node may be beside the faces
        height = np.where(is_used, mesh.nodes[:, 2], np.nan)
        outermost = np.nanargmax if side == "upper" else np.nanargmin
        return int(outermost(height))
    motion, _ = surface_motion(mesh, np.array([place_of(mesh, spot, side)]), side)
    vertical = motion[[2]]
    return int(vertical.indices[np.abs(vertical.data).argmax()]) // mesh.dofs_per_node


def extent_text(mesh: Mesh, chosen: Bools) -> str:
    """Return in words where chosen nodes are."""
    positions = mesh.nodes[chosen]
    rounding = 1e-9 * np.abs(positions).max(initial=0.0)
    ends = np.stack([positions.min(axis=0), positions.max(axis=0)])
    low, high = np.where(np.abs(ends) > rounding, ends, 0.0)
    ranges = [
        f"{axis} {first:.4g} to {last:.4g}"
        for axis, first, last in zip("xyz", low, high, strict=True)
    ]
    return f"{', '.join(ranges)} m"


def _with_nodes(mesh: Mesh, chosen: Bools) -> Mesh:
    """Return the elements of a mesh whose nodes are chosen, with their sets and materials."""
    new_node = np.cumsum(chosen) - 1  # number of each chosen node
    blocks = []
    chosen_elements = []
    for block in mesh.blocks:
        is_chosen = chosen[block.connectivity[:, 0]]
        chosen_elements.append(is_chosen)
        if is_chosen.any():
            blocks.append(ElementBlock(block.kind, new_node[block.connectivity[is_chosen]]))
    element_is_chosen = np.concatenate(chosen_elements)
    new_element = np.cumsum(element_is_chosen) - 1
    element_materials = mesh.element_materials
    if mesh.materials:
        element_materials = element_materials[element_is_chosen]
    joints = mesh.joints
    if joints is not None:
        joints = joints.of_nodes(chosen)
    return replace(
        mesh,
        nodes=mesh.nodes[chosen],
        blocks=tuple(blocks),
        node_sets=_renumbered_sets(mesh.node_sets, chosen, new_node),
        element_sets=_renumbered_sets(mesh.element_sets, element_is_chosen, new_element),
        element_materials=element_materials,
        stated=_stated_for(mesh.stated, element_is_chosen),
        joints=joints,
    )


def _renumbered_sets(
    sets: Mapping[str, Integers], is_chosen: Bools, new_number: Integers
) -> dict[str, Integers]:
    """Return named sets of those members that are chosen, renumbered, without empty sets."""
    return {
        name: new_number[members[is_chosen[members]]]
        for name, members in sets.items()
        if is_chosen[members].any()
    }


def _stated_for(stated: StatedMaterials | None, is_chosen: Bools) -> StatedMaterials | None:
    """Return the stated materials of chosen elements; None if there are none."""
    if stated is None:
        return None
    used, of_elements = np.unique(stated.of_elements[is_chosen], return_inverse=True)
    has_elements_without = int(used[0] < 0)  # -1 stands for no material
    materials = tuple(stated.materials[number] for number in used[has_elements_without:])
    if not materials:
        return None
    return StatedMaterials(materials, of_elements - has_elements_without)
