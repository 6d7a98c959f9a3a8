"""Joints of a mesh: displacements of nodes that follow those of others, from linear
equations between displacements.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array

from vibroimpact.arrays import Bools, Integers
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
        starts, columns, values = (
            part.tolist() for part in (self.weights.indptr, self.weights.indices, self.weights.data)
        )
        return [
            (follower, dict(zip(columns[start:end], values[start:end], strict=True)))
            for follower, start, end in zip(
                self.followers.tolist(), starts[:-1], starts[1:], strict=True
            )
        ]

    def of_nodes(self, chosen: Bools) -> Joints | None:
        """Return the joints of chosen nodes, renumbered without the others; None if there
        are none. No joint may lead to others.
        """
        places = AXES * (np.cumsum(chosen) - 1)[:, None] + np.arange(AXES)
        columns = np.repeat(chosen, AXES)
        mine = columns[self.followers]
        if not mine.any():
            return None
        return Joints(
            places.ravel()[self.followers[mine]],
            csr_array(self.weights[mine][:, np.flatnonzero(columns)]),
        )


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
    waiting = [*_without_others(equations, displacements)]
    uses = Counter(unknown for row in waiting for unknown in row)
    ties: dict[int, Terms] = {}
    for row in waiting:
        found = _substituted(row, ties)
        largest = max(map(abs, found.values()), default=0.0)
        if not largest > _NONE * max(map(abs, row.values())):
            continue  # it follows from those before
        able = [unknown for unknown, value in found.items() if abs(value) >= _PIVOT * largest]
        follower = min(able, key=lambda unknown: (uses[unknown], -unknown))
        scale = found.pop(follower)
        ties[follower] = {
            unknown: -value / scale
            for unknown, value in found.items()
            if abs(value) > _NONE * _PIVOT * largest
        }
    return _resolved(ties, displacements) if ties else None


def _substituted(row: Terms, ties: dict[int, Terms]) -> Terms:
    """Return an equation in terms of displacements that do not follow others so far."""
    waiting, found = list(row.items()), dict[int, float]()
    while waiting:
        unknown, value = waiting.pop()
        if unknown in ties:
            waiting += [(other, value * share) for other, share in ties[unknown].items()]
        else:
            found[unknown] = found.get(unknown, 0.0) + value
    return found


def _resolved(ties: dict[int, Terms], displacements: int) -> Joints:
    """Return the joints of ties, of which earlier ones may lead to followers of later ones."""
    followers = np.array(sorted(ties), dtype=np.int64)
    entries = [
        (row, unknown, value)
        for row, one in enumerate(followers.tolist())
        for unknown, value in ties[one].items()
    ]
    rows, columns, values = (
        (np.array(side) for side in zip(*entries, strict=True))
        if entries
        else (np.zeros(0, int),) * 3
    )
    weights = csr_array(
        coo_array((values, (rows, columns)), shape=(len(followers), displacements)),
        dtype=np.float64,
    )
    place = np.full(displacements, -1)
    place[followers] = np.arange(len(followers))
    while len(followed := np.flatnonzero(place[weights.indices] >= 0)):
        entry = weights.tocoo()
        direct = np.ones(len(entry.data), dtype=bool)
        direct[followed] = False
        through = coo_array(
            (entry.data[followed], (entry.row[followed], place[entry.col[followed]])),
            shape=(len(followers), len(followers)),
        )
        straight = coo_array(
            (entry.data[direct], (entry.row[direct], entry.col[direct])), shape=weights.shape
        )
        weights = csr_array(straight.tocsr() + through.tocsr() @ weights)
    return Joints(followers, weights)


def _without_others(equations: Sequence[Terms], displacements: int) -> list[Terms]:
    """Return the equations that remain once the unknowns that are no displacements are
    eliminated.
    """
    from scipy.linalg import qr

    with_others = _that_bind(equations, displacements)
    found = [row for row in equations if not any(unknown >= displacements for unknown in row)]
    for members in _hanging_together([equations[index] for index in with_others], displacements):
        rows = [equations[with_others[index]] for index in members]
        others = sorted({unknown for row in rows for unknown in row if unknown >= displacements})
        if len(rows) * len(others) > _MOST_DENSE:
            raise InputError(
                f"{len(rows)} equations of rigid parts are linked through rotations or "
                "nodes off the mesh, which is too many; replace "
                "chains of rigid parts by one that joins the nodes of the mesh directly, or "
                "leave parts out"
            )
        place = {unknown: index for index, unknown in enumerate(others)}
        matrix = np.zeros((len(rows), len(others)))
        for index, row in enumerate(rows):
            for unknown, value in row.items():
                if unknown >= displacements:
                    matrix[index, place[unknown]] = value
        matrix /= np.linalg.norm(matrix, axis=0)
        triangle, order = qr(matrix.T, mode="r", pivoting=True)
        diagonal = np.abs(np.diagonal(triangle))
        rank = int((diagonal > _NONE * diagonal[0]).sum())
        solved, rest = order[:rank], order[rank:]
        shares = np.linalg.lstsq(matrix[solved].T, matrix[rest].T, rcond=None)[0].T
        bases = [
            {unknown: value for unknown, value in rows[index].items() if unknown < displacements}
            for index in solved
        ]
        for index, share in zip(rest.tolist(), shares.tolist(), strict=True):
            left = {
                unknown: value for unknown, value in rows[index].items() if unknown < displacements
            }
            for factor, base in zip(share, bases, strict=True):
                for unknown, value in base.items() if factor else ():
                    left[unknown] = left.get(unknown, 0.0) - factor * value
            size = max([*map(abs, rows[index].values()), *map(abs, share)])
            left = {unknown: value for unknown, value in left.items() if abs(value) > _NONE * size}
            if left:
                found.append(left)
    return found


def _that_bind(equations: Sequence[Terms], displacements: int) -> list[int]:
    """Return the numbers of the equations with unknowns from `displacements` on, but for those that
    hold for some value of one of these.

    Such an unknown is in no other equation, as the rotation of a node that follows a rigid part.
    """
    others = {
        index: {unknown for unknown in row if unknown >= displacements}
        for index, row in enumerate(equations)
    }
    uses: dict[int, set[int]] = {}
    for index, unknowns in others.items():
        for unknown in unknowns:
            uses.setdefault(unknown, set()).add(index)
    waiting = [unknown for unknown, rows in uses.items() if len(rows) == 1]
    while waiting:
        for index in uses[waiting.pop()].copy():
            for unknown in others.pop(index):
                uses[unknown].discard(index)
                if len(uses[unknown]) == 1:
                    waiting.append(unknown)
    return [index for index, unknowns in others.items() if unknowns]


def _hanging_together(rows: Sequence[Terms], displacements: int) -> list[list[int]]:
    """Return the numbers of rows in groups that share unknowns from `displacements` on."""
    from scipy.sparse.csgraph import connected_components

    if not rows:
        return []
    pairs = [
        (row, unknown)
        for row, terms in enumerate(rows)
        for unknown in terms
        if unknown >= displacements
    ]
    row, unknown = (np.array(side, dtype=np.int64) for side in zip(*pairs, strict=True))
    _, column = np.unique(unknown, return_inverse=True)
    size = len(rows) + int(column.max()) + 1
    graph = coo_array((np.ones(len(row)), (row, len(rows) + column)), shape=(size, size))
    labels = connected_components(graph, directed=False)[1][: len(rows)]
    order = np.argsort(labels, kind="stable")
    return [part.tolist() for part in np.split(order, np.flatnonzero(np.diff(labels[order])) + 1)]


def joined_adjacency(adjacency: csr_array, joints: Joints) -> csr_array:
    """Return the pattern of nodes that are coupled once followers are expressed by the
    nodes that move them.
    """
    number = adjacency.shape[0]
    follower, mover = joints.pairs
    moved = csr_array(
        coo_array((np.ones(len(follower)), (follower, mover)), shape=(number, number))
    )
    whole = csr_array(
        moved
        + csr_array(coo_array((np.ones(number), (np.arange(number),) * 2), shape=(number, number)))
    )
    return csr_array(whole.T @ adjacency @ whole)


def hubs(joints: Joints, nodes: int) -> Bools:
    """Return a mask of the nodes that move so many others that they are to be eliminated last."""
    follower, mover = joints.pairs
    pairs = np.unique(np.stack([mover, follower]), axis=1)
    return np.asarray(np.bincount(pairs[0], minlength=nodes) > _HUB)
