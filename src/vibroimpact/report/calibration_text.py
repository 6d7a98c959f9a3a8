"""What the calibrate command prints."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from vibroimpact.calibration.calibrate import Calibration
from vibroimpact.cases.schema import Case
from vibroimpact.report.calibration_tables import (
    Cells,
    differences_table,
    fit_sentences,
    function_words,
    given_sentences,
    match_words,
    values_table,
    ways_words,
)


def calibration_summary(case: Case, found: Calibration) -> RenderableType:
    """Return the function, the value of each impact, what it still gets wrong, and what to doubt."""
    parts: list[RenderableType] = [
        Text(case.name or "a drop", style="bold"),
        Text(f"{case.contact.law}, so that {match_words(found)} of each impact comes out as wanted"),
        Text(),
        _table(values_table(found)),
        Text(),
        Text(function_words(found), style="bold"),
        *(Text(f" {sentence}") for sentence in fit_sentences(found)),
    ]
    if sentences := given_sentences(found):
        parts += [Text(), *(Text(sentence) for sentence in sentences)]
    off = differences_table(found)
    if off[1]:
        parts += [Text(), Text("What is still wrong [%]", style="bold"), _table(off), Text(f" {ways_words()}", style="dim")]
    parts += [Text(), *(Text(f"Doubt: {doubt}.") for doubt in found.doubts)] if found.doubts else []
    return Group(*parts)


def _table(cells: Cells) -> Table:
    headers, rows = cells
    table = Table(box=None, padding=(0, 1), header_style="bold")
    for number, (heading, unit) in enumerate(headers):
        words = f"{heading}\n[{unit}]".replace(", ", ",\n") if unit else heading
        table.add_column(escape(words), justify="right" if number else "left", no_wrap=not number, vertical="bottom")
    for row in rows:
        table.add_row(*(escape(cell) for cell in row))
    return table
