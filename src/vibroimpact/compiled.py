"""Scalar functions that numba compiles where it is there, and that plain Python runs where it is not.

Two decorators mark them. `scalar` marks a function of a contact law: it stays a Python function, which NumPy's arrays go through as well,
and compiled code may call it. `compiled` marks a function of the core, with its types; the module that it stands in is loaded only where
drops are computed, since loading numba takes some tenths of a second.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from functools import cache
from importlib.util import find_spec
from typing import Any, cast

import numpy as np

from vibroimpact.compiler.deferred import DeferredFunction
from vibroimpact.compiler.function_values import force_at, force_coefficients, interpreted_force
from vibroimpact.compiler.marks import Function, scalar, scalar_as

__all__ = [
    "compiled",
    "force_address",
    "force_addresses",
    "force_at",
    "force_coefficients",
    "force_function",
    "scalar",
    "scalar_as",
    "why_not_compiled",
]

SWITCH = "VIBROIMPACT_COMPILE"
"""Environment variable: 0 runs everything in plain Python."""

_SWITCH_OF_NUMBA = "NUMBA_DISABLE_JIT"


def compiled(signature: Callable[[Any], Any]) -> Callable[[Function], Function]:
    """Compile a function of the core, or leave it as it is where there is no compiler.

    Parameters
    ----------
    signature : callable
        Returns numba's signature from the names of the types, which are in `vibroimpact.compiler.types`. Not called without a compiler.

    Examples
    --------
    >>> @compiled(lambda t: t.real(t.vector))
    ... def largest(values):
    ...     highest = values[0]
    ...     for value in values:
    ...         highest = max(highest, value)
    ...     return highest
    >>> import numpy as np
    >>> largest(np.array([1.0, 3.0, 2.0]))
    3.0
    """

    def compile_function(function: Function) -> Function:
        if _why_switched_off():
            return function
        return cast(Function, DeferredFunction(function, signature, why_not_compiled))

    return compile_function


def force_function(law_class: type[Any]) -> Any:
    """Return the force of a contact law as a function value of the type `force`; without a compiler the Python function.

    It takes indentation [m], its rate [m/s], approach speed [m/s] and the coefficients that `force_coefficients` returns, and returns
    static and dissipative force [N]. A law that numba cannot compile is called in Python from compiled code; a `SlowLawWarning` says so.

    Parameters
    ----------
    law_class : type
        Class of the law, a `CompliantLaw`.
    """
    if why_not_compiled():
        return interpreted_force(law_class)
    from vibroimpact.compiler.law_forces import compiled_force

    return compiled_force(law_class)


def force_address(law_class: type[Any]) -> Any:
    """Return what a compiled function takes from Python as an `address`, and makes the force of a law of by `force_at`.

    Parameters
    ----------
    law_class : type
        Class of the law, a `CompliantLaw`.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> @compiled(lambda t: t.real(t.address, t.real, t.vector))
    ... def static_force(address, delta, coefficients):
    ...     force = force_at(address)
    ...     return force(delta, 0.0, 1.0, coefficients)[0]
    >>> law = vi.find_contact_law("hunt-crossley")(stiffness=2.0, restitution=0.5)
    >>> static_force(force_address(type(law)), 4.0, force_coefficients(law))
    16.0
    """
    force = force_function(law_class)
    return force if why_not_compiled() else force.address()


def force_addresses(law_classes: Iterable[type[Any]]) -> Any:
    """Return what `force_address` does of several laws, as an array."""
    return np.array([force_address(law_class) for law_class in law_classes], dtype=object if why_not_compiled() else np.int64)


@cache
def why_not_compiled() -> str:
    """Return why nothing is compiled, in words, or "" if it is."""
    if reason := _why_switched_off():
        return reason
    try:
        import numba
    except Exception as error:  # ImportError where NumPy is too new for it, OSError where a library of it cannot be loaded
        return f"numba cannot be loaded: {error}"
    return "switched off in the configuration of numba" if numba.config.DISABLE_JIT else ""


def _why_switched_off() -> str:
    """Return why nothing is compiled, as far as it is known before numba is loaded, or ""."""
    if os.environ.get(SWITCH) == "0":
        return f"switched off by {SWITCH}=0"
    if os.environ.get(_SWITCH_OF_NUMBA, "0") not in ("", "0"):
        return f"switched off by {_SWITCH_OF_NUMBA}"
    if find_spec("numba") is None:
        return "numba is not installed"
    return ""
