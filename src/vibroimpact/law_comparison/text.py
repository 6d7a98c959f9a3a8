"""What the compare command prints: a row a law, and what sets the loss of each."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.law_comparison.comparison import (
    Comparison,
    comparison_doubts,
    comparison_subtitle,
    comparison_table,
    comparison_title,
    free_parameter_words,
)
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable, facts, numbers
from vibroimpact.runs.text import doubt_lines


def comparison_summary(comparison: Comparison) -> RenderableType:
    """Return the console report of a comparison: a row for each law, the free parameter
    of each law, and the doubts.
    """
    headers, rows = comparison_table(comparison)
    names, *cells = zip(*rows, strict=True)
    key = TerminalColumn(headers[0][0], names, text=True)
    table = TerminalTable(
        [
            key,
            *(
                numbers(heading, unit, one)
                for (heading, unit), one in zip(headers[1:], cells, strict=True)
            ),
        ]
    )
    free = facts(
        [
            (name, free_parameter_words(law), comparison.results[name].status)
            for name, law in comparison.laws.items()
        ],
        indent=1,
    )
    words = (
        "Indentation, force, duration, height and energy are those of the first impact; energy "
        "lost is dissipated in its contact."
    )
    note = Text(f" {words}", style="dim")
    title = Text("Loss parameters, and end of each run", style="bold")
    heading = (
        Text(comparison_title(comparison), style="bold"),
        Text(comparison_subtitle(comparison)),
    )
    return Group(
        *heading, table, note, Text(), title, free, *doubt_lines(comparison_doubts(comparison))
    )
