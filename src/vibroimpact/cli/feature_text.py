"""What `features` prints: the list of features, and the summary of a table."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
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
    found = signal_features().values()
    columns = (
        TerminalColumn("feature", [one.name for one in found], text=True),
        TerminalColumn("unit", [one.unit_for(_SIGNAL) for one in found], text=True),
        TerminalColumn("what", [one.meaning for one in found], text=True),
        TerminalColumn("equation", [one.equation for one in found], text=True),
        TerminalColumn("source", [one.source for one in found], text=True),
    )
    note = (
        "x are the samples, and their unit; a is their envelope, X their transform, P their "
        "energy by frequency f."
    )
    return Group(TerminalTable(columns), Text(), Text(note))


def features_document() -> dict[str, Any]:
    """Return the features by name: unit (with x for that of the signal), meaning,
    equation, source, and how they scale.
    """
    return {
        "features": {
            one.name: {
                "unit": one.unit_for(_SIGNAL),
                "meaning": one.meaning,
                "equation": one.equation,
                "source": one.source,
                "degree": one.degree,
                "offset_free": one.offset_free,
                "least_samples": one.least,
            }
            for one in signal_features().values()
        }
    }


def table_document(table: RecordTable) -> dict[str, Any]:
    """Return the rows of a table as its file has them, with null where a feature has no value."""
    return {
        "signals": [
            {
                "file": one.source,
                "channel": one.name,
                "signal": number,
                "start_s": one.start,
                "rate_Hz": one.rate,
                "unit": one.unit,
                **dict(zip(table.columns, values, strict=True)),
                "offset": table.offset[row],
                "drift": table.drift[row],
                "lacking": table.lacking(row),
            }
            for row, (one, number, values) in enumerate(
                zip(table.records, table.numbers, table.values.tolist(), strict=True)
            )
        ]
    }


def table_summary(table: RecordTable) -> RenderableType:
    """Return each feature with its least, middle and largest value over the signals, and
    why signals lack it.
    """
    units = {one.unit for one in table.records}
    unit = units.pop() if len(units) == 1 else _SIGNAL
    cells: list[tuple[str, ...]] = []
    for name, values, reasons in zip(table.names, table.values.T, table.reasons.T, strict=True):
        there = values[~np.isnan(values)]
        shown = (
            [digits(float(one)) for one in np.percentile(there, (0, 50, 100), method="nearest")]
            if there.size
            else [""] * 3
        )
        lacking = "; ".join(
            f"{count}: {Reason(code).text}"
            for code, count in Counter(reasons[reasons > 0].tolist()).items()
        )
        cells.append(
            (
                name,
                signal_features()[name].unit_for(unit),
                *(shown if len(table.records) > 1 else shown[:1]),
                lacking,
            )
        )
    for name, removed in (("offset", table.offset), ("drift", table.drift)):
        if any(removed):
            shown = [
                digits(float(one)) for one in np.percentile(removed, (0, 50, 100), method="nearest")
            ]
            cells.append(
                (f"{name} removed", unit, *(shown if len(table.records) > 1 else shown[:1]), "")
            )
    heads = ("least", "median", "largest") if len(table.records) > 1 else ("value",)
    names, of_units, *numbers, lacking_cells = zip(*cells, strict=True)
    columns = [
        TerminalColumn("feature", names, text=True),
        *(TerminalColumn(head, one) for head, one in zip(heads, numbers, strict=True)),
    ]
    columns.append(TerminalColumn("unit", of_units, text=True))
    if any(lacking_cells):
        columns.append(TerminalColumn("signals without it", lacking_cells, text=True))
    return TerminalTable(columns)
