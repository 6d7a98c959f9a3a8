"""The tables of a drop with units, as CSV, Parquet and MATLAB files hold them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.columns import Column, history_columns, impact_columns
from vibroimpact.errors import InputError
from vibroimpact.exporting.drop import Drop
from vibroimpact.files.plain_names import one_line, plain_names
from vibroimpact.results.csv_files import TableColumn, signal_columns

Table = dict[str, TableColumn]


def tables_of(drop: Drop) -> dict[str, Table]:
    """Return the tables "impacts", "history", and "sensors/NAME" of each sensor, as far as the drop
    has them.

    Raises
    ------
    InputError
        If it has none of them.
    """
    tables: dict[str, Table] = {}
    if drop.impacts:
        tables["impacts"] = _table(drop.impacts, impact_columns(drop.impacts))
    if drop.history:
        tables["history"] = _table(drop.history, history_columns(drop.history))
    for name, plain in plain_names(list(drop.signals)).items():
        tables[f"sensors/{plain}"] = signal_columns(drop.signals[name])
    if not tables:
        raise InputError(
            f'"{one_line(drop.name)}" has no impacts, no history and no signals; there is '
            "nothing to write"
        )
    return tables


def _table(values: Mapping[str, Floats], columns: Mapping[str, Column]) -> Table:
    table = {}
    for name, column in columns.items():
        kind = np.int64 if column.values == "count" else np.float64
        table[name] = TableColumn(np.asarray(values[name], dtype=kind), column.unit, column.meaning)
    return table
