"""The report of a calibration, for the terminal, the page and the files of its folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from vibroimpact.cases.case import Case
from vibroimpact.charts.chart import Chart

Cells = tuple[list[tuple[str, str]], list[list[str]]]
"""A table as text: headers with units, and rows."""

_MOST_ROWS = 50


def shortened(rows: list[list[str]]) -> list[list[str]]:
    """Return the first rows of a table, and an ellipsis if there are more."""
    if len(rows) <= _MOST_ROWS:
        return rows
    ellipsis = ["…", *[""] * (len(rows[0]) - 1)]
    return [*rows[: _MOST_ROWS - 1], ellipsis]


@dataclass(frozen=True, kw_only=True, eq=False)
class CalibrationReport:
    """The report of a calibration.

    Parameters
    ----------
    law : str
        Name of the calibrated law.
    parameter : str
        What was tuned.
    matched : str
        What was matched, in words that follow the law.
    function : str
        What was found.
    fit, given : sequence of str
        Sentences on how well it is known, and on what the case gives.
    values : Cells
        The matched impacts.
    dialog : Cells, optional
        What Adams' dialog of a contact takes; None for laws other than IMPACT.
    differences : mapping of str to Cells
        Remaining differences, by their titles.
    ways : str
        In what ways the values of these differences are prescribed.
    charts : sequence of Chart
        The charts.
    doubts : sequence of str
        Warnings, as sentences.
    document : mapping
        Contents of `calibration.json`.
    tables : mapping of str to sequences of rows
        The CSV files, by their names without ending.
    calibrated : Case
        The case with the values found.
    """

    law: str
    parameter: str
    matched: str
    function: str
    fit: Sequence[str]
    given: Sequence[str]
    values: Cells
    dialog: Cells | None = None
    differences: Mapping[str, Cells]
    ways: str
    charts: Sequence[Chart]
    doubts: Sequence[str]
    document: Mapping[str, Any]
    tables: Mapping[str, Sequence[dict[str, Any]]]
    calibrated: Case
