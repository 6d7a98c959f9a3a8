"""Links between nodes that a mesh file states, as linear equations between their displacements and rotations."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.meshes.text_files import TextLine
from vibroimpact.structures.joints import AXES, Joints, Terms, solved_joints
from vibroimpact.structures.structure import rotation_columns

COMPONENTS = 6
"""Of the motion of a node: three displacements, and three rotations."""

Free = tuple[int, int]
"""A node and a component of its motion, from 0."""


class Equation(NamedTuple):
    """A sum of components of motion that is zero."""

    line: TextLine
    terms: Sequence[tuple[Free, float]]


class Rigid(NamedTuple):
    """Components of the motion of nodes that follow one rigid motion; of all six of one node, it is the motion of this."""

    line: TextLine
    members: Sequence[tuple[int, Sequence[int]]]


class Mean(NamedTuple):
    """Components of the motion of a node that are the mean motion of others: the rigid one that fits their displacements best.

    Each member is a node, its weight, and those of its displacements that count.
    """

    line: TextLine
    node: int
    components: Sequence[int]
    members: Sequence[tuple[int, float, Sequence[int]]]


class Distance(NamedTuple):
    """Two nodes whose distance stays the same."""

    line: TextLine
    nodes: tuple[int, int]


Link = Equation | Rigid | Mean | Distance


@dataclass
class Links:
    """The links of a file, with the numbers of the file."""

    stated: list[tuple[str, Link]] = field(default_factory=list)

    def add(self, name: str, link: Link) -> None:
        """Add a link; `name` is that of its card or keyword."""
        self.stated.append((name, link))

    def names(self, nodes: Integers) -> dict[str, int]:
        """Return the names of the links that concern given nodes, by their numbers in the file, and how many there are of each."""
        mine = set(nodes.tolist()) if self.stated else set()
        return dict(Counter(name for name, link in self.stated if not mine.isdisjoint(_nodes_of(link))))

    def joints(self, numbers: Integers, points: Floats, used: Integers, more: Iterable[Link] = ()) -> Joints | None:
        """Return the joints of the mesh that the links make.

        Parameters
        ----------
        numbers, points : array, shape (n,) and (n, 3)
            Numbers of all nodes of the file, ascending, and their coordinates.
        used : int array
            Indices of the nodes of the mesh.
        more : iterable of links
            Further links, which do not count.

        Raises
        ------
        InputError
            If a node of a rigid link is not in the file.
        """
        links = [*(link for _, link in self.stated), *more]
        if not links:
            return None
        unknowns = _Unknowns(numbers, points, used)
        equations = [row for link in links for row in unknowns.equations(link)]
        return solved_joints([row for row in equations if row], AXES * len(used))


class _Unknowns:
    """Numbers of unknowns: 3 times a node of the mesh plus an axis, and above these all others as they come."""

    def __init__(self, numbers: Integers, points: Floats, used: Integers) -> None:
        self._numbers, self._points = numbers, points
        self._used: dict[object, int] = {int(number): index for index, number in enumerate(numbers[used].tolist())}
        self._others: dict[object, int] = {}
        self._rigids = 0

    def number(self, node: object, component: int) -> int:
        """Return the number of the unknown of a component of the motion of a node."""
        index = self._used.get(node)
        if component < AXES and index is not None:
            return AXES * index + component
        return self._others.setdefault((node, component), AXES * len(self._used) + len(self._others))

    def at(self, line: TextLine, node: int) -> Floats:
        """Return the place of a node.

        Raises
        ------
        InputError
            If it is not in the file.
        """
        index = int(np.searchsorted(self._numbers, node))
        if index == len(self._numbers) or self._numbers[index] != node:
            raise line.wrong(f"the node {node} that is joined here is not in the file; every node must be in it")
        return np.asarray(self._points[index])

    def equations(self, link: Link) -> list[Terms]:
        """Return the equations of a link; terms that meet are added."""
        if isinstance(link, Equation):
            return [_sum((self.number(*free), value) for free, value in link.terms)]
        if isinstance(link, Rigid):
            return self._rigid(link)
        return self._mean(link) if isinstance(link, Mean) else self._distance(link)

    def _rigid(self, link: Rigid) -> list[Terms]:
        leads = next((node for node, components in link.members if len(set(components)) == COMPONENTS), None)
        self._rigids += 1
        owner: object = ("rigid", self._rigids) if leads is None else leads
        centre = self.at(link.line, link.members[0][0] if leads is None else leads)
        rows = []
        for node, components in link.members:
            if node == leads:
                continue
            turned = rotation_columns(*(self.at(link.line, node) - centre)[:, None])[0]
            for component in components:
                moved = [(self.number(owner, component), -1.0)]
                if component < AXES:
                    moved += [(self.number(owner, AXES + axis), -float(turned[component, axis])) for axis in range(AXES)]
                rows.append(_sum([(self.number(node, component), 1.0), *moved]))
        return rows

    def _mean(self, link: Mean) -> list[Terms]:
        """The rigid motion about the node that fits the displacements of the others best, with weights (of RBE3 and of couplings)."""
        centre = self.at(link.line, link.node)
        at = np.array([self.at(link.line, node) for node, _, _ in link.members]) - centre
        length = float(np.abs(at).max(initial=0.0)) or 1.0
        rigid = np.concatenate([np.broadcast_to(np.eye(3), (len(at), 3, 3)), rotation_columns(*(at / length).T)], axis=2)
        counted = np.array([[axis in axes for axis in range(AXES)] for _, _, axes in link.members])
        root = np.sqrt([weight for _, weight, _ in link.members])[:, None] * counted
        # the pseudoinverse: nodes on one line do not turn about it
        fit = np.linalg.pinv((root[:, :, None] * rigid).reshape(-1, COMPONENTS)) * root.ravel()
        fit[AXES:] /= length
        unknowns = [self.number(node, axis) for node, _, _ in link.members for axis in range(AXES)]
        return [
            _sum([(self.number(link.node, component), 1.0), *zip(unknowns, (-fit[component]).tolist(), strict=True)])
            for component in link.components
        ]

    def _distance(self, link: Distance) -> list[Terms]:
        first, second = link.nodes
        apart = self.at(link.line, second) - self.at(link.line, first)
        size = float(np.linalg.norm(apart))
        if not size > 0.0:
            raise link.line.wrong("the two nodes whose distance is kept are at the same place; they must lie apart")
        along = (apart / size).tolist()
        ends = [(self.number(second, axis), value) for axis, value in enumerate(along)]
        return [_sum([*ends, *((self.number(first, axis), -value) for axis, value in enumerate(along))])]


def _nodes_of(link: Link) -> list[int]:
    """Return the numbers of the nodes of a link."""
    if isinstance(link, Equation):
        return [node for (node, _), _ in link.terms]
    if isinstance(link, Distance):
        return list(link.nodes)
    members = [member[0] for member in link.members]
    return [link.node, *members] if isinstance(link, Mean) else members


def _sum(terms: Iterable[tuple[int, float]]) -> Terms:
    """Return an equation without terms that are zero."""
    found: Terms = {}
    for unknown, value in terms:
        found[unknown] = found.get(unknown, 0.0) + value
    return {unknown: value for unknown, value in found.items() if value != 0.0}
