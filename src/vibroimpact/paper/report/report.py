"""What the reproduction of the paper tells: verdicts on all values, and the paper's figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from vibroimpact._version import __version__
from vibroimpact.files.result_folder import FIGURES
from vibroimpact.paper.report.blocks import blocks_of
from vibroimpact.paper.report.counts import kind_counts, verdict_counts
from vibroimpact.paper.report.markdown_report import TITLE, anchor, markdown_report
from vibroimpact.paper.report.opening import IN_SHORT, OPENING, summary_blocks
from vibroimpact.paper.report.outline import (
    VALUE_COLUMNS,
    RenderedPart,
    chapters_of,
    find_parts,
    missing_from,
)
from vibroimpact.paper.report.reproduction import Reproduction
from vibroimpact.paper.report_section import Verdict
from vibroimpact.report.report import (
    Block,
    Column,
    Figure,
    Heading,
    Note,
    Paragraph,
    Quantity,
    Report,
    Section,
    Table,
)
from vibroimpact.results.csv_files import write_csv


def report_of(reproduction: Reproduction) -> Report:
    """Return the report of a reproduction, on the parts that it has.

    Its files are `report.md` and, if values are compared, `values.csv`.
    """
    parts = reproduction.parts
    missing = missing_from(parts)
    summary = Section("summary", "", summary_blocks(parts), medium="page")
    chapters = [
        _chapter_section(chapter, members) for chapter, members in chapters_of(parts).items()
    ]
    files = {"report.md": partial(_write_markdown, parts)}
    if reproduction.values:
        files["values.csv"] = partial(_write_values, reproduction)
    opening = OPENING
    if not missing:
        opening = (*OPENING, IN_SHORT)
    return Report(
        title=TITLE,
        quantities=_answer(parts),
        opening=opening,
        sections=[summary, *chapters, *_missing_section(missing), *_counts_sections(parts)],
        files=files,
        summary={
            "version": __version__,
            "verdicts": verdict_counts(parts),
            "kinds": kind_counts(parts),
            "values": reproduction.values,
        },
        provenance="made by: vibroimpact reproduce.",
    )


def _answer(parts: Mapping[str, RenderedPart]) -> list[Quantity]:
    """Return how many printed values have each verdict."""
    counts = verdict_counts(parts).get("all", {})
    quantities = [Quantity(verdict.capitalize(), number) for verdict, number in counts.items()]
    if not quantities:
        return []
    first, *others = quantities
    return [replace(first, note=f"of {sum(counts.values()):,} printed values"), *others]


def _chapter_section(chapter: str, members: list[RenderedPart]) -> Section:
    """Return a chapter: the texts and charts of its parts."""
    blocks = [block for part in members for block in blocks_of(part.text, part.chart)]
    return Section(anchor(chapter), chapter, blocks, medium="page")


_SHOWN_COLUMNS = ("What", "Printed", "Computed", "Difference", "Verdict")
"""Columns of a table of compared values that a terminal shows; the page has all."""


def report_of_parts(reproduction: Reproduction, names: Sequence[str]) -> Report:
    """Return the report of a reproduction, of which a terminal shows some parts whole.

    Parameters
    ----------
    reproduction : Reproduction
        The reproduction.
    names : sequence of str
        Names of parts that it has: their texts and tables are shown, and their figures named with
        the files.
    """
    report = report_of(reproduction)
    sections = [
        _terminal_section(part.name, reproduction.parts[part.name], reproduction.path)
        for part in find_parts(names)
    ]
    return replace(report, sections=[*sections, *report.sections])


def _terminal_section(name: str, part: RenderedPart, folder: Path) -> Section:
    """Return a part as a terminal shows it."""
    blocks: list[Block] = []
    for block in blocks_of(part.text, part.chart):
        if isinstance(block, Figure):
            file = folder / FIGURES / f"{name}.png"
            blocks.append(Paragraph(f"The figure is {file}."))
        elif isinstance(block, Table):
            blocks.append(_without_details(block))
        elif not isinstance(block, Heading):
            blocks.append(block)
    return Section(name, part.title, blocks, medium="terminal")


def _without_details(table: Table) -> Table:
    """Return a table of compared values with its main columns; other tables whole."""
    shown = [column for column in table.columns if column.heading in _SHOWN_COLUMNS]
    if len(shown) < len(_SHOWN_COLUMNS):
        return table
    return replace(table, columns=shown)


def _missing_section(missing: list[str]) -> list[Section]:
    """Return which parts are missing; nothing if none is."""
    if not missing:
        return []
    text = f"Not made yet: {', '.join(missing)}. vibroimpact reproduce -o DIR makes them."
    return [Section("missing", "", (Paragraph(text),), medium="page")]


def _counts_sections(parts: Mapping[str, RenderedPart]) -> list[Section]:
    """Return what the terminal shows: the number of values with each verdict, by part and by the
    kind of the comparison, and what the kinds are.
    """
    by_part = verdict_counts(parts)
    by_kind = kind_counts(parts)
    kinds = Note(
        "Only a result tests the paper. Inferred: restitution, full-damping penetration, and "
        "the printed values they were inferred from. Fitted model: fitted to printed results of "
        "Type 2. Arithmetic: from other printed results. Input: what the paper assumes."
    )
    blocks: dict[str, Block] = {
        "parts": _counts_table("part", by_part, bold=[len(by_part) - 1]),
        "kinds": _counts_table("kind", by_kind),
        "meaning": kinds,
    }
    return [Section(name, "", (block,), medium="terminal") for name, block in blocks.items()]


def _counts_table(
    heading: str, counts: Mapping[str, Mapping[str, int]], bold: Sequence[int] = ()
) -> Table:
    """Return the number of values with each verdict as a table."""
    columns = [Column(heading, list(counts), is_text=True)]
    for verdict in Verdict:
        numbers = [str(of_row[verdict.value]) for of_row in counts.values()]
        # a heading of two words is not broken
        columns.append(Column(verdict.value.replace(" ", "\u00a0"), numbers))
    return Table(columns, bold=bold)


def _write_markdown(parts: Mapping[str, RenderedPart], path: Path) -> None:
    path.write_text(markdown_report(parts), encoding="utf-8")


def _write_values(reproduction: Reproduction, path: Path) -> None:
    write_csv(reproduction.values, list(VALUE_COLUMNS), path)
