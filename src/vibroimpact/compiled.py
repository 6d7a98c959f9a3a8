"""Scalar functions that numba compiles, and that plain Python runs without it.

Two decorators mark them. `scalar` marks a function of a contact law: it stays a Python function,
which NumPy's arrays go through as well, and compiled code may call it. `compiled` marks a function
of the core, whose annotations are its types; the module that it stands in is loaded only where
drops are computed, since loading numba takes some tenths of a second.
"""

from __future__ import annotations

import os
from functools import cache
from importlib.util import find_spec
from typing import Annotated, Any, TypeAlias, TypeVar, cast
from weakref import WeakKeyDictionary

import numpy as np

from vibroimpact.compiler.deferred import INTERPRETING, DeferredFunction, interpreted
from vibroimpact.compiler.function_values import (
    ALL_FUNCTIONS,
    compressed_at,
    energies_at,
    force_at,
    friction_at,
    interpreted_function,
    law_coefficients,
    levels_at,
    multiply_row,
    slip_after_at,
)
from vibroimpact.compiler.marks import Function, scalar, scalar_as

__all__ = [
    "Address",
    "Lent",
    "compiled",
    "compressed_at",
    "energies_at",
    "force_at",
    "friction_at",
    "interpreted",
    "law_addresses",
    "law_coefficients",
    "law_function",
    "levels_at",
    "multiply_row",
    "scalar",
    "scalar_as",
    "slip_after_at",
    "why_not_compiled",
]

SWITCH = "VIBROIMPACT_COMPILE"
"""Environment variable: 0 runs everything in plain Python."""

_SWITCH_OF_NUMBA = "NUMBA_DISABLE_JIT"

_T = TypeVar("_T")

Lent = Annotated[_T, "lent"]
"""A named tuple that Python lends to a compiled function, which is handed its address."""

Address: TypeAlias = int
"""Address of a function of a law, which `force_at` and its like take."""


def compiled(function: Function) -> Function:
    """Compile a function of the core, or leave it as it is where there is no compiler.

    Parameters
    ----------
    function : callable
        Its parameters and what it returns are annotated with `float`, `int`, `bool`, `complex`,
        arrays of `vibroimpact.arrays`, named tuples of these, or tuples; `None` for nothing. Arrays
        are C-contiguous. A named tuple that Python lends is annotated `Lent[...]`.

    Examples
    --------
    >>> from vibroimpact.arrays import Vector
    >>> @compiled
    ... def largest(values: Vector) -> float:
    ...     highest = values[0]
    ...     for value in values:
    ...         highest = max(highest, value)
    ...     return highest
    >>> import numpy as np
    >>> largest(np.array([1.0, 3.0, 2.0]))
    3.0
    """
    if _why_switched_off():
        return function
    return cast(Function, DeferredFunction(function, why_not_compiled))


def law_function(law_class: type[Any], kind: str = "force") -> Any:
    """Return a function of a law as a function value; without a compiler the Python function.

    A law that numba cannot compile is called in Python from compiled code; a `SlowLawWarning` says
    so.

    Parameters
    ----------
    law_class : type
        Class of the law, a `CompliantLaw` or an `ImpulsiveFriction`.
    kind : {"force", "energies", "levels", "compressed", "slip_after", "friction"}
        Which of its functions.
    """
    if why_not_compiled():
        return interpreted_function(law_class, kind)
    from vibroimpact.compiler.law_functions import compiled_law_function

    return compiled_law_function(law_class, kind)


def law_addresses(law_class: type[Any]) -> Any:
    """Return what compiled functions take from Python for the functions of a law.

    They make the functions of it by `force_at` and its like.

    Parameters
    ----------
    law_class : type
        Class of the law, a `CompliantLaw` or an `ImpulsiveFriction`.

    Returns
    -------
    array, shape (4,) or (2,)
        Of its force, energies, levels and change by compression; or of what friction leaves of a
        slip, and of its force.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> from vibroimpact.arrays import Integers, Vector
    >>> @compiled
    ... def static_force(addresses: Integers, delta: float, coefficients: Vector) -> float:
    ...     force = force_at(addresses[0])
    ...     return force(delta, 0.0, 1.0, coefficients)[0]
    >>> law = vi.laws.find_contact_law("hunt-crossley")(stiffness=2.0, restitution=0.5)
    >>> static_force(law_addresses(type(law)), 4.0, law_coefficients(law))
    16.0
    """
    kinds = [kind for kind, attribute in ALL_FUNCTIONS.items() if hasattr(law_class, attribute)]
    if INTERPRETING.get():
        return np.array([interpreted_function(law_class, kind) for kind in kinds], dtype=object)
    addresses = _ADDRESSES.get(law_class)
    if addresses is None:
        functions = [law_function(law_class, kind) for kind in kinds]
        if why_not_compiled():
            addresses = np.array(functions, dtype=object)
        else:
            addresses = np.array([function.address() for function in functions], dtype=np.int64)
        _ADDRESSES[law_class] = addresses
    return addresses


_ADDRESSES: WeakKeyDictionary[type[Any], Any] = WeakKeyDictionary()


@cache
def why_not_compiled() -> str:
    """Return why nothing is compiled, in words, or "" if it is."""
    if reason := _why_switched_off():
        return reason
    try:
        import numba
    except Exception as error:
        # ImportError where NumPy is too new for it, OSError where a library of it cannot be loaded
        return f"numba cannot be loaded: {error}"
    if numba.config.DISABLE_JIT:
        return "switched off in the configuration of numba"
    return ""


def _why_switched_off() -> str:
    """Return why nothing is compiled, as far as it is known before numba is loaded, or ""."""
    if os.environ.get(SWITCH) == "0":
        return f"switched off by {SWITCH}=0"
    if os.environ.get(_SWITCH_OF_NUMBA, "0") not in ("", "0"):
        return f"switched off by {_SWITCH_OF_NUMBA}"
    if find_spec("numba") is None:
        return "numba is not installed"
    return ""
