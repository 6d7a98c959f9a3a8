"""Measured modes as data: the table, the summary, and what `modes --json` prints of them."""

from __future__ import annotations

from typing import Any

from vibroimpact._version import __version__
from vibroimpact.modes.measured_table import MeasuredTable
from vibroimpact.test_analysis.document import (
    MODE_COLUMNS,
    MODE_HEADERS,
    TEXTS,
    mode_cells,
    mode_record,
    mode_row,
    without_blank_remarks,
)
from vibroimpact.test_analysis.measured.modes_of_file import MeasuredModes

_MEASURED = (
    "frequency_Hz",
    "frequency_low_Hz",
    "frequency_high_Hz",
    "damping_ratio",
    "damping_ratio_low",
    "damping_ratio_high",
)
MEASURED_COLUMNS = ("mode", *_MEASURED, "remark")
"""Columns of `modes.csv` of a measured file."""
_OF_MEASURED = (
    "Mode",
    "Measured, Hz",
    "95 % ±",
    "Measured damping ratio",
    "95 % from",
    "to",
    "Remark",
)


def measured_table(found: MeasuredModes) -> tuple[list[str], list[list[str]]]:
    """Return headers and rows of the table of measured modes alone, numbered by their
    frequencies.
    """
    rows = []
    for number, pair in enumerate(found.modes, start=1):
        cells = dict(zip(MODE_HEADERS, mode_row(pair), strict=True)) | {"Mode": str(number)}
        rows.append([cells[head] for head in _OF_MEASURED])
    return without_blank_remarks(_OF_MEASURED, rows)


def measured_records(found: MeasuredModes) -> list[dict[str, Any]]:
    """Return the measured modes alone as rows of `MEASURED_COLUMNS`."""
    return [
        {
            name: value
            for name, value in (mode_record(pair) | {"mode": number}).items()
            if name in MEASURED_COLUMNS
        }
        for number, pair in enumerate(found.modes, start=1)
    ]


def compared_table(found: MeasuredModes) -> MeasuredTable:
    """Return the modes of a case and measured ones as the folder of the case's modes has them."""
    rows = [mode_record(pair) for pair in found.modes]
    return MeasuredTable(*mode_cells(found.modes), TEXTS, MODE_COLUMNS, rows, found.doubts)


def summary_of_measured(found: MeasuredModes) -> dict[str, Any]:
    """Return the content of `summary.json` of a measured file, and of what `modes --json`
    prints of it.
    """
    return {
        "version": __version__,
        "band_Hz": [float(found.frequency[0]), float(found.frequency[-1])],
        "responses": [
            {
                "response": one.name,
                "reference": one.reference.name,
                "unit": one.unit or None,
                "source": one.source,
            }
            for one in found.responses
        ],
        "modes": measured_records(found),
        "doubts": list(found.doubts),
    }
