"""Nodes, elements and sets as read from a file, and their assembly into a mesh."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.meshes.node_order import to_ours
from vibroimpact.meshes.text_files import TextLine
from vibroimpact.shown import shown
from vibroimpact.structures.element_kinds import ELEMENT_KINDS
from vibroimpact.structures.geometry import renumbered_by_volume
from vibroimpact.structures.mesh import ElementBlock, Mesh
from vibroimpact.structures.stated_materials import StatedMaterial, StatedMaterials

LARGEST_COORDINATE = 1e15
MOST_MEMBERS = 10_000_000
"""Limit for all node sets, or all element sets, together: with nested sets and ranges a short file could exhaust the memory."""

FLUID = "fluid"
"""What a stated material is whose elements are left out: they have pressures and no displacements."""

FLUID_ELEMENTS = "elements of a fluid"
"""Name of these among the items that a reader skipped."""

EMPTY_SET = "set without solid elements or their nodes"


@dataclass
class Selection:
    """A selection of node or element numbers: single numbers, and ranges (first, last, step).

    Ranges are expanded only against the existing numbers, so that "1 to 10^12" costs nothing.

    Examples
    --------
    >>> Selection({7}, {(2, 10**12, 2)}).places(np.array([1, 2, 3, 4, 7])).tolist()
    [1, 3, 4]
    """

    numbers: set[int] = field(default_factory=set)
    ranges: set[tuple[int, int, int]] = field(default_factory=set)

    def places(self, known: Integers) -> Integers:
        """Return the indices of the selected numbers in `known`, which is sorted."""
        numbers = np.fromiter(self.numbers, np.int64, len(self.numbers))
        places = np.minimum(np.searchsorted(known, numbers), len(known) - 1).astype(np.int64)
        places = np.sort(places[known[places] == numbers])
        if not self.ranges:  # avoid arrays of the size of `known`: there may be many small sets
            return places
        ranges = np.array(list(self.ranges), dtype=np.int64)
        starts, stops = np.searchsorted(known, ranges[:, 0]), np.searchsorted(known, ranges[:, 1], side="right")
        unit_step = ranges[:, 2] == 1
        # ranges of step 1 by the cumulative sum of their starts and ends: thousands cost as much as one
        ends = np.bincount(starts[unit_step], minlength=len(known) + 1) - np.bincount(stops[unit_step], minlength=len(known) + 1)
        chosen = np.cumsum(ends[:-1]) > 0
        chosen[places] = True
        others = (part[~unit_step].tolist() for part in (ranges, starts, stops))
        for (first, _, step), start, stop in zip(*others, strict=True):
            chosen[start:stop] |= (known[start:stop] - first) % step == 0
        return np.flatnonzero(chosen)

    def update(self, other: Selection) -> None:
        """Add another selection."""
        self.numbers |= other.numbers
        self.ranges |= other.ranges


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
    """

    path: Path
    orders: Mapping[str, str] = field(default_factory=dict)
    node_sets: defaultdict[str, Selection] = field(default_factory=lambda: defaultdict(Selection))
    element_sets: defaultdict[str, Selection] = field(default_factory=lambda: defaultdict(Selection))
    skipped: Counter[str] = field(default_factory=Counter)
    materials: dict[str, StatedMaterial] = field(default_factory=dict)
    sections: list[tuple[Selection, StatedMaterial]] = field(default_factory=list)
    _copied: int = 0
    _node_lines: list[TextLine] = field(default_factory=list)
    _node_numbers: list[int] = field(default_factory=list)
    _points: list[tuple[float, float, float]] = field(default_factory=list)
    _elements: defaultdict[str, _Elements] = field(default_factory=lambda: defaultdict(_Elements))

    def add_node(self, line: TextLine, number: int, point: tuple[float, float, float]) -> None:
        """Add a node.

        Raises
        ------
        InputError
            If a coordinate is not finite.
        """
        for coordinate in point:
            if not -LARGEST_COORDINATE < coordinate < LARGEST_COORDINATE:
                raise line.wrong(f"node {number} has the coordinate {coordinate:g}; it must be finite and less than 1e15 in size")
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
        """Add an element of a kind, its nodes in the order of the file; their number must be that of the kind."""
        found = self._elements[kind]
        found.lines.append(line)
        found.numbers.append(number)
        found.nodes.append(nodes)

    def mesh(self) -> Mesh:
        """Return the mesh, numbered from 0, without nodes that no element uses.

        Raises
        ------
        InputError
            If an element number occurs twice, a node number with other coordinates, a node is missing or there is no element.
        """
        self._leave_out_fluids()
        if not self._elements:
            left_out = ", ".join(f"{shown(name)[1:-1]} ({count})" for name, count in self.skipped.most_common(5))
            raise InputError(
                f"{self.path}: the file has no solid element; a mesh is of tetrahedra, pyramids, wedges or bricks"
                f"{left_out and '; left out: ' + left_out}"
            )
        numbers, points = self._distinct_nodes()
        blocks = {kind: self._places_of_nodes(kind, numbers) for kind in ELEMENT_KINDS if kind in self._elements}
        used, places = np.unique(np.concatenate([places.ravel() for places in blocks.values()]), return_inverse=True)
        ends = np.cumsum([places.size for places in blocks.values()])[:-1]
        renumbered = zip(blocks, np.split(places, ends), blocks.values(), strict=True)
        elements = self._distinct_elements(list(blocks))
        mesh = Mesh(
            points[used],
            tuple(ElementBlock(kind, flat.reshape(shaped.shape)) for kind, flat, shaped in renumbered),
            self._sets(self.node_sets, numbers[used], np.arange(len(used))),
            self._sets(self.element_sets, *elements),
            dict(self.skipped),
            stated=self._stated(*elements),
        )
        return renumbered_by_volume(mesh)

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
                    lines, left = [found.lines[index] for index in dry], [found.numbers[index] for index in dry]
                    self._elements[kind] = _Elements(lines, left, [found.nodes[index] for index in dry])

    def _stated(self, numbers: Integers, places: Integers) -> StatedMaterials | None:
        """Return the materials that the file gives its elements; None if it gives none."""
        materials = tuple(dict.fromkeys(material for _, material in self.sections if material.other != FLUID))
        if not materials:
            return None
        of_elements = np.full(len(numbers), -1)
        for chosen, material in self.sections:
            if material.other != FLUID:
                of_elements[places[chosen.places(numbers)]] = materials.index(material)
        used = np.unique(of_elements[of_elements >= 0])
        renumbered = np.append(np.searchsorted(used, np.arange(len(materials))), -1)
        return StatedMaterials(tuple(materials[index] for index in used), renumbered[of_elements]) if len(used) else None

    def _distinct_nodes(self) -> tuple[Integers, Floats]:
        """Return the node numbers, sorted, and the coordinates; raise if a node is given twice with different coordinates."""
        numbers, points = np.array(self._node_numbers, dtype=np.int64), np.array(self._points, dtype=float).reshape(-1, 3)
        order = np.argsort(numbers, kind="stable")
        numbers, points = numbers[order], points[order]
        again = numbers[1:] == numbers[:-1]
        moved = again & (points[1:] != points[:-1]).any(axis=1)
        if moved.any():
            at = int(np.argmax(moved)) + 1
            first = self._node_lines[order[at - 1]]
            raise self._node_lines[order[at]].wrong(
                f"node {numbers[at]} was given other coordinates in line {first.number}; a node may be given once"
            )
        once = np.append(~again, True) if len(numbers) else np.ones(0, dtype=bool)
        return numbers[once], points[once]

    def _places_of_nodes(self, kind: str, numbers: Integers) -> Integers:
        """Return the connectivity as indices into `numbers`, in our node order."""
        found = self._elements[kind]
        wanted = np.array(found.nodes, dtype=np.int64)
        places = np.minimum(np.searchsorted(numbers, wanted), max(len(numbers) - 1, 0)).astype(np.int64)
        missing = numbers[places] != wanted if len(numbers) else np.ones(wanted.shape, dtype=bool)
        if missing.any():
            row, column = np.argwhere(missing)[0]
            raise found.lines[row].wrong(
                f"element {found.numbers[row]} has the node {wanted[row, column]}, which the file does not give; "
                "every node of an element must be in the file"
            )
        return places[:, to_ours(kind, self.orders[kind])] if kind in self.orders else places

    def _distinct_elements(self, kinds: list[str]) -> tuple[Integers, Integers]:
        """Return the element numbers, sorted, and their indices counted through all blocks."""
        numbers = np.concatenate([np.array(self._elements[kind].numbers, dtype=np.int64) for kind in kinds])
        order = np.argsort(numbers, kind="stable")
        again = np.flatnonzero(np.diff(numbers[order]) == 0)
        if len(again):
            lines = [line for kind in kinds for line in self._elements[kind].lines]
            first, second = sorted((lines[order[again[0]]], lines[order[again[0] + 1]]), key=lambda line: line.number)
            raise second.wrong(f"element {numbers[order[again[0]]]} was given in line {first.number} already; an element may be given once")
        return numbers[order], order

    def _sets(self, sets: Mapping[str, Selection], numbers: Integers, places: Integers) -> dict[str, Integers]:
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


def _too_many_members() -> str:
    return f"the sets have more than {MOST_MEMBERS:,} members in all; leave out those that are not needed"
