"""Linear algebra on stacks of small matrices, with NaN results for the singular ones."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.arrays import Floats


def stacked_matvec(matrices: Floats, values: Floats) -> Floats:
    """Return the products of matrices (B or 1, K, M) and vectors (B, M): (B, K)."""
    return np.asarray((matrices @ values[:, :, None])[:, :, 0])


def stacked_solve(matrices: Floats, right: Floats) -> Floats:
    """Return the solutions (B, M) of B linear systems; NaN where a matrix (B, M, M) is singular."""
    return _each(np.linalg.solve, matrices, right[:, :, None])[:, :, 0]


def stacked_inverse(matrices: Floats) -> Floats:
    """Return the inverse of each matrix (B, M, M); NaN where it is singular."""
    return _each(np.linalg.inv, matrices)


def _each(function: Callable[..., Floats], *stacks: Floats) -> Floats:
    """Apply a NumPy function to stacks of matrices, with NaN for the singular ones.

    NumPy raises for the whole stack if one matrix is singular, so the stack is bisected until the singular ones are isolated.
    """
    try:
        return np.asarray(function(*stacks))
    except np.linalg.LinAlgError:
        if len(stacks[0]) == 1:
            return np.full_like(stacks[-1], np.nan)
        half = len(stacks[0]) // 2
        return np.concatenate([_each(function, *(stack[part] for stack in stacks)) for part in (slice(half), slice(half, None))])
