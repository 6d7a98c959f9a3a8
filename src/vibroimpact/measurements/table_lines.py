"""Lines of a table: what separates their fields, which are rows of numbers, and the
beginning of a file in which a header is sought.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from vibroimpact.measurements.cell_numbers import is_number

MARKS = ("\t", ";", ",")
"""What separates fields, beside blanks."""

_NOT_A_COMMENT = ("N/A", "NV", "NUM!", "DIV/0!", "WERT!", "VALUE!")
"""What spreadsheets write after # in a cell."""


class Clock(NamedTuple):
    """Times of a column without a column of times of its own: that of its first row [s], and the
    step from row to row [s].

    `alone` tells whether the column of times beside it, if there is one, belongs to another
    channel.
    """

    start: float
    step: float
    alone: bool = True


class Head(NamedTuple):
    """The beginning of a table: number and text of its lines, without comments, and the
    separator that the file states.
    """

    lines: list[tuple[int, str]]
    mark: str | None


class Found(NamedTuple):
    """The header in the beginning of a table.

    Parameters
    ----------
    number : int
        Number of its line.
    cells : list of str
        Its cells; "" for a column that is left out.
    mark : str or None
        What separates fields; None for blanks.
    below : int
        Place of the first line below it.
    clocks : mapping of int to Clock
        By the place of a column what its times follow from, if it is not a column of times.
    doubts : mapping of int to str
        By the place of a column what was taken for granted, as a sentence.
    """

    number: int
    cells: list[str]
    mark: str | None
    below: int
    clocks: Mapping[int, Clock] = {}
    doubts: Mapping[int, str] = {}


def fields_of(line: str, mark: str | None) -> list[str]:
    """Return the fields of a line."""
    return (
        line.split(mark)
        if mark is None or '"' not in line
        else next(csv.reader([line], delimiter=mark))
    )


def header_cells(line: str, mark: str | None) -> list[str]:
    """Return the cells of a header; where blanks separate them, a unit in brackets belongs to the
    word before it.

    Examples
    --------
    >>> header_cells("time [s] force [N]", None)
    ['time [s]', 'force [N]']
    """
    cells: list[str] = []
    for cell in fields_of(line, mark):
        if mark is None and cells and cell.startswith(("[", "(")):
            cells[-1] += f" {cell}"
        else:
            cells.append(cell.strip())
    return cells


def filled(cells: Sequence[str]) -> int:
    """Return the number of cells without the empty ones at the end.

    Examples
    --------
    >>> filled(["0", "", "1", "", " "])
    3
    """
    return next((place + 1 for place in reversed(range(len(cells))) if cells[place].strip()), 0)


def content(whole: str) -> str:
    """Return a line without its comment; "" if there is nothing in it."""
    line = whole.rstrip("\r\n ")  # a tab at the end may stand before an empty field
    if "#" not in line:
        return line if line.strip(" ,;\t") else ""
    start = next(
        (found.start() for found in re.finditer("#", line) if _begins_comment(line, found.start())),
        len(line),
    )
    line = line[:start].rstrip()
    return line if line.strip(" ,;\t") else ""


def _begins_comment(line: str, place: int) -> bool:
    """Return whether a # begins a comment: in a name (Channel #1) and in what
    spreadsheets write (#N/A) it does not.
    """
    before, after = line[:place], line[place + 1 :]
    if after.upper().startswith(_NOT_A_COMMENT):
        return False
    has_words = any(one.isalpha() and one not in "eE" for one in before)
    return not has_words or not after or after[0].isspace()


def mark_of(line: str) -> str | None:
    """Return what separates the numbers of a line."""
    mark = next((mark for mark in MARKS if mark in line), None)
    # a comma beside blanks is the decimal point
    return None if mark == "," and " " in line.strip() and is_row(line, None) else mark


def is_row(line: str, mark: str | None) -> bool:
    """Return whether a line is a row of numbers, some of which may be missing."""
    cells = fields_of(line, mark)
    return has_digits(line) and all(is_number(cell, mark) for cell in cells)


def first_rows(head: Head, least: int = 2) -> tuple[int, str | None] | None:
    """Return the place of the first of two rows of at least so many fields, one after the
    other, and what separates their fields.
    """
    full = [place for place, (_, line) in enumerate(head.lines) if line]
    for here, after in pairwise(full):
        mark = head.mark or mark_of(head.lines[here][1])
        line = head.lines[here][1]
        if (
            len(fields_of(line, mark)) >= least
            and is_row(line, mark)
            and is_row(head.lines[after][1], mark)
        ):
            return here, mark
    return None


def has_digits(line: str) -> bool:
    """Return whether there is a digit in a line."""
    return any(character.isdigit() for character in line)
