"""The functions of a contact law as function values, which compiled functions pass on and call.

From Python a law is given by the addresses of its machine code, as numba takes some 40 us to make a
function value of an argument; compiled code makes one of an address by `force_at` and its like.
Without a compiler all of them are the Python function.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from itertools import count
from typing import Any
from weakref import WeakValueDictionary

import numpy as np

from vibroimpact.arrays import Cube, Floats, Matrix

LAW_FUNCTIONS = {
    "force": "scalar_forces",
    "energies": "scalar_energies",
    "levels": "scalar_levels",
    "compressed": "scalar_compressed",
}
"""The functions of a contact law with the attributes of its class, in the order of addresses."""

FRICTION_FUNCTIONS = {"slip_after": "scalar_slip_after", "friction": "scalar_friction"}
"""The same of a friction law without tangential compliance."""

ALL_FUNCTIONS = LAW_FUNCTIONS | FRICTION_FUNCTIONS

MOST_COEFFICIENTS = 24
"""Largest number of coefficients of a law."""

_NUMBERS = count(1)

_HELD: WeakValueDictionary[int, Any] = WeakValueDictionary()
"""Laws that have only methods, by the numbers by which they are called; each number is new."""

# laws under other memories that are kept, since a law is called many times under each
_MOST_CHANGED = 256


def force_at(address: Any) -> Any:
    """Return the function value of a law's force at an address; for compiled functions."""
    return address


def energies_at(address: Any) -> Any:
    """Return the function value of a law's energies at an address; for compiled functions."""
    return address


def levels_at(address: Any) -> Any:
    """Return the function value of a law's levels at an address; for compiled functions."""
    return address


def compressed_at(address: Any) -> Any:
    """Return the function value of a law's change by compression; for compiled functions."""
    return address


def slip_after_at(address: Any) -> Any:
    """Return the function value of a friction law's slip at an address; for compiled functions."""
    return address


def friction_at(address: Any) -> Any:
    """Return the function value of a law's friction at an address; for compiled functions."""
    return address


def multiply_row(
    room: Matrix, values: int, matrices: Cube, matrix: int, width: int, columns: int, product: int
) -> None:
    """Write the product of a row of an array with a matrix into another row.

    It is for compiled functions.

    Parameters
    ----------
    room : array, shape (R, M)
        Holds both rows.
    values : int
        Number of the row that is multiplied.
    matrices : array, shape (K, N, P)
        Matrices with a column for each element of the product.
    matrix : int
        Number of the one.
    width : int
        How much of the row is multiplied, a multiple of eight.
    columns : int
        How much of the product is written, a multiple of eight.
    product : int
        Number of the row that is written, another one.
    """
    room[product, :columns] = room[values, :width] @ matrices[matrix, :width, :columns]


def law_coefficients(law: Any) -> Floats:
    """Return the coefficients of a contact law for its functions.

    For a law that has only methods these are a number, by which the law itself is called, and its
    memories; the law must be kept as long as they are used, those that `compressed` has made of
    them included.
    """
    coefficients = np.zeros(MOST_COEFFICIENTS)
    if type(law).missing_functions():
        memories = tuple(law.memories().values())
        coefficients[0] = _number(law)
        coefficients[1 : 1 + len(memories)] = memories
    else:
        coefficients[: len(law.coefficients)] = law.coefficients
    return coefficients


def interpreted_function(law_class: type[Any], kind: str) -> Callable[..., Any]:
    """Return a function of a law as a Python function of floats and coefficients.

    Of a law that lacks any of its own it is one that calls its methods. `kind` is of
    `ALL_FUNCTIONS`.
    """
    if law_class.missing_functions():
        return _OF_HELD[kind]
    function: Callable[..., Any] = getattr(law_class, ALL_FUNCTIONS[kind])
    return function


def forces_of_held(
    delta: float, delta_dot: float, approach_speed: float, coefficients: Any
) -> tuple[float, float]:
    """Return the forces of the law with the number and the memories of `law_coefficients`."""
    static, dissipative = _held(coefficients).forces(delta, delta_dot, approach_speed)
    return float(static), float(dissipative)


def energies_of_held(delta: float, coefficients: Any) -> tuple[float, float]:
    """Return elastic energy and plastic work of such a law."""
    law = _held(coefficients)
    return float(law.elastic_energy(delta)), float(law.plastic_work(delta))


def levels_of_held(coefficients: Any) -> tuple[float, ...]:
    """Return the levels of such a law: of touch, release and memory, and two breakpoints.

    Any compression may change a memory.
    """
    law = _held(coefficients)
    touch_level = float(law.touch_level)
    release_level = float(law.release_level)
    memory_level = touch_level if law.memories() else np.inf
    breakpoints = [*map(float, law.breakpoints), np.inf, np.inf]
    return touch_level, release_level, memory_level, breakpoints[0], breakpoints[1]


def compress_held(deepest: float, coefficients: Any, changed: Any) -> float:
    """Write the memories of such a law after compression.

    The indentation beyond which they may change again is returned. It is the deepest one, since a
    law remembers its largest indentation.
    """
    law = _held(coefficients).after_compression(deepest)
    for index, memory in enumerate(law.memories().values()):
        changed[1 + index] = float(memory)
    if not law.memories():
        return np.inf
    return max(float(law.touch_level), deepest)


def slip_after_of_held(
    slip: float, impulse: float, whole: float, mass: float, coefficients: Any
) -> float:
    """Return what the friction law with the number of `law_coefficients` leaves of a slip."""
    law = _held(coefficients)
    arguments = (np.array([value]) for value in (slip, impulse, whole, mass))
    return float(law.slip_after(*arguments)[0])


def friction_of_held(slip: float, normal_force: float, coefficients: Any) -> float:
    """Return the friction force of such a law."""
    return float(_held(coefficients).force(np.array([slip]), np.array([normal_force]))[0])


def _number(law: Any) -> int:
    """Return the number of a law."""
    # a copy of a law comes with the number of the original, and gets its own
    number = int(vars(law).get("_number", 0))
    if _HELD.get(number) is not law:
        number = vars(law)["_number"] = next(_NUMBERS)
        _HELD[number] = law
    return number


def _held(coefficients: Any) -> Any:
    """Return the law with the number and the memories in coefficients."""
    number = int(coefficients[0])
    memories = coefficients[1 : 1 + len(_memories(number))]
    return _law_with_memories(number, tuple(memories))


@lru_cache(maxsize=_MOST_CHANGED)
def _memories(number: int) -> tuple[str, ...]:
    return tuple(_HELD[number].memories())


@lru_cache(maxsize=_MOST_CHANGED)
def _law_with_memories(number: int, memories: tuple[float, ...]) -> Any:
    """Return a law with other memories than its own; the cache keeps it, but not its original."""
    return _HELD[number].changed(dict(zip(_memories(number), memories, strict=True)))


_OF_HELD: dict[str, Callable[..., Any]] = {
    "force": forces_of_held,
    "energies": energies_of_held,
    "levels": levels_of_held,
    "compressed": compress_held,
    "slip_after": slip_after_of_held,
    "friction": friction_of_held,
}
