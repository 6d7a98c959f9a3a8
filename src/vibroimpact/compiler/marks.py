"""Marks of functions that compiled code may call, which need no compiler."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

SCALAR: list[tuple[Callable[..., Any], Callable[..., Any] | None]] = []
"""The functions that `scalar` marks, with the one that compiled code calls instead, if any."""

DEFERRED: list[Any] = []
"""The functions that `compiled` marks: each is compiled when it is first called."""


def scalar(function: Function) -> Function:
    """Mark a function of floats, or of arrays elementwise, as one that compiled code may call.

    It takes and returns floats (or a tuple of floats), or arrays of them by NumPy's rules, and uses
    NumPy's functions that are there for both: `np.sqrt`, `np.minimum` and so on, but not
    `np.where`. Indices into its coefficients are constants.
    """
    SCALAR.append((function, None))
    return function


def scalar_as(of_floats: Callable[..., Any]) -> Callable[[Function], Function]:
    """Mark a function as `scalar` does, with another body for floats, which may branch."""

    def mark(function: Function) -> Function:
        SCALAR.append((function, of_floats))
        return function

    return mark
