"""A table for a terminal of any width: words are wrapped between words, numbers are never cut."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.measure import Measurement
from rich.text import Text

from vibroimpact.report.encodable import encodable

_BETWEEN = 2
"""Blanks between two columns."""

_PHRASE, _COMFORT = 30, 24
"""Letters of what may be wrapped word by word, and letters to a line that more than that needs; with less it is put below the row."""

_NUMBER = re.compile(r"[-\u2212+]?\d+(\.\d*)?")
_KEPT = "\u00a0"  # no break there


@dataclass(frozen=True)
class Column:
    """A column of a `TerminalTable`.

    Parameters
    ----------
    heading : str
        Wrapped between words; what belongs together is joined by no-break spaces.
    cells : sequence of str
        A cell a row.
    words : bool
        Words are flush left and may be wrapped; numbers are aligned at their decimal points and are not.
    """

    heading: str
    cells: Sequence[str]
    words: bool = False


def numbers(heading: str, unit: str, cells: Sequence[str]) -> Column:
    """Return a column of numbers with its unit in brackets below the heading."""
    return Column("\n".join(part for part in (heading, f"[{unit.replace(' ', _KEPT)}]" if unit else "") if part), cells)


@dataclass(frozen=True)
class TerminalTable:
    """A table that fits a terminal: the first column names the rows.

    Where it is too wide, first words are wrapped, then long words are put below their row, and at last the numbers go on in a second
    block of rows below the first.

    Parameters
    ----------
    columns : sequence of Column
        The first names the rows and stands in every block.
    bold : collection of int
        Rows that stand out.
    indent : int
        Blanks before every line.
    """

    columns: Sequence[Column]
    bold: Sequence[int] = ()
    indent: int = 1

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the lines, in letters that the terminal has."""

        def shown(words: str) -> str:  # what must not be parted stays so until lines are made
            return _KEPT.join(encodable(part, options.encoding) for part in words.split(_KEPT))

        columns = [Column(shown(one.heading), [shown(cell) for cell in one.cells], one.words) for one in self.columns]
        for line, style in self._lines(columns, options.max_width):
            yield Text(line.replace(_KEPT, " "), style=style)

    @property
    def width(self) -> int:
        """The width that it likes: no words wrapped, all columns beside each other."""
        return self.indent + sum(_width(one) for one in self.columns) + _BETWEEN * (len(self.columns) - 1)

    def __rich_measure__(self, console: Console, options: ConsoleOptions) -> Measurement:
        """Return the narrowest and the widest that it may be."""
        return Measurement(min(self.width, options.max_width), self.width)

    def _lines(self, columns: list[Column], width: int) -> Iterable[tuple[str, str]]:
        """Yield each line with its style."""
        blocks, below = _arranged(columns, width - self.indent)
        for number, block in enumerate(blocks):
            if number:
                yield "", ""
            for line, style in _block(block, below if number == len(blocks) - 1 else [], width - self.indent, set(self.bold)):
                yield f"{' ' * self.indent}{line}".rstrip(), style


def with_gap(columns: Sequence[Column], row: int) -> list[Column]:
    """Return columns with a line before a row that says that others are left out."""
    return [
        Column(one.heading, [*one.cells[:row], "" if place else "...", *one.cells[row:]], one.words) for place, one in enumerate(columns)
    ]


def facts(rows: Iterable[tuple[str, ...]], indent: int = 0) -> TerminalTable:
    """Return a table of names and what is to be said of each, without headings."""
    return TerminalTable([Column("", cells, words=True) for cells in zip(*rows, strict=True)], indent=indent)


def _arranged(columns: list[Column], width: int) -> tuple[list[list[tuple[Column, int]]], list[Column]]:
    """Return blocks of columns with their widths, and the columns of words that go below the rows."""
    key, rest = columns[0], list(columns[1:])
    below: list[Column] = []
    while True:
        chosen = _fitted([key, *rest], width)
        if chosen is not None:
            return [list(zip([key, *rest], chosen, strict=True))], below
        last = next((one for one in reversed(rest) if one.words), None)
        if last is None:
            break
        rest.remove(last)
        below.insert(0, last)
    # numbers alone are too wide
    first = (key, max(min(_width(key), width // 3), min(_least(key), width // 2)))
    blocks: list[list[tuple[Column, int]]] = [[first]]
    for one in rest:
        if len(blocks[-1]) > 1 and sum(taken + _BETWEEN for _, taken in blocks[-1]) + _width(one) > width:
            blocks.append([first])
        blocks[-1].append((one, _width(one)))
    return blocks, below


def _fitted(columns: list[Column], width: int) -> list[int] | None:
    """Return widths with which columns fit beside each other, words wrapped as little as may be; None if they do not."""
    widths, least = [_width(one) for one in columns], [_least(one) for one in columns]
    for number, one in enumerate(columns):
        if one.words:
            least[number] = min(least[number], width // 2)  # a longer name is broken
        if number and one.words:
            least[number] = least[number] if widths[number] <= _PHRASE else max(least[number], _COMFORT)
    room = width - _BETWEEN * (len(columns) - 1)
    while sum(widths) > room:
        widest = max((number for number in range(len(columns)) if widths[number] > least[number]), key=lambda at: widths[at], default=None)
        if widest is None:
            return None
        widths[widest] -= 1
    return widths


def _width(column: Column) -> int:
    """Return the width that a column likes: of its cells on one line; and of its heading, which is wrapped to numbers but not to words."""
    cells = max((cell_len(cell) for cell in _aligned(column)), default=0)
    heading = max(map(cell_len, column.heading.split("\n"))) if column.words else _longest(column.heading)
    return max(cells, heading)


def _least(column: Column) -> int:
    """Return the least width of a column: of its longest word, or of its longest number."""
    return max(map(_longest, [column.heading, *column.cells]), default=0) if column.words else _width(column)


def _longest(words: str) -> int:
    return max((cell_len(word) for word in re.split("[ \n]", words)), default=0)


def _aligned(column: Column) -> list[str]:
    """Return the cells of numbers with blanks behind them that bring their decimal points below each other."""
    if column.words:
        return list(column.cells)
    found = [_NUMBER.match(cell) for cell in column.cells]
    behind = [len(cell) - (len(match[0].split(".")[0]) if match else len(cell)) for cell, match in zip(column.cells, found, strict=True)]
    most = max((after for after, match in zip(behind, found, strict=True) if match), default=0)
    return [cell + " " * (most - after if match else 0) for cell, after, match in zip(column.cells, behind, found, strict=True)]


def _block(block: list[tuple[Column, int]], below: list[Column], width: int, bold: set[int]) -> Iterable[tuple[str, str]]:
    """Yield the lines of a block: its headings, and its rows with what goes below each."""
    if any(one.heading for one, _ in block):
        wrapped = [_wrapped(one.heading, taken) for one, taken in block]
        high = max(map(len, wrapped))
        for line in range(high):
            cells = [lines[line - high + len(lines)] if line >= high - len(lines) else "" for lines in wrapped]
            yield _row(block, cells), "bold"
    aligned = [_aligned(one) for one, _ in block]
    for number in range(len(block[0][0].cells)):
        cells_of = [
            _wrapped(cells[number], taken) if one.words else [cells[number]] for cells, (one, taken) in zip(aligned, block, strict=True)
        ]
        style = "bold" if number in bold else ""
        for line in range(max(map(len, cells_of))):
            yield _row(block, [lines[line] if line < len(lines) else "" for lines in cells_of]), style
        for one in below:
            if one.cells[number]:
                said = f"{one.heading}: {one.cells[number]}" if one.heading else one.cells[number]
                yield from ((f"    {line}", style) for line in _wrapped(said, width - 4))


def _row(block: list[tuple[Column, int]], cells: list[str]) -> str:
    """Return one line of a block."""
    filled = []
    for (one, taken), cell in zip(block, cells, strict=True):
        blanks = " " * (taken - cell_len(cell))
        filled.append(cell + blanks if one.words else blanks + cell)
    return (" " * _BETWEEN).join(filled)


def _wrapped(words: str, width: int) -> list[str]:
    """Return words in lines of a width, broken between words; a word that is longer than a line is broken within."""
    lines = [line for part in words.split("\n") for line in textwrap.wrap(part, max(width, 1), break_on_hyphens=False)]
    return lines or [""]
