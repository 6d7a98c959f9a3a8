"""What the terminal, and whoever listens, is told of a compilation that takes long."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

Hear = Callable[[str], None]
"""Function that is given a sentence."""

_LONG = 2.0  # seconds
_ROUNDED = 5  # seconds
_SAID: set[str] = set()
_LISTENER: ContextVar[Hear | None] = ContextVar("_LISTENER", default=None)


@contextmanager
def heard_by(hear: Hear) -> Iterator[None]:
    """Tell a function, too, that the solver is being compiled, within a block.

    It hears of the threads that are started with the context of the block.
    """
    token = _LISTENER.set(hear)
    try:
        yield
    finally:
        _LISTENER.reset(token)


def say_how_long(estimate: Callable[[], float]) -> None:
    """Say that the solver is being compiled, and about how long that takes, if it takes long.

    It is said in a terminal once, and to a listener each time.

    Parameters
    ----------
    estimate : callable
        Returns the time [s].
    """
    hear = _LISTENER.get()
    prints = "how long" not in _SAID and _is_terminal()
    if hear is None and not prints:
        return
    seconds = estimate()
    if seconds <= _LONG:
        return
    rounded = _ROUNDED * max(1, round(seconds / _ROUNDED))
    sentence = f"Compiling the solver for this machine, once; about {rounded} s."
    if hear is not None:
        hear(sentence)
    if prints:
        _SAID.add("how long")
        print(sentence, file=sys.stderr)


def say_trouble(trouble: str) -> None:
    """Say in a terminal, once, that compiled code is not kept."""
    if "trouble" not in _SAID and _is_terminal():
        _SAID.add("trouble")
        print(
            f"The compiled solver can't be kept, and is compiled again the next time: {trouble}.",
            file=sys.stderr,
        )


def _is_terminal() -> bool:
    return sys.stderr is not None and sys.stderr.isatty()  # None in programs without one
