"""The impact table as rows and as CSV."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from vibroimpact.dynamics.columns import HISTORY_COLUMNS, IMPACT_COLUMNS, VIBRATION_HISTORY_COLUMNS, VIBRATION_IMPACT_COLUMNS

_COUNTS = ("impact", "contacts")


def impact_columns(impacts: Iterable[str]) -> dict[str, tuple[str, str]]:
    """Return unit and meaning of the columns that an impact table has: more where a body vibrates."""
    has = set(impacts)
    return {name: told for name, told in {**IMPACT_COLUMNS, **VIBRATION_IMPACT_COLUMNS}.items() if name in has}


def history_columns(history: Iterable[str]) -> dict[str, tuple[str, str]]:
    """Return unit and meaning of the columns that a history has: more where a body vibrates."""
    has = set(history)
    return {name: told for name, told in {**HISTORY_COLUMNS, **VIBRATION_HISTORY_COLUMNS}.items() if name in has}


def impact_rows(impacts: dict[str, Any]) -> list[dict[str, float | int | None]]:
    """Return the impact table as one mapping an impact; None where there is no value.

    Examples
    --------
    >>> import numpy as np
    >>> impact_rows({name: np.array([1.0]) for name in IMPACT_COLUMNS})[0]["impact"]
    1
    """
    rows: list[dict[str, float | int | None]] = []
    columns = impact_columns(impacts)
    for index in range(len(impacts["impact"])):
        row: dict[str, float | int | None] = {}
        for name in columns:
            value = float(impacts[name][index])
            row[name] = (int(value) if name in _COUNTS else value) if math.isfinite(value) else None
        rows.append(row)
    return rows


def write_csv(rows: list[dict[str, Any]], columns: list[str], path: Path) -> None:
    """Write rows with every digit; an empty cell where there is no value."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: "" if value is None else value for name, value in row.items()} for row in rows)
