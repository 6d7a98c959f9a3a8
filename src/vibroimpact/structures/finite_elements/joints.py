"""Joints of a mesh: displacements of nodes that follow those of others.

They follow from linear equations between displacements.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array

from vibroimpact.arrays import Bools, Floats, Integers
from vibroimpact.errors import InputError

AXES = 3
"""Displacements of a node."""

_NONE = 1e-9  # of the largest coefficient of an equation: smaller ones are rounding
# of the largest coefficient of an equation: a displacement with less does not follow the others
_PIVOT = 0.1
_MOST_DENSE = 50_000_000  # numbers in the equations of rigid parts that hang together
_HUB = 100  # nodes: a node that moves more than these is eliminated last

Terms = dict[int, float]
"""A linear equation: the coefficient of each unknown, whose sum is zero."""


@dataclass(frozen=True)
class Joints:
    """Displacements that follow others.

    Parameters
    ----------
    followers : int array, shape (n,)
        The following displacements, each numbered 3 times its node plus its axis.
    weights : sparse array, shape (n, 3 nodes)
        Each follower as a sum of displacements that do not follow.

    Examples
    --------
    >>> joints = solved_joints([{0: 1.0, 3: -1.0}, {3: 1.0, 6: -2.0}], 9)
    >>> joints.followers.tolist(), joints.weights.toarray()[:, 3].tolist()
    ([0, 6], [1.0, 0.5])
    """

    followers: Integers
    weights: csr_array

    @property
    def pairs(self) -> tuple[Integers, Integers]:
        """Nodes of followers, and the nodes that move them."""
        entries = self.weights.tocoo()
        return self.followers[entries.row] // AXES, entries.col // AXES

    @property
    def nodes(self) -> Integers:
        """The nodes that the joints concern."""
        return np.unique(np.concatenate([self.followers // AXES, self.weights.indices // AXES]))

    def rows(self) -> list[tuple[int, Terms]]:
        """Return each follower with the weights of the displacements that move it."""
        starts = self.weights.indptr.tolist()
        columns = self.weights.indices.tolist()
        values = self.weights.data.tolist()
        rows = []
        for index, follower in enumerate(self.followers.tolist()):
            entries = slice(starts[index], starts[index + 1])
            rows.append((follower, dict(zip(columns[entries], values[entries], strict=True))))
        return rows

    def of_nodes(self, chosen: Bools) -> Joints | None:
        """Return the joints of chosen nodes, renumbered without the others; None if there are none.

        No joint may lead to others.
        """
        new_numbers = AXES * (np.cumsum(chosen) - 1)[:, None] + np.arange(AXES)
        is_chosen = np.repeat(chosen, AXES)  # of each displacement
        kept = is_chosen[self.followers]
        if not kept.any():
            return None
        weights = csr_array(self.weights[kept][:, np.flatnonzero(is_chosen)])
        return Joints(new_numbers.ravel()[self.followers[kept]], weights)


def solved_joints(equations: Sequence[Terms], displacements: int) -> Joints | None:
    """Return the joints that equations between unknowns make; None if they make none.

    Parameters
    ----------
    equations : sequence of dict
        Coefficients by the number of the unknown.
    displacements : int
        Number of displacements of nodes of the mesh: unknowns from this number on are others, such
        as rotations, that may take any value.

    Raises
    ------
    InputError
        If too many of the other unknowns hang together.

    Notes
    -----
    The other unknowns are eliminated: of the equations with them, those combinations remain that
    hold for some value of these. Then each equation is solved for one displacement, if possible for
    one that occurs in no other.
    """
    remaining = _without_other_unknowns(equations, displacements)
    uses = Counter(unknown for equation in remaining for unknown in equation)
    ties: dict[int, Terms] = {}  # each follower in terms of other displacements
    for equation in remaining:
        terms = _substituted(equation, ties)
        largest = max(map(abs, terms.values()), default=0.0)
        if not largest > _NONE * max(map(abs, equation.values())):
            continue  # it follows from earlier equations
        pivots = [unknown for unknown, value in terms.items() if abs(value) >= _PIVOT * largest]
        # the one in the fewest equations; of several, the highest number
        follower = min(pivots, key=lambda unknown: (uses[unknown], -unknown))
        pivot = terms.pop(follower)
        ties[follower] = {
            unknown: -value / pivot
            for unknown, value in terms.items()
            if abs(value) > _NONE * _PIVOT * largest
        }
    return _resolved(ties, displacements) if ties else None


def _substituted(equation: Terms, ties: dict[int, Terms]) -> Terms:
    """Return an equation in terms of displacements that do not follow others so far."""
    stack = list(equation.items())
    terms = dict[int, float]()
    while stack:
        unknown, value = stack.pop()
        if unknown in ties:
            stack += [(mover, value * weight) for mover, weight in ties[unknown].items()]
        else:
            terms[unknown] = terms.get(unknown, 0.0) + value
    return terms


def _resolved(ties: dict[int, Terms], displacements: int) -> Joints:
    """Return the joints of ties, of which earlier ones may lead to followers of later ones."""
    followers = np.array(sorted(ties), dtype=np.int64)
    rows = []
    columns = []
    values = []
    for row, follower in enumerate(followers.tolist()):
        for unknown, value in ties[follower].items():
            rows.append(row)
            columns.append(unknown)
            values.append(value)
    weights = csr_array(
        coo_array(
            (
                np.array(values, dtype=np.float64),
                (np.array(rows, dtype=np.int64), np.array(columns, dtype=np.int64)),
            ),
            shape=(len(followers), displacements),
        ),
        dtype=np.float64,
    )
    row_of_follower = np.full(displacements, -1)
    row_of_follower[followers] = np.arange(len(followers))
    # substitute followers until none is left among the displacements that move others
    while (leads_to_follower := row_of_follower[weights.indices] >= 0).any():
        entries = weights.tocoo()
        is_direct = ~leads_to_follower
        indirect = coo_array(
            (
                entries.data[leads_to_follower],
                (
                    entries.row[leads_to_follower],
                    row_of_follower[entries.col[leads_to_follower]],
                ),
            ),
            shape=(len(followers), len(followers)),
        )
        direct = coo_array(
            (entries.data[is_direct], (entries.row[is_direct], entries.col[is_direct])),
            shape=weights.shape,
        )
        weights = csr_array(direct.tocsr() + indirect.tocsr() @ weights)
    return Joints(followers, weights)


def _without_other_unknowns(equations: Sequence[Terms], displacements: int) -> list[Terms]:
    """Return the equations that remain once all unknowns but displacements are eliminated."""
    binding = [equations[number] for number in _that_bind(equations, displacements)]
    remaining = [
        equation
        for equation in equations
        if not any(unknown >= displacements for unknown in equation)
    ]
    for members in _hanging_together(binding, displacements):
        remaining += _eliminated([binding[member] for member in members], displacements)
    return remaining


def _eliminated(equations: list[Terms], displacements: int) -> list[Terms]:
    """Return those combinations of equations in which unknowns from `displacements` on cancel.

    Raises
    ------
    InputError
        If there are too many.
    """
    from scipy.linalg import qr

    matrix = _coefficients_of_others(equations, displacements)
    # independent equations, of which the others are combinations as far as the matrix goes
    triangle, order = qr(matrix.T, mode="r", pivoting=True)
    diagonal = np.abs(np.diagonal(triangle))
    rank = int((diagonal > _NONE * diagonal[0]).sum())
    independent = order[:rank]
    dependent = order[rank:]
    shares = np.linalg.lstsq(matrix[independent].T, matrix[dependent].T, rcond=None)[0].T
    of_displacements = [
        {unknown: value for unknown, value in equation.items() if unknown < displacements}
        for equation in equations
    ]
    remaining = []
    for index, row_shares in zip(dependent.tolist(), shares.tolist(), strict=True):
        terms = of_displacements[index].copy()
        for share, base in zip(row_shares, independent.tolist(), strict=True):
            if not share:
                continue
            for unknown, value in of_displacements[base].items():
                terms[unknown] = terms.get(unknown, 0.0) - share * value
        scale = max([*map(abs, equations[index].values()), *map(abs, row_shares)])
        terms = {unknown: value for unknown, value in terms.items() if abs(value) > _NONE * scale}
        if terms:
            remaining.append(terms)
    return remaining


def _coefficients_of_others(equations: list[Terms], displacements: int) -> Floats:
    """Return the coefficients of unknowns from `displacements` on, (equations, unknowns).

    Columns are of unit norm.

    Raises
    ------
    InputError
        If there are too many.
    """
    others = sorted(
        {unknown for equation in equations for unknown in equation if unknown >= displacements}
    )
    if len(equations) * len(others) > _MOST_DENSE:
        raise InputError(
            f"{len(equations)} equations of rigid parts are linked through rotations or "
            "nodes off the mesh, which is too many; replace "
            "chains of rigid parts by one that joins the nodes of the mesh directly, or "
            "leave parts out"
        )
    column_of = {unknown: column for column, unknown in enumerate(others)}
    matrix = np.zeros((len(equations), len(others)))
    for row, equation in enumerate(equations):
        for unknown, value in equation.items():
            if unknown >= displacements:
                matrix[row, column_of[unknown]] = value
    matrix /= np.linalg.norm(matrix, axis=0)
    return matrix


def _that_bind(equations: Sequence[Terms], displacements: int) -> list[int]:
    """Return the numbers of the equations that bind unknowns from `displacements` on.

    Left out are equations that hold for some value of such an unknown, which is in no other
    equation, as the rotation of a node that follows a rigid part.
    """
    unknowns_of = {
        number: {unknown for unknown in equation if unknown >= displacements}
        for number, equation in enumerate(equations)
    }
    uses: dict[int, set[int]] = {}  # the equations of each unknown
    for number, unknowns in unknowns_of.items():
        for unknown in unknowns:
            uses.setdefault(unknown, set()).add(number)
    used_once = [unknown for unknown, numbers in uses.items() if len(numbers) == 1]
    while used_once:
        for number in uses[used_once.pop()].copy():
            for unknown in unknowns_of.pop(number):
                uses[unknown].discard(number)
                if len(uses[unknown]) == 1:
                    used_once.append(unknown)
    return [number for number, unknowns in unknowns_of.items() if unknowns]


def _hanging_together(equations: Sequence[Terms], displacements: int) -> list[list[int]]:
    """Return the numbers of equations in groups that share unknowns from `displacements` on."""
    from scipy.sparse.csgraph import connected_components

    if not equations:
        return []
    numbers = []
    unknowns = []
    for number, equation in enumerate(equations):
        for unknown in equation:
            if unknown >= displacements:
                numbers.append(number)
                unknowns.append(unknown)
    # a graph of equations, followed by unknowns
    _, column = np.unique(np.array(unknowns, dtype=np.int64), return_inverse=True)
    size = len(equations) + int(column.max()) + 1
    graph = coo_array(
        (np.ones(len(numbers)), (np.array(numbers, dtype=np.int64), len(equations) + column)),
        shape=(size, size),
    )
    labels = connected_components(graph, directed=False)[1][: len(equations)]
    order = np.argsort(labels, kind="stable")
    ends = np.flatnonzero(np.diff(labels[order])) + 1
    return [group.tolist() for group in np.split(order, ends)]


def joined_adjacency(adjacency: csr_array, joints: Joints) -> csr_array:
    """Return the pattern of coupled nodes once followers are expressed by nodes that move them."""
    nodes = adjacency.shape[0]
    follower, mover = joints.pairs
    movers = csr_array(coo_array((np.ones(len(follower)), (follower, mover)), shape=(nodes, nodes)))
    every_node = np.arange(nodes)
    identity = csr_array(
        coo_array((np.ones(nodes), (every_node, every_node)), shape=(nodes, nodes))
    )
    expansion = csr_array(movers + identity)
    return csr_array(expansion.T @ adjacency @ expansion)


def hubs(joints: Joints, nodes: int) -> Bools:
    """Return a mask of the nodes that move so many others that they are to be eliminated last."""
    follower, mover = joints.pairs
    pairs = np.unique(np.stack([mover, follower]), axis=1)
    return np.asarray(np.bincount(pairs[0], minlength=nodes) > _HUB)
