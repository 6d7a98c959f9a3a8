"""Factorisation of a sparse symmetric matrix in nested-dissection order.

The memory of the factors is estimated beforehand. Compared with that order, SuperLU's
minimum-degree order has less fill for plate elements (0.35 to 1), but 1.2 to 1.7 times the fill and
two to three times the time for whole plates of bricks, the largest systems here; and its fill is
not known before the factorisation.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Bools, Floats, Integers
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.structures.finite_elements.free_memory import check_memory

_LEAF = 40  # nodes of a part that is not dissected further; smaller parts do not reduce the fill
_ROUNDING = 1e-15  # relative to the diagonal: smaller entries of the matrix are rounding
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
        """Return the number of negative pivots.

        It is that of negative eigenvalues (Sylvester's law of inertia).
        """
        return int((self._factors.U.diagonal() < 0.0).sum())

    def solve(self, right: Floats) -> Floats:
        """Return the solution for one right-hand side (n,), or for several (n, columns)."""
        solution = np.empty_like(right)
        solution[self._order] = self._factors.solve(right[self._order])
        return solution


def _without_rounding(matrix: csr_array) -> csr_array:
    """Return a matrix without entries that are zero up to rounding.

    They are a fifth of all in a regular mesh.
    """
    entries = matrix.tocoo()
    scale = np.sqrt(np.abs(matrix.diagonal()))
    kept = np.abs(entries.data) >= _ROUNDING * scale[entries.row] * scale[entries.col]
    return csr_array(
        (entries.data[kept], (entries.row[kept], entries.col[kept])), shape=matrix.shape
    )


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
    is_above = np.zeros(len(nodes), dtype=bool)  # working memory of the cuts
    parts: list[Integers] = []
    # a stack of parts to be dissected, and of separators, in reverse of their elimination
    stack: list[tuple[Integers, bool]] = [(np.arange(len(nodes)), False)]
    while stack:
        part, is_separator = stack.pop()
        if is_separator or len(part) <= _LEAF:
            parts.append(part)
            continue
        longest_side = np.ptp(nodes[part], axis=0).argmax()
        below, separates = _best_cut(nodes[part, longest_side], part, adjacency, is_above)
        lower_half = part[below]
        if not len(lower_half):  # all nodes are at one level
            parts.append(part)
            continue
        stack.append((lower_half[separates], True))
        stack.append((part[~below], False))
        stack.append((lower_half[~separates], False))
    return [part for part in parts if len(part)]


def _best_cut(
    positions: Floats, part: Integers, adjacency: csr_array, is_above: Bools
) -> tuple[Bools, Bools]:
    """Return the nodes below the cut with the smallest separator, and which of them separate.

    Cuts at the median and beside it are tried. Both results are masks: the first of the nodes of
    the part, the second of those below the cut.

    Parameters
    ----------
    positions : array, shape (part,)
        Positions of the nodes across the cut.
    part : int array
        The nodes.
    adjacency : sparse array
        Pattern of the nodes that share an element.
    is_above : bool array, shape (nodes,)
        Working memory, False before and after.
    """
    levels = np.unique(np.round(positions, 12))
    median = int(np.searchsorted(levels, np.median(positions)))
    best_below = np.zeros(len(part), dtype=bool)
    best_separator = np.zeros(0, dtype=bool)
    for level in levels[max(0, median - 1) : min(median + 2, len(levels) - 1)]:
        below = positions <= level + 1e-12
        is_above[part[~below]] = True
        neighbours, counts = _neighbours(adjacency, part[below])
        starts = np.cumsum(counts) - counts
        separates = np.add.reduceat(is_above[neighbours], starts, dtype=np.int64) > 0
        is_above[part[~below]] = False
        if not best_below.any() or separates.sum() < best_separator.sum():
            best_below = below
            best_separator = separates
    return best_below, best_separator


def factor_entries(parts: list[Integers], adjacency: csr_array) -> int:
    """Return an upper estimate of the number of entries of the factors.

    It is that for one degree of freedom per node, and follows from a symbolic factorisation in
    which each part is a dense block.
    """
    order = np.concatenate(parts)
    rank = np.empty(adjacency.shape[0], dtype=np.int64)  # of a node in the elimination order
    rank[order] = np.arange(len(order))
    part_of_node = np.empty_like(rank)
    for number, part in enumerate(parts):
        part_of_node[part] = number
    ends = np.cumsum([len(part) for part in parts])  # ranks where parts end
    # ranks of the nodes that the elimination of earlier parts couples to a part
    coupled: list[list[Integers]] = [[] for _ in parts]
    entries = 0
    for number, part in enumerate(parts):
        neighbours = rank[_neighbours(adjacency, part)[0]]
        reached = np.unique(np.concatenate([neighbours, *coupled[number]]))
        coupled[number] = []
        # a dense block of both factors, and those that couple it to what comes later
        later = reached[reached >= ends[number]]
        entries += len(part) ** 2 + 2 * len(part) * len(later)
        if len(later):  # they are all coupled to the part that is eliminated first among them
            coupled[part_of_node[order[later[0]]]].append(later)
    return entries


def _neighbours(adjacency: csr_array, nodes: Integers) -> tuple[Integers, Integers]:
    """Return the concatenated neighbours of nodes, and their number for each node."""
    starts = adjacency.indptr[nodes]
    counts = adjacency.indptr[nodes + 1] - starts
    ends = np.cumsum(counts)  # of each node's neighbours among the concatenated ones
    entries = np.arange(ends[-1]) + np.repeat(starts - ends + counts, counts)
    return adjacency.indices[entries], counts


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
