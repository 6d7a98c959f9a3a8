"""Full factorial design: all combinations of the levels."""

from __future__ import annotations

from math import prod

from vibroimpact.studies.planning.design import Asked, Design
from vibroimpact.studies.planning.plan import Plan


def size(asked: Asked) -> int:
    """Return the number of combinations."""
    return prod(map(len, asked.axes.values()))


def plan(asked: Asked) -> Plan:
    """Return the points of the grid."""
    return Plan("grid", {key: axis.levels() for key, axis in asked.axes.items()}, True)


DESIGN = Design("grid", "all combinations of the values", False, size, plan)
