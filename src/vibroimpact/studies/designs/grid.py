"""Full factorial design: all combinations of the levels."""

from __future__ import annotations

from collections.abc import Mapping
from math import prod

from vibroimpact.studies.axes import Axis
from vibroimpact.studies.design import Design
from vibroimpact.studies.plan import Plan


def size(axes: Mapping[str, Axis], samples: int) -> int:
    """Return the number of combinations."""
    return prod(map(len, axes.values()))


def plan(axes: Mapping[str, Axis], samples: int, seed: int) -> Plan:
    """Return the points of the grid."""
    return Plan("grid", {key: axis.levels() for key, axis in axes.items()}, True)


DESIGN = Design("grid", "all combinations of the values", False, size, plan)
