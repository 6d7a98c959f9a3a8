"""CSV files of a result: the impact table, and one file for each sensor signal."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.columns import impact_columns
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.files.plain_names import one_line, plain_names

MOST_CSV_SAMPLES = 250_000
"""Largest number of samples written as CSV; a longer signal is stored in `result.nc` only."""


def impact_rows(impacts: dict[str, Any]) -> list[dict[str, float | int | None]]:
    """Return the impact table as one mapping per impact; None where a value is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from vibroimpact.dynamics.motion.columns import IMPACT_COLUMNS
    >>> impact_rows({name: np.array([1.0]) for name in IMPACT_COLUMNS})[0]["impact"]
    1
    """
    return list(_rows(impacts))


def write_impacts(impacts: dict[str, Any], path: Path) -> None:
    """Write the impact table as a CSV file."""
    write_csv(_rows(impacts), list(impact_columns(impacts)), path)


def _rows(impacts: dict[str, Any]) -> Iterator[dict[str, float | int | None]]:
    columns = impact_columns(impacts)
    for index in range(len(impacts["impact"])):
        row: dict[str, float | int | None] = {}
        for name, column in columns.items():
            number = float(impacts[name][index])
            if not math.isfinite(number):
                row[name] = None
            elif column.values == "count":
                row[name] = int(number)
            else:
                row[name] = number
        yield row


def write_csv(rows: Iterable[Mapping[str, Any]], columns: Sequence[str], path: Path) -> None:
    """Write rows as a CSV file with numbers in full precision; None becomes an empty cell."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow(row)


def write_rows(rows: Sequence[dict[str, Any]], path: Path) -> None:
    """Write rows that have the same columns as a CSV file; the first row names them."""
    write_csv(rows, list(rows[0]), path)


def write_columns(columns: Mapping[str, Floats], path: Path) -> None:
    """Write columns of equal lengths, by their names, as a CSV file."""
    names = list(columns)
    table = np.stack(list(columns.values()), axis=1).tolist()
    write_csv((dict(zip(names, row, strict=True)) for row in table), names, path)


class TableColumn(NamedTuple):
    """Column of a table: values (rows,), unit and meaning."""

    values: NDArray[np.generic]
    unit: str
    meaning: str


def signal_columns(signal: Signal) -> dict[str, TableColumn]:
    """Return the columns of a signal's table: sample times and values."""
    sensor = signal.sensor
    name = f"{sensor.quantity}_{sensor.unit.replace('/', '_')}"
    meaning = f"{sensor.quantity} measured by the sensor {one_line(sensor.name)}"
    return {
        "time_s": TableColumn(signal.time, "s", "time since the start"),
        name: TableColumn(signal.value, sensor.unit, meaning),
    }


def signal_csv(signal: Signal) -> str:
    """Return a signal as the text of a CSV file.

    Times have 12 significant digits, values full precision.
    """
    (time_name, time), (name, column) = signal_columns(signal).items()
    rows = np.stack([time.values, column.values], axis=1)
    # all rows in one operation: a signal has 100,000 samples and more
    return f"{time_name},{name}\n" + "%.12g,%r\n" * len(rows) % tuple(rows.ravel().tolist())


def write_signal_files(signals: Mapping[str, Signal], directory: Path) -> None:
    """Write `NAME.csv` for each signal of at most 250,000 samples, its unit in the header.

    The folder is made only if there is such a signal.
    """
    for name, plain in plain_names(list(signals)).items():
        signal = signals[name]
        if len(signal.value) > MOST_CSV_SAMPLES:
            continue
        directory.mkdir(exist_ok=True)
        (directory / f"{plain}.csv").write_text(signal_csv(signal), encoding="utf-8", newline="\n")
