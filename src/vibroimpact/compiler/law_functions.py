"""The compiled functions of contact laws, and calls of those that cannot be compiled.

Loading this module loads numba.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

from numba import objmode

from vibroimpact.compiler import types
from vibroimpact.compiler.function_values import interpreted_function
from vibroimpact.compiler.functions import CompiledFunction
from vibroimpact.errors import SlowLawWarning

_COMPILED: dict[Any, CompiledFunction] = {}
"""Compiled functions by their Python functions; they are kept, as their addresses are in use."""

_REASONS: dict[Any, str] = {}
"""Why a function is not compiled, by its Python function; "" if it is."""

_WARNED: set[type[Any]] = set()
"""Laws of which the user knows that they are not compiled."""


def compiled_law_function(law_class: type[Any], kind: str) -> CompiledFunction:
    """Return a function of a law as a function value, compiled once a process.

    `kind` is of `ALL_FUNCTIONS`.
    """
    source = interpreted_function(law_class, kind)
    if source not in _COMPILED:
        missing = law_class.missing_functions()
        lacks = f"it has no {_listed(missing)}" if missing else ""
        reason = lacks or _why_not_compiled(source, kind)
        if reason:
            function_type = getattr(types, kind)
            calling = CompiledFunction(_CALLING[kind](source), function_type.signature, nogil=False)
            calling.ready()
            _COMPILED[source] = calling
        _REASONS[source] = reason
    if _REASONS[source] and law_class not in _WARNED:
        _WARNED.add(law_class)
        name = getattr(law_class, "name", law_class.__name__)
        message = (
            f"the law {name} is not compiled, and its force takes microseconds in place of "
            f"nanoseconds: {_REASONS[source]}"
        )
        warnings.warn(SlowLawWarning(message), stacklevel=4)
    return _COMPILED[source]


def _why_not_compiled(source: Callable[..., Any], kind: str) -> str:
    """Compile a function, or return why numba refuses it."""
    function = CompiledFunction(source, getattr(types, kind).signature)
    try:
        function.ready()
    except Exception as error:
        # numba has many kinds, and a function of another package may be anything
        return _first_reason(error)
    _COMPILED[source] = function
    return ""


# functions that compiled code calls, and which call Python


def _calling_force(source: Callable[..., Any]) -> Callable[..., Any]:
    def force(delta, delta_dot, approach_speed, coefficients):  # type: ignore[no-untyped-def]
        with objmode(static="float64", dissipative="float64"):
            static, dissipative = source(delta, delta_dot, approach_speed, coefficients)
        return static, dissipative

    return force


def _calling_energies(source: Callable[..., Any]) -> Callable[..., Any]:
    def energies(delta, coefficients):  # type: ignore[no-untyped-def]
        with objmode(elastic="float64", plastic="float64"):
            elastic, plastic = source(delta, coefficients)
        return elastic, plastic

    return energies


def _calling_levels(source: Callable[..., Any]) -> Callable[..., Any]:
    def levels(coefficients):  # type: ignore[no-untyped-def]
        with objmode(
            touch="float64", release="float64", memory="float64", first="float64", second="float64"
        ):
            touch, release, memory, first, second = source(coefficients)
        return touch, release, memory, first, second

    return levels


def _calling_compressed(source: Callable[..., Any]) -> Callable[..., Any]:
    def compressed(deepest, coefficients, changed):  # type: ignore[no-untyped-def]
        with objmode(memory_level="float64"):
            memory_level = source(deepest, coefficients, changed)
        return memory_level  # noqa: RET504

    return compressed


def _calling_slip_after(source: Callable[..., Any]) -> Callable[..., Any]:
    def slip_after(slip, impulse, whole, mass, coefficients):  # type: ignore[no-untyped-def]
        with objmode(remaining_slip="float64"):
            remaining_slip = source(slip, impulse, whole, mass, coefficients)
        return remaining_slip  # noqa: RET504

    return slip_after


def _calling_friction(source: Callable[..., Any]) -> Callable[..., Any]:
    def friction(slip, normal_force, coefficients):  # type: ignore[no-untyped-def]
        with objmode(friction_force="float64"):
            friction_force = source(slip, normal_force, coefficients)
        return friction_force  # noqa: RET504

    return friction


_CALLING = {
    "force": _calling_force,
    "energies": _calling_energies,
    "levels": _calling_levels,
    "compressed": _calling_compressed,
    "slip_after": _calling_slip_after,
    "friction": _calling_friction,
}


def _listed(names: list[str]) -> str:
    *first, last = [f"`{name}`" for name in names]
    if not first:
        return last
    return f"{', '.join(first)} and {last}"


def _first_reason(error: Exception) -> str:
    """Return the first line of numba's message that says something of the function."""
    for line in str(error).splitlines():
        reason = line.strip()
        if reason and not reason.startswith("Failed in"):
            return reason
    return type(error).__name__
