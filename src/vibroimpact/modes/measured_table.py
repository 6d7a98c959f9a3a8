"""Measured modes beside those of a case, as a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from vibroimpact.report.report import Table


class MeasuredTable(NamedTuple):
    """Measured modes beside those of a case.

    `table` is what is shown; `columns` and `rows` are the table of `measured.csv`; and `doubts` is
    what is not sure.
    """

    table: Table
    columns: Sequence[str]
    rows: Sequence[Mapping[str, Any]]
    doubts: Sequence[str]
