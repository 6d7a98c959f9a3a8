"""A report in the terminal: its answer, tables, notes and warnings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

from rich.columns import Columns
from rich.console import Console, ConsoleOptions, Group, RenderableType, RenderResult
from rich.text import Text

from vibroimpact.report.report import (
    Block,
    Code,
    Column,
    Explanation,
    Facts,
    Heading,
    Note,
    Paragraph,
    Report,
    Section,
    Table,
)
from vibroimpact.report.result_warning import size_of
from vibroimpact.report.terminal_table import (
    TerminalColumn,
    TerminalTable,
    facts,
    numbers,
    with_gap,
)


def terminal_report(report: Report) -> RenderableType:
    """Return what a terminal shows of a report.

    Parameters
    ----------
    report : Report
        The report; charts, explanations and texts to copy are on its page alone.

    Examples
    --------
    >>> from rich.console import Console
    >>> from vibroimpact.report.report import Section, table_of
    >>> table = table_of(["Law", ("Force", "N")], [["hertz", "20"]])
    >>> section = Section("force", "Force", (table, Note("The force is the largest.")))
    >>> Console(width=60).print(terminal_report(Report("Two balls", (section,), {})))
    Two balls
            Force
     Law      [N]
     hertz     20
     The force is the largest.
    """
    lines: list[RenderableType] = [Text(report.title, style="bold")]
    if report.answer:
        lines.append(Text(report.answer))
    if report.quantities:
        lines.append(facts([quantity.cells for quantity in report.quantities], indent=1))
    warnings = report.all_warnings
    if report.quantities:
        # beside the answer, the worst one; the others follow at the end
        lines.extend(warning_lines(warnings[:1]))
        warnings = warnings[1:]
    lines.extend(Text(sentence) for sentence in report.sentences)
    sections = [section for section in report.sections if section.medium != "page"]
    shown = [(section, blocks) for section in sections if (blocks := list(_section_lines(section)))]
    for number, (section, blocks) in enumerate(shown):
        lines.extend(_heading_lines(section, is_first=number == 0))
        lines.extend(blocks)
    lines.extend(warning_lines(warnings))
    if report.all_warnings and report.warnings_note:
        lines.append(Text(report.warnings_note, style="dim"))
    return Group(*lines)


def _heading_lines(section: Section, *, is_first: bool) -> Iterator[Text]:
    """Yield what sets a section apart; the table below the answer needs no heading."""
    has_heading = section.title and not (is_first and isinstance(section.blocks[0], Table))
    if has_heading or not is_first:
        yield Text()
    if has_heading:
        yield Text(section.title, style="bold")


def _section_lines(section: Section) -> Iterator[RenderableType]:
    """Yield what the terminal shows of a section; tables with titles stand beside each other."""
    for titled, blocks in groupby(section.blocks, _has_title):
        groups = [list(block_lines(block)) for block in blocks]
        if titled and len(groups) > 1:
            yield Columns([Group(*lines) for lines in groups], padding=(0, 4))
        else:
            for lines in groups:
                yield from lines


def _has_title(block: Block) -> bool:
    return isinstance(block, Table) and block.title != ""


def block_lines(block: Block) -> Iterator[RenderableType]:
    """Yield what the terminal shows of a block."""
    if isinstance(block, Table):
        table = block.short or block
        if table.title:
            yield Text(table.title, style="bold")
        if table.expendable:
            yield _FittedTable(table)
        else:
            yield _terminal_table(table, table.columns)
    elif isinstance(block, Facts):
        yield facts(block.rows, indent=1)
    elif isinstance(block, Heading):
        yield Text(block.text, style="bold")
    elif isinstance(block, Paragraph):
        yield Text(block.text)
    elif isinstance(block, Code) and block.is_short:
        yield Text(f"{block.lead}\n{block.text}")
    elif isinstance(block, Note):
        yield Text(f" {block.text}", style="yellow" if block.is_warning else "dim")
    elif isinstance(block, Explanation) and block.short:
        yield Text(f" {block.short}", style="dim")


@dataclass(frozen=True)
class _FittedTable:
    """A table without the columns that do not fit, and the notes on those that do."""

    table: Table

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the table, and its notes."""
        table = self.table
        columns = list(table.columns)
        for heading in table.expendable:
            # the row of a gap is not wider than the cells beside it
            if TerminalTable(_terminal_columns(columns)).width <= options.max_width:
                break
            columns = [column for column in columns if column.heading != heading]
        yield _terminal_table(table, columns)
        notes = [column.note for column in columns if column.note]
        if len(columns) < len(table.columns):
            notes.append(f"A wider terminal shows more columns; {table.file} has all, in SI units.")
        for note in notes:
            yield Text(f" {note}", style="dim")


def _terminal_table(table: Table, columns: Sequence[Column]) -> TerminalTable:
    """Return columns of a table for the terminal, with its gap."""
    shown = _terminal_columns(columns)
    if table.gap is not None:
        shown = with_gap(shown, table.gap.row)
    return TerminalTable(shown, bold=table.bold)


def _terminal_columns(columns: Iterable[Column]) -> list[TerminalColumn]:
    return [_terminal_column(column) for column in columns]


def _terminal_column(column: Column) -> TerminalColumn:
    if column.is_text:
        return TerminalColumn(
            column.heading, column.cells, text=True, least_width=column.least_width
        )
    return numbers(column.heading, column.unit, column.cells)


def warning_lines(warnings: Iterable[str]) -> list[RenderableType]:
    """Return warnings as paragraphs for the terminal, one each."""
    return [Text(f"Warning: {warning}.", style=_STYLES[size_of(warning)]) for warning in warnings]


_STYLES = {"large": "bold red", "fair": "yellow", "small": "dim"}
"""How warnings look, by the size of their effect."""
