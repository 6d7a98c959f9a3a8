"""The functions of a contact law as function values, which compiled functions pass on and call.

From Python a law is given by the addresses of its machine code, as numba takes some 40 us to make a function value of an argument; compiled
code makes one of an address by `force_at` and its like. Without a compiler all of them are the Python function.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats

LAW_FUNCTIONS = {
    "force": "scalar_forces",
    "energies": "scalar_energies",
    "levels": "scalar_levels",
    "compressed": "scalar_compressed",
}
"""The functions of a law, in the order of `law_addresses`, with the attributes of its class that hold them."""

MOST_COEFFICIENTS = 24
"""Largest number of coefficients of a law."""

_MOST_HELD = 10_000

_HELD: OrderedDict[int, Any] = OrderedDict()
"""The last laws without functions of floats, which are called by number; one that is called stays."""


def force_at(address: Any) -> Any:
    """Return the function value of a law's force at an address; for use in compiled functions."""
    return address


def energies_at(address: Any) -> Any:
    """Return the function value of a law's energies at an address; for use in compiled functions."""
    return address


def levels_at(address: Any) -> Any:
    """Return the function value of a law's levels at an address; for use in compiled functions."""
    return address


def compressed_at(address: Any) -> Any:
    """Return the function value of a law's change by compression at an address; for use in compiled functions."""
    return address


def law_coefficients(law: Any) -> Floats:
    """Return the coefficients of a contact law for its functions.

    For a law that has only methods this is a number by which the law itself is called.
    """
    coefficients = np.zeros(MOST_COEFFICIENTS)
    if type(law).scalar_forces is not None:
        coefficients[: len(law.coefficients)] = law.coefficients
    else:
        coefficients[0] = _hold(law)
    return coefficients


def interpreted_function(law_class: type[Any], kind: str) -> Callable[..., Any]:
    """Return a function of a law as a Python function of floats and coefficients; `kind`: of `LAW_FUNCTIONS`."""
    function: Callable[..., Any] | None = getattr(law_class, LAW_FUNCTIONS[kind])
    return _OF_HELD[kind] if function is None else function


def _hold(law: Any) -> int:
    _HELD[id(law)] = law
    _HELD.move_to_end(id(law))
    while len(_HELD) > _MOST_HELD:
        _HELD.popitem(last=False)
    return id(law)


def _held(coefficients: Floats) -> Any:
    number = int(coefficients[0])
    _HELD.move_to_end(number)
    return _HELD[number]


def _forces_of_held(delta: float, delta_dot: float, approach_speed: float, coefficients: Floats) -> tuple[float, float]:
    static, dissipative = _held(coefficients).forces(delta, delta_dot, approach_speed)
    return float(static), float(dissipative)


def _energies_of_held(delta: float, coefficients: Floats) -> tuple[float, float]:
    law = _held(coefficients)
    return float(law.elastic_energy(delta)), float(law.plastic_work(delta))


def _levels_of_held(coefficients: Floats) -> tuple[float, float, float, float, float]:
    law = _held(coefficients)
    breakpoints = [*(float(level) for level in law.breakpoints), np.inf, np.inf]
    # the memory of a law whose levels are not known may change at any indentation
    memory = -np.inf if law.memories() else np.inf
    return float(law.touch_level), float(law.release_level), memory, breakpoints[0], breakpoints[1]


def _compressed_of_held(deepest: float, coefficients: Floats, changed: Floats) -> None:
    changed[:] = coefficients
    changed[0] = _hold(_held(coefficients).after_compression(deepest))


_OF_HELD: dict[str, Callable[..., Any]] = {
    "force": _forces_of_held,
    "energies": _energies_of_held,
    "levels": _levels_of_held,
    "compressed": _compressed_of_held,
}
