"""Console output of the export command: the table of formats, and the summary of an export."""

from __future__ import annotations

from collections.abc import Sequence
from os.path import commonpath
from pathlib import Path

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.calibration.contact_law.adams_dialog import dialog_table
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, Rows, export_formats
from vibroimpact.report.report import Column, Table
from vibroimpact.report.terminal_report import block_lines, warning_lines
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable
from vibroimpact.units.display import digits

_UNITS = {"_N_m_n": "N/m^n", "_Pa": "Pa", "_N": "N", "_s": "s"}
"""Units at the ends of the names of columns."""

_MOST = 6
"""Largest number of files that are listed; of more files, the first ones and a count."""


def format_table() -> RenderableType:
    """Return the table of export formats."""
    formats = export_formats()
    said = {
        "read by": [format.program for format in formats.values()],
        "files": [format.files for format in formats.values()],
    }
    said["tested"] = [format.tested for format in formats.values()]
    table = TerminalTable(
        [
            TerminalColumn("format", list(formats), text=True),
            *(TerminalColumn(name, cells, text=True) for name, cells in said.items()),
        ]
    )
    return Group(
        table,
        Text(),
        Text(
            "vibroimpact export DIR --to FORMAT writes a result folder, or a calibration "
            "folder, in one of them."
        ),
    )


def export_summary(drop: Drop, format: ExportFormat, files: Sequence[Path]) -> RenderableType:
    """Return the files written, what a dialog takes, the limitations of the format, the
    doubts about the drop, and how it was tested.
    """
    shown = files if len(files) <= _MOST else files[: _MOST - 1]
    lines: list[RenderableType] = [Text(f"wrote {file}") for file in shown]
    if len(shown) < len(files):
        lines.append(Text(f"and {len(files) - len(shown)} more files in {commonpath(files)}"))
    if dialog := format.dialog(drop):
        speeds = drop.impacts["approach_speed_m_s"].tolist()
        names = [
            f"impact {number} at {digits(speed)} m/s" for number, speed in enumerate(speeds, 1)
        ]
        lines += block_lines(dialog_table(dialog, names))
    for name, rows in format.rows(drop).items():
        lines += block_lines(_rows_table(name, rows))
    lines += [Text(f"Note: {note}", style="yellow") for note in format.notes(drop)]
    lines += warning_lines(drop.doubts)
    lines.append(Text(f"Tested: {format.tested}.", style="dim"))
    return Group(*lines)


def _rows_table(name: str, rows: Rows) -> Table:
    """Return rows as a table."""
    columns = []
    for column, first in rows[0].items():
        is_text = isinstance(first, str)
        cells = [str(row[column]) if is_text else f"{row[column]:.6g}" for row in rows]
        suffix = next((ending for ending in _UNITS if column.endswith(ending)), "")
        heading = column.removesuffix(suffix).replace("_", " ")
        columns.append(Column(heading, cells, _UNITS.get(suffix, ""), is_text=is_text))
    return Table(columns, title=name.replace("-", " ").capitalize())
