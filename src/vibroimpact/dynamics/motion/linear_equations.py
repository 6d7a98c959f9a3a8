"""The inverses of a stack of small matrices, with NaN for the singular ones."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats


def stacked_inverse(matrices: Floats) -> Floats:
    """Return the inverse of each matrix (B, M, M); NaN where it is singular.

    NumPy raises for the whole stack if one matrix is singular, so the stack is bisected until the
    singular ones are isolated.
    """
    try:
        return np.asarray(np.linalg.inv(matrices))
    except np.linalg.LinAlgError:
        if len(matrices) == 1:
            return np.full_like(matrices, np.nan)
        half = len(matrices) // 2
        return np.concatenate([stacked_inverse(matrices[:half]), stacked_inverse(matrices[half:])])
