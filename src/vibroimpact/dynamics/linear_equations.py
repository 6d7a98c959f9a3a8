"""Linear equations of several systems at once, of which one may be singular."""

from __future__ import annotations

import numpy as np

from vibroimpact.dynamics.collocation import Floats


def times(matrices: Floats, values: Floats) -> Floats:
    """Return matrices (B, M, M) times values (B, M)."""
    return np.asarray((matrices @ values[:, :, None])[:, :, 0])


def solutions(matrices: Floats, right: Floats) -> Floats:
    """Return the solutions of B systems of linear equations, (B, M); NaN where a matrix (B, M, M) is singular."""
    try:
        return np.asarray(np.linalg.solve(matrices, right[:, :, None])[:, :, 0])
    except np.linalg.LinAlgError:  # NumPy gives up all for one of them
        if len(matrices) == 1:
            return np.full_like(right, np.nan)
        half = len(matrices) // 2
        return np.concatenate([solutions(matrices[:half], right[:half]), solutions(matrices[half:], right[half:])])


def inverses(matrices: Floats) -> Floats:
    """Return the inverse of each matrix (B, M, M); NaN where it is singular."""
    try:
        return np.asarray(np.linalg.inv(matrices))
    except np.linalg.LinAlgError:
        if len(matrices) == 1:
            return np.full_like(matrices, np.nan)
        half = len(matrices) // 2
        return np.concatenate([inverses(matrices[:half]), inverses(matrices[half:])])
