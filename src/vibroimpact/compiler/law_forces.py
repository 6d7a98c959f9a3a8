"""The compiled forces of contact laws, and calls of those that cannot be compiled. Loading this module loads numba."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

from numba import objmode

from vibroimpact.compiler.function_values import interpreted_force
from vibroimpact.compiler.functions import CompiledFunction
from vibroimpact.errors import SlowLawWarning

_FORCES: dict[Any, CompiledFunction] = {}
"""Forces by their Python functions; they are kept, since addresses of them are in use."""

_REASONS: dict[Any, str] = {}
"""Why a force is not compiled, by its Python function; "" if it is."""

_WARNED: set[type[Any]] = set()
"""Laws of which the user knows that they are not compiled."""


def compiled_force(law_class: type[Any]) -> CompiledFunction:
    """Return the force of a law as a function value, compiled once a process."""
    source = interpreted_force(law_class)
    if source not in _FORCES:
        reason = "it has no force of floats, `scalar_forces`" if law_class.scalar_forces is None else _why_not_compiled(source)
        if reason:
            _FORCES[source] = CompiledFunction(_calling(source), lambda types: types.force.signature, nogil=False)
            _FORCES[source].ready()
        _REASONS[source] = reason
    if _REASONS[source] and law_class not in _WARNED:
        _WARNED.add(law_class)
        name = getattr(law_class, "name", law_class.__name__)
        said = f"the law {name} is not compiled, and its force takes microseconds in place of nanoseconds: {_REASONS[source]}"
        warnings.warn(SlowLawWarning(said), stacklevel=4)
    return _FORCES[source]


def _why_not_compiled(source: Callable[..., Any]) -> str:
    """Compile a force, or return why numba refuses it."""
    force = CompiledFunction(source, lambda types: types.force.signature)
    try:
        force.ready()
    except Exception as error:  # numba has many kinds, and a function of another package may be anything
        return _first_reason(error)
    _FORCES[source] = force
    return ""


def _calling(source: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that compiled code calls, and which calls Python."""

    def force(delta, delta_dot, approach_speed, coefficients):  # type: ignore[no-untyped-def]
        with objmode(static="float64", dissipative="float64"):
            static, dissipative = source(delta, delta_dot, approach_speed, coefficients)
        return static, dissipative

    return force


def _first_reason(error: Exception) -> str:
    """Return the first line of numba's message that says something of the function."""
    lines = [line.strip() for line in str(error).splitlines()]
    said = [line for line in lines if line and not line.startswith("Failed in")]
    return said[0] if said else type(error).__name__
