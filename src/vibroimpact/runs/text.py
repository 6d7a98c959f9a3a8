"""Result of one drop as printed in a terminal: impact table, energy ledger, status and doubts."""

from __future__ import annotations

from collections.abc import Iterable

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.dynamics.columns import ALL_IMPACT_COLUMNS
from vibroimpact.dynamics.energy import closure_in_words
from vibroimpact.report.terminal_report import warning_lines
from vibroimpact.report.terminal_table import (
    TerminalColumn,
    TerminalTable,
    facts,
    numbers,
    with_gap,
)
from vibroimpact.results.result import Result
from vibroimpact.runs.deformation import deformation_rows, treatment_sentence
from vibroimpact.runs.tables import PUT_IN, SUM, formatted_column, ledger_table, shown_columns
from vibroimpact.units.display import MISSING, text

_FIRST_LEFT_OUT = (
    "max_acceleration_m_s2",
    "energy_lost_J",
    "separation_speed_m_s",
    "restitution_asked",
    "max_indentation_m",
    "contacts",
    "rebound_height_m",
    "duration_s",
    "approach_speed_m_s",
)
"""Columns left out in a narrow terminal, in this order, until the others fit."""
_FIRST_ROWS, _LAST_ROWS = 15, 3


def impact_table_for_terminal(result: Result, width: int) -> RenderableType:
    """Return the impact table for a terminal of a given width in characters.

    Columns that do not fit are left out, as are the middle rows of a long table. Units and certain
    figures are those of the report.
    """
    impacts, change = result.impacts, result.change_by_impact
    number = len(impacts["impact"])
    if not number:
        return Text("No impact within the run.")
    rows = [index for index in range(number) if not _FIRST_ROWS <= index < number - _LAST_ROWS]
    cells = {name: formatted_column(name, impacts[name], change) for name in shown_columns(result)}
    columns = {
        name: numbers(ALL_IMPACT_COLUMNS[name].short, unit, [shown[index] for index in rows])
        for name, (unit, shown) in cells.items()
    }
    left_out = [name for name in _FIRST_LEFT_OUT if name in columns]
    while left_out and TerminalTable(tuple(columns.values())).width > width:
        del columns[left_out.pop(0)]
    table = TerminalTable(
        with_gap(tuple(columns.values()), _FIRST_ROWS)
        if len(rows) < number
        else tuple(columns.values())
    )
    notes = []
    if "energy_lost_J" in columns and "energy_to_vibration_J" in impacts:
        friction = "friction and " if "friction_J" in result.energy else ""
        notes.append(
            f" Energy lost is the energy dissipated in the contact, without {friction}the "
            "energy of vibration."
        )
    if len(columns) < len(cells):
        notes.append(" A wider terminal shows more columns; impacts.csv has all, in SI units.")
    return Group(table, *(Text(note, style="dim") for note in notes))


def energy_table_for_terminal(result: Result) -> RenderableType:
    """Return the final energy ledger for a terminal."""
    unit, ledger = ledger_table(result)
    shown = [row for row in ledger if row.name != SUM]
    names = [
        row.name.removesuffix("_J").replace("_", " ") if row.name != PUT_IN else "put in"
        for row in shown
    ]
    columns = (
        TerminalColumn("energy at the end", names, text=True),
        numbers("", unit, [row.energy for row in shown]),
        TerminalColumn("%", [row.part for row in shown]),
    )
    closure = Text(f" {closure_in_words(float(result.energy['closure_relative']))}", style="dim")
    return Group(TerminalTable(columns, bold=(len(shown) - 1,)), closure)


def result_summary(result: Result, width: int) -> RenderableType:
    """Return what a run prints in a terminal of a given width in characters: tables,
    status, model of deformation, and doubts.
    """
    return Group(
        Text(result.name, style="bold"),
        impact_table_for_terminal(result, width),
        Text(),
        energy_table_for_terminal(result),
        *sensor_lines(result),
        Text(),
        Text(result.status),
        *_deformation(result),
        *warning_lines(result.doubts),
    )


def sensor_lines(result: Result) -> list[RenderableType]:
    """Return the largest reading of each sensor, and for how long it was beyond the
    range; empty without sensors.
    """
    if not result.signals:
        return []
    readings = {
        name: (signal.largest, signal.sensor.unit) for name, signal in result.signals.items()
    }
    overloads = [signal.overload_time for signal in result.signals.values()]
    columns = [
        TerminalColumn("sensor", list(readings), text=True),
        TerminalColumn(
            "largest reading", [text(*reading) for reading in readings.values()], text=True
        ),
    ]
    if any(overloads):
        columns.append(
            TerminalColumn(
                "beyond its range for",
                [text(one, "s") if one else MISSING for one in overloads],
                text=True,
            )
        )
    return [Text(), TerminalTable(columns)]


def _deformation(result: Result) -> list[RenderableType]:
    """Return a sentence and numbers on how deformation is modelled; empty for rigid bodies."""
    rows, sentence = deformation_rows(result), treatment_sentence(result)
    return (
        [
            Text(),
            *([Text(sentence)] if sentence else []),
            *([facts(rows, indent=1)] if rows else []),
        ]
        if rows or sentence
        else []
    )


def versions_table(rows: Iterable[tuple[str, str]]) -> RenderableType:
    """Return name-value pairs as a plain table of two columns."""
    return facts(rows)
