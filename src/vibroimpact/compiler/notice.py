"""What the terminal says of a compilation that takes long."""

from __future__ import annotations

import sys
from collections.abc import Callable

_LONG = 2.0  # seconds
_ROUNDED = 5  # seconds
_SAID: set[str] = set()


def say_how_long(estimate: Callable[[], float]) -> None:
    """Say in a terminal, once, that the solver is being compiled, and about how long that takes, if it takes long.

    Parameters
    ----------
    estimate : callable
        Returns the time [s].
    """
    if "how long" in _SAID or not _is_terminal():
        return
    seconds = estimate()
    if seconds > _LONG:
        _SAID.add("how long")
        print(f"Compiling the solver for this machine, once; about {_ROUNDED * max(1, round(seconds / _ROUNDED))} s.", file=sys.stderr)


def say_trouble(trouble: str) -> None:
    """Say in a terminal, once, that compiled code is not kept."""
    if "trouble" not in _SAID and _is_terminal():
        _SAID.add("trouble")
        print(f"The compiled solver can't be kept, and is compiled again the next time: {trouble}.", file=sys.stderr)


def _is_terminal() -> bool:
    return sys.stderr is not None and sys.stderr.isatty()  # None in programs without one
