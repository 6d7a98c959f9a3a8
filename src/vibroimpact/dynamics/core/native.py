"""The force of a law as the core calls it: by the address of compiled code, or in plain Python."""

from __future__ import annotations

from typing import Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import why_not_compiled

__all__ = ["LAWS", "evaluate", "force_of"]

if why_not_compiled():
    from vibroimpact.compiler.forces import interpreted_force as force_of

    LAWS: Any = object
    """Type of the elements of an array of forces, as `force_of` gives them."""

    def evaluate(law: Any, delta: float, delta_dot: float, approach_speed: float, coefficients: Floats, forces: Floats) -> None:
        """Write the static and the dissipative force of a law [N] into `forces`."""
        forces[0], forces[1] = law(delta, delta_dot, approach_speed, coefficients)

else:
    from vibroimpact.compiler.addresses import evaluate
    from vibroimpact.compiler.addresses import force_address as force_of  # type: ignore[assignment]

    LAWS = np.int64
