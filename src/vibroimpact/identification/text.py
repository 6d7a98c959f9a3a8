"""What the identify command prints."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.identification.document import HEADERS, identification_rows
from vibroimpact.identification.identify import Identification
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable
from vibroimpact.runs.text import doubt_lines


def identification_summary(found: Identification) -> RenderableType:
    """Return what was found with its intervals, and the doubts, for the terminal."""
    columns = zip(HEADERS, zip(*identification_rows(found), strict=True), strict=True)
    table = TerminalTable(
        [
            TerminalColumn(head.lower(), cells, text=head in ("Quantity", "Unit"))
            for head, cells in columns
        ]
    )
    certain = Text(f" Taken as certain, in no interval: {', '.join(found.certain)}.")
    return Group(
        Text(found.plate.case.name or "an impact", style="bold"),
        table,
        certain,
        *doubt_lines(found.doubts),
    )
