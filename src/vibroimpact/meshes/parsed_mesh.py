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
from vibroimpact.structures.element_kinds import ELEMENT_KINDS
from vibroimpact.structures.geometry import renumbered_by_volume
from vibroimpact.structures.joints import AXES
from vibroimpact.structures.mesh import ElementBlock, Mesh
from vibroimpact.structures.stated_materials import StatedMaterial, StatedMaterials
from vibroimpact.structures.surface import Faces

LARGEST_COORDINATE = 1e15
MOST_MEMBERS = 10_000_000
"""Limit for all node sets, or all element sets, together: with nested sets and ranges a
short file could exhaust the memory.
"""

FLUID = "fluid"
"""What a stated material is whose elements are left out: they have pressures and no
displacements.
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
        return number if self.span is None else number % self.span

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
        """Add an element of a kind, its nodes in the order of the file; their number must be that
        of the kind.

        Nodes in the middle of edges may be `edge_nodes.OMITTED`.
        """
        found = self._elements[kind]
        found.lines.append(line)
        found.numbers.append(number)
        found.nodes.append(nodes)

    def node_numbers(self, chosen: Selection) -> list[int]:
        """Return the numbers of chosen nodes that the file gives, ascending."""
        known = np.unique(np.array(self._node_numbers, dtype=np.int64))
        return [int(number) for number in known[chosen.places(known)]] if len(known) else []

    def nodes_of_elements(self, chosen: Selection) -> set[int]:
        """Return the numbers of the nodes of chosen elements."""
        found: set[int] = set()
        for elements in self._elements.values():
            for row in _chosen_rows(elements, chosen):
                found.update(elements.nodes[row])
        return found

    def nodes_of_surface(self, surface: MeshSurface) -> set[int]:
        """Return the numbers of the nodes of a surface; of faces without a label, those of none."""
        found = set(self.node_numbers(surface.nodes))
        for chosen, by_corners in surface.faces:
            for kind, elements in self._elements.items():
                corners = by_corners.get(ELEMENT_KINDS[kind].corners)
                order = (
                    to_ours(kind, self.orders[kind])
                    if kind in self.orders
                    else np.arange(len(ELEMENT_KINDS[kind].reference))
                )
                if corners is not None:
                    on_face = order[
                        Faces(
                            ELEMENT_KINDS[kind], corners, np.zeros((0, 0), dtype=np.int64)
                        ).has_node
                    ].tolist()
                    found.update(
                        elements.nodes[row][node]
                        for row in _chosen_rows(elements, chosen)
                        for node in on_face
                    )
        return found

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
        complete = with_edge_nodes(
            {kind: self._nodes_of(kind) for kind in ELEMENT_KINDS if kind in self._elements},
            *self._distinct_nodes(),
        )
        numbers, points = complete.numbers, complete.points
        blocks = {
            kind: self._places_of_nodes(kind, nodes, numbers)
            for kind, nodes in complete.elements.items()
        }
        used, places = np.unique(
            np.concatenate([places.ravel() for places in blocks.values()]), return_inverse=True
        )
        ends = np.cumsum([places.size for places in blocks.values()])[:-1]
        renumbered = zip(blocks, np.split(places, ends), blocks.values(), strict=True)
        elements = self._distinct_elements(list(blocks))
        mesh = Mesh(
            points[used],
            tuple(
                ElementBlock(kind, flat.reshape(shaped.shape)) for kind, flat, shaped in renumbered
            ),
            self._sets(self.node_sets, numbers[used], np.arange(len(used))),
            self._sets(self.element_sets, *elements),
            dict(self.skipped),
            stated=self._stated(*elements),
        )
        return renumbered_by_volume(self._joined(mesh, complete, used, elements))

    def _joined(
        self, mesh: Mesh, complete: EdgeNodes, used: Integers, elements: tuple[Integers, Integers]
    ) -> Mesh:
        """Return the mesh with the joints that the file states, and remarks on them and
        on nodes that were made.
        """
        tied = tied_nodes(mesh, self.ties, complete.numbers[used], elements)
        line = TextLine(self.path, 0, "")
        halves = [
            Equation(line, [((node, axis), 1.0), ((first, axis), -0.5), ((second, axis), -0.5)])
            for node, first, second in complete.linear
            for axis in range(AXES)
        ]
        points = complete.points.copy()
        points[used] = tied.nodes
        joints = self.links.joints(
            complete.numbers, points, used, [*halves, *tied.equations], self.written
        )
        joined_by = {
            **self.links.names(complete.numbers[used]),
            **({"*TIE": len(self.ties)} if tied.equations else {}),
        }
        made = [_made_text(complete)] if complete.made else []
        return replace(
            mesh,
            nodes=tied.nodes,
            joints=joints,
            joined_by=joined_by if joints else {},
            remarks=(*mesh.remarks, *made, *tied.remarks),
        )

    def _leave_out_fluids(self) -> None:
        """Remove the elements of fluids, and count them as skipped."""
        fluids = [chosen for chosen, material in self.sections if material.other == FLUID]
        for kind, found in list(self._elements.items()) if fluids else []:
            numbers = np.array(found.numbers, dtype=np.int64)
            order = np.argsort(numbers, kind="stable")
            wet = np.zeros(len(numbers), dtype=bool)
            for chosen in fluids:
                wet[order[chosen.places(numbers[order])]] = True
            if wet.any():
                self.skipped[FLUID_ELEMENTS] += int(wet.sum())
                dry = np.flatnonzero(~wet).tolist()
                del self._elements[kind]
                if dry:
                    lines, left = (
                        [found.lines[index] for index in dry],
                        [found.numbers[index] for index in dry],
                    )
                    self._elements[kind] = _Elements(
                        lines, left, [found.nodes[index] for index in dry]
                    )

    def _stated(self, numbers: Integers, places: Integers) -> StatedMaterials | None:
        """Return the materials that the file gives its elements; None if it gives none."""
        materials = tuple(
            dict.fromkeys(material for _, material in self.sections if material.other != FLUID)
        )
        if not materials:
            return None
        of_elements = np.full(len(numbers), -1)
        for chosen, material in self.sections:
            if material.other != FLUID:
                of_elements[places[chosen.places(numbers)]] = materials.index(material)
        used = np.unique(of_elements[of_elements >= 0])
        renumbered = np.append(np.searchsorted(used, np.arange(len(materials))), -1)
        return (
            StatedMaterials(tuple(materials[index] for index in used), renumbered[of_elements])
            if len(used)
            else None
        )

    def _distinct_nodes(self) -> tuple[Integers, Floats]:
        """Return the node numbers, sorted, and the coordinates; raise if a node is given
        twice with different coordinates.
        """
        numbers, points = (
            np.array(self._node_numbers, dtype=np.int64),
            np.array(self._points, dtype=float).reshape(-1, 3),
        )
        order = np.argsort(numbers, kind="stable")
        numbers, points = numbers[order], points[order]
        again = numbers[1:] == numbers[:-1]
        moved = again & (points[1:] != points[:-1]).any(axis=1)
        if moved.any():
            at = int(np.argmax(moved)) + 1
            first = self._node_lines[order[at - 1]]
            raise self._node_lines[order[at]].wrong(
                f"node {self.written(int(numbers[at]))} was given other coordinates in "
                f"{_place_of(first, self._node_lines[order[at]])}; "
                "a node may be given again at the same place only"
            )
        once = np.append(~again, True) if len(numbers) else np.ones(0, dtype=bool)
        return numbers[once], points[once]

    def _nodes_of(self, kind: str) -> Integers:
        """Return the numbers of the nodes of the elements of a kind, in our node order."""
        nodes = np.array(self._elements[kind].nodes, dtype=np.int64)
        return nodes[:, to_ours(kind, self.orders[kind])] if kind in self.orders else nodes

    def _places_of_nodes(self, kind: str, wanted: Integers, numbers: Integers) -> Integers:
        """Return the connectivity as indices into `numbers`."""
        found = self._elements[kind]
        places = np.minimum(np.searchsorted(numbers, wanted), max(len(numbers) - 1, 0)).astype(
            np.int64
        )
        missing = numbers[places] != wanted if len(numbers) else np.ones(wanted.shape, dtype=bool)
        if missing.any():
            row, column = np.argwhere(missing)[0]
            raise found.lines[row].wrong(
                f"element {self.written(found.numbers[row])} has the node "
                f"{self.written(int(wanted[row, column]))}, which the file does not give; "
                "every node of an element must be in the file"
            )
        return places

    def _distinct_elements(self, kinds: list[str]) -> tuple[Integers, Integers]:
        """Return the element numbers, sorted, and their indices counted through all blocks."""
        numbers = np.concatenate(
            [np.array(self._elements[kind].numbers, dtype=np.int64) for kind in kinds]
        )
        order = np.argsort(numbers, kind="stable")
        again = np.flatnonzero(np.diff(numbers[order]) == 0)
        if len(again):
            lines = [line for kind in kinds for line in self._elements[kind].lines]
            first, second = lines[order[again[0]]], lines[order[again[0] + 1]]
            if first.path == second.path and first.number > second.number:  # of two kinds
                first, second = second, first
            element = self.written(int(numbers[order[again[0]]]))
            raise second.wrong(
                f"element {element} was given in {_place_of(first, second)} already; an "
                "element may be given once"
            )
        return numbers[order], order

    def _sets(
        self, sets: Mapping[str, Selection], numbers: Integers, places: Integers
    ) -> dict[str, Integers]:
        """Return the sets as indices; members that the mesh does not have are dropped."""
        found: dict[str, Integers] = {}
        total = 0
        for name, selection in sets.items():
            found[name] = np.sort(places[selection.places(numbers)])
            total += len(found[name])
            if total > MOST_MEMBERS:
                raise InputError(f"{self.path}: {_too_many_members()}")
        empty = [name for name, members in found.items() if len(members) == 0]
        self.skipped.update({EMPTY_SET: len(empty)} if empty else {})
        return {name: members for name, members in found.items() if len(members)}


def _chosen_rows(elements: _Elements, chosen: Selection) -> list[int]:
    """Return the rows of chosen elements of a kind."""
    numbers = np.array(elements.numbers, dtype=np.int64)
    order = np.argsort(numbers, kind="stable")
    return [int(row) for row in order[chosen.places(numbers[order])]]


def _place_of(line: TextLine, other: TextLine) -> str:
    """Return where a line is, for a message that names the file of another one."""
    return (
        f"line {line.number}"
        if line.path == other.path
        else f"line {line.number} of {shortened(str(line.path), 200)}"
    )


def _made_text(complete: EdgeNodes) -> str:
    """Return what nodes were made, as a remark."""
    straight = (
        f", of which {len(complete.linear)} move as the straight edges of neighbours of first order"
        if complete.linear
        else ""
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
