"""Factorisation of a sparse symmetric matrix in nested-dissection order, with an estimate of the
memory of the factors beforehand.

Compared with it, SuperLU's minimum-degree order has less fill for plate elements (0.35 to 1), but
1.2 to 1.7 times the fill and two to three times the time for whole plates of bricks, the largest
systems here; and its fill is not known before the factorisation.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Bools, Floats, Integers
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.structures.free_memory import check_memory

_LEAF = 40  # nodes of a part that is not dissected further; smaller parts do not reduce the fill
_ROUNDING = 1e-15  # relative to the diagonal
# of the matrix; SuperLU reserves thirty times as many, and has 32-bit indices
_MAX_ENTRIES = 71_000_000
BYTES_PER_ENTRY = 12.0
"""Memory per entry of a sparse matrix or of its factors: value and row index."""


class Factors:
    """LU factors of a sparse symmetric matrix, with pivots on the diagonal.

    Parameters
    ----------
    matrix : sparse array, shape (n, n)
        Symmetric matrix.
    order : int array, shape (n,)
        Elimination order of its rows.

    Raises
    ------
    ComputationError
        If the matrix is singular, or the memory does not suffice.
    InputError
        If the matrix has more entries than SuperLU can index.
    """

    def __init__(self, matrix: csr_array, order: Integers) -> None:
        from scipy.sparse.linalg import splu  # imported late: modes that are stored do not need it

        self._order = order
        permuted = _without_rounding(matrix)[order][:, order].tocsc()
        if permuted.nnz > _MAX_ENTRIES:
            raise InputError(
                f"the factors for {len(order)} degrees of freedom may have more entries "
                "than the solver can number; use larger elements"
            )
        try:
            self._factors = splu(
                permuted,
                permc_spec="NATURAL",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
        except RuntimeError:
            raise ComputationError(
                "the stiffness matrix is singular: part of the body can move without resistance"
            ) from None
        except MemoryError:
            raise ComputationError(
                "there is not enough memory for the factors of the stiffness matrix; use "
                "larger elements"
            ) from None

    @property
    def entries(self) -> int:
        """Number of entries of the factors."""
        return int(self._factors.nnz)

    @property
    def size(self) -> float:
        """Approximate memory of the factors [bytes]."""
        return BYTES_PER_ENTRY * self.entries

    def negative_pivots(self) -> int:
        """Return the number of negative pivots, which is that of negative eigenvalues
        (Sylvester's law of inertia).
        """
        return int((self._factors.U.diagonal() < 0.0).sum())

    def solve(self, right: Floats) -> Floats:
        """Return the solution for one right-hand side (n,), or for several (n, columns)."""
        solution = np.empty_like(right)
        solution[self._order] = self._factors.solve(right[self._order])
        return solution


def _without_rounding(matrix: csr_array) -> csr_array:
    """Return a matrix without entries that are zero up to rounding: a fifth of all in a
    regular mesh.
    """
    whole = matrix.tocoo()
    size = np.sqrt(np.abs(matrix.diagonal()))
    keep = np.abs(whole.data) >= _ROUNDING * size[whole.row] * size[whole.col]
    return csr_array((whole.data[keep], (whole.row[keep], whole.col[keep])), shape=matrix.shape)


def nested_dissection(nodes: Floats, adjacency: csr_array) -> list[Integers]:
    """Return the nodes of a mesh in parts, in a fill-reducing elimination order.

    Parameters
    ----------
    nodes : array, shape (n, 3)
        Coordinates of the nodes.
    adjacency : sparse array, shape (n, n)
        Pattern of the nodes that share an element.

    Notes
    -----
    Nested dissection (A. George, SIAM J. Numer. Anal. 10:345, 1973): the nodes are cut in two by a
    plane across the longest side of their bounding box. Nodes of one half that are adjacent to the
    other half are the separator and are eliminated last; both halves are dissected in the same way.
    """
    other = np.zeros(len(nodes), dtype=bool)
    parts: list[Integers] = []
    waiting: list[tuple[Integers, bool]] = [(np.arange(len(nodes)), False)]
    while waiting:
        part, separates = waiting.pop()
        if separates or len(part) <= _LEAF:
            parts.append(part)
            continue
        low, touching = _best_cut(
            nodes[part, np.ptp(nodes[part], axis=0).argmax()], part, adjacency, other
        )
        first = part[low]
        if not len(first):
            parts.append(part)
            continue
        waiting += [(first[touching], True), (part[~low], False), (first[~touching], False)]
    return [part for part in parts if len(part)]


def _best_cut(
    at: Floats, part: Integers, adjacency: csr_array, other: Bools
) -> tuple[Bools, Bools]:
    """Return the nodes below the cut near the median with the smallest separator, and which of them
    are in the separator.

    Both are masks: the first of the nodes of the part, the second of those below the cut.
    """
    levels = np.unique(np.round(at, 12))
    middle = int(np.searchsorted(levels, np.median(at)))
    best = (np.zeros(len(part), dtype=bool), np.zeros(0, dtype=bool))
    for level in levels[max(0, middle - 1) : min(middle + 2, len(levels) - 1)]:
        low = at <= level + 1e-12
        other[part[~low]] = True
        neighbours, count = _neighbours(adjacency, part[low])
        touching = np.add.reduceat(other[neighbours], np.cumsum(count) - count, dtype=np.int64) > 0
        other[part[~low]] = False
        if not best[0].any() or touching.sum() < best[1].sum():
            best = low, touching
    return best


def factor_entries(parts: list[Integers], adjacency: csr_array) -> int:
    """Return an upper estimate of the number of entries of the factors for one degree of freedom
    per node.

    It follows from a symbolic factorisation in which each part is a dense block.
    """
    place = np.empty(adjacency.shape[0], dtype=np.int64)  # of a node in the elimination order
    owner = np.empty_like(place)
    order = np.concatenate(parts)
    place[order] = np.arange(len(order))
    ends = np.cumsum([len(part) for part in parts])
    for index, part in enumerate(parts):
        owner[part] = index
    # columns that the elimination of descendants couples to a part
    passed: list[list[Integers]] = [[] for _ in parts]
    entries = 0
    for index, part in enumerate(parts):
        reached = np.unique(
            np.concatenate([place[_neighbours(adjacency, part)[0]], *passed[index]])
        )
        passed[index] = []
        later = reached[reached >= ends[index]]
        entries += len(part) ** 2 + 2 * len(part) * len(later)
        if len(later):
            passed[owner[order[later[0]]]].append(later)
    return entries


def _neighbours(adjacency: csr_array, nodes: Integers) -> tuple[Integers, Integers]:
    """Return the concatenated neighbours of nodes, and their number for each node."""
    start = adjacency.indptr[nodes]
    count = adjacency.indptr[nodes + 1] - start
    end = np.cumsum(count)
    return adjacency.indices[np.arange(end[-1]) + np.repeat(start - end + count, count)], count


def check_factor_memory(dofs: int, entries: float) -> None:
    """Raise if factors with the given number of entries would not fit into the free memory.

    Raises
    ------
    InputError
        With the estimate and the free memory.
    """
    check_memory(
        BYTES_PER_ENTRY * entries,
        f"the factors of {dofs} degrees of freedom need",
        "use larger elements",
    )
