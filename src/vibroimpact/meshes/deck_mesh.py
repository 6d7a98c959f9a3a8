"""A mesh prepared for Nastran and Abaqus input decks.

Its element shapes are those that both support, numbered from 1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.element_kinds import PLATE_ORDER
from vibroimpact.structures.finite_elements.joints import AXES
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh

# local node order of a 9-node quadrilateral on a 3 x 3 lattice, as (row, column): corners, mid-edge
# nodes, centre
_SQUARE = np.array([(0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0), (1, 1)])


@dataclass(frozen=True)
class DeckMesh:
    """Nodes in use, and element shapes with connectivity, numbered from 1.

    The shape is the element kind of the block, except for "hex20" in place of hex27, "pyramid13" in
    place of pyramid14, and "quad8" in place of quad25. `materials` are those of the elements, by
    number, and of the body if some elements have none of their own: number -1. `equations` are the
    joints: node, axis from 1 and coefficient of each term, the first of which is the displacement
    that follows.
    """

    points: Floats
    blocks: list[tuple[str, Integers]]
    node_sets: Mapping[str, Integers]
    element_sets: Mapping[str, Integers]
    materials: Mapping[int, Material]
    element_materials: Integers
    equations: list[list[tuple[int, int, float]]]


def deck_mesh(mesh: Mesh, material: Material | None = None) -> DeckMesh:
    """Return a mesh with the element shapes of the decks.

    Nodes that no shape uses are dropped, also from the sets.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    material : Material, optional
        Material of the elements that have none of their own.

    Raises
    ------
    InputError
        If the mesh has no elements, or a material is rigid.
    """
    if mesh.number_of_elements == 0:
        raise InputError("the mesh has no elements; there is nothing to write")
    shapes = [_shape(block) for block in mesh.blocks if len(block.connectivity)]
    used = np.unique(np.concatenate([nodes.ravel() for _, nodes in shapes]))
    owners = _owners(mesh)
    materials, element_materials = _materials(mesh, material)
    node_sets = {
        name: np.flatnonzero(np.isin(used, nodes)) + 1 for name, nodes in mesh.node_sets.items()
    }
    element_sets = {
        name: np.flatnonzero(np.isin(owners, elements)) + 1
        for name, elements in mesh.element_sets.items()
    }
    return DeckMesh(
        np.asarray(mesh.nodes, dtype=float)[used],
        [(shape, np.searchsorted(used, nodes) + 1) for shape, nodes in shapes],
        _without_empty(node_sets),
        _without_empty(element_sets),
        materials,
        element_materials[owners],
        _equations(mesh, used),
    )


def _owners(mesh: Mesh) -> Integers:
    """Return the element of the mesh from which each element of the deck is made."""
    elements_made = []
    for block in mesh.blocks:
        number = 4 if block.kind == "quad25" else 1  # four shells of each plate element
        elements_made.append(np.full(len(block.connectivity), number))
    return np.repeat(np.arange(mesh.number_of_elements), np.concatenate(elements_made))


def _materials(mesh: Mesh, material: Material | None) -> tuple[dict[int, Material], Integers]:
    """Return the materials in use by number, and the number of that of each element.

    Elements without a material of their own have that of the body, of number -1.
    """
    numbers = np.full(mesh.number_of_elements, -1)
    if mesh.materials:
        numbers = mesh.element_materials
    materials = {
        number: stated for number, stated in enumerate(mesh.materials) if number in numbers
    }
    if material is not None and -1 in numbers:
        materials[-1] = material
    for used in materials.values():
        _check_deck_material(used)
    return materials, numbers


def _equations(mesh: Mesh, used: Integers) -> list[list[tuple[int, int, float]]]:
    """Return the joints of a mesh as equations between nodes in use, numbered from 1."""
    if mesh.joints is None:
        return []
    numbers = np.full(len(mesh.nodes), 0)  # zero for a node that the deck lacks
    numbers[used] = np.arange(1, len(used) + 1)
    equations = []
    for follower, weights in mesh.joints.rows():
        terms = [(follower, 1.0), *((unknown, -weight) for unknown, weight in weights.items())]
        equation = [
            (int(numbers[unknown // AXES]), unknown % AXES + 1, coefficient)
            for unknown, coefficient in terms
        ]
        # a node that the shapes of the deck lack is joined to nothing there
        if all(node for node, _, _ in equation):
            equations.append(equation)
    return equations


def nine_node_shells(connectivity: Integers) -> Integers:
    """Return the connectivity of four 9-node shells for each plate element of 5 by 5 nodes.

    The nodes of a shell are corners, edges, centre.

    Examples
    --------
    >>> nine_node_shells(np.arange(25)[None, :])[0].tolist()
    [0, 2, 12, 10, 1, 7, 11, 5, 6]
    """
    lattice = connectivity.reshape(-1, PLATE_ORDER + 1, PLATE_ORDER + 1)
    first_corners = range(0, PLATE_ORDER, 2)
    squares = [
        lattice[:, row + _SQUARE[:, 0], column + _SQUARE[:, 1]]
        for row in first_corners
        for column in first_corners
    ]
    return np.stack(squares, axis=1).reshape(-1, len(_SQUARE))


def _check_deck_material(material: Material) -> None:
    """Check that a material can be written to a deck.

    Raises
    ------
    InputError
        If its density or modulus is not finite.
    """
    if not np.isfinite([material.density, material.youngs_modulus]).all():
        raise InputError(
            f'the material "{material.name}" is rigid or has no density; one that is written to a '
            "file must have a finite density and Young's modulus"
        )


def check_shell_thickness(thickness: float | None) -> None:
    """Check the thickness of shells.

    Raises
    ------
    InputError
        If it is not positive and finite.
    """
    if thickness is not None and not 0 < thickness < np.inf:
        raise InputError(
            f"{thickness:g} m is not allowed; it must be greater than 0 and finite", "thickness"
        )


def _shape(block: ElementBlock) -> tuple[str, Integers]:
    """Return the shape of the elements of a block, and their nodes."""
    if block.kind == "quad25":
        return "quad8", nine_node_shells(block.connectivity)[:, :8]
    if block.kind == "hex27":
        return "hex20", block.connectivity[:, :20]
    if block.kind == "pyramid14":
        return "pyramid13", block.connectivity[:, :13]
    return block.kind, block.connectivity


def _without_empty(sets: Mapping[str, Integers]) -> dict[str, Integers]:
    return {name: members for name, members in sets.items() if len(members)}
