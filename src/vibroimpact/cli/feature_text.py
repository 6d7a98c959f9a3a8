"""What `features` prints: the list of features, and the summary of a table."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable
from vibroimpact.signals.reasons import Reason
from vibroimpact.signals.record_table import RecordTable
from vibroimpact.signals.registry import signal_features
from vibroimpact.units.display import digits

_SIGNAL = "x"
"""Stands for the unit of the signal."""


def feature_list() -> RenderableType:
    """Return the table of features."""
    features = signal_features().values()
    units = [feature.unit_for(_SIGNAL) for feature in features]
    columns = (
        TerminalColumn("feature", [feature.name for feature in features], text=True),
        TerminalColumn("unit", units, text=True),
        TerminalColumn("what", [feature.meaning for feature in features], text=True),
        TerminalColumn("equation", [feature.equation for feature in features], text=True),
        TerminalColumn("source", [feature.source for feature in features], text=True),
    )
    note = (
        "x are the samples, and their unit; a is their envelope, X their transform, P their "
        "energy by frequency f."
    )
    return Group(TerminalTable(columns), Text(), Text(note))


def features_document() -> dict[str, Any]:
    """Return the features by name, with x for the unit of the signal, and how they scale."""
    features = {
        feature.name: {
            "unit": feature.unit_for(_SIGNAL),
            "meaning": feature.meaning,
            "equation": feature.equation,
            "source": feature.source,
            "degree": feature.degree,
            "offset_free": feature.offset_free,
            "least_samples": feature.least,
        }
        for feature in signal_features().values()
    }
    return {"features": features}


def table_document(table: RecordTable) -> dict[str, Any]:
    """Return the rows of a table as its file has them, with null where a feature has no value."""
    offsets = table.offset
    drifts = table.drift
    signals = []
    for row, record in enumerate(table.records):
        values = table.values[row].tolist()
        signals.append(
            {
                "file": record.source,
                "channel": record.name,
                "signal": table.numbers[row],
                "start_s": record.start,
                "rate_Hz": record.rate,
                "unit": record.unit,
                **dict(zip(table.columns, values, strict=True)),
                "offset": offsets[row],
                "drift": drifts[row],
                "lacking": table.lacking(row),
            }
        )
    return {"signals": signals}


class _Row(NamedTuple):
    """A row of the summary; its numbers are texts."""

    name: str
    unit: str
    numbers: list[str]
    lacking: str


def table_summary(table: RecordTable) -> RenderableType:
    """Return the least, middle and largest value of each feature, and why signals lack it."""
    units = {record.unit for record in table.records}
    unit = units.pop() if len(units) == 1 else _SIGNAL
    rows = [*_feature_rows(table, unit), *_baseline_rows(table, unit)]
    number_heads = ["value"]
    if len(table.records) > 1:
        number_heads = ["least", "median", "largest"]
    columns = [TerminalColumn("feature", [row.name for row in rows], text=True)]
    for position, head in enumerate(number_heads):
        columns.append(TerminalColumn(head, [row.numbers[position] for row in rows]))
    columns.append(TerminalColumn("unit", [row.unit for row in rows], text=True))
    lacking = [row.lacking for row in rows]
    if any(lacking):
        columns.append(TerminalColumn("signals without it", lacking, text=True))
    return TerminalTable(columns)


def _feature_rows(table: RecordTable, unit: str) -> Iterator[_Row]:
    for name, values, reasons in zip(table.names, table.values.T, table.reasons.T, strict=True):
        numbers = _least_middle_largest(values[~np.isnan(values)])
        counts = Counter(reasons[reasons > 0].tolist())
        lacking = "; ".join(f"{count}: {Reason(code).text}" for code, count in counts.items())
        yield _Row(name, signal_features()[name].unit_for(unit), numbers, lacking)


def _baseline_rows(table: RecordTable, unit: str) -> Iterator[_Row]:
    """Yield what was removed from the records, if anything was."""
    if any(table.offset):
        yield _Row("offset removed", unit, _least_middle_largest(table.offset), "")
    if any(table.drift):
        yield _Row("drift removed", unit, _least_middle_largest(table.drift), "")


def _least_middle_largest(values: ArrayLike) -> list[str]:
    """Return three of the values as texts; of a single one they are alike, of none empty."""
    numbers = np.asarray(values, dtype=float)
    if not numbers.size:
        return ["", "", ""]
    percentiles = np.percentile(numbers, (0, 50, 100), method="nearest")
    return [digits(float(percentile)) for percentile in percentiles]
