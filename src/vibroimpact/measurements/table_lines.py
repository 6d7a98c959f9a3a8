"""Lines of a table: what separates their fields, which are rows, and the beginning of a file."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from vibroimpact.measurements.cell_numbers import is_number

DELIMITERS = ("\t", ";", ",")
"""What separates fields, beside blanks."""

_NOT_A_COMMENT = ("N/A", "NV", "NUM!", "DIV/0!", "WERT!", "VALUE!")
"""What spreadsheets write after # in a cell."""


class Clock(NamedTuple):
    """Times of a column without a column of times of its own.

    That of its first row [s], and the step from row to row [s]. `alone` tells whether the column of
    times beside it, if there is one, belongs to another channel.
    """

    start: float
    step: float
    alone: bool = True


class Head(NamedTuple):
    """The beginning of a table, in which a header is sought.

    Number and text of its lines, without comments, and the separator that the file states.
    """

    lines: list[tuple[int, str]]
    delimiter: str | None


class HeaderLines(NamedTuple):
    """The header in the beginning of a table.

    Parameters
    ----------
    number : int
        Number of its line.
    cells : list of str
        Its cells; "" for a column that is left out.
    delimiter : str or None
        What separates fields; None for blanks.
    below : int
        Index of the first line below it.
    clocks : mapping of int to Clock
        By the index of a column what its times follow from, if it is not a column of times.
    doubts : mapping of int to str
        By the index of a column what was taken for granted, as a sentence.
    """

    number: int
    cells: list[str]
    delimiter: str | None
    below: int
    clocks: Mapping[int, Clock] = {}
    doubts: Mapping[int, str] = {}


def fields_of(line: str, delimiter: str | None) -> list[str]:
    """Return the fields of a line."""
    if delimiter is None or '"' not in line:
        return line.split(delimiter)
    return next(csv.reader([line], delimiter=delimiter))


def header_cells(line: str, delimiter: str | None) -> list[str]:
    """Return the cells of a header.

    Where blanks separate them, a unit in brackets belongs to the word before it.

    Examples
    --------
    >>> header_cells("time [s] force [N]", None)
    ['time [s]', 'force [N]']
    """
    cells: list[str] = []
    for cell in fields_of(line, delimiter):
        if delimiter is None and cells and cell.startswith(("[", "(")):
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
    for count in range(len(cells), 0, -1):
        if cells[count - 1].strip():
            return count
    return 0


def content(whole: str) -> str:
    """Return a line without its comment; "" if there is nothing in it."""
    line = whole.rstrip("\r\n ")  # a tab at the end may stand before an empty field
    if "#" in line:
        signs = [sign.start() for sign in re.finditer("#", line)]
        comment = next((sign for sign in signs if _begins_comment(line, sign)), len(line))
        line = line[:comment].rstrip()
    return line if line.strip(" ,;\t") else ""


def _begins_comment(line: str, position: int) -> bool:
    """Return whether a # begins a comment.

    In a name (Channel #1) and in what spreadsheets write (#N/A) it does not.
    """
    before = line[:position]
    after = line[position + 1 :]
    if after.upper().startswith(_NOT_A_COMMENT):
        return False
    # an e or E is that of an exponent
    has_words = any(character.isalpha() and character not in "eE" for character in before)
    return not has_words or not after or after[0].isspace()


def delimiter_of(line: str) -> str | None:
    """Return what separates the numbers of a line."""
    delimiter = next((delimiter for delimiter in DELIMITERS if delimiter in line), None)
    # a comma beside blanks is the decimal point
    if delimiter == "," and " " in line.strip() and is_row(line, None):
        return None
    return delimiter


def is_row(line: str, delimiter: str | None) -> bool:
    """Return whether a line is a row of numbers, some of which may be missing."""
    cells = fields_of(line, delimiter)
    return has_digits(line) and all(is_number(cell, delimiter) for cell in cells)


def first_rows(head: Head, least: int = 2) -> tuple[int, str | None] | None:
    """Return the index of the first of two rows, one after the other, and what separates fields.

    The first has at least so many fields.
    """
    not_empty = [index for index, (_, line) in enumerate(head.lines) if line]
    for index, following in pairwise(not_empty):
        _, line = head.lines[index]
        _, next_line = head.lines[following]
        delimiter = head.delimiter or delimiter_of(line)
        has_fields = len(fields_of(line, delimiter)) >= least
        if has_fields and is_row(line, delimiter) and is_row(next_line, delimiter):
            return index, delimiter
    return None


def has_digits(line: str) -> bool:
    """Return whether there is a digit in a line."""
    return any(character.isdigit() for character in line)
