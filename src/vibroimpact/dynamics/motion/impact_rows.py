"""Tables of the impacts of single drops, and of several drops side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.columns import (
    CARRIED_IMPACT_COLUMNS,
    OBLIQUE_IMPACT_COLUMNS,
    SHAKEN_IMPACT_COLUMNS,
)
from vibroimpact.dynamics.statement.problem import Problem


def table_of(rows: Sequence[Mapping[str, float]], columns: Sequence[str]) -> dict[str, Floats]:
    """Return columns of the impacts of one drop (impacts,); what a row lacks is NaN.

    Examples
    --------
    >>> table_of([{"time_s": 0.5}, {}], ["time_s"])
    {'time_s': array([0.5, nan])}
    """
    return {name: np.array([row.get(name, np.nan) for row in rows]) for name in columns}


def further_columns(problem: Problem) -> list[str]:
    """Return the columns that a table of impacts has for what moves, rubs or flows."""
    columns: list[str] = []
    if problem.motion is not None:
        columns += SHAKEN_IMPACT_COLUMNS
    if problem.oblique is not None:
        columns += OBLIQUE_IMPACT_COLUMNS
        if problem.motion is not None:
            columns += CARRIED_IMPACT_COLUMNS
    if problem.fluid is not None:
        columns.append(f"{problem.fluid.key}_lost_J")
    return columns


def stacked_tables(
    tables: Sequence[Mapping[str, Floats]], columns: Sequence[str]
) -> dict[str, Floats]:
    """Return columns of the tables of several drops, (B, impacts).

    Impacts that a drop does not have are NaN.

    Examples
    --------
    >>> stacked_tables([{"time_s": np.array([0.5, 0.7])}, {"time_s": np.zeros(0)}], ["time_s"])
    {'time_s': array([[0.5, 0.7],
           [nan, nan]])}
    """
    most = max(len(next(iter(table.values()))) for table in tables)
    stacked = {name: np.full((len(tables), most), np.nan) for name in columns}
    for number, table in enumerate(tables):
        for name in columns:
            stacked[name][number, : len(table[name])] = table[name]
    return stacked
