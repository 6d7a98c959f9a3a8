"""Nodes, elements and sets as read from a file, and their assembly into a mesh."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.meshes.edge_nodes import EdgeNodes, with_edge_nodes
from vibroimpact.meshes.links import Equation, Links
from vibroimpact.meshes.node_order import to_ours
from vibroimpact.meshes.selection import Selection
from vibroimpact.meshes.text_files import TextLine
from vibroimpact.meshes.tied_surfaces import MeshSurface, Tie, tied_nodes
from vibroimpact.quoting import quoted, shortened
from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS
from vibroimpact.structures.finite_elements.geometry import renumbered_by_volume
from vibroimpact.structures.finite_elements.joints import AXES
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh
from vibroimpact.structures.finite_elements.stated_materials import StatedMaterial, StatedMaterials
from vibroimpact.structures.finite_elements.surface import Faces

LARGEST_COORDINATE = 1e15
MOST_MEMBERS = 10_000_000
"""Limit for all node sets, or all element sets, together.

With nested sets and ranges a short file could exhaust the memory.
"""

FLUID = "fluid"
"""What a stated material is whose elements are left out.

They have pressures and no displacements.
"""

FLUID_ELEMENTS = "elements of a fluid"
"""Name of these among the items that a reader skipped."""

EMPTY_SET = "set without solid elements or their nodes"


@dataclass
class _Elements:
    """The elements of one kind, with the numbers of the file."""

    lines: list[TextLine] = field(default_factory=list)
    numbers: list[int] = field(default_factory=list)
    nodes: list[Sequence[int]] = field(default_factory=list)


@dataclass
class Parts:
    """Nodes, elements and sets with the numbers of the file.

    Parameters
    ----------
    path : Path
        The file, for messages.
    orders : mapping of str to str
        The file's node order of the element kinds where it differs from ours.

    Attributes
    ----------
    sections : list of (Selection, StatedMaterial)
        Materials of elements; of several for one element the last one counts.
    links : Links
        Links between nodes, such as rigid elements and equations.
    ties : list of Tie
        Surfaces that are tied to one another.
    span : int or None
        Numbers that each instance of an assembly has for itself: above it, a number is that of the
        file and a multiple of this.
    """

    path: Path
    orders: Mapping[str, str] = field(default_factory=dict)
    node_sets: defaultdict[str, Selection] = field(default_factory=lambda: defaultdict(Selection))
    element_sets: defaultdict[str, Selection] = field(
        default_factory=lambda: defaultdict(Selection)
    )
    skipped: Counter[str] = field(default_factory=Counter)
    materials: dict[str, StatedMaterial] = field(default_factory=dict)
    sections: list[tuple[Selection, StatedMaterial]] = field(default_factory=list)
    links: Links = field(default_factory=Links)
    ties: list[Tie] = field(default_factory=list)
    span: int | None = None
    _copied: int = 0
    _node_lines: list[TextLine] = field(default_factory=list)
    _node_numbers: list[int] = field(default_factory=list)
    _points: list[tuple[float, float, float]] = field(default_factory=list)
    _elements: defaultdict[str, _Elements] = field(default_factory=lambda: defaultdict(_Elements))

    def written(self, number: int) -> int:
        """Return the number of a node or an element as the file has it, for messages."""
        if self.span is None:
            return number
        return number % self.span

    def add_node(self, line: TextLine, number: int, point: tuple[float, float, float]) -> None:
        """Add a node.

        Raises
        ------
        InputError
            If a coordinate is not finite.
        """
        for coordinate in point:
            if not -LARGEST_COORDINATE < coordinate < LARGEST_COORDINATE:
                raise line.wrong(
                    f"node {self.written(number)} has the coordinate {coordinate:g}; it "
                    "must be finite and less than 1e15 in size"
                )
        self._node_lines.append(line)
        self._node_numbers.append(number)
        self._points.append(point)

    def add_members(self, line: TextLine, chosen: Selection, more: Selection) -> None:
        """Add a selection to a set.

        Raises
        ------
        InputError
            If all sets together have too many members.
        """
        self._copied += len(more.numbers) + len(more.ranges)
        if self._copied > MOST_MEMBERS:
            raise line.wrong(_too_many_members())
        chosen.update(more)

    def add_element(self, line: TextLine, kind: str, number: int, nodes: Sequence[int]) -> None:
        """Add an element of a kind, its nodes in the order of the file.

        Their number must be that of the kind. Nodes in the middle of edges may be
        `edge_nodes.OMITTED`.
        """
        elements = self._elements[kind]
        elements.lines.append(line)
        elements.numbers.append(number)
        elements.nodes.append(nodes)

    def node_numbers(self, chosen: Selection) -> list[int]:
        """Return the numbers of chosen nodes that the file gives, ascending."""
        known = np.unique(np.array(self._node_numbers, dtype=np.int64))
        if not len(known):
            return []
        return [int(number) for number in known[chosen.places(known)]]

    def nodes_of_elements(self, chosen: Selection) -> set[int]:
        """Return the numbers of the nodes of chosen elements."""
        nodes: set[int] = set()
        for elements in self._elements.values():
            for row in _chosen_rows(elements, chosen):
                nodes.update(elements.nodes[row])
        return nodes

    def nodes_of_surface(self, surface: MeshSurface) -> set[int]:
        """Return the numbers of the nodes of a surface; of faces without a label, those of none."""
        nodes = set(self.node_numbers(surface.nodes))
        for chosen, by_corners in surface.faces:
            for kind, elements in self._elements.items():
                corners = by_corners.get(ELEMENT_KINDS[kind].corners)
                if corners is None:
                    continue
                on_face = self._nodes_on_face(kind, corners)
                for row in _chosen_rows(elements, chosen):
                    nodes.update(elements.nodes[row][node] for node in on_face)
        return nodes

    def _nodes_on_face(self, kind: str, corners: tuple[int, ...]) -> list[int]:
        """Return which nodes of an element, in the order of the file, are on a face of it."""
        element = ELEMENT_KINDS[kind]
        order = np.arange(len(element.reference))
        if kind in self.orders:
            order = to_ours(kind, self.orders[kind])
        face = Faces(element, corners, np.zeros((0, 0), dtype=np.int64))
        return [int(node) for node in order[face.has_node]]

    def mesh(self) -> Mesh:
        """Return the mesh, numbered from 0, without nodes that no element uses.

        Raises
        ------
        InputError
            If an element number occurs twice, a node number with other coordinates, a node is
            missing or there is no element.
        """
        self._leave_out_fluids()
        if not self._elements:
            left_out = ", ".join(
                f"{quoted(name)[1:-1]} ({count})" for name, count in self.skipped.most_common(5)
            )
            raise InputError(
                f"{self.path}: the file has no solid element; a mesh is of tetrahedra, "
                "pyramids, wedges or bricks"
                f"{left_out and '; left out: ' + left_out}"
            )
        nodes_of_kinds = {
            kind: self._nodes_of(kind) for kind in ELEMENT_KINDS if kind in self._elements
        }
        complete = with_edge_nodes(nodes_of_kinds, *self._distinct_nodes())
        # indices into all nodes of the file, then into those that elements use
        blocks = {
            kind: self._connectivity(kind, nodes, complete.numbers)
            for kind, nodes in complete.elements.items()
        }
        used, places = np.unique(
            np.concatenate([block.ravel() for block in blocks.values()]), return_inverse=True
        )
        ends = np.cumsum([block.size for block in blocks.values()])[:-1]
        element_blocks = tuple(
            ElementBlock(kind, flat.reshape(block.shape))
            for (kind, block), flat in zip(blocks.items(), np.split(places, ends), strict=True)
        )
        elements = self._distinct_elements(list(blocks))
        mesh = Mesh(
            complete.points[used],
            element_blocks,
            self._sets(self.node_sets, complete.numbers[used], np.arange(len(used))),
            self._sets(self.element_sets, *elements),
            dict(self.skipped),
            stated=self._stated(*elements),
        )
        return renumbered_by_volume(self._joined(mesh, complete, used, elements))

    def _joined(
        self, mesh: Mesh, complete: EdgeNodes, used: Integers, elements: tuple[Integers, Integers]
    ) -> Mesh:
        """Return the mesh with the joints that the file states.

        It has remarks on them, and on nodes that were made.
        """
        tied = tied_nodes(mesh, self.ties, complete.numbers[used], elements)
        line = TextLine(self.path, 0, "")
        # on the edge of an element of first order, the middle is the mean of the corners
        means = [
            Equation(line, [((node, axis), 1.0), ((first, axis), -0.5), ((second, axis), -0.5)])
            for node, first, second in complete.linear
            for axis in range(AXES)
        ]
        points = complete.points.copy()
        points[used] = tied.nodes
        joints = self.links.joints(
            complete.numbers, points, used, [*means, *tied.equations], self.written
        )
        joined_by: dict[str, int] = {}
        if joints:
            joined_by = self.links.names(complete.numbers[used])
            if tied.equations:
                joined_by["*TIE"] = len(self.ties)
        made = [_made_text(complete)] if complete.made else []
        return replace(
            mesh,
            nodes=tied.nodes,
            joints=joints,
            joined_by=joined_by,
            remarks=(*mesh.remarks, *made, *tied.remarks),
        )

    def _leave_out_fluids(self) -> None:
        """Remove the elements of fluids, and count them as skipped."""
        fluids = [chosen for chosen, material in self.sections if material.other == FLUID]
        if not fluids:
            return
        for kind, elements in list(self._elements.items()):
            is_fluid = np.zeros(len(elements.numbers), dtype=bool)
            for chosen in fluids:
                is_fluid[_chosen_rows(elements, chosen)] = True
            if not is_fluid.any():
                continue
            self.skipped[FLUID_ELEMENTS] += int(is_fluid.sum())
            solid = np.flatnonzero(~is_fluid).tolist()
            del self._elements[kind]
            if solid:
                self._elements[kind] = _Elements(
                    [elements.lines[row] for row in solid],
                    [elements.numbers[row] for row in solid],
                    [elements.nodes[row] for row in solid],
                )

    def _stated(self, numbers: Integers, places: Integers) -> StatedMaterials | None:
        """Return the materials that the file gives its elements; None if it gives none.

        Parameters
        ----------
        numbers, places : int array
            Numbers of the elements, sorted, and their indices counted through all blocks.
        """
        sections = [
            (chosen, material) for chosen, material in self.sections if material.other != FLUID
        ]
        materials = tuple(dict.fromkeys(material for _, material in sections))
        if not materials:
            return None
        of_elements = np.full(len(numbers), -1)
        for chosen, material in sections:
            of_elements[places[chosen.places(numbers)]] = materials.index(material)
        used = np.unique(of_elements[of_elements >= 0])
        if not len(used):
            return None
        # the last one is that of elements without a material, -1
        renumbered = np.append(np.searchsorted(used, np.arange(len(materials))), -1)
        return StatedMaterials(tuple(materials[index] for index in used), renumbered[of_elements])

    def _distinct_nodes(self) -> tuple[Integers, Floats]:
        """Return the node numbers, sorted, and the coordinates.

        Raises
        ------
        InputError
            If a node is given twice with different coordinates.
        """
        numbers = np.array(self._node_numbers, dtype=np.int64)
        points = np.array(self._points, dtype=float).reshape(-1, 3)
        order = np.argsort(numbers, kind="stable")
        numbers = numbers[order]
        points = points[order]
        is_repeated = numbers[1:] == numbers[:-1]
        is_moved = is_repeated & (points[1:] != points[:-1]).any(axis=1)
        if is_moved.any():
            index = int(np.argmax(is_moved)) + 1
            first_line = self._node_lines[order[index - 1]]
            line = self._node_lines[order[index]]
            raise line.wrong(
                f"node {self.written(int(numbers[index]))} was given other coordinates in "
                f"{_place_of(first_line, line)}; "
                "a node may be given again at the same place only"
            )
        if not len(numbers):
            return numbers, points
        is_last = np.append(~is_repeated, True)
        return numbers[is_last], points[is_last]

    def _nodes_of(self, kind: str) -> Integers:
        """Return the numbers of the nodes of the elements of a kind, in our node order."""
        nodes = np.array(self._elements[kind].nodes, dtype=np.int64)
        if kind not in self.orders:
            return nodes
        return nodes[:, to_ours(kind, self.orders[kind])]

    def _connectivity(self, kind: str, nodes: Integers, numbers: Integers) -> Integers:
        """Return the nodes of the elements of a kind as indices into `numbers`.

        Raises
        ------
        InputError
            If a node is not in the file.
        """
        places = np.minimum(np.searchsorted(numbers, nodes), max(len(numbers) - 1, 0))
        places = places.astype(np.int64)
        is_missing = np.ones(nodes.shape, dtype=bool)
        if len(numbers):
            is_missing = numbers[places] != nodes
        if is_missing.any():
            elements = self._elements[kind]
            row, column = np.argwhere(is_missing)[0]
            raise elements.lines[row].wrong(
                f"element {self.written(elements.numbers[row])} has the node "
                f"{self.written(int(nodes[row, column]))}, which the file does not give; "
                "every node of an element must be in the file"
            )
        return places

    def _distinct_elements(self, kinds: list[str]) -> tuple[Integers, Integers]:
        """Return the element numbers, sorted, and their indices counted through all blocks.

        Raises
        ------
        InputError
            If an element is given twice.
        """
        numbers = np.concatenate(
            [np.array(self._elements[kind].numbers, dtype=np.int64) for kind in kinds]
        )
        order = np.argsort(numbers, kind="stable")
        repeated = np.flatnonzero(np.diff(numbers[order]) == 0)
        if len(repeated):
            lines = [line for kind in kinds for line in self._elements[kind].lines]
            first = lines[order[repeated[0]]]
            second = lines[order[repeated[0] + 1]]
            if first.path == second.path and first.number > second.number:  # of two kinds
                first, second = second, first
            element = self.written(int(numbers[order[repeated[0]]]))
            raise second.wrong(
                f"element {element} was given in {_place_of(first, second)} already; an "
                "element may be given once"
            )
        return numbers[order], order

    def _sets(
        self, sets: Mapping[str, Selection], numbers: Integers, places: Integers
    ) -> dict[str, Integers]:
        """Return the sets as indices; members that the mesh does not have are dropped.

        Parameters
        ----------
        sets : mapping of str to Selection
            The sets, of numbers of the file.
        numbers, places : int array
            Numbers that the mesh has, sorted, and their indices in it.
        """
        members_of_sets: dict[str, Integers] = {}
        total = 0
        for name, selection in sets.items():
            members_of_sets[name] = np.sort(places[selection.places(numbers)])
            total += len(members_of_sets[name])
            if total > MOST_MEMBERS:
                raise InputError(f"{self.path}: {_too_many_members()}")
        empty = [name for name, members in members_of_sets.items() if not len(members)]
        if empty:
            self.skipped[EMPTY_SET] += len(empty)
        return {name: members for name, members in members_of_sets.items() if len(members)}


def _chosen_rows(elements: _Elements, chosen: Selection) -> list[int]:
    """Return the rows of chosen elements of a kind."""
    numbers = np.array(elements.numbers, dtype=np.int64)
    order = np.argsort(numbers, kind="stable")
    return [int(row) for row in order[chosen.places(numbers[order])]]


def _place_of(line: TextLine, other: TextLine) -> str:
    """Return where a line is, for a message that names the file of another one."""
    if line.path == other.path:
        return f"line {line.number}"
    return f"line {line.number} of {shortened(str(line.path), 200)}"


def _made_text(complete: EdgeNodes) -> str:
    """Return which nodes were made, as a remark."""
    straight = ""
    if complete.linear:
        straight = (
            f", of which {len(complete.linear)} move as the straight edges of neighbours of "
            "first order"
        )
    were = "was" if complete.made == 1 else "were"
    return (
        "the mesh file leaves out nodes in the middle of edges of elements of second "
        f"order: {complete.made} {were} made halfway "
        f"between the corners{straight}; a curved edge is straight there"
    )


def _too_many_members() -> str:
    return (
        f"the sets have more than {MOST_MEMBERS:,} members in all; leave out "
        "those that are not needed"
    )
