"""The free memory of the computer, and a check that something fits into it."""

from __future__ import annotations

import math
import os
from pathlib import Path

from vibroimpact.errors import InputError

_PART_OF_MEMORY = 0.8  # of the free memory, as the other arrays need some too


def check_memory(
    need: float, what: str, remedy: str = "ask for fewer, or use larger elements"
) -> None:
    """Raise if `need` [bytes] exceeds the free memory less a reserve.

    `what` and `remedy` are for the message.

    Raises
    ------
    InputError
        With the estimate and the free memory.
    """
    free = free_memory()
    if need > _PART_OF_MEMORY * free:
        is_known = _available() is not None
        status = "are free" if is_known else "are built in"
        raise InputError(
            f"{what} about {need / 1e9:.2g} GB of memory, and {free / 1e9:.2g} GB {status}, "
            f"of which {100.0 * _PART_OF_MEMORY:g} % may be used; {remedy}"
        )


def free_memory() -> float:
    """Return the free memory [bytes].

    Where the system does not tell, it is the total memory, or infinity.
    """
    available = _available()
    if available is not None:
        return available
    try:
        return float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (AttributeError, OSError, ValueError):
        return math.inf


def _available() -> float | None:
    """Return the free memory [bytes]; None where the system does not tell."""
    try:
        text = Path("/proc/meminfo").read_text(encoding="ascii")
        return 1024.0 * float(text.split("MemAvailable:")[1].split()[0])
    except (OSError, IndexError, ValueError):
        return None
