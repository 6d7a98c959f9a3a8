"""Tables for terminals of any width: text is wrapped between words, numbers are never truncated."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import zip_longest

from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.measure import Measurement
from rich.text import Text

from vibroimpact.report.encodable import encodable

_BETWEEN = 2
"""Spaces between two columns."""

_WIDEST_PHRASE = 30
_LEAST_LINE = 24
"""Widest text that may be wrapped to single words, and least line width of wider text;
with less, the text goes below its row.
"""

_NUMBER = re.compile(r"[-\u2212+]?\d+(\.\d*)?")
_NO_BREAK = "\u00a0"  # no-break space


@dataclass(frozen=True)
class TerminalColumn:
    """A column of a `TerminalTable`.

    Parameters
    ----------
    heading : str
        Heading, wrapped between words except at no-break spaces.
    cells : sequence of str
        One cell per row.
    text : bool
        Text, left-aligned and wrapped; otherwise numbers, aligned at the decimal point and never
        wrapped.
    least_width : int
        Width of a terminal below which the column is left out.
    """

    heading: str
    cells: Sequence[str]
    text: bool = False
    least_width: int = 0


def numbers(heading: str, unit: str, cells: Sequence[str]) -> TerminalColumn:
    """Return a column of numbers with the unit in brackets below the heading."""
    lines = []
    if heading:
        lines.append(heading)
    if unit:
        lines.append(f"[{unit.replace(' ', _NO_BREAK)}]")
    return TerminalColumn("\n".join(lines), cells)


@dataclass(frozen=True)
class TerminalTable:
    """A table that fits the width of a terminal.

    A table that is too wide is reduced in steps: text columns are wrapped, then moved below their
    row, and finally the number columns are split into further blocks of rows.

    Parameters
    ----------
    columns : sequence of TerminalColumn
        The first column names the rows, and is repeated in every block.
    bold : collection of int
        Indices of bold rows.
    indent : int
        Spaces before every line.
    """

    columns: Sequence[TerminalColumn]
    bold: Sequence[int] = ()
    indent: int = 1

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the lines, transliterated to the encoding of the terminal."""

        def shown(phrase: str) -> str:  # no-break spaces are kept until the lines are wrapped
            return _NO_BREAK.join(
                encodable(part, options.encoding) for part in phrase.split(_NO_BREAK)
            )

        columns = [
            TerminalColumn(
                shown(column.heading), [shown(cell) for cell in column.cells], column.text
            )
            for column in self.columns
            if column.least_width <= options.max_width
        ]
        for line, style in self._lines(columns, options.max_width):
            yield Text(line.replace(_NO_BREAK, " "), style=style)

    @property
    def width(self) -> int:
        """Natural width: all columns side by side, no text wrapped."""
        return (
            self.indent
            + sum(_natural_width(column) for column in self.columns)
            + _BETWEEN * (len(self.columns) - 1)
        )

    def __rich_measure__(self, console: Console, options: ConsoleOptions) -> Measurement:
        """Return the minimum and maximum width."""
        return Measurement(min(self.width, options.max_width), self.width)

    def _lines(self, columns: list[TerminalColumn], width: int) -> Iterable[tuple[str, str]]:
        """Yield each line with its style."""
        blocks, below = _arrange(columns, width - self.indent)
        for number, block in enumerate(blocks):
            if number:
                yield "", ""
            below_block = below if number == len(blocks) - 1 else []
            for line, style in _block(block, below_block, width - self.indent, set(self.bold)):
                yield f"{' ' * self.indent}{line}".rstrip(), style


def with_gap(columns: Sequence[TerminalColumn], row: int) -> list[TerminalColumn]:
    """Return columns with an ellipsis row inserted before a row, to mark omitted rows."""
    marks = ["...", *([""] * (len(columns) - 1))]
    return [
        TerminalColumn(
            column.heading, [*column.cells[:row], mark, *column.cells[row:]], column.text
        )
        for mark, column in zip(marks, columns, strict=False)
    ]


def facts(rows: Iterable[tuple[str, ...]], indent: int = 0) -> TerminalTable:
    """Return a table of facts, such as names and values, without headings."""
    return TerminalTable(
        [TerminalColumn("", cells, text=True) for cells in zip(*rows, strict=True)], indent=indent
    )


def _arrange(
    columns: list[TerminalColumn], width: int
) -> tuple[list[list[tuple[TerminalColumn, int]]], list[TerminalColumn]]:
    """Return blocks of columns with their widths, and the text columns that go below the rows."""
    key = columns[0]
    rest = list(columns[1:])
    below: list[TerminalColumn] = []
    while True:
        chosen = _fitting_widths([key, *rest], width)
        if chosen is not None:
            return [list(zip([key, *rest], chosen, strict=True))], below
        last = next((column for column in reversed(rest) if column.text), None)
        if last is None:
            break
        rest.remove(last)
        below.insert(0, last)
    # the numbers alone are too wide: split them into blocks that repeat the first column
    first = (key, max(min(_natural_width(key), width // 3), min(_least_width(key), width // 2)))
    blocks: list[list[tuple[TerminalColumn, int]]] = [[first]]
    for column in rest:
        if (
            len(blocks[-1]) > 1
            and sum(taken + _BETWEEN for _, taken in blocks[-1]) + _natural_width(column) > width
        ):
            blocks.append([first])
        blocks[-1].append((column, _natural_width(column)))
    return blocks, below


def _fitting_widths(columns: list[TerminalColumn], width: int) -> list[int] | None:
    """Return column widths that fit side by side with the least wrapping; None if there
    are none.
    """
    widths = [_natural_width(column) for column in columns]
    least = [_least_width(column) for column in columns]
    for number, column in enumerate(columns):
        if column.text:
            least[number] = min(least[number], width // 2)  # longer words are broken
        if number and column.text:
            if widths[number] <= _WIDEST_PHRASE:
                least[number] = least[number]
            else:
                least[number] = max(least[number], _LEAST_LINE)
    room = width - _BETWEEN * (len(columns) - 1)
    while sum(widths) > room:
        widest = max(
            (number for number in range(len(columns)) if widths[number] > least[number]),
            key=lambda at: widths[at],
            default=None,
        )
        if widest is None:
            return None
        widths[widest] -= 1
    return widths


def _natural_width(column: TerminalColumn) -> int:
    """Return the natural width of a column: unwrapped cells, and a heading that is
    wrapped above numbers but not above text.
    """
    cells = max((cell_len(cell) for cell in _aligned(column)), default=0)
    if column.text:
        heading = max(map(cell_len, column.heading.split("\n")))
    else:
        heading = _longest_word(column.heading)
    return max(cells, heading)


def _least_width(column: TerminalColumn) -> int:
    """Return the least width of a column: its longest word, or the natural width for numbers."""
    if column.text:
        return max(map(_longest_word, [column.heading, *column.cells]), default=0)
    return _natural_width(column)


def _longest_word(phrase: str) -> int:
    return max((cell_len(word) for word in re.split("[ \n]", phrase)), default=0)


def _aligned(column: TerminalColumn) -> list[str]:
    """Return the cells of numbers padded on the right, so that right alignment aligns
    their decimal points.
    """
    if column.text:
        return list(column.cells)
    # the number of characters from the decimal point on, of each cell with a number
    behind: dict[int, int] = {}
    for row, cell in enumerate(column.cells):
        if match := _NUMBER.match(cell):
            behind[row] = len(cell) - len(match[0].split(".")[0])
    most = max(behind.values(), default=0)
    return [cell + " " * (most - behind.get(row, most)) for row, cell in enumerate(column.cells)]


def _block(
    block: list[tuple[TerminalColumn, int]], below: list[TerminalColumn], width: int, bold: set[int]
) -> Iterable[tuple[str, str]]:
    """Yield the lines of a block: headings, and rows with the text below each."""
    if any(column.heading for column, _ in block):
        wrapped = [_wrapped(column.heading, taken) for column, taken in block]
        high = max(map(len, wrapped))
        # short headings stand on the last lines
        raised = [[""] * (high - len(lines)) + lines for lines in wrapped]
        for headings in zip(*raised, strict=True):
            yield _row(block, headings), "bold"
    aligned = [_aligned(column) for column, _ in block]
    for number in range(len(block[0][0].cells)):
        cells_of = []
        for cells, (column, taken) in zip(aligned, block, strict=True):
            # numbers are not broken: their column is wide enough
            lines = _wrapped(cells[number], taken) if column.text else [cells[number]]
            cells_of.append(lines)
        style = "bold" if number in bold else ""
        for line_cells in zip_longest(*cells_of, fillvalue=""):
            yield _row(block, line_cells), style
        for column in below:
            phrase = column.cells[number]
            if not phrase:
                continue
            if column.heading:
                phrase = f"{column.heading}: {phrase}"
            for line in _wrapped(phrase, width - 4):
                yield f"    {line}", style


def _row(block: list[tuple[TerminalColumn, int]], cells: Sequence[str]) -> str:
    """Return one line of a block."""
    filled = []
    for (column, taken), cell in zip(block, cells, strict=True):
        blanks = " " * (taken - cell_len(cell))
        padded = cell + blanks if column.text else blanks + cell
        filled.append(padded)
    return (" " * _BETWEEN).join(filled)


def _wrapped(phrase: str, width: int) -> list[str]:
    """Return a text wrapped to lines of a width; words longer than a line are broken."""
    lines = [
        line
        for part in phrase.split("\n")
        for line in textwrap.wrap(part, max(width, 1), break_on_hyphens=False)
    ]
    return lines or [""]
