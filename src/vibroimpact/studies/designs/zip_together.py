"""Paired values: the first values of all keys together, then the second, and so on."""

from __future__ import annotations

from vibroimpact.errors import InputError
from vibroimpact.studies.planning.design import Asked, Design
from vibroimpact.studies.planning.plan import Plan


def size(asked: Asked) -> int:
    """Return the number of values of each key.

    Raises
    ------
    InputError
        If the keys have different numbers of values, or one is a distribution.
    """
    for key, axis in asked.axes.items():
        if axis.is_random:
            raise InputError(
                "a distribution has no values in an order; take a list or a range, or "
                'design = "latin-hypercube"',
                f'over."{key}"',
            )
    counts = {key: len(axis) for key, axis in asked.axes.items()}
    if len(set(counts.values())) > 1:
        sizes = ", ".join(f"{key} has {count}" for key, count in counts.items())
        raise InputError(
            f"all keys of a zip need as many values as each other, and {sizes}", "over"
        )
    return next(iter(counts.values()))


def plan(asked: Asked) -> Plan:
    """Return the paired points."""
    size(asked)
    return Plan("zip", {key: axis.levels() for key, axis in asked.axes.items()}, False)


DESIGN = Design(
    "zip", "the first values together, then the second values, and so on", False, size, plan
)
