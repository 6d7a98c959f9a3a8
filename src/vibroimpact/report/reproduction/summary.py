"""What the command prints of a reproduction: how many values of each part are reproduced."""

from __future__ import annotations

from pathlib import Path

from rich.table import Table

from vibroimpact.report.reproduction.folder import read_parts
from vibroimpact.report.reproduction.page import counts
from vibroimpact.reproduction.row import Verdict


def summary_table(folder: Path) -> Table:
    """Return how many values have each verdict, part by part."""
    table = Table(box=None, padding=(0, 1), header_style="bold")
    table.add_column("part")
    for verdict in Verdict:
        table.add_column(verdict.value, justify="right")
    for name, by in counts(read_parts(folder)).items():
        table.add_row(name, *map(str, by.values()), style="bold" if name == "all" else "")
    return table
