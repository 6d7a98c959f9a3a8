"""What the command `bound` prints."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.bayes_error.bound import Bound
from vibroimpact.bayes_error.tables import (
    HEADERS,
    error_rows,
    headline,
    heard_words,
    sampling_words,
    scatter_words,
)
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable


def bound_summary(bound: Bound) -> RenderableType:
    """Return the console report of a bound."""
    names, *errors_and_left = zip(*error_rows(bound), strict=True)
    columns = [TerminalColumn(HEADERS[0], names, text=True)]
    columns += [
        TerminalColumn(heading, cells, text=True)
        for heading, cells in zip(HEADERS[1:3], errors_and_left[:2], strict=True)
    ]
    columns += [
        TerminalColumn(heading, cells)
        for heading, cells in zip(HEADERS[3:], errors_and_left[2:], strict=True)
    ]
    note = (
        "Without scatter: without that of the amplitude; the noise remains. Remaining: "
        "standard deviation of the logarithm after the best "
        "linear estimate, over that in the population."
    )
    return Group(
        Text(f"Bounds on the classification error: {bound.name}", style="bold"),
        Text(headline(bound)),
        Text(scatter_words(bound)),
        TerminalTable(columns),
        Text(f" {note}", style="dim"),
        Text(f" {heard_words(bound)}", style="dim"),
        Text(f" {sampling_words(bound)}", style="dim"),
    )
