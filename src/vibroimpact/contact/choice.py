"""A choice between two values that compiled code makes as well.

Numba's `np.where` of floats is an array, which scalar code can't use.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar_as


def _where_of_floats(condition: bool, value: float, other: float) -> float:
    return value if condition else other


@scalar_as(_where_of_floats)
def where(condition: Array, value: Array, other: Array) -> Array:
    """Return the value where the condition is true, and the other elsewhere; both are computed.

    Examples
    --------
    >>> where(np.array([True, False]), 1.0, 2.0).tolist()
    [1.0, 2.0]
    """
    return np.where(condition, value, other)
