"""Terminal output of the calibrate command."""

from __future__ import annotations

from rich.columns import Columns
from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.calibration.adams_dialog import DIALOG_TITLE, dialog_note
from vibroimpact.calibration.report import CalibrationReport, Cells
from vibroimpact.cases.case import Case
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable, numbers
from vibroimpact.runs.text import doubt_lines


def calibration_summary(case: Case, told: CalibrationReport) -> RenderableType:
    """Return the values, the fit, the remaining differences and the warnings of a
    calibration, for the terminal.
    """
    parts: list[RenderableType] = [
        Text(case.name or "a drop", style="bold"),
        Text(f"{told.law}, so that {told.matched}"),
        Text(),
        cells_table(told.values),
        Text(),
        Text(told.function, style="bold"),
        *(Text(f" {sentence}") for sentence in told.fit),
    ]
    if told.dialog:
        parts += [Text(), Text(DIALOG_TITLE, style="bold"), cells_table(told.dialog)]
        parts += (
            [Text(f" {dialog_note(told.parameter)}", style="dim")]
            if len(told.dialog[1]) > 1
            else []
        )
    if told.given:
        parts += [Text(), *(Text(sentence) for sentence in told.given)]
    if told.differences:
        parts += [Text(), Text("Remaining differences", style="bold")]
        parts.append(
            Columns(
                [
                    Group(Text(f" {title}"), cells_table(cells))
                    for title, cells in told.differences.items()
                ],
                padding=(0, 4),
            )
        )
        parts.append(Text(f" {told.ways}", style="dim"))
    parts += [Text(), *doubt_lines(told.doubts)] if told.doubts else []
    return Group(*parts)


def cells_table(cells: Cells) -> TerminalTable:
    """Return a table as text for the terminal."""
    (first, *headers), rows = cells
    names, *columns = zip(*rows, strict=True)
    key = TerminalColumn(first[0], names, text=True)
    return TerminalTable(
        [
            key,
            *(
                numbers(heading, unit, one)
                for (heading, unit), one in zip(headers, columns, strict=True)
            ),
        ]
    )
