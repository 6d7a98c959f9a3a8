"""The factors of a sparse symmetric matrix, in an order that keeps them small, after a look at the memory they need."""

from __future__ import annotations

import math
import os
from pathlib import Path

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import SuperLU, splu

from vibroimpact.arrays import Bools, Floats, Integers
from vibroimpact.errors import ComputationError, InputError

_LEAF = 40  # nodes of the smallest part; smaller ones gain nothing
_PART_OF_MEMORY = 0.8  # of what is free: the rest of the work needs some too
_NOTHING = 1e-15  # relative to the diagonal
_MOST_INDEXED = 71_000_000  # entries; SuperLU reserves thirty times as many, and numbers them with 32 bits
BYTES = 12.0
"""For each entry of a sparse matrix, or of its factors: the number and its row."""


class Factors:
    """The factors of a symmetric matrix.

    Parameters
    ----------
    matrix : sparse array, shape (n, n)
        Symmetric.
    order : int array, shape (n,)
        The elimination order of its rows.

    Raises
    ------
    ComputationError
        If the matrix is singular, or the memory does not suffice.
    """

    def __init__(self, matrix: csr_array, order: Integers) -> None:
        self._order = order
        permuted = _without_rounding(matrix)[order][:, order].tocsc()
        if permuted.nnz > _MOST_INDEXED:
            raise InputError(f"{len(order)} degrees of freedom are more than the solver can number; use larger elements")
        try:
            self._factors: SuperLU = splu(permuted, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        except RuntimeError:
            raise ComputationError("the stiffness matrix is singular: part of the body can move without resistance") from None
        except MemoryError:
            raise ComputationError("there is not enough memory for the factors of the stiffness matrix; use larger elements") from None

    @property
    def entries(self) -> int:
        """How many numbers the factors hold."""
        return int(self._factors.nnz)

    @property
    def size(self) -> float:
        """About how many bytes they take."""
        return BYTES * self.entries

    def negative_pivots(self) -> int:
        """Return how many pivots are negative: as many as the matrix has negative eigenvalues (Sylvester's law of inertia)."""
        return int((self._factors.U.diagonal() < 0.0).sum())

    def solve(self, right: Floats) -> Floats:
        """Return the solution for one right side, or one a column."""
        solution = np.empty_like(right)
        solution[self._order] = self._factors.solve(right[self._order])
        return solution


def _without_rounding(matrix: csr_array) -> csr_array:
    """Return a matrix without the entries that are rounding of sums that vanish: a fifth of all in a regular mesh."""
    whole = matrix.tocoo()
    size = np.sqrt(np.abs(matrix.diagonal()))
    keep = np.abs(whole.data) >= _NOTHING * size[whole.row] * size[whole.col]
    return csr_array((whole.data[keep], (whole.row[keep], whole.col[keep])), shape=matrix.shape)


def dissection(nodes: Floats, adjacency: csr_array) -> list[Integers]:
    """Return the nodes of a mesh in parts, in an elimination order that keeps the factors sparse.

    Parameters
    ----------
    nodes : array, shape (n, 3)
        Coordinates.
    adjacency : sparse array, shape (n, n)
        The pattern of which nodes share an element.

    Notes
    -----
    Nested dissection (A. George, SIAM J. Numer. Anal. 10:345, 1973): cut the nodes in two by a plane across the longest
    side of their box; the nodes of one half that touch the other come last, and so on in each half.
    """
    other = np.zeros(len(nodes), dtype=bool)
    parts: list[Integers] = []
    waiting: list[tuple[Integers, bool]] = [(np.arange(len(nodes)), False)]
    while waiting:
        part, separates = waiting.pop()
        if separates or len(part) <= _LEAF:
            parts.append(part)
            continue
        low, touching = _best_cut(nodes[part, np.ptp(nodes[part], axis=0).argmax()], part, adjacency, other)
        first = part[low]
        if not len(first):
            parts.append(part)
            continue
        waiting += [(first[touching], True), (part[~low], False), (first[~touching], False)]
    return [part for part in parts if len(part)]


def _best_cut(at: Floats, part: Integers, adjacency: csr_array, other: Bools) -> tuple[Bools, Bools]:
    """Return which nodes lie below the cut near the middle that fewest touch, and which of those touch the others."""
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
    """Return how many entries the factors of a matrix of one degree of freedom a node have, without computing them.

    The parts are taken as dense, so that it is a little more than there will be.
    """
    place = np.empty(adjacency.shape[0], dtype=np.int64)  # of a node in the order
    owner = np.empty_like(place)
    order = np.concatenate(parts)
    place[order] = np.arange(len(order))
    ends = np.cumsum([len(part) for part in parts])
    for index, part in enumerate(parts):
        owner[part] = index
    passed: list[list[Integers]] = [[] for _ in parts]
    entries = 0
    for index, part in enumerate(parts):
        reached = np.unique(np.concatenate([place[_neighbours(adjacency, part)[0]], *passed[index]]))
        passed[index] = []
        later = reached[reached >= ends[index]]
        entries += len(part) ** 2 + 2 * len(part) * len(later)
        if len(later):
            passed[owner[order[later[0]]]].append(later)
    return entries


def _neighbours(adjacency: csr_array, nodes: Integers) -> tuple[Integers, Integers]:
    """Return the neighbours of nodes, one after the other, and how many each has."""
    start = adjacency.indptr[nodes]
    count = adjacency.indptr[nodes + 1] - start
    end = np.cumsum(count)
    return adjacency.indices[np.arange(end[-1]) + np.repeat(start - end + count, count)], count


def check_memory(dofs: int, entries: float) -> None:
    """Raise if factors of so many entries would not fit into the memory that is free.

    Raises
    ------
    InputError
        With the estimate and what is free.
    """
    check_room(BYTES * entries, f"the factors of {dofs} degrees of freedom need", "use larger elements")


def check_room(need: float, what: str, remedy: str = "ask for fewer, or use larger elements") -> None:
    """Raise if so many bytes are not free.

    Raises
    ------
    InputError
        With the estimate and what is free.
    """
    free = free_memory()
    if need > _PART_OF_MEMORY * free:
        raise InputError(f"{what} about {need / 1e9:.2g} GB of memory, and {free / 1e9:.2g} GB are free; {remedy}")


def free_memory() -> float:
    """Return how many bytes are free; infinite where the system does not say."""
    try:
        text = Path("/proc/meminfo").read_text(encoding="ascii")
        return 1024.0 * float(text.split("MemAvailable:")[1].split()[0])
    except (OSError, IndexError, ValueError):
        pass
    try:
        return float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (AttributeError, OSError, ValueError):
        return math.inf
