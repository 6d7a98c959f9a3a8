"""What the correlate command prints."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable
from vibroimpact.runs.text import doubt_lines
from vibroimpact.test_analysis.correlate import Correlation
from vibroimpact.test_analysis.document import (
    RECORD_HEADERS,
    TEXTS,
    mode_cells,
    octave_headers,
    octave_rows,
    record_rows,
    what_frac_is_of,
)
from vibroimpact.test_analysis.mode_pairs import damping_field


def correlation_summary(found: Correlation) -> RenderableType:
    """Return how records and simulation agree, the modes of both, the damping to be put
    into the case, and the doubts, for the terminal.
    """
    octaves = octave_rows(found)
    parts: list[RenderableType] = [
        Text(found.case.name or "a test", style="bold"),
        criteria_table(RECORD_HEADERS, record_rows(found)),
        Text(f"\nFRAC of {what_frac_is_of(found)}"),
        criteria_table(octave_headers(found), octaves),
        Text("\nmodes"),
        criteria_table(*mode_cells(found.modes)),
    ]
    if damping := damping_field(found.modes):
        parts.append(Text(f"\nin [plate] of the case:\n{damping}"))
    return Group(*parts, *doubt_lines(found.doubts))


def criteria_table(headers: Sequence[str], rows: Sequence[Sequence[str]]) -> TerminalTable:
    """Return a table of a correlation for the terminal."""
    columns = (
        zip(headers, zip(*rows, strict=True), strict=True)
        if rows
        else ((head, ()) for head in headers)
    )
    return TerminalTable(
        [TerminalColumn(head, cells, text=head in TEXTS) for head, cells in columns]
    )
