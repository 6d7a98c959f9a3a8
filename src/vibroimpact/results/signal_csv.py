"""The signals of sensors as CSV: one file each, where they are small enough to be of use so."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.files.plain_names import one_line, plain_names

MOST_SAMPLES = 250_000
"""Of a signal that is written; a longer one is in `result.nc` alone."""


class TableColumn(NamedTuple):
    """Values (rows,), their unit, and what they mean."""

    values: NDArray[np.generic]
    unit: str
    meaning: str


def signal_columns(signal: Signal) -> dict[str, TableColumn]:
    """Return the times of a signal and its values as two columns of a table."""
    sensor = signal.sensor
    name = f"{sensor.quantity}_{sensor.unit.replace('/', '_')}"
    meaning = f"{sensor.quantity} that the sensor {one_line(sensor.name)} reads"
    return {"time_s": TableColumn(signal.time, "s", "time since the start"), name: TableColumn(signal.value, sensor.unit, meaning)}


def signal_csv(signal: Signal) -> str:
    """Return a signal as the text of a CSV file, with every digit of its values."""
    (time_name, time), (name, column) = signal_columns(signal).items()
    rows = (f"{at:.12g},{value!r}" for at, value in zip(time.values.tolist(), column.values.tolist(), strict=True))
    return "\n".join([f"{time_name},{name}", *rows, ""])


def write_signal_files(signals: Mapping[str, Signal], directory: Path) -> None:
    """Write `NAME.csv` for each signal that is not too long, with its unit in the header; no folder if there is none."""
    for name, plain in plain_names(list(signals)).items():
        signal = signals[name]
        if len(signal.value) > MOST_SAMPLES:
            continue
        directory.mkdir(exist_ok=True)
        (directory / f"{plain}.csv").write_text(signal_csv(signal), encoding="utf-8", newline="\n")
