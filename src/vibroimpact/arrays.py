"""Type aliases of arrays, by element type, and a fast assignment to columns."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
Bools = NDArray[np.bool_]
Integers = NDArray[np.int64]
Indices = NDArray[np.intp]
"""Indices into other arrays."""

Drops = Indices
"""Indices of drops in a batch."""

Array = Any
"""A float, or an array of any library that supports NumPy's operators and ufuncs."""


def put(array: Floats, columns: Indices, values: Floats) -> None:
    """Write values (..., b) into columns of an array (..., B): row by row, which NumPy does several times faster than all at once."""
    if columns.size:
        for row, value in zip(array.reshape(-1, array.shape[-1]), values.reshape(-1, columns.size), strict=True):
            row[columns] = value
