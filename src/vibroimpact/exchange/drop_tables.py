"""The tables of a drop with their units: what CSV, Parquet and MATLAB files hold alike."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.columns import Column as Facts
from vibroimpact.dynamics.columns import history_columns, impact_columns
from vibroimpact.dynamics.recording import Signal
from vibroimpact.errors import InputError
from vibroimpact.exchange.drop import Drop
from vibroimpact.exchange.plain_names import one_line, plain_names


class Column(NamedTuple):
    """Values (rows,), their unit, and what they mean."""

    values: NDArray[np.generic]
    unit: str
    meaning: str


Table = dict[str, Column]


def tables_of(drop: Drop) -> dict[str, Table]:
    """Return "impacts", "history", and "sensors/NAME" of each sensor; what the drop does not have is not among them.

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
        tables[f"sensors/{plain}"] = _of_signal(drop.signals[name])
    if not tables:
        raise InputError(f'"{one_line(drop.name)}" has no impacts, no history and no signals; there is nothing to write')
    return tables


def signal_csv(signal: Signal) -> str:
    """Return a signal as the text of a CSV file, with every digit of its values."""
    (time_name, time), (name, column) = _of_signal(signal).items()
    rows = (f"{at:.12g},{value!r}" for at, value in zip(time.values.tolist(), column.values.tolist(), strict=True))
    return "\n".join([f"{time_name},{name}", *rows, ""])


def _table(values: Mapping[str, Floats], columns: Mapping[str, Facts]) -> Table:
    found = {}
    for name, column in columns.items():
        kind = np.int64 if column.values == "count" else np.float64
        found[name] = Column(np.asarray(values[name], dtype=kind), column.unit, column.meaning)
    return found


def _of_signal(signal: Signal) -> Table:
    sensor = signal.sensor
    name = f"{sensor.quantity}_{sensor.unit.replace('/', '_')}"
    meaning = f"{sensor.quantity} that the sensor {one_line(sensor.name)} reads"
    return {"time_s": Column(signal.time, "s", "time since the start"), name: Column(signal.value, sensor.unit, meaning)}
