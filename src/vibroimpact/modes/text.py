"""Console output on modes, and on elastic bodies before their modes are computed."""

from __future__ import annotations

from collections.abc import Mapping

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.cases.case import Case
from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.cases.elastic.modes import BodyModes
from vibroimpact.modes.document import mesh_facts
from vibroimpact.modes.measured_table import MeasuredTable
from vibroimpact.modes.tables import ROWS, body_facts, mode_table, rows_left_out, supports_text
from vibroimpact.report.report import table_of
from vibroimpact.report.terminal_report import block_lines, warning_lines
from vibroimpact.report.terminal_table import TerminalTable, facts, numbers, with_gap


def modes_summary(case: Case, modes: Mapping[str, BodyModes]) -> RenderableType:
    """Return the console report on the modes of a case: each body, its lowest modes, and
    the doubts.
    """
    parts: list[RenderableType] = [Text(case.name or "modes", style="bold")]
    for name, found in modes.items():
        doubts = (Text(f"Doubt: {doubt}.", style="yellow") for doubt in found.doubts)
        parts += [facts(body_facts(name, found)), _terminal_table(found), *doubts, Text()]
    return Group(*parts[:-1])


def _terminal_table(found: BodyModes) -> TerminalTable:
    headers, rows = mode_table(found)
    columns = [
        numbers(heading, unit, cells)
        for (heading, unit), cells in zip(headers, zip(*rows, strict=True), strict=True)
    ]
    return TerminalTable(with_gap(columns, ROWS) if rows_left_out(found) else columns)


def elastic_rows(case: Case) -> list[tuple[str, str]]:
    """Return the facts on the elastic bodies of a case that `check` prints: mesh, modes, damping
    and supports.

    Raises
    ------
    InputError
        If a mesh can't be generated, or an object that must lie on it does not.
    """
    rows: list[tuple[str, str]] = []
    meshes = mesh_facts(case)
    for name, body in elastic_bodies(case).items():
        mesh, reduction = meshes[name], body.recipe.reduction
        kept = (
            f"{reduction.modes} modes"
            if reduction.modes
            else f"modes up to {reduction.max_frequency:g} Hz"
        )
        stored = "computed already" if mesh["modes_computed"] else "not computed yet"
        rows += [
            (
                f"elastic {name}",
                f"{mesh['elements']}, {mesh['nodes']} nodes, {mesh['degrees_of_freedom']} "
                "degrees of freedom before supports",
            ),
            (
                "  modes",
                f"{kept}, "
                f"{reduction.method}{', with an attachment mode' if reduction.attachment else ''}; "
                f"{stored}",
            ),
            ("  damping", body.damping.description),
            ("  held by", supports_text(body)),
        ]
        rows += [("  materials", mesh["materials"])] if mesh["materials"] else []
        rows += [("  of the file", remark) for remark in mesh["remarks"]]
    return rows


def measured_summary(measured: MeasuredTable) -> RenderableType:
    """Return measured modes beside those of a case, and the warnings about them, for the
    terminal.
    """
    table = table_of(measured.headers, measured.cells, measured.texts)
    return Group(
        Text("\nmeasured modes", style="bold"),
        *block_lines(table),
        *warning_lines(measured.doubts),
    )
