"""Finite-element mesh: nodes, elements, and named sets of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.structures.element_kinds import ELEMENT_KINDS, ElementKind


@dataclass(frozen=True)
class ElementBlock:
    """Elements of one kind in a mesh.

    Parameters
    ----------
    kind : str
        A name in `ELEMENT_KINDS`.
    connectivity : int array, shape (elements, nodes of the kind)
        Nodes of each element, numbered from 0, in the order of the kind.
    """

    kind: str
    connectivity: Integers

    @property
    def element(self) -> ElementKind:
        """The kind of the elements."""
        return ELEMENT_KINDS[self.kind]


@dataclass(frozen=True)
class Mesh:
    """Finite-element mesh of a body.

    Parameters
    ----------
    nodes : array, shape (nodes, 3)
        Coordinates [m]; z is up.
    blocks : tuple of ElementBlock
        Elements, one block per kind.
    node_sets : mapping of str to int array
        Named sets of nodes, numbered from 0.
    element_sets : mapping of str to int array
        Named sets of elements, numbered from 0 through all blocks in their order.
    skipped : mapping of str to int
        Items of a mesh file that its reader skipped, and how many of each.

    Examples
    --------
    >>> tet = Mesh(np.eye(4, 3), (ElementBlock("tet4", np.array([[3, 0, 1, 2]])),))
    >>> tet.number_of_elements
    1
    """

    nodes: Floats
    blocks: tuple[ElementBlock, ...]
    node_sets: Mapping[str, Integers] = field(default_factory=dict)
    element_sets: Mapping[str, Integers] = field(default_factory=dict)
    skipped: Mapping[str, int] = field(default_factory=dict)

    @property
    def number_of_elements(self) -> int:
        """Number of elements."""
        return sum(len(block.connectivity) for block in self.blocks)

    @property
    def is_flat(self) -> bool:
        """Whether the elements are plate elements."""
        return any(block.element.dimension == 2 for block in self.blocks)

    @property
    def dofs_per_node(self) -> int:
        """Degrees of freedom per node: three displacements, and two slopes in plate elements."""
        return 5 if self.is_flat else 3

    @property
    def extent(self) -> Floats:
        """Length, width and height of the bounding box of the nodes [m]."""
        return np.asarray(np.ptp(self.nodes, axis=0))

    def nodes_of(self, name: str) -> Integers:
        """Return the nodes of a named set of nodes, or of a named set of elements.

        Raises
        ------
        InputError
            If there is no such set, or it is empty.
        """
        known = [*self.node_sets, *self.element_sets]
        exact = name if name in known else next((other for other in known if other.lower() == name.lower()), None)
        if exact is None:
            have = f"there are {', '.join(known)}" if known else "it has no named sets"
            raise InputError(f'the mesh has no set "{name}"; {have}.{did_you_mean(name, known)}')
        found = self.node_sets[exact] if exact in self.node_sets else self._nodes_of_elements(self.element_sets[exact])
        if len(found) == 0:
            raise InputError(f'the set "{exact}" of the mesh is empty')
        return found

    def _nodes_of_elements(self, elements: Integers) -> Integers:
        found, first = [], 0
        for block in self.blocks:
            inside = elements[(elements >= first) & (elements < first + len(block.connectivity))] - first
            found.append(block.connectivity[inside].ravel())
            first += len(block.connectivity)
        return np.unique(np.concatenate(found))
