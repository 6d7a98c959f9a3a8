"""Finite-element mesh: nodes, elements, named sets of them, and materials of the elements."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.materials import Material
from vibroimpact.quoting import quoted
from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS, ElementKind
from vibroimpact.structures.finite_elements.stated_materials import StatedMaterials

# not imported at run time, as a case with rigid bodies does not need scipy.sparse
if TYPE_CHECKING:
    from vibroimpact.structures.finite_elements.joints import Joints


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
    materials : tuple of Material
        Materials of the elements; none if all elements are of the material of the body.
    element_materials : int array, shape (elements,)
        Number of each element's material in `materials`, through all blocks in their order; -1 is
        the material of the body.
    stated : StatedMaterials, optional
        Materials as a mesh file states them, whether they are used or not.
    joints : Joints, optional
        Displacements that follow others, by which parts that share no node are joined.
    joined_by : mapping of str to int
        Items of a mesh file that made the joints, and how many of each.
    remarks : tuple of str
        What a mesh file holds that is not in the mesh and what that does to the body, one sentence
        each, without a full stop.

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
    materials: tuple[Material, ...] = ()
    element_materials: Integers = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    stated: StatedMaterials | None = None
    joints: Joints | None = None
    joined_by: Mapping[str, int] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()

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

    def of_elements(self, body: Material, value: Callable[[Material], float]) -> Floats:
        """Return a property of the material of each element, (elements,).

        -1 in `element_materials` is the material of the body.
        """
        if not self.materials:
            return np.full(self.number_of_elements, value(body))
        values = np.array([*map(value, self.materials), value(body)])  # number -1 is the last
        return np.asarray(values[self.element_materials])

    @property
    def materials_text(self) -> str:
        """How many elements have which material, in words.

        It is "" if all elements are of the material of the body.
        """
        counts = Counter(self.element_materials.tolist())
        texts = [
            f"{counts[number]} of {_material_text(material)}"
            for number, material in enumerate(self.materials)
            if counts[number]
        ]
        if counts[-1]:
            texts.append(f"{counts[-1]} of the material of the case")
        return ", ".join(texts)

    def nodes_of(self, name: str) -> Integers:
        """Return the nodes of a named set of nodes, or of a named set of elements.

        Raises
        ------
        InputError
            If there is no such set, or it is empty.
        """
        known = [*self.node_sets, *self.element_sets]
        # the exact name, else one that differs in case only
        matches = [other for other in known if other == name]
        matches += [other for other in known if other.lower() == name.lower()]
        if not matches:
            have = "it has no named sets"
            if known:
                have = f"there are {', '.join(known)}"
            raise InputError(f'the mesh has no set "{name}"; {have}.{did_you_mean(name, known)}')
        set_name = matches[0]
        if set_name in self.node_sets:
            nodes = self.node_sets[set_name]
        else:
            nodes = self._nodes_of_elements(self.element_sets[set_name])
        if len(nodes) == 0:
            raise InputError(f'the set "{set_name}" of the mesh is empty')
        return nodes

    def _nodes_of_elements(self, elements: Integers) -> Integers:
        """Return the nodes of elements, numbered through all blocks."""
        nodes = []
        first = 0
        for block in self.blocks:
            end = first + len(block.connectivity)
            in_block = elements[(elements >= first) & (elements < end)]
            nodes.append(block.connectivity[in_block - first].ravel())
            first = end
        return np.unique(np.concatenate(nodes))


def _material_text(material: Material) -> str:
    """Return the name of a material, and its numbers in parentheses."""
    numbers = (
        f"{material.density:.4g} kg/m3, {1e-9 * material.youngs_modulus:.4g} GPa, "
        f"{material.poissons_ratio:.3g}"
    )
    if not material.name:
        return f"({numbers})"
    return f"{quoted(material.name)[1:-1]} ({numbers})"
