"""Where the header of a table stands, and what separates its fields: as people, instruments and languages write them."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from itertools import chain, islice
from typing import NamedTuple

from vibroimpact.errors import InputError

_MOST_COLUMNS = 1000
_MARKS = ("\t", ";", ",")
_LOOKED = 100
"""Lines before which a header is sought."""
_SEPARATOR = re.compile(r"sep=(\t|;|,)\s*", re.IGNORECASE)
"""First line by which spreadsheets are told the separator."""
_UNIT = re.compile(r"\s*([\[(].*[\])])?\s*")


class Layout(NamedTuple):
    """Layout of a table.

    Parameters
    ----------
    number : int
        Number of the line of the header.
    header : list of str
        Its cells.
    mark : str or None
        What separates fields; None for blanks.
    rows : iterator of (int, str)
        Number and text of each line below, without comments; an empty line is "".
    """

    number: int
    header: list[str]
    mark: str | None
    rows: Iterator[tuple[int, str]]


def table_layout(lines: Iterator[tuple[int, str]]) -> Layout:
    r"""Return the layout of a table of numbered lines.

    The header is the first line that is not a comment (#); but the last comment before the rows, where these begin at once
    (`numpy.savetxt`), and the last line of text before the rows, where the first line has another number of fields than they have (lines
    about the measurement). Units may stand in a line of their own below it, each in brackets. A line `sep=;` states the separator.

    Raises
    ------
    InputError
        If there is no line, no header or too many columns.

    Examples
    --------
    >>> table_layout(iter([(1, "# time [s] force [N]\n"), (2, "0.0 1.0\n")]))[:3]
    (1, ['time [s]', 'force [N]'], None)
    >>> table_layout(iter([(1, "Time;Channel A\n"), (2, "(ms);(V)\n"), (3, "0,1;2,5\n")]))[:3]
    (1, ['Time (ms)', 'Channel A (V)'], ';')
    """
    mark: str | None = None
    comment = (0, "")
    for number, whole in lines:
        line = _content(whole)
        if stated := _SEPARATOR.fullmatch(line) if number == 1 else None:
            mark = stated.group(1)
        elif line:
            break
        elif "#" in whole:
            comment = number, whole.partition("#")[2].strip()
    else:
        raise InputError("the file is empty")
    first = (number, line)
    if _is_row(line, mark or _mark_of(line)):
        mark = mark or _mark_of(line)
        return _below(lines, first, _comment_header(comment, first, mark), mark)
    ahead = [(at, _content(one)) for at, one in islice(lines, _LOOKED)]
    above = _above_rows([first, *ahead], mark)
    header, mark = above or (0, mark or _header_mark(line))
    head = [first, *ahead]
    number, cells = head[header][0], [cell.strip() for cell in fields_of(head[header][1], mark)]
    after = header + 1
    while after < len(head) and not head[after][1]:
        after += 1
    if after < len(head) and len(units := fields_of(head[after][1], mark)) == len(cells) and _are_units(units):
        cells = [f"{cell} {unit.strip()}".strip() for cell, unit in zip(cells, units, strict=True)]
        header = after
    return Layout(number, _checked(number, cells), mark, chain(head[header + 1 :], _contents(lines)))


def fields_of(line: str, mark: str | None) -> list[str]:
    """Return the fields of a line."""
    return line.split(mark) if mark is None or '"' not in line else next(csv.reader([line], delimiter=mark))


def _content(whole: str) -> str:
    """Return a line without its comment; "" if there is nothing in it."""
    line = whole.partition("#")[0].rstrip()
    return line if line.strip(" ,;\t") else ""


def _contents(lines: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    for number, whole in lines:
        yield number, _content(whole)


def _header_mark(line: str) -> str:
    return next((mark for mark in _MARKS if mark in line), ",")


def _mark_of(line: str) -> str | None:
    """Return what separates the numbers of a line."""
    mark = next((mark for mark in _MARKS if mark in line), None)
    # a comma beside blanks is the decimal point
    return None if mark == "," and " " in line.strip() and _is_row(line, None) else mark


def _is_row(line: str, mark: str | None) -> bool:
    """Return whether a line is a row of numbers, some of which may be missing."""
    cells = [cell.strip() for cell in fields_of(line, mark)]
    return any(cells) and all(not cell or _is_number(cell, mark) for cell in cells)


def _is_number(cell: str, mark: str | None) -> bool:
    try:
        float(cell.replace(",", ".") if mark != "," else cell)
    except ValueError:
        return False
    return "_" not in cell


def _below(lines: Iterator[tuple[int, str]], first: tuple[int, str], header: tuple[int, list[str]], mark: str | None) -> Layout:
    number, cells = header
    return Layout(number, _checked(number, cells), mark, chain([first], _contents(lines)))


def _comment_header(comment: tuple[int, str], first: tuple[int, str], mark: str | None) -> tuple[int, list[str]]:
    """Return the header in the comment before rows that begin at once.

    Raises
    ------
    InputError
        If it has another number of fields than they have.
    """
    columns = len(fields_of(first[1], mark))
    for separator in (",", ";", "\t", None):
        cells = [cell.strip() for cell in fields_of(comment[1], separator)]
        cells = _joined(cells) if separator is None else cells
        if len(cells) == columns and all(cells):
            return comment[0], cells
    seen = f"the comment before them does not have as many ({comment[1][:40]!r})" if comment[1] else "no header is above them"
    columns_are = f"{columns} numbers" if columns > 1 else "a number"
    raise InputError(f"line {first[0]}: it has {columns_are}, and {seen}; write a header, such as time [s],force [N]")


def _joined(words: list[str]) -> list[str]:
    """Return words between blanks with the units that follow them in brackets."""
    cells: list[str] = []
    for word in words:
        if cells and word.startswith(("[", "(")):
            cells[-1] += f" {word}"
        else:
            cells.append(word)
    return cells


def _above_rows(head: list[tuple[int, str]], mark: str | None) -> tuple[int, str | None] | None:
    """Return the place of the header above the first two rows in a row, if the first line can be none; and what separates fields."""
    full = [place for place, (_, line) in enumerate(head) if line]
    for before, here, after in zip(full, full[1:], full[2:], strict=False):
        used = mark or _mark_of(head[here][1])
        columns = len(fields_of(head[here][1], used))
        if columns < 2 or not (_is_row(head[here][1], used) and _is_row(head[after][1], used)):
            continue
        if len(fields_of(head[0][1], used)) == columns:
            return None
        units = fields_of(head[before][1], used)
        place = full[full.index(before) - 1] if _are_units(units) and before > 0 else before
        return (place, used) if len(fields_of(head[place][1], used)) == columns else None
    return None


def _are_units(cells: list[str]) -> bool:
    """Return whether cells are units in brackets, or empty."""
    return any(cell.strip() for cell in cells) and all(_UNIT.fullmatch(cell) for cell in cells)


def _checked(number: int, cells: list[str]) -> list[str]:
    if len(cells) > _MOST_COLUMNS:
        raise InputError(f"line {number}: there are {len(cells)} columns; a table has {_MOST_COLUMNS} at most")
    return cells
