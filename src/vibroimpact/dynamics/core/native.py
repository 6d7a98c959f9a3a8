"""The functions of a law as the core calls them: by the addresses of compiled code, or in plain Python."""

from __future__ import annotations

from typing import Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import why_not_compiled

__all__ = ["LAWS", "evaluate", "evaluate_compressed", "evaluate_energies", "evaluate_levels", "force_of", "functions_of"]

if why_not_compiled():
    from vibroimpact.compiler.forces import interpreted_force as force_of
    from vibroimpact.compiler.forces import python_functions

    LAWS: Any = object
    """Type of the elements of an array of functions of laws, as `functions_of` gives them."""

    def functions_of(law_class: type[Any]) -> Any:
        """Return forces, energies, levels and compressed coefficients of a law (4,)."""
        return np.array(python_functions(law_class), dtype=LAWS)

    def evaluate(law: Any, delta: float, delta_dot: float, approach_speed: float, coefficients: Floats, forces: Floats) -> None:
        """Write the static and the dissipative force of a law [N] into `forces` (2,)."""
        forces[0], forces[1] = law(delta, delta_dot, approach_speed, coefficients)

    def evaluate_energies(law: Any, delta: float, coefficients: Floats, energies: Floats) -> None:
        """Write the elastic energy of a law and its plastic work since the state of the coefficients [J] into `energies` (2,)."""
        energies[0], energies[1] = law(delta, coefficients)

    def evaluate_levels(law: Any, coefficients: Floats, levels: Floats) -> None:
        """Write the indentations [m] of touch, of release, beyond which the memory changes, and of breakpoints into `levels` (5,)."""
        levels[:] = law(coefficients)

    def evaluate_compressed(law: Any, deepest: float, coefficients: Floats, changed: Floats) -> None:
        """Write the coefficients of a law after compression to an indentation [m] into `changed`."""
        law(deepest, coefficients, changed)

else:
    from vibroimpact.compiler.addresses import evaluate, evaluate_compressed, evaluate_energies, evaluate_levels
    from vibroimpact.compiler.addresses import force_address as force_of  # type: ignore[assignment]
    from vibroimpact.compiler.addresses import law_addresses as functions_of

    LAWS = np.int64
