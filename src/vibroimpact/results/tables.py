"""The impact table as rows and as CSV."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from vibroimpact.dynamics.columns import impact_columns


def impact_rows(impacts: dict[str, Any]) -> list[dict[str, float | int | None]]:
    """Return the impact table as one mapping an impact; None where there is no value.

    Examples
    --------
    >>> import numpy as np
    >>> from vibroimpact.dynamics.columns import IMPACT_COLUMNS
    >>> impact_rows({name: np.array([1.0]) for name in IMPACT_COLUMNS})[0]["impact"]
    1
    """
    return list(_rows(impacts))


def write_impacts(impacts: dict[str, Any], path: Path) -> None:
    """Write the impact table as CSV."""
    write_csv(_rows(impacts), list(impact_columns(impacts)), path)


def _rows(impacts: dict[str, Any]) -> Iterator[dict[str, float | int | None]]:
    columns = impact_columns(impacts)
    for index in range(len(impacts["impact"])):
        row: dict[str, float | int | None] = {}
        for name in columns:
            value = float(impacts[name][index])
            row[name] = (int(value) if columns[name].values == "count" else value) if math.isfinite(value) else None
        yield row


def write_csv(rows: Iterable[dict[str, Any]], columns: list[str], path: Path) -> None:
    """Write rows with every digit; an empty cell where there is no value."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: "" if value is None else value for name, value in row.items()} for row in rows)
