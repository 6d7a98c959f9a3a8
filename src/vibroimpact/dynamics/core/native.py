"""The force of a law as the core calls it: by the address of compiled code, or in plain Python."""

from __future__ import annotations

from typing import Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import force_address as force_of
from vibroimpact.compiled import force_at, scalar, why_not_compiled

__all__ = ["LAWS", "evaluate", "force_of"]

LAWS: Any = object if why_not_compiled() else np.int64
"""Type of the elements of an array of forces, as `force_of` gives them."""


@scalar
def evaluate(law: Any, delta: float, delta_dot: float, approach_speed: float, coefficients: Floats, forces: Floats) -> None:
    """Write the static and the dissipative force of a law [N] into `forces`."""
    force = force_at(law)
    forces[0], forces[1] = force(delta, delta_dot, approach_speed, coefficients)
