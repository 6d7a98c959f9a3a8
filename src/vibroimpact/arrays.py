"""Types of arrays, by what they hold."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
Bools = NDArray[np.bool_]
Integers = NDArray[np.int64]
Indices = NDArray[np.intp]
"""Places in other arrays."""

Drops = Indices
"""Which drops of a batch."""

Array = Any
"""A float, or an array of any library that follows NumPy's operators and ufuncs."""
