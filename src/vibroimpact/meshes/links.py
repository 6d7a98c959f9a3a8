"""Links between nodes that a mesh file states, as linear equations between their
displacements and rotations.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.meshes.text_files import TextLine
from vibroimpact.structures.joints import AXES, Joints, Terms, solved_joints
from vibroimpact.structures.structure import rotation_columns

COMPONENTS = 6
"""Of the motion of a node: three displacements, and three rotations."""

_TOGETHER = 5e-7
"""Of the extent of the mesh: nodes within this distance are at one place, as files round
coordinates to seven digits.
"""

_ROUNDING = 1e-12
"""Of the extent of the mesh, or of the largest coefficient: smaller components of an arm,
or coefficients, are rounding.
"""

_LOOSE = 1e-6
"""Of the largest singular value: rigid motions that nodes show less do not follow from theirs."""

_NONE = 1e-9
"""Of the largest coefficient: smaller ones are rounding."""

Free = tuple[int, int]
"""A node and a component of its motion, from 0."""


class Equation(NamedTuple):
    """A sum of components of motion that is zero."""

    line: TextLine
    terms: Sequence[tuple[Free, float]]


class Rigid(NamedTuple):
    """Components of the motion of nodes that follow one rigid motion; of all six of one
    node, it is the motion of this.
    """

    line: TextLine
    members: Sequence[tuple[int, Sequence[int]]]


class Mean(NamedTuple):
    """Components of the motion of a node that are the mean motion of others: the rigid one that
    fits their displacements best.

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
        """Return the names of the links that concern given nodes, by their numbers in the
        file, and how many there are of each.
        """
        mine = set(nodes.tolist()) if self.stated else set()
        return dict(
            Counter(name for name, link in self.stated if not mine.isdisjoint(_nodes_of(link)))
        )

    def joints(
        self,
        numbers: Integers,
        points: Floats,
        used: Integers,
        more: Iterable[Link] = (),
        written: Callable[[int], int] = int,
    ) -> Joints | None:
        """Return the joints of the mesh that the links make.

        Parameters
        ----------
        numbers, points : array, shape (n,) and (n, 3)
            Numbers of all nodes of the file, ascending, and their coordinates.
        used : int array
            Indices of the nodes of the mesh.
        more : iterable of links
            Further links, which do not count.
        written : callable
            Returns the number of a node as the file has it, for messages.

        Raises
        ------
        InputError
            If a node of a link is not in the file.
        """
        links = [*(link for _, link in self.stated), *more]
        if not links:
            return None
        unknowns = _Unknowns(numbers, points, used, written)
        equations = [row for link in links for row in unknowns.equations(link)]
        return solved_joints([row for row in equations if row], AXES * len(used))


class _Unknowns:
    """Numbers of unknowns: 3 times a node of the mesh plus an axis, and above these all
    others as they come.
    """

    def __init__(
        self, numbers: Integers, points: Floats, used: Integers, written: Callable[[int], int]
    ) -> None:
        self._numbers, self._points = numbers, points
        self._written = written
        self._used: dict[object, int] = {
            int(number): index for index, number in enumerate(numbers[used].tolist())
        }
        self._others: dict[object, int] = {}
        self._made = 0
        self._extent = float(np.ptp(points[used], axis=0).max(initial=0.0))

    def number(self, node: object, component: int) -> int:
        """Return the number of the unknown of a component of the motion of a node."""
        index = self._used.get(node)
        if component < AXES and index is not None:
            return AXES * index + component
        return self._others.setdefault(
            (node, component), AXES * len(self._used) + len(self._others)
        )

    def at(self, line: TextLine, node: int) -> Floats:
        """Return the place of a node.

        Raises
        ------
        InputError
            If it is not in the file.
        """
        index = int(np.searchsorted(self._numbers, node))
        if index == len(self._numbers) or self._numbers[index] != node:
            raise line.wrong(
                f"the node {self._written(node)} that is joined here is not in the file; "
                "every node must be in it"
            )
        return np.asarray(self._points[index])

    def _arm(self, line: TextLine, node: int, centre: Floats) -> Floats:
        """Return where a node is from a centre; zero if it is there but for rounding,
        which would be a hinge in any direction.
        """
        arm = self.at(line, node) - centre
        if np.linalg.norm(arm) < _TOGETHER * self._extent:
            return np.zeros_like(arm)
        return np.where(np.abs(arm) < _ROUNDING * self._extent, 0.0, arm)

    def _owner(self) -> object:
        """Return a new owner of unknowns that is no node."""
        self._made += 1
        return ("made", self._made)

    def equations(self, link: Link) -> list[Terms]:
        """Return the equations of a link; terms that meet are added."""
        if isinstance(link, Equation):
            for (node, _), _ in link.terms:
                if node not in self._used:
                    self.at(link.line, node)  # raises if the file does not have it
            return [_sum((self.number(*free), value) for free, value in link.terms)]
        if isinstance(link, Rigid):
            return self._rigid(link)
        return self._mean(link) if isinstance(link, Mean) else self._distance(link)

    def _rigid(self, link: Rigid) -> list[Terms]:
        leads = next(
            (node for node, components in link.members if len(set(components)) == COMPONENTS), None
        )
        owner = self._owner() if leads is None else leads
        centre = self.at(link.line, link.members[0][0] if leads is None else leads)
        rows = []
        for node, components in link.members:
            if node == leads:
                continue
            turned = rotation_columns(*self._arm(link.line, node, centre)[:, None])[0]
            for component in components:
                moved = [(self.number(owner, component), -1.0)]
                if component < AXES:
                    moved += [
                        (self.number(owner, AXES + axis), -float(turned[component, axis]))
                        for axis in range(AXES)
                    ]
                rows.append(_sum([(self.number(node, component), 1.0), *moved]))
        return rows

    def _mean(self, link: Mean) -> list[Terms]:
        """The rigid motion that fits the displacements of the others best, with weights (of RBE3
        and of couplings), at the node.

        What the others do not show, as the rotation about the line on which they lie, may take any
        value.
        """
        centre = self.at(link.line, link.node)
        arms = np.array([self._arm(link.line, node, centre) for node, _, _ in link.members])
        weights = np.array([weight for _, weight, _ in link.members])
        weights /= weights.max()
        middle = weights @ arms / weights.sum()
        beside = arms - middle
        length = float(np.abs(beside).max(initial=0.0))
        length = length if length > _TOGETHER * self._extent else 1.0
        rigid = np.concatenate(
            [np.broadcast_to(np.eye(3), (len(arms), 3, 3)), rotation_columns(*(beside / length).T)],
            axis=2,
        )
        counted = np.array([[axis in axes for axis in range(AXES)] for _, _, axes in link.members])
        root = (np.sqrt(weights)[:, None] * counted).ravel()
        rows = np.zeros((max(len(root), COMPONENTS), COMPONENTS))
        rows[: len(root)] = root[:, None] * rigid.reshape(-1, COMPONENTS)
        left, sizes, right = np.linalg.svd(rows, full_matrices=False)
        shown = sizes > _LOOSE * sizes[0]
        at_node = np.eye(COMPONENTS)
        at_node[:AXES, AXES:] = rotation_columns(*(-middle / length)[:, None])[0]
        fit = at_node @ (right[shown].T / sizes[shown]) @ left[: len(root), shown].T * root
        loose = at_node @ right[~shown].T
        loose[np.abs(loose) < _NONE * np.abs(at_node).max()] = 0.0
        fit[AXES:] /= length
        loose[AXES:] /= length
        owner = self._owner()
        unknowns = [self.number(node, axis) for node, _, _ in link.members for axis in range(AXES)]
        unknowns += [self.number(owner, index) for index in range(loose.shape[1])]
        shares = -np.concatenate([fit, loose], axis=1)
        return [
            _sum(
                [
                    (self.number(link.node, component), 1.0),
                    *zip(unknowns, shares[component].tolist(), strict=True),
                ]
            )
            for component in link.components
        ]

    def _distance(self, link: Distance) -> list[Terms]:
        first, second = link.nodes
        apart = self.at(link.line, second) - self.at(link.line, first)
        size = float(np.linalg.norm(apart))
        if not size > _TOGETHER * self._extent:
            raise link.line.wrong(
                "the two nodes whose distance is kept are at the same place; they must lie apart"
            )
        along = (apart / size).tolist()
        ends = [(self.number(second, axis), value) for axis, value in enumerate(along)]
        return [
            _sum([*ends, *((self.number(first, axis), -value) for axis, value in enumerate(along))])
        ]


def equation_of(line: TextLine, terms: Sequence[tuple[Free, float]]) -> Equation | None:
    """Return the equation of terms, of which some may be zero or of one component; None
    if one alone is left, which is a support.
    """
    found: dict[Free, float] = {}
    for free, value in terms:
        found[free] = found.get(free, 0.0) + value
    left = [(free, value) for free, value in found.items() if value != 0.0]
    return None if len(left) == 1 or not terms else Equation(line, left)


def _nodes_of(link: Link) -> list[int]:
    """Return the numbers of the nodes of a link."""
    if isinstance(link, Equation):
        return [node for (node, _), _ in link.terms]
    if isinstance(link, Distance):
        return list(link.nodes)
    members = [member[0] for member in link.members]
    return [link.node, *members] if isinstance(link, Mean) else members


def _sum(terms: Iterable[tuple[int, float]]) -> Terms:
    """Return an equation without terms that are zero but for rounding, as where a node is
    one of those whose mean it is.
    """
    found: Terms = {}
    largest = 0.0
    for unknown, value in terms:
        found[unknown] = found.get(unknown, 0.0) + value
        largest = max(largest, abs(value))
    return {unknown: value for unknown, value in found.items() if abs(value) > _ROUNDING * largest}
