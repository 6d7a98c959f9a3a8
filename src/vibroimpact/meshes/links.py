"""Links between nodes that a mesh file states, as linear equations of their motions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats, Integers
from vibroimpact.meshes.text_files import TextLine
from vibroimpact.structures.finite_elements.joints import AXES, Joints, Terms, solved_joints
from vibroimpact.structures.finite_elements.structure import rotation_columns

COMPONENTS = 6
"""Of the motion of a node: three displacements, and three rotations."""

_COINCIDENT = 5e-7
"""Distance over the extent of the mesh below which nodes coincide.

Files round coordinates to seven digits.
"""

_ROUNDING = 1e-12
"""Size below which a component of an arm, over the extent of the mesh, is rounding.

So is a coefficient, over the largest one of its equation.
"""

_INDETERMINATE = 1e-6
"""Singular value, over the largest, below which a rigid motion does not follow from the nodes."""

_NO_COEFFICIENT = 1e-9
"""Coefficient of such a motion, over the largest, below which it is rounding."""

Free = tuple[int, int]
"""A node and a component of its motion, from 0."""


class Equation(NamedTuple):
    """A sum of components of motion that is zero."""

    line: TextLine
    terms: Sequence[tuple[Free, float]]


class Rigid(NamedTuple):
    """Components of the motion of nodes that follow one rigid motion.

    If all six components of a node are among them, it is the motion of this node.
    """

    line: TextLine
    members: Sequence[tuple[int, Sequence[int]]]


class Mean(NamedTuple):
    """Components of the motion of a node that are the mean motion of others.

    This is the rigid motion that fits their displacements best. Each member is a node, its weight,
    and those of its displacements that count.
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
        """Return the names of the links of some nodes, and how many there are of each.

        The nodes are given by their numbers in the file.
        """
        if not self.stated:
            return {}
        chosen = set(nodes.tolist())
        return dict(
            Counter(name for name, link in self.stated if not chosen.isdisjoint(_nodes_of(link)))
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
        equations = [equation for link in links for equation in unknowns.equations(link)]
        return solved_joints([equation for equation in equations if equation], AXES * len(used))


class _Unknowns:
    """Numbers of the unknowns of the equations.

    A displacement of a node of the mesh is 3 times the node plus the axis. Above these are all
    others as they come: rotations, the motion of other nodes, and of nothing but a link.
    """

    def __init__(
        self, numbers: Integers, points: Floats, used: Integers, written: Callable[[int], int]
    ) -> None:
        self._numbers = numbers
        self._points = points
        self._written = written
        self._mesh_nodes: dict[object, int] = {
            int(number): index for index, number in enumerate(numbers[used].tolist())
        }
        self._others: dict[object, int] = {}
        self._owners = 0
        self._extent = float(np.ptp(points[used], axis=0).max(initial=0.0))

    def number(self, owner: object, component: int) -> int:
        """Return the number of the unknown of a component of the motion of a node or a link."""
        index = self._mesh_nodes.get(owner)
        if component < AXES and index is not None:
            return AXES * index + component
        return self._others.setdefault(
            (owner, component), AXES * len(self._mesh_nodes) + len(self._others)
        )

    def position(self, line: TextLine, node: int) -> Floats:
        """Return the position of a node.

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
        """Return the vector from a centre to a node; zero if they coincide but for rounding.

        An arm of rounding alone would be a hinge in any direction.
        """
        arm = self.position(line, node) - centre
        if np.linalg.norm(arm) < _COINCIDENT * self._extent:
            return np.zeros_like(arm)
        return np.where(np.abs(arm) < _ROUNDING * self._extent, 0.0, arm)

    def _new_owner(self) -> object:
        """Return a new owner of unknowns that is no node."""
        self._owners += 1
        return ("made", self._owners)

    def equations(self, link: Link) -> list[Terms]:
        """Return the equations of a link; coefficients of the same unknown are added."""
        if isinstance(link, Equation):
            return self._equation(link)
        if isinstance(link, Rigid):
            return self._rigid(link)
        if isinstance(link, Mean):
            return self._mean(link)
        return self._distance(link)

    def _equation(self, link: Equation) -> list[Terms]:
        for (node, _), _ in link.terms:
            if node not in self._mesh_nodes:
                self.position(link.line, node)  # raises if the file does not have it
        return [_sum((self.number(*free), coefficient) for free, coefficient in link.terms)]

    def _rigid(self, link: Rigid) -> list[Terms]:
        """Return the equations of nodes that follow one rigid motion.

        It is u + theta x arm, with the motion u and theta of a node that leads with all its
        components, or else of unknowns of the link itself, at its first node.
        """
        leader = next(
            (node for node, components in link.members if len(set(components)) == COMPONENTS), None
        )
        owner: object
        if leader is None:
            owner = self._new_owner()
            first_node, _ = link.members[0]
            centre = self.position(link.line, first_node)
        else:
            owner = leader
            centre = self.position(link.line, leader)
        equations = []
        for node, components in link.members:
            if node == leader:
                continue
            # displacements by unit rotations, a column for each axis
            arm = self._arm(link.line, node, centre)
            by_rotation = rotation_columns(*arm[:, None])[0]
            for component in components:
                followed = [(self.number(owner, component), -1.0)]
                if component < AXES:
                    for axis in range(AXES):
                        rotation = self.number(owner, AXES + axis)
                        followed.append((rotation, -float(by_rotation[component, axis])))
                equations.append(_sum([(self.number(node, component), 1.0), *followed]))
        return equations

    def _mean(self, link: Mean) -> list[Terms]:
        """Return the equations of a node that follows the mean motion of others.

        Of this kind are RBE3 of Nastran and the distributing coupling of Abaqus.
        """
        centre = self.position(link.line, link.node)
        arms = []
        weights = []
        counted = []
        unknowns = []
        for node, weight, axes in link.members:
            arms.append(self._arm(link.line, node, centre))
            weights.append(weight)
            counted.append([axis in axes for axis in range(AXES)])
            unknowns += [self.number(node, axis) for axis in range(AXES)]
        coincident = _COINCIDENT * self._extent
        fit, indeterminate = _mean_motion(
            np.array(arms), np.array(weights), np.array(counted), coincident
        )
        # what the members do not show of the motion is an unknown of the link itself
        owner = self._new_owner()
        unknowns += [self.number(owner, index) for index in range(indeterminate.shape[1])]
        # u - fit u_members - indeterminate q = 0
        coefficients = -np.concatenate([fit, indeterminate], axis=1)
        equations = []
        for component in link.components:
            followed = zip(unknowns, coefficients[component].tolist(), strict=True)
            equations.append(_sum([(self.number(link.node, component), 1.0), *followed]))
        return equations

    def _distance(self, link: Distance) -> list[Terms]:
        """Return the equation of two nodes with the same displacement along their line."""
        first, second = link.nodes
        arm = self.position(link.line, second) - self.position(link.line, first)
        length = float(np.linalg.norm(arm))
        if not length > _COINCIDENT * self._extent:
            raise link.line.wrong(
                "the two nodes whose distance is kept are at the same place; they must lie apart"
            )
        # e . (u_2 - u_1) = 0, with the unit vector e of the line
        direction = (arm / length).tolist()
        terms = [(self.number(second, axis), cosine) for axis, cosine in enumerate(direction)]
        terms += [(self.number(first, axis), -cosine) for axis, cosine in enumerate(direction)]
        return [_sum(terms)]


def _mean_motion(
    arms: Floats, weights: Floats, counted: Bools, coincident: float
) -> tuple[Floats, Floats]:
    """Return the rigid motion at a node that fits the displacements of others best.

    The fit is that of least squares with weights.

    Parameters
    ----------
    arms : array, shape (members, 3)
        Vectors from the node to the others.
    weights : array, shape (members,)
        Their weights.
    counted : bool array, shape (members, 3)
        Which of their displacements count.
    coincident : float
        Distance below which they are all at one point.

    Returns
    -------
    fit : array, shape (6, 3 members)
        The motion for unit displacements of the others.
    indeterminate : array, shape (6, n)
        The motions that these do not show, as the rotation about the line on which all of them lie,
        and which may take any value.
    """
    weights = weights / weights.max()
    mean_arm = weights @ arms / weights.sum()
    from_mean = arms - mean_arm
    # lengths are counted in a unit of the size of the group, so that rotations and displacements
    # are of the same order
    unit = float(np.abs(from_mean).max(initial=0.0))
    if not unit > coincident:
        unit = 1.0
    # displacements of the members by the six rigid motions about the weighted mean
    translations = np.broadcast_to(np.eye(3), (len(arms), 3, 3))
    rotations = rotation_columns(*(from_mean / unit).T)
    rigid = np.concatenate([translations, rotations], axis=2)
    root_weights = (np.sqrt(weights)[:, None] * counted).ravel()
    # least squares by the singular values of W^1/2 A, at least six rows, so that there are six
    number = len(root_weights)
    rows = np.zeros((max(number, COMPONENTS), COMPONENTS))
    rows[:number] = root_weights[:, None] * rigid.reshape(-1, COMPONENTS)
    left, singular_values, right = np.linalg.svd(rows, full_matrices=False)
    shown = singular_values > _INDETERMINATE * singular_values[0]
    # the motion at the node of a rigid motion about the mean: u + theta x (-mean arm)
    at_node = np.eye(COMPONENTS)
    at_node[:AXES, AXES:] = rotation_columns(*(-mean_arm / unit)[:, None])[0]
    inverse = right[shown].T / singular_values[shown]
    fit = at_node @ inverse @ left[:number, shown].T * root_weights
    indeterminate = at_node @ right[~shown].T
    indeterminate[np.abs(indeterminate) < _NO_COEFFICIENT * np.abs(at_node).max()] = 0.0
    # rotations are per unit of length again
    fit[AXES:] /= unit
    indeterminate[AXES:] /= unit
    return fit, indeterminate


def equation_of(line: TextLine, terms: Sequence[tuple[Free, float]]) -> Equation | None:
    """Return the equation of terms, of which some may be zero or of the same component.

    None if a single term is left, which is a support.
    """
    coefficients: dict[Free, float] = {}
    for free, coefficient in terms:
        coefficients[free] = coefficients.get(free, 0.0) + coefficient
    nonzero = [(free, coefficient) for free, coefficient in coefficients.items() if coefficient]
    if len(nonzero) == 1 or not terms:
        return None
    return Equation(line, nonzero)


def _nodes_of(link: Link) -> list[int]:
    """Return the numbers of the nodes of a link."""
    if isinstance(link, Equation):
        return [node for (node, _), _ in link.terms]
    if isinstance(link, Distance):
        return list(link.nodes)
    members = [member[0] for member in link.members]
    if isinstance(link, Mean):
        return [link.node, *members]
    return members


def _sum(terms: Iterable[tuple[int, float]]) -> Terms:
    """Return an equation without coefficients that are zero but for rounding.

    Such terms arise where a node is one of those whose mean it is.
    """
    coefficients: Terms = {}
    largest = 0.0
    for unknown, coefficient in terms:
        coefficients[unknown] = coefficients.get(unknown, 0.0) + coefficient
        largest = max(largest, abs(coefficient))
    return {
        unknown: coefficient
        for unknown, coefficient in coefficients.items()
        if abs(coefficient) > _ROUNDING * largest
    }
