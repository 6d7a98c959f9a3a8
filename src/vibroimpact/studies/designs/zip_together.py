"""Paired values: the first values of all keys together, then the second, and so on."""

from __future__ import annotations

from collections.abc import Mapping

from vibroimpact.errors import InputError
from vibroimpact.studies.axes import Axis
from vibroimpact.studies.design import Design
from vibroimpact.studies.plan import Plan


def size(axes: Mapping[str, Axis], samples: int) -> int:
    """Return the number of values of each key.

    Raises
    ------
    InputError
        If the keys have different numbers of values, or one is a distribution.
    """
    for key, axis in axes.items():
        if axis.is_random:
            raise InputError(
                'a distribution has no values in an order; take a list or a range, or design = "latin-hypercube"', f'over."{key}"'
            )
    counts = {key: len(axis) for key, axis in axes.items()}
    if len(set(counts.values())) > 1:
        told = ", ".join(f"{key} has {count}" for key, count in counts.items())
        raise InputError(f"all keys of a zip need as many values as each other, and {told}", "over")
    return next(iter(counts.values()))


def plan(axes: Mapping[str, Axis], samples: int, seed: int) -> Plan:
    """Return the paired points."""
    size(axes, samples)
    return Plan("zip", {key: axis.levels() for key, axis in axes.items()}, False)


DESIGN = Design("zip", "the first values together, then the second values, and so on", False, size, plan)
