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
    """Content of a file: columns (rows,) in SI units by name, the line number of each
    row, empty lines before the last row, and doubts.
    """

    path: Path
    columns: Mapping[str, Floats]
    lines: Sequence[int]
    empty: Sequence[int] = ()
    doubts: tuple[str, ...] = ()


class Cells(NamedTuple):
    """Columns of a table in SI units by their place (rows,), the number of the line of
    each row, empty lines, and the layout.
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
        places, factors = _places(layout, units)
        names.update({place: name for name, place in places.items()})
        return dict(zip(places.values(), factors, strict=True))

    found = read_cells(path, known, _refused, doubts, columns)
    last = found.lines[-1]
    values = {names[place]: column for place, column in found.columns.items()}
    return TableFile(
        Path(path),
        values,
        found.lines,
        [number for number in found.empty if number < last],
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
        Returns the places of the columns to read, with the factors that convert them to SI.
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
        header, mark = layout.header, layout.mark
        places = wanted(layout)
        found: list[array[float]] = [array("d") for _ in places]
        appended = list(
            zip([values.append for values in found], places, places.values(), strict=True)
        )
        lines, empty, decimal = array("q"), array("q"), _DecimalPoint(mark)
        for number, line in layout.rows:
            if not line:
                empty.append(number)
                continue
            cells = fields_of(line, mark)
            if len(cells) > len(header) and filled(cells) > len(header):
                raise InputError(_too_many(number, filled(cells), layout))
            if mark != ",":
                decimal.check(number, line, cells)
            for append, place, factor in appended:
                append(_number(number, header[place], cells, place, mark, without_number) * factor)
            lines.append(number)
    except InputError as error:
        raise in_table(file, error) from None
    if not lines:
        raise InputError(
            f"{shortened(str(file), _LONGEST_PATH)}: there are no rows under the header; "
            f"{layout.understood}"
        )
    return Cells(
        layout,
        {place: np.array(values) for place, values in zip(places, found, strict=True)},
        lines,
        empty,
    )


def in_table(path: str | PathLike[str], error: InputError) -> InputError:
    """Return an error with the path of the table before the line that it names.

    Examples
    --------
    >>> in_table("drop.csv", InputError("line 3: the cell is empty")).message
    'drop.csv, line 3: the cell is empty'
    """
    where = shortened(str(path), _LONGEST_PATH)
    return InputError(
        f"{where}{', ' if error.message.startswith('line ') else ': '}{error.message}"
    )


def header_of(path: str | PathLike[str], columns: str | None = None) -> list[str]:
    """Return the cells of the header of a CSV file, or those that the user states.

    Raises
    ------
    InputError
        If the file can't be read, or is empty.
    """
    file = Path(path)
    try:
        with closing(text_lines(file, TABLE, _LONGEST, [])) as lines:
            return table_layout(_numbered(lines), columns).header
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
    """Watches whether a table with decimal commas also has points, which may group
    digits: 1.234 is 1234 or 1.234 then.
    """

    def __init__(self, mark: str | None) -> None:
        self.comma, self.either = 0, (0, "")

    def check(self, number: int, line: str, cells: Sequence[str]) -> None:
        """Raise if a line leaves open what a point in the table means."""
        if (
            not self.comma
            and "," in line
            and any(
                "," in cell for cell in cells if cell[:1].strip('"+- ').isdigit() or cell[:1] == "-"
            )
        ):
            self.comma = number
        if not self.either[0] and "." in line:
            self.either = next(
                ((number, cell) for cell in cells if "." in cell and is_either(cell)), self.either
            )
        if self.comma and self.either[0]:
            at, cell = self.either
            words = (
                f"{quoted(cell.strip())} has a point, and a number in line {self.comma} a "
                "comma: either may group digits"
            )
            raise InputError(
                f"line {at}: {words}; write all numbers with the same decimal sign, and do "
                "not group digits"
            )


def _too_many(number: int, fields: int, layout: Layout) -> str:
    hint = (
        "; where a comma is the decimal point, semicolons separate the fields"
        if layout.mark == ","
        else ""
    )
    columns = len(layout.header)
    known = (
        f"{columns} {'is' if columns == 1 else 'are'} stated"
        if layout.is_stated
        else f"the header has {columns}"
    )
    return f"line {number}: there are {fields} fields, and {known}{hint}; {layout.understood}"


def _places(layout: Layout, units: Mapping[str, str]) -> tuple[dict[str, int], list[float]]:
    """Return the positions of the known columns, and their conversion factors to SI."""
    places: dict[str, int] = {}
    factors = []
    for place, cell in enumerate(layout.header):
        name, unit = name_and_unit(cell)
        if name not in units:
            continue
        if name in places:
            raise InputError(
                f'{layout.where}: there are two columns "{name}"; rename one, {layout.remedy}'
            )
        places[name] = place
        factors.append(factor_to_si(layout, cell, unit, units[name]))
    if not places:
        names = [name_and_unit(cell)[0] for cell in layout.header[:_MOST_NAMED]]
        hint = next(
            (
                words
                for name in names
                if len(name) < _LONG_NAME and (words := did_you_mean(name, units))
            ),
            "",
        )
        listed = ", ".join(shortened(name, _LONG_NAME) for name in names) + (
            ", ..." if len(layout.header) > _MOST_NAMED else ""
        )
        raise InputError(
            f"{layout.where}: no column is known among {listed}; {_allowed(units)}.{hint}"
        )
    return places, factors


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
    if unit is None or not unit:
        name = shortened(cell.split("[")[0].strip(), _LONG_NAME)
        raise InputError(f"{where}: the unit is missing; {layout.with_unit(name, wanted)}")
    try:
        return to_si(f"1 {unit}", wanted)
    except InputError as error:
        # without the 1 before the unit, and without the hint how to write a number
        given, one = quoted(unit, 80), quoted(f"1 {unit}", 80)
        words = (
            error.message.partition(" (a number in ")[0]
            .replace(f"{given} in {one}", given)
            .replace(one, given)
        )
        raise InputError(f"{where}: {words}, such as {wanted}") from None


def _number(
    line: int,
    column: str,
    row: list[str],
    place: int,
    mark: str | None,
    without: Callable[[float, str], float],
) -> float:
    text = row[place] if place < len(row) else ""
    try:
        value = number_in(text, mark)
    except ValueError:
        hint = f"; {_EITHER}" if is_either(text) else ""
        raise InputError(
            f"line {line}, column {quoted(column)}: {quoted(text.strip())} is not a number{hint}"
        ) from None
    if -_LARGEST_NUMBER < value < _LARGEST_NUMBER:
        return value
    where = f"line {line}, column {quoted(column)}"
    if place >= len(row):
        return without(
            nan,
            f"{where}: the cell is missing; the line has {len(row)} "
            f"field{'' if len(row) == 1 else 's'}",
        )
    coded = SCPI.get(value, value)
    if isnan(coded) or isinf(coded):
        return without(coded, f"{where}: {_what_is_there(text.strip(), value, coded)}")
    raise InputError(
        f"{where}: {quoted(text.strip())} is not a measurement; it must be less than 1e30 in size"
    )


def _what_is_there(text: str, value: float, coded: float) -> str:
    """Return what a cell without a number has: nothing, words for a missing one, or the
    code of an instrument for one.
    """
    if not text:
        return "the cell is empty"
    if not (isnan(value) or isinf(value)):
        return (
            f"{quoted(text)} stands for a sample that is "
            f"{'missing' if isnan(coded) else 'over the range'} (SCPI)"
        )
    try:
        float(text)
    except ValueError:
        return f"{quoted(text)} is {'no number' if isnan(value) else 'over the range'}"
    return f"{quoted(text)} is not finite"


_EITHER = (
    "a comma is the decimal point or groups digits there: save the table with semicolons "
    "between the fields, or without groups"
)


def _refused(_: float, fault: str) -> float:
    raise InputError(f"{fault}; fill it in, or leave out the line")


def _allowed(units: Mapping[str, str]) -> str:
    return "known are " + ", ".join(
        f"{name} [{unit}]" if unit else name
        for name, unit in units.items()
        if "deviation" not in name
    )
