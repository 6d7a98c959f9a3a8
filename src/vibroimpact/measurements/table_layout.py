"""Where the header of a table stands, and what separates its fields.

It is found as people, instruments and languages write tables.
"""

from __future__ import annotations

import re
from collections import Counter
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
    DELIMITERS,
    Clock,
    Head,
    HeaderLines,
    content,
    delimiter_of,
    fields_of,
    filled,
    first_rows,
    has_digits,
    header_cells,
    is_row,
)
from vibroimpact.quoting import shortened

_MOST_COLUMNS = 1000
_DELIMITER_NAMES = {"\t": "tabs", ";": "semicolons", ",": "commas", None: "blanks"}
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
    delimiter : str or None
        What separates fields; None for blanks.
    rows : iterator of (int, str)
        Number and text of each line below, without comments; an empty line is "".
    clocks : mapping of int to Clock
        By the index of a column what its times follow from, if it is not a column of times.
    is_stated : bool
        Whether the user states the columns.
    doubts : mapping of int to str
        By the index of a column what was taken for granted, as a sentence.
    """

    number: int
    header: list[str]
    delimiter: str | None
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
        if len(self.header) > 1:
            separated = f"separated by {_DELIMITER_NAMES[self.delimiter]}"
        else:
            separated = "of one column"
        return f"line {self.number} was taken for the header: {cells}, {separated}"

    @property
    def remedy(self) -> str:
        """How a user reads the table if it is not as understood, for messages."""
        if self.is_stated:
            return 'or state others, such as "time=s,force=N"'
        return remedy_for(self.header)

    @property
    def name_columns_so(self) -> str:
        """How a user names columns that are not known, for messages."""
        if self.is_stated:
            return 'State columns with these names, such as "time=s,force=N"'
        return f"Name the columns so, {self.remedy}"

    def with_unit(self, name: str, unit: str) -> str:
        """Return how a user states the unit of a column, for messages."""
        if self.is_stated:
            return f"state it, such as {name}={unit}"
        return f"write it in brackets, such as {name} [{unit}], {self.remedy}"


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
    stated = None
    if columns is not None:
        stated = stated_columns(columns)
    delimiter, comment, first = _beginning(lines)
    looked_at = ((number, content(line)) for number, line in islice(lines, _LOOKED))
    head = Head([first, *looked_at], delimiter)
    header = instrument_layout(head)
    if stated is not None:
        header = _stated(head, stated, header)
    elif header is None:
        header = _first_line_is_row(head, comment) or _header_above_rows(head)
    if len(header.cells) > _MOST_COLUMNS:
        raise InputError(
            f"line {header.number}: there are {len(header.cells)} columns; a table has "
            f"{_MOST_COLUMNS} at most"
        )
    further = ((number, content(line)) for number, line in lines)
    rows = rows_of_instrument(head, chain(head.lines[header.below :], further))
    return Layout(
        header.number,
        header.cells,
        header.delimiter,
        rows,
        header.clocks,
        stated is not None,
        header.doubts,
    )


def _beginning(
    lines: Iterator[tuple[int, str]],
) -> tuple[str | None, tuple[int, str], tuple[int, str]]:
    """Return the separator that a file states, its last comment, and its first line.

    The comment is the last one before the first line that is none.
    """
    delimiter: str | None = None
    comment = (0, "")
    has_text = False
    for number, whole in lines:
        line = content(whole)
        has_text = has_text or bool(whole.strip())
        separator = _SEPARATOR.fullmatch(line) if number == 1 else None
        if separator is not None:
            delimiter = separator.group(1)
        elif line:
            return delimiter, comment, (number, line)
        elif "#" in whole:
            comment = (number, whole.partition("#")[2].strip())
    if has_text:
        raise InputError("the file is empty but for comments, separators and blanks")
    raise InputError("the file is empty")


def _stated(head: Head, stated: StatedColumns, instrument: HeaderLines | None) -> HeaderLines:
    """Return the columns that the user states, above the first line with numbers in all of them."""
    cells = list(stated.cells)
    count = len(cells)
    named = [column for column, cell in enumerate(cells) if cell]
    stated_are = "one column is stated"
    if count > 1:
        stated_are = f"{count} columns are stated"
    first_row = 0
    known_delimiter = head.delimiter
    if instrument is not None:
        first_row = instrument.below
        known_delimiter = instrument.delimiter
    nearest = ""
    for index, (number, line) in enumerate(head.lines):
        if not line or index < first_row:
            continue
        delimiter = known_delimiter
        if not delimiter and count > 1:
            delimiter = delimiter_of(line)
        fields = fields_of(line, delimiter)
        has_numbers = has_digits(line) and all(
            column < len(fields) and is_number(fields[column], delimiter) for column in named
        )
        fields_are = _fields_are(filled(fields), delimiter)
        if has_numbers and filled(fields) > count:
            raise InputError(
                f"{STATED}: line {number} has {fields_are}, and {stated_are}; state each, and - "
                'for one that is left out, such as "time=s,-,force=N"'
            )
        if has_numbers:
            clocks = _stated_clocks(stated, instrument)
            return HeaderLines(number, cells, delimiter, index, clocks)
        if not nearest and is_row(line, delimiter):
            nearest = f"line {number} has {fields_are}"
    if not nearest:
        if len(head.lines) > 1:
            lines_have = f"none of the first {len(head.lines)} lines has"
        else:
            lines_have = "the only line does not have"
        nearest = f"{lines_have} a number in each column that is named"
    raise InputError(
        f"{STATED}: {nearest}, and {stated_are}; state each column, and - for one that is left out"
    )


def _stated_clocks(stated: StatedColumns, instrument: HeaderLines | None) -> Mapping[int, Clock]:
    """Return the clocks of columns that the user states, by their index.

    A rate that is stated, or a column of times, takes the place of the clocks of an instrument.
    """
    if stated.rate is not None:
        clock = Clock(0.0, 1.0 / stated.rate)
        return {column: clock for column, cell in enumerate(stated.cells) if cell}
    has_times = any(is_time(*name_and_unit(cell)) for cell in stated.cells if cell)
    if has_times or instrument is None:
        return {}
    return dict(instrument.clocks)


def _fields_are(count: int, delimiter: str | None) -> str:
    if count > 1:
        return f"{count} fields, separated by {_DELIMITER_NAMES[delimiter]}"
    return "one field"


def _first_line_is_row(head: Head, comment: tuple[int, str]) -> HeaderLines | None:
    """Return the header in the comment before rows that begin at once; None if they do not.

    Raises
    ------
    InputError
        If it has another number of fields than they have.
    """
    number, line = head.lines[0]
    delimiter = head.delimiter or delimiter_of(line)
    if not is_row(line, delimiter):
        return None
    columns = len(fields_of(line, delimiter))
    comment_number, comment_text = comment
    for separator in (",", ";", "\t", None):
        cells = header_cells(comment_text, separator)
        if len(cells) == columns and all(cells):
            return HeaderLines(comment_number, cells, delimiter, 0)
    if comment_text:
        above = f"the comment before it does not have as many names ({comment_text[:40]!r})"
    else:
        above = "no header is above it"
    if columns > 1:
        columns_are = f"{columns} numbers"
        remedy = remedy_for([])
    else:
        columns_are = "a number"
        remedy = (
            'or give --columns "rate=10 kHz,force=N" with the rate of the rows (in a case the key '
            "columns)"
        )
    raise InputError(
        f"line {number}: it has {columns_are}, and {above}; write a header, such as time "
        f"[s],force [N], {remedy}"
    )


def _header_above_rows(head: Head) -> HeaderLines:
    """Return the header with its units, from a line below it.

    It is the first line, or, if this can be none, the nearest one above the rows.
    """
    texts = [line for _, line in head.lines]
    rows = first_rows(head)
    header, delimiter = _header_and_delimiter(head, rows)
    cells = header_cells(texts[header], delimiter)
    below = header + 1

    # units may stand in the next line that is not empty
    following = next((index for index in range(below, len(texts)) if texts[index]), None)
    if following is not None:
        units = fields_of(texts[following], delimiter)
        if filled(units) <= len(cells) and are_units(units):
            missing = [""] * (len(cells) - len(units))
            cells = list(map(with_unit, cells, [*units, *missing]))
            below = following + 1
    if rows is not None and header > 0:
        first_row, _ = rows
        below = max(below, first_row)  # further lines about the columns
    cells = _with_groups(head, header, cells, delimiter)
    cells = _with_stated_units(head.lines[:header], cells, delimiter)
    return HeaderLines(head.lines[header][0], cells, delimiter, below)


def _header_and_delimiter(
    head: Head, rows: tuple[int, str | None] | None
) -> tuple[int, str | None]:
    """Return the index of the header and what separates its cells, with the first of the rows."""
    _, first_line = head.lines[0]
    if rows is not None:
        first_row, delimiter = rows
        header = _above(head, first_row, delimiter)
        if header is not None:
            return header, delimiter
        row = fields_of(head.lines[first_row][1], delimiter)
        if _fits(header_cells(first_line, delimiter), row):
            return 0, delimiter
    in_first_line = next((delimiter for delimiter in DELIMITERS if delimiter in first_line), ",")
    return 0, head.delimiter or in_first_line


def _above(head: Head, rows: int, delimiter: str | None) -> int | None:
    """Return the index of the header above rows; None if it is the first line, or there is none."""
    cells = {
        index: header_cells(line, delimiter)
        for index, (_, line) in enumerate(head.lines[: rows + 1])
        if line
    }
    above = [index for index in cells if index < rows and _fits(cells[index], cells[rows])]
    # the line above one of units
    for index, following in pairwise(above):
        if are_units(cells[following]) and not are_units(cells[index]):
            return index
    # a line with numbers is one about the measurement, or a row with something else than a number
    # in it
    above = [index for index in above if not _has_numbers(cells[index], delimiter)]
    if not above or (above[0] == 0 and _has_units(cells[0])):
        return None
    with_units = [index for index in above if _has_units(cells[index])]
    return with_units[-1] if with_units else above[-1]


def _has_numbers(cells: list[str], delimiter: str | None) -> bool:
    """Return whether a cell of a line is a number."""
    return any(cell.strip() and is_number(cell, delimiter) for cell in cells)


def _fits(cells: list[str], row: list[str]) -> bool:
    """Return whether a line may be the header of a row: it has as many fields.

    Empty ones at the ends may count or not.
    """
    return bool(filled(cells)) and (len(cells) == len(row) or filled(cells) == filled(row))


def _has_units(cells: list[str]) -> bool:
    """Return whether a cell of a line has a unit."""
    return any(name_and_unit(cell)[1] for cell in cells)


def _with_groups(head: Head, at: int, cells: list[str], delimiter: str | None) -> list[str]:
    """Return header cells with the names of their groups, as Tracker writes them.

    Several cells have one name then, and the line above names groups.
    """
    names = [name_and_unit(cell)[0] for cell in cells]
    counts = Counter(name for name, cell in zip(names, cells, strict=True) if cell)
    if at == 0 or not counts or max(counts.values()) == 1:
        return cells
    _, line_above = head.lines[at - 1]
    groups = [cell.strip() for cell in fields_of(line_above, delimiter)]
    if not 0 < sum(map(bool, groups)) < len(cells) or len(groups) > len(cells):
        return cells
    groups += [""] * (len(cells) - len(groups))
    # the name of a group stands above its first column
    group = ""
    with_groups = []
    for name, cell, group_above in zip(names, cells, groups, strict=True):
        group = group_above or group
        is_distinct = counts[name] == 1 or name == "time"
        if cell and not is_distinct:
            cell = f"{group} {cell}".strip()
        with_groups.append(cell)
    return with_groups


def _with_stated_units(
    above: list[tuple[int, str]], cells: list[str], delimiter: str | None
) -> list[str]:
    """Return header cells with the units that Tektronix states in lines about the measurement."""
    stated = {}
    for _, line in above:
        fields = fields_of(line, delimiter)
        if fields and fields[0].strip():
            stated[fields[0].strip().lower()] = [field.strip() for field in fields[1:]]
    # a line may have its name alone
    horizontal = next(iter(stated.get("horizontal units", [])), "").lower()
    vertical = stated.get("vertical units", [])
    if not horizontal or not any(vertical) or name_and_unit(cells[0])[1] is not None:
        return cells
    with_units = [with_unit(cells[0], horizontal)]
    for channel, cell in enumerate(cells[1:]):
        # the last one is that of all further channels
        unit = vertical[min(channel, len(vertical) - 1)] or vertical[0]
        with_units.append(with_unit(cell, unit))
    return with_units
