"""The force of a contact law as a function value, which compiled functions pass on and call.

From Python a law is given by the address of its machine code, as numba takes some 40 us to make a function value of an argument; compiled
code makes one of the address by `force_at`. Without a compiler both are the Python function.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from weakref import WeakValueDictionary

import numpy as np

from vibroimpact.arrays import Floats

MOST_COEFFICIENTS = 24
"""Largest number of coefficients of a law."""

_HELD: WeakValueDictionary[int, Any] = WeakValueDictionary()
"""Laws without a force of floats, which are called by number."""


def force_at(address: Any) -> Any:
    """Return the function value at an address that `force_address` returned; for use in compiled functions."""
    return address


def force_coefficients(law: Any) -> Floats:
    """Return the coefficients of a contact law for `force_function`.

    For a law that has only `forces` this is a number by which the law itself is called; it must be kept as long as that is used.
    """
    coefficients = np.zeros(MOST_COEFFICIENTS)
    if type(law).scalar_forces is not None:
        coefficients[: len(law.coefficients)] = law.coefficients
    else:
        _HELD[id(law)] = law
        coefficients[0] = id(law)
    return coefficients


def interpreted_force(law_class: type[Any]) -> Callable[..., Any]:
    """Return the force of a law as a Python function of floats and coefficients."""
    scalar_forces: Callable[..., Any] | None = law_class.scalar_forces
    return forces_of_held if scalar_forces is None else scalar_forces


def forces_of_held(delta: float, delta_dot: float, approach_speed: float, coefficients: Floats) -> tuple[float, float]:
    """Return the forces of the law with the number that `force_coefficients` returned."""
    static, dissipative = _HELD[int(coefficients[0])].forces(delta, delta_dot, approach_speed)
    return float(static), float(dissipative)
