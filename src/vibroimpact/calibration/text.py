"""Terminal output of the calibrate command."""

from __future__ import annotations

from rich.columns import Columns
from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.calibration.calibration import Calibration
from vibroimpact.calibration.tables import (
    Cells,
    differences_tables,
    fit_sentences,
    function_words,
    given_sentences,
    match_words,
    values_table,
    ways_words,
)
from vibroimpact.cases.case import Case
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable, numbers


def calibration_summary(case: Case, found: Calibration) -> RenderableType:
    """Return the values, the fitted polynomial, the remaining differences and the warnings of a calibration, for the terminal."""
    parts: list[RenderableType] = [
        Text(case.name or "a drop", style="bold"),
        Text(f"{case.contact.law}, so that {match_words(found)}"),
        Text(),
        _table(values_table(found)),
        Text(),
        Text(function_words(found), style="bold"),
        *(Text(f" {sentence}") for sentence in fit_sentences(found)),
    ]
    if sentences := given_sentences(found):
        parts += [Text(), *(Text(sentence) for sentence in sentences)]
    if tables := differences_tables(found):
        parts += [Text(), Text("What is still wrong", style="bold")]
        parts.append(Columns([Group(Text(f" {title}"), _table(cells)) for title, cells in tables.items()], padding=(0, 4)))
        parts.append(Text(f" {ways_words(found)}", style="dim"))
    parts += [Text(), *(Text(f"Doubt: {doubt}.") for doubt in found.doubts)] if found.doubts else []
    return Group(*parts)


def _table(cells: Cells) -> TerminalTable:
    (first, *headers), rows = cells
    names, *columns = zip(*rows, strict=True)
    key = TerminalColumn(first[0], names, text=True)
    return TerminalTable([key, *(numbers(heading, unit, one) for (heading, unit), one in zip(headers, columns, strict=True))])
