"""What the command prints of a reproduction: how many values of each part are reproduced."""

from __future__ import annotations

from pathlib import Path

from vibroimpact.paper.printed_and_computed import Verdict
from vibroimpact.paper.report.folder import read_parts
from vibroimpact.paper.report.page import counts
from vibroimpact.report.terminal_table import Column, TerminalTable


def summary_table(folder: Path) -> TerminalTable:
    """Return how many values have each verdict, part by part."""
    parts = counts(read_parts(folder))
    verdicts = [Column(verdict.value.replace(" ", "\u00a0"), [str(by[verdict.value]) for by in parts.values()]) for verdict in Verdict]
    return TerminalTable([Column("part", list(parts), words=True), *verdicts], bold=[len(parts) - 1])
