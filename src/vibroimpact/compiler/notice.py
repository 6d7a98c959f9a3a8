"""What the terminal says of a compilation that takes long."""

from __future__ import annotations

import sys

_LONG = 2.0  # seconds
_ROUNDED = 5  # seconds


def say_how_long(seconds: float) -> None:
    """Say in a terminal that the solver is being compiled, and about how long that takes, if it takes long."""
    if seconds > _LONG:
        _say(f"Compiling the solver for this machine, once; about {_ROUNDED * max(1, round(seconds / _ROUNDED))} s.")


def say_trouble(trouble: str) -> None:
    """Say in a terminal that compiled code is not kept."""
    _say(f"The compiled solver can't be kept, and is compiled again the next time: {trouble}.")


def _say(text: str) -> None:
    stream = sys.stderr  # None in programs without a terminal
    if stream is not None and stream.isatty():
        print(text, file=stream, flush=True)
