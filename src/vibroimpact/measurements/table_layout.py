"""Where the header of a table stands, and what separates its fields: as people,
instruments and languages write them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import chain, islice, pairwise
from typing import NamedTuple

from vibroimpact.errors import InputError
from vibroimpact.measurements.cell_numbers import is_number
from vibroimpact.measurements.header_cells import are_units, is_time, name_and_unit, with_unit
from vibroimpact.measurements.instrument_layouts import instrument_layout, rows_of_instrument
from vibroimpact.measurements.stated_columns import (
    STATED,
    StatedColumns,
    remedy_for,
    stated_columns,
)
from vibroimpact.measurements.table_lines import (
    MARKS,
    Clock,
    Found,
    Head,
    content,
    fields_of,
    filled,
    first_rows,
    has_digits,
    header_cells,
    is_row,
    mark_of,
)
from vibroimpact.quoting import shortened

_MOST_COLUMNS = 1000
_MARK_WORDS = {"\t": "tabs", ";": "semicolons", ",": "commas", None: "blanks"}
_LOOKED = 100
"""Lines before which a header is sought."""
_SEPARATOR = re.compile(r"sep=(\t|;|,)\s*", re.IGNORECASE)
"""First line by which spreadsheets are told the separator."""
_LONGEST_SHOWN = 60


class Layout(NamedTuple):
    """Layout of a table.

    Parameters
    ----------
    number : int
        Number of the line of the header; of the first row, where the user states the columns.
    header : list of str
        Its cells; "" for a column that is left out.
    mark : str or None
        What separates fields; None for blanks.
    rows : iterator of (int, str)
        Number and text of each line below, without comments; an empty line is "".
    clocks : mapping of int to Clock
        By the place of a column what its times follow from, if it is not a column of times.
    is_stated : bool
        Whether the user states the columns.
    doubts : mapping of int to str
        By the place of a column what was taken for granted, as a sentence.
    """

    number: int
    header: list[str]
    mark: str | None
    rows: Iterator[tuple[int, str]]
    clocks: Mapping[int, Clock] = {}
    is_stated: bool = False
    doubts: Mapping[int, str] = {}

    @property
    def where(self) -> str:
        """Where the header is, for messages."""
        return STATED if self.is_stated else f"line {self.number}"

    @property
    def understood(self) -> str:
        """What was understood of the table, for messages."""
        if self.is_stated:
            return f"the columns are those stated, and the first row is line {self.number}"
        cells = shortened(", ".join(cell for cell in self.header if cell), _LONGEST_SHOWN)
        parts = (
            f"separated by {_MARK_WORDS[self.mark]}" if len(self.header) > 1 else "of one column"
        )
        return f"line {self.number} was taken for the header: {cells}, {parts}"

    @property
    def remedy(self) -> str:
        """How a user reads the table if it is not as understood, for messages."""
        return (
            'or state others, such as "time=s,force=N"'
            if self.is_stated
            else remedy_for(self.header)
        )

    def with_unit(self, name: str, unit: str) -> str:
        """Return how a user states the unit of a column, for messages."""
        return (
            f"state it, such as {name}={unit}"
            if self.is_stated
            else f"write it in brackets, such as {name} [{unit}], {self.remedy}"
        )


def table_layout(lines: Iterator[tuple[int, str]], columns: str | None = None) -> Layout:
    r"""Return the layout of a table of numbered lines.

    The header is the first line that is not a comment (#); but the last comment before the rows,
    where these begin at once (`numpy.savetxt`), and the nearest line above the rows that has as
    many fields, where lines about the measurement come first. Units may stand in a line of their
    own below it. A line `sep=;` states the separator. Files of LabVIEW, oscilloscopes and Audacity
    have their own layouts (`instrument_layouts`). Columns that the user states replace the header.

    Parameters
    ----------
    lines : iterator of (int, str)
        Number and text of each line.
    columns : str, optional
        The columns as a user states them, "time=s,force=N".

    Raises
    ------
    InputError
        If there is no line, no header or too many columns, or the rows do not have the columns that
        are stated.

    Examples
    --------
    >>> table_layout(iter([(1, "# time [s] force [N]\n"), (2, "0.0 1.0\n")]))[:3]
    (1, ['time [s]', 'force [N]'], None)
    >>> table_layout(iter([(1, "Time;Channel A\n"), (2, "(ms);(V)\n"), (3, "0,1;2,5\n")]))[:3]
    (1, ['Time (ms)', 'Channel A (V)'], ';')
    >>> table_layout(iter([(1, "0,1\n"), (2, "1,2\n")]), "time=s,force=N")[:3]
    (1, ['time [s]', 'force [N]'], ',')
    """
    stated = None if columns is None else stated_columns(columns)
    mark, comment, first = _beginning(lines)
    head = Head([first, *((at, content(one)) for at, one in islice(lines, _LOOKED))], mark)
    found = instrument_layout(head)
    if stated is not None:
        found = _stated(head, stated, found)
    elif found is None:
        found = _first_line_is_row(head, comment) or _header_above_rows(head)
    if len(found.cells) > _MOST_COLUMNS:
        raise InputError(
            f"line {found.number}: there are {len(found.cells)} columns; a table has "
            f"{_MOST_COLUMNS} at most"
        )
    rows = rows_of_instrument(
        head, chain(head.lines[found.below :], ((at, content(one)) for at, one in lines))
    )
    return Layout(
        found.number, found.cells, found.mark, rows, found.clocks, stated is not None, found.doubts
    )


def _beginning(
    lines: Iterator[tuple[int, str]],
) -> tuple[str | None, tuple[int, str], tuple[int, str]]:
    """Return the separator that the file states, its last comment before the first line,
    and this line.
    """
    mark: str | None = None
    comment, seen = (0, ""), ""
    for number, whole in lines:
        line = content(whole)
        seen = seen or whole.strip()
        if stated := _SEPARATOR.fullmatch(line) if number == 1 else None:
            mark = stated.group(1)
        elif line:
            return mark, comment, (number, line)
        elif "#" in whole:
            comment = number, whole.partition("#")[2].strip()
    raise InputError(
        "the file is empty but for comments, separators and blanks" if seen else "the file is empty"
    )


def _stated(head: Head, stated: StatedColumns, instrument: Found | None) -> Found:
    """Return the columns that the user states, above the first line in which all of them
    have numbers.
    """
    count = len(stated.cells)
    cells = list(stated.cells)
    clocks = {} if instrument is None else dict(instrument.clocks)
    if any(is_time(*name_and_unit(cell)) for cell in cells if cell):
        clocks = {}
    if stated.rate is not None:
        clocks = {place: Clock(0.0, 1.0 / stated.rate) for place, cell in enumerate(cells) if cell}
    nearest, stated_are = "", f"{count} columns are stated" if count > 1 else "one column is stated"
    for place, (number, line) in enumerate(head.lines):
        if not line or (instrument is not None and place < instrument.below):
            continue
        mark = (instrument.mark if instrument is not None else head.mark) or (
            mark_of(line) if count > 1 else None
        )
        fields = fields_of(line, mark)
        named = [at for at, cell in enumerate(cells) if cell]
        if not has_digits(line) or not all(
            at < len(fields) and is_number(fields[at], mark) for at in named
        ):
            if is_row(line, mark):
                nearest = nearest or f"line {number} has {_fields_are(filled(fields), mark)}"
            continue
        if filled(fields) > count:
            words = f"line {number} has {_fields_are(filled(fields), mark)}, and {stated_are}"
            raise InputError(
                f"{STATED}: {words}; state each, and - for one that is left out, such as "
                '"time=s,-,force=N"'
            )
        return Found(number, cells, mark, place, clocks)
    none_has = (
        f"none of the first {len(head.lines)} lines has"
        if len(head.lines) > 1
        else "the only line does not have"
    )
    words = nearest or f"{none_has} a number in each column that is named"
    raise InputError(
        f"{STATED}: {words}, and {stated_are}; state each column, and - for one that is left out"
    )


def _fields_are(count: int, mark: str | None) -> str:
    return f"{count} fields, separated by {_MARK_WORDS[mark]}" if count > 1 else "one field"


def _first_line_is_row(head: Head, comment: tuple[int, str]) -> Found | None:
    """Return the header in the comment before rows that begin at once; None if they do not.

    Raises
    ------
    InputError
        If it has another number of fields than they have.
    """
    number, line = head.lines[0]
    mark = head.mark or mark_of(line)
    if not is_row(line, mark):
        return None
    columns = len(fields_of(line, mark))
    for separator in (",", ";", "\t", None):
        cells = header_cells(comment[1], separator)
        if len(cells) == columns and all(cells):
            return Found(comment[0], cells, mark, 0)
    seen = (
        f"the comment before it does not have as many names ({comment[1][:40]!r})"
        if comment[1]
        else "no header is above it"
    )
    columns_are = f"{columns} numbers" if columns > 1 else "a number"
    remedy = (
        remedy_for([])
        if columns > 1
        else 'or give --columns "rate=10 kHz,force=N" with the rate of the rows (in a case the '
        "key columns)"
    )
    raise InputError(
        f"line {number}: it has {columns_are}, and {seen}; write a header, such as time "
        f"[s],force [N], {remedy}"
    )


def _header_above_rows(head: Head) -> Found:
    """Return the header: the first line, or, if this can be none, the nearest one above
    the rows; with units from a line below it.
    """
    rows = first_rows(head)
    at = 0
    mark: str | None = head.mark or next((mark for mark in MARKS if mark in head.lines[0][1]), ",")
    if rows is not None:
        above = _above(head, *rows)
        if above is not None or _fits(
            header_cells(head.lines[0][1], rows[1]), fields_of(head.lines[rows[0]][1], rows[1])
        ):
            at, mark = above or 0, rows[1]
    cells = header_cells(head.lines[at][1], mark)
    below = at + 1
    full = [place for place in range(at + 1, len(head.lines)) if head.lines[place][1]]
    for place in full[:1]:
        units = fields_of(head.lines[place][1], mark)
        if filled(units) <= len(cells) and are_units(units):
            cells, below = (
                list(map(with_unit, cells, [*units, *[""] * (len(cells) - len(units))])),
                place + 1,
            )
    if rows is not None and rows[0] > below and at > 0:
        below = rows[0]  # further lines about the columns
    cells = _with_groups(head, at, cells, mark)
    return Found(head.lines[at][0], _with_stated_units(head.lines[:at], cells, mark), mark, below)


def _above(head: Head, rows: int, mark: str | None) -> int | None:
    """Return the place of the header above rows; None if it is the first line, or there is none."""
    cells = {
        place: header_cells(head.lines[place][1], mark)
        for place in range(rows + 1)
        if head.lines[place][1]
    }
    above = [place for place in cells if place < rows and _fits(cells[place], cells[rows])]
    for before, place in pairwise(above):
        if are_units(cells[place]) and not are_units(cells[before]):
            return before
    # a line with numbers is one about the measurement, or a row with something else than a number
    # in it
    above = [
        place
        for place in above
        if not any(cell.strip() and is_number(cell, mark) for cell in cells[place])
    ]
    if not above or (above[0] == 0 and _has_units(cells[0])):
        return None
    return next((place for place in reversed(above) if _has_units(cells[place])), above[-1])


def _fits(cells: list[str], row: list[str]) -> bool:
    """Return whether a line may be the header of a row: it has as many fields, with or
    without empty ones at their ends.
    """
    return bool(filled(cells)) and (len(cells) == len(row) or filled(cells) == filled(row))


def _has_units(cells: list[str]) -> bool:
    """Return whether a cell of a line has a unit."""
    return any(name_and_unit(cell)[1] for cell in cells)


def _with_groups(head: Head, at: int, cells: list[str], mark: str | None) -> list[str]:
    """Return header cells with the names of their groups, where several have one name and
    the line above names groups (Tracker).
    """
    names = [name_and_unit(cell)[0] for cell in cells if cell]
    if at == 0 or len(set(names)) == len(names):
        return cells
    groups = [cell.strip() for cell in fields_of(head.lines[at - 1][1], mark)]
    if not 0 < len(list(filter(None, groups))) < len(cells) or len(groups) > len(cells):
        return cells
    group, found = "", []
    for place, cell in enumerate(cells):
        group = groups[place] if place < len(groups) and groups[place] else group
        is_alone = names.count(name_and_unit(cell)[0]) == 1 or name_and_unit(cell)[0] == "time"
        found.append(cell if is_alone or not cell else f"{group} {cell}".strip())
    return found


def _with_stated_units(
    above: list[tuple[int, str]], cells: list[str], mark: str | None
) -> list[str]:
    """Return header cells with the units that lines about the measurement state, as
    Tektronix writes them.
    """
    units = {
        fields[0].strip().lower(): fields[1:]
        for _, line in above
        if (fields := fields_of(line, mark)) and fields[0].strip()
    }
    horizontal, vertical = (
        units.get("horizontal units", [""])[0].strip().lower(),
        [one.strip() for one in units.get("vertical units", [])],
    )
    if not horizontal or not any(vertical) or name_and_unit(cells[0])[1] is not None:
        return cells
    return [
        with_unit(cells[0], horizontal),
        *(
            with_unit(cell, vertical[min(at, len(vertical) - 1)] or vertical[0])
            for at, cell in enumerate(cells[1:])
        ),
    ]
