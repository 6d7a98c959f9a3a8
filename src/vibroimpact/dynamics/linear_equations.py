"""Linear equations of several systems at once, of which one may be singular."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.arrays import Floats


def stacked_matvec(matrices: Floats, values: Floats) -> Floats:
    """Return matrices (B, M, M) times values (B, M)."""
    return np.asarray((matrices @ values[:, :, None])[:, :, 0])


def stacked_solve(matrices: Floats, right: Floats) -> Floats:
    """Return the solutions of B systems of linear equations, (B, M); NaN where a matrix (B, M, M) is singular."""
    return _each(np.linalg.solve, matrices, right[:, :, None])[:, :, 0]


def stacked_inverse(matrices: Floats) -> Floats:
    """Return the inverse of each matrix (B, M, M); NaN where it is singular."""
    return _each(np.linalg.inv, matrices)


def _each(function: Callable[..., Floats], *stacks: Floats) -> Floats:
    """Return a function of each of several matrices, with a NaN result where it is singular: NumPy gives up all for one of them."""
    try:
        return np.asarray(function(*stacks))
    except np.linalg.LinAlgError:
        if len(stacks[0]) == 1:
            return np.full_like(stacks[-1], np.nan)
        half = len(stacks[0]) // 2
        return np.concatenate([_each(function, *(stack[part] for stack in stacks)) for part in (slice(half), slice(half, None))])
