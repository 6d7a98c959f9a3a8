"""Type aliases of arrays, by element type, and a fast assignment to columns."""

from __future__ import annotations

from typing import Annotated, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
Bools = NDArray[np.bool_]
Integers = NDArray[np.int64]

# with the number of dimensions that compiled functions need: the others have one there
Vector: TypeAlias = Annotated[Floats, 1]
Matrix: TypeAlias = Annotated[Floats, 2]
Cube: TypeAlias = Annotated[Floats, 3]

Indices = NDArray[np.intp]
"""Indices into other arrays."""

Drops = Indices
"""Indices of drops in a batch."""

Array = Any
"""A float, or an array of any library that supports NumPy's operators and ufuncs."""
