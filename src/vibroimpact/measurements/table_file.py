"""Tables of measurements from CSV files: columns with units; errors name the line."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from math import isinf, isnan, nan
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.files.reading import FileKind, text_lines, with_path
from vibroimpact.measurements.cell_numbers import SCPI, is_either, number_in
from vibroimpact.measurements.header_cells import name_and_unit
from vibroimpact.measurements.table_layout import Layout, table_layout
from vibroimpact.measurements.table_lines import fields_of, filled
from vibroimpact.quoting import quoted, shortened
from vibroimpact.units.reading import to_si
from vibroimpact.units.spelling import plain_factor

TABLE = FileKind(
    "a table is a text file, such as CSV", 500_000_000, "keep the part with the impacts"
)
"""Requirements on a table file."""

MOST_LINES = 10_000_000
"""Largest number of lines of a table: five seconds at 2 MHz."""

_LARGEST_NUMBER = 1e30  # so that powers of the values do not overflow
_LONGEST = 100_000  # characters of a line
_MOST_NAMED = 12  # columns that a message names
_LONG_NAME = 40  # characters of a name in a message
_LONGEST_PATH = 200  # characters of a path in a message


@dataclass(frozen=True)
class TableFile:
    """Content of a file.

    Columns (rows,) in SI units by name, the line number of each row, empty lines before the last
    row, and doubts.
    """

    path: Path
    columns: Mapping[str, Floats]
    lines: Sequence[int]
    empty: Sequence[int] = ()
    doubts: tuple[str, ...] = ()


class Cells(NamedTuple):
    """Columns of a table in SI units by their index (rows,).

    With them come the layout, the number of the line of each row, and empty lines.
    """

    layout: Layout
    columns: Mapping[int, Floats]
    lines: Sequence[int]
    empty: Sequence[int]


def read_table_file(
    path: str | PathLike[str],
    units: Mapping[str, str],
    doubts: list[str] | None = None,
    columns: str | None = None,
) -> TableFile:
    """Read the known columns of a CSV file.

    The first line that is not a comment (#) is the header, with column names and units: `time_s`,
    `time [ms]`, `force (kN)`; how other headers are found says `table_layout`. Fields are separated
    by commas, semicolons or tabs, or by blanks; a comma that does not separate them may be the
    decimal point.

    Parameters
    ----------
    path : path
        The file.
    units : mapping of str to str
        The SI unit of each known column; "" for a plain number.
    doubts : list of str, optional
        Where sentences are told that are added to it; without it a file that is read only with a
        doubt is refused.
    columns : str, optional
        The columns as a user states them in place of a header, "time=s,force=N".

    Raises
    ------
    InputError
        If the file can't be read, a column has no unit or one of another dimension, or a cell is
        not a finite number.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "drop.csv")
    ...     _ = file.write_text("time [ms],force_N\\n0,1\\n1,2\\n")
    ...     read_table_file(file, {"time": "s", "force": "N"}).columns["time"].tolist()
    [0.0, 0.001]
    """
    names: dict[int, str] = {}

    def known(layout: Layout) -> dict[int, float]:
        columns = _known_columns(layout, units)
        names.update({column: name for column, (name, _) in columns.items()})
        return {column: factor for column, (_, factor) in columns.items()}

    cells = read_cells(path, known, _refused, doubts, columns)
    last_row = cells.lines[-1]
    return TableFile(
        Path(path),
        {names[column]: values for column, values in cells.columns.items()},
        cells.lines,
        [number for number in cells.empty if number < last_row],
        tuple(doubts or ()),
    )


def read_cells(
    path: str | PathLike[str],
    wanted: Callable[[Layout], Mapping[int, float]],
    without_number: Callable[[float, str], float],
    doubts: list[str] | None = None,
    columns: str | None = None,
) -> Cells:
    """Read columns of a table.

    Parameters
    ----------
    path : path
        The file.
    wanted : callable
        Returns the indices of the columns to read, with the factors that convert them to SI.
    without_number : callable
        Returns the value of a cell that has none (nan), or an infinite one, from this and a
        sentence on the cell; or raises.
    doubts, columns
        As those of `read_table_file`.

    Raises
    ------
    InputError
        If the file can't be read, a line has more fields than the header, or a cell is not a
        number.
    """
    file = Path(path)
    try:
        layout = table_layout(_numbered(text_lines(file, TABLE, _LONGEST, doubts)), columns)
        header = layout.header
        delimiter = layout.delimiter
        factors = wanted(layout)
        values: dict[int, array[float]] = {column: array("d") for column in factors}
        # bound methods, since tables have millions of rows
        readers = [(column, factor, values[column].append) for column, factor in factors.items()]
        lines = array("q")
        empty = array("q")
        decimal = _DecimalPoint()
        for number, line in layout.rows:
            if not line:
                empty.append(number)
                continue
            cells = fields_of(line, delimiter)
            if len(cells) > len(header) and filled(cells) > len(header):
                raise InputError(_too_many(number, filled(cells), layout))
            if delimiter != ",":
                decimal.check(number, line, cells)
            for column, factor, append in readers:
                value = _number(number, header[column], cells, column, delimiter, without_number)
                append(value * factor)
            lines.append(number)
    except InputError as error:
        raise in_table(file, error) from None
    if not lines:
        raise InputError(
            f"{shortened(str(file), _LONGEST_PATH)}: there are no rows under the header; "
            f"{layout.understood}"
        )
    return Cells(
        layout, {column: np.array(numbers) for column, numbers in values.items()}, lines, empty
    )


def in_table(path: str | PathLike[str], error: InputError) -> InputError:
    """Return an error with the path of the table before the line that it names.

    Examples
    --------
    >>> in_table("drop.csv", InputError("line 3: the cell is empty")).message
    'drop.csv, line 3: the cell is empty'
    """
    where = shortened(str(path), _LONGEST_PATH)
    separator = ", " if error.message.startswith("line ") else ": "
    return InputError(f"{where}{separator}{error.message}")


def header_of(path: str | PathLike[str], columns: str | None = None) -> list[str]:
    """Return the cells of the header of a CSV file, or those that the user states.

    Raises
    ------
    InputError
        If the file can't be read, or is empty.
    """
    return layout_of(path, columns).header


def layout_of(path: str | PathLike[str], columns: str | None = None) -> Layout:
    """Return how a CSV file is laid out, with the columns that the user states, if any.

    Raises
    ------
    InputError
        If the file can't be read, or is empty.
    """
    file = Path(path)
    try:
        with closing(text_lines(file, TABLE, _LONGEST, [])) as lines:
            return table_layout(_numbered(lines), columns)
    except InputError as error:
        raise with_path(file, error) from None


def _numbered(text: Iterable[str]) -> Iterator[tuple[int, str]]:
    """Yield number and text of each line."""
    for number, whole in enumerate(text, 1):
        if number > MOST_LINES:
            raise InputError(
                f"the file has more than {MOST_LINES:,} lines; keep the part with the "
                "impacts, or fewer samples a second"
            )
        if len(whole) > _LONGEST:
            raise InputError(
                f"line {number}: it has more than {_LONGEST:,} characters; this is not a table"
            )
        yield number, whole


class _DecimalPoint:
    """Watches whether a table with decimal commas also has points, which may group digits.

    1.234 is 1234 or 1.234 then.
    """

    def __init__(self) -> None:
        # number of the first line with a decimal comma; 0 if there was none yet
        self.comma_line = 0
        # number of the first line with a point that may group digits, and its cell
        self.point_line = 0
        self.point_cell = ""

    def check(self, number: int, line: str, cells: Sequence[str]) -> None:
        """Raise if a line leaves open what a point in the table means."""
        is_first = not self.comma_line and "," in line
        if is_first and any("," in cell and _begins_as_number(cell) for cell in cells):
            self.comma_line = number
        if not self.point_line and "." in line:
            for cell in cells:
                if "." in cell and is_either(cell):
                    self.point_line = number
                    self.point_cell = cell
                    break
        if self.comma_line and self.point_line:
            raise InputError(
                f"line {self.point_line}: {quoted(self.point_cell.strip())} has a point, and a "
                f"number in line {self.comma_line} a comma: either may group digits; write all "
                "numbers with the same decimal sign, and do not group digits"
            )


def _begins_as_number(cell: str) -> bool:
    return cell[:1].strip('"+- ').isdigit() or cell[:1] == "-"


def _too_many(number: int, fields: int, layout: Layout) -> str:
    """Return the message that a line has more fields than the header."""
    columns = len(layout.header)
    if layout.is_stated:
        known = "1 is stated" if columns == 1 else f"{columns} are stated"
    else:
        known = f"the header has {columns}"
    hint = ""
    if layout.delimiter == ",":
        hint = "; where a comma is the decimal point, semicolons separate the fields"
    return f"line {number}: there are {fields} fields, and {known}{hint}; {layout.understood}"


def _known_columns(layout: Layout, units: Mapping[str, str]) -> dict[int, tuple[str, float]]:
    """Return the names of the known columns, and their factors to SI, by their index.

    Raises
    ------
    InputError
        If there is none, a name is that of two, or a unit is missing or of another dimension.
    """
    columns: dict[int, tuple[str, float]] = {}
    names = set()
    for column, cell in enumerate(layout.header):
        name, unit = name_and_unit(cell)
        if name not in units:
            continue
        if name in names:
            raise InputError(
                f'{layout.where}: there are two columns "{name}"; rename one, {layout.remedy}'
            )
        names.add(name)
        columns[column] = (name, factor_to_si(layout, cell, unit, units[name]))
    if not columns:
        raise InputError(_no_known_column(layout, units))
    return columns


def _no_known_column(layout: Layout, units: Mapping[str, str]) -> str:
    """Return the message that no column of a table is known."""
    names = [name_and_unit(cell)[0] for cell in layout.header[:_MOST_NAMED]]
    hints = (did_you_mean(name, units) for name in names if len(name) < _LONG_NAME)
    hint = next((hint for hint in hints if hint), "")
    listed = ", ".join(shortened(name, _LONG_NAME) for name in names)
    if len(layout.header) > _MOST_NAMED:
        listed += ", ..."
    return (
        f"{layout.where}: no column is known among {listed}; {_allowed(units)}.{hint} "
        f"{layout.name_columns_so}"
    )


def factor_to_si(layout: Layout, cell: str, unit: str | None, wanted: str) -> float:
    """Return the factor that converts a column to an SI unit; "" for a plain number.

    Raises
    ------
    InputError
        If it has no unit, or one of another quantity.
    """
    where = f"{layout.where}, column {quoted(cell)}"
    if not wanted:
        factor = plain_factor(unit or "")
        if factor is None:
            raise InputError(f"{where}: it is a plain number, and must have no unit")
        return factor
    if not unit:
        name = shortened(cell.split("[")[0].strip(), _LONG_NAME)
        raise InputError(f"{where}: the unit is missing; {layout.with_unit(name, wanted)}")
    try:
        return to_si(f"1 {unit}", wanted)
    except InputError as error:
        # without the 1 before the unit, and without the hint how to write a number
        unit_alone = quoted(unit, 80)
        with_one = quoted(f"1 {unit}", 80)
        cause = error.message.partition(" (a number in ")[0]
        cause = cause.replace(f"{unit_alone} in {with_one}", unit_alone)
        cause = cause.replace(with_one, unit_alone)
        raise InputError(f"{where}: {cause}, such as {wanted}") from None


def _number(
    line: int,
    name: str,
    row: list[str],
    column: int,
    delimiter: str | None,
    without_number: Callable[[float, str], float],
) -> float:
    """Return the number in a cell of a row, or what the callable makes of a cell that has none."""
    text = row[column] if column < len(row) else ""
    where = f"line {line}, column {quoted(name)}"
    try:
        value = number_in(text, delimiter)
    except ValueError:
        fault = f"{quoted(text.strip())} is not a number"
        if is_either(text):
            fault += f"; {_EITHER}"
        raise InputError(f"{where}: {fault}") from None
    if -_LARGEST_NUMBER < value < _LARGEST_NUMBER:
        return value
    if column >= len(row):
        fields = "1 field" if len(row) == 1 else f"{len(row)} fields"
        return without_number(nan, f"{where}: the cell is missing; the line has {fields}")
    coded = SCPI.get(value, value)
    if isnan(coded) or isinf(coded):
        return without_number(coded, f"{where}: {_content_of(text.strip(), value, coded)}")
    raise InputError(
        f"{where}: {quoted(text.strip())} is not a measurement; it must be less than 1e30 in size"
    )


def _content_of(text: str, value: float, coded: float) -> str:
    """Return what a cell without a number has.

    It has nothing, words for a missing one, or the code of an instrument for one.
    """
    if not text:
        return "the cell is empty"
    if not (isnan(value) or isinf(value)):
        meaning = "missing" if isnan(coded) else "over the range"
        return f"{quoted(text)} stands for a sample that is {meaning} (SCPI)"
    try:
        float(text)
    except ValueError:
        fault = "no number" if isnan(value) else "over the range"
        return f"{quoted(text)} is {fault}"
    return f"{quoted(text)} is not finite"


_EITHER = (
    "a comma is the decimal point or groups digits there: save the table with semicolons "
    "between the fields, or without groups"
)


def _refused(_: float, fault: str) -> float:
    raise InputError(f"{fault}; fill it in, or leave out the line")


def _allowed(units: Mapping[str, str]) -> str:
    """Return the names of known columns with their units."""
    columns = []
    for name, unit in units.items():
        if "deviation" not in name:
            columns.append(f"{name} [{unit}]" if unit else name)
    return f"known are {', '.join(columns)}"
