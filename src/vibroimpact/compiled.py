"""Scalar functions that numba compiles where it is there, and that plain Python runs where it is not.

Two decorators mark them. `scalar` marks a function of a contact law: it stays a Python function, which NumPy's arrays go through as well,
and compiled code may call it. `compiled` marks a function of the core, with its types; the module that it stands in is loaded only where
drops are computed, since loading numba takes some tenths of a second.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

_SCALAR: list[tuple[Callable[..., Any], Callable[..., Any] | None]] = []
"""The functions that `scalar` marks, each with the one that compiled code calls in its place, if any."""

HAS_COMPILER = find_spec("numba") is not None
"""Is numba installed?"""


def scalar(function: Function) -> Function:
    """Mark a function of floats, or of arrays elementwise, as one that compiled code may call.

    It takes and returns floats (or a tuple of floats), or arrays of them by NumPy's rules, and uses NumPy's functions that are there for
    both: `np.sqrt`, `np.minimum`, `np.exp` and so on, but not `np.where`. Indices into its coefficients are constants.
    """
    _SCALAR.append((function, None))
    return function


def scalar_as(of_floats: Callable[..., Any]) -> Callable[[Function], Function]:
    """Mark a function as `scalar` does, with another body for floats, which may branch where that for arrays can't."""

    def mark(function: Function) -> Function:
        _SCALAR.append((function, of_floats))
        return function

    return mark
