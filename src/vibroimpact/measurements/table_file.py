"""Tables of measurements from CSV files: columns with units; errors name the line."""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from math import isfinite
from os import PathLike
from pathlib import Path

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.files.reading import FileKind, text_lines, with_path
from vibroimpact.measurements.table_layout import fields_of, table_layout
from vibroimpact.shown import shortened, shown
from vibroimpact.units.reading import to_si
from vibroimpact.units.spelling import plain_factor

TABLE = FileKind("a table is a CSV file", 500_000_000, "keep the part with the impacts")
"""Requirements on a table file."""

MOST_LINES = 10_000_000
"""Largest number of lines of a table: five seconds at 2 MHz."""

_LARGEST_NUMBER = 1e30  # so that powers of the values do not overflow
_LONGEST = 100_000  # characters of a line
_MOST_NAMED = 12  # columns that a message names
_LONG_NAME = 40  # characters of a name in a message
_ENDINGS = {
    "_m_s2": "m/s^2",
    "_m_s": "m/s",
    "_rad_s": "rad/s",
    "_deg": "deg",
    "_s": "s",
    "_ms": "ms",
    "_us": "us",
    "_m": "m",
    "_mm": "mm",
    "_um": "um",
    "_N": "N",
    "_kN": "kN",
    "_V": "V",
    "_mV": "mV",
    "_Pa": "Pa",
}

_LANGUAGES = {
    "time": "t zeit temps tiempo tempo tijd tid aika czas čas idő zaman время 时间 時間",
    "force": "kraft fuerza forza força kracht voima siła síla erő kuvvet сила 力",
}
"""Names of a column in other languages, which instruments write by the language that they are set to."""

_ENGLISH = {word: name for name, words in _LANGUAGES.items() for word in words.split()}


@dataclass(frozen=True)
class TableFile:
    """Content of a file: columns (rows,) in SI units by name, the line number of each row, and empty lines before the last row."""

    path: Path
    columns: Mapping[str, Floats]
    lines: Sequence[int]
    empty: Sequence[int] = ()


def read_table_file(path: str | PathLike[str], units: Mapping[str, str], doubts: list[str] | None = None) -> TableFile:
    """Read the known columns of a CSV file.

    The first line that is not a comment (#) is the header, with column names and units: `time_s`, `time [ms]`, `force (kN)`; how other
    headers are found says `table_layout`. Fields are separated by commas, semicolons or tabs, or by blanks; a comma that does not separate
    them may be the decimal point.

    Parameters
    ----------
    path : path
        The file.
    units : mapping of str to str
        The SI unit of each known column; "" for a plain number.
    doubts : list of str, optional
        Where sentences are told that are added to it; without it a file that is read only with a doubt is refused.

    Raises
    ------
    InputError
        If the file can't be read, a column has no unit or one of another dimension, or a cell is not a finite number.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "drop.csv")
    ...     _ = file.write_text("time [ms],force_N\\n0,1\\n1,2\\n")
    ...     read_table_file(file, {"time": "s", "force": "N"}).columns["time"].tolist()
    [0.0, 0.001]
    """
    file = Path(path)
    try:
        number, header, mark, rows = table_layout(_numbered(text_lines(file, TABLE, _LONGEST, doubts)))
        places, factors = _places(number, header, units)
        found: list[array[float]] = [array("d") for _ in places]
        lines, empty, last = array("q"), array("q"), number
        for number, line in rows:
            if not line:
                empty.append(number)
                continue
            cells = fields_of(line, mark)
            if len(cells) > len(header):
                hint = "; where a comma is the decimal point, semicolons separate the fields" if mark == "," else ""
                raise InputError(f"line {number}: there are {len(cells)} fields, and the header has {len(header)}{hint}")
            for values, place, factor in zip(found, places.values(), factors, strict=True):
                values.append(_number(number, header[place], cells, place, mark) * factor)
            lines.append(number)
            last = number
    except InputError as error:
        where = shortened(str(file), 200)
        raise InputError(f"{where}{', ' if error.message.startswith('line ') else ': '}{error.message}") from None
    if not lines:
        raise InputError(f"{file}: there are no rows under the header")
    columns = {name: np.array(values) for name, values in zip(places, found, strict=True)}
    return TableFile(file, columns, lines, [number for number in empty if number < last])


def header_of(path: str | PathLike[str]) -> list[str]:
    """Return the cells of the header of a CSV file.

    Raises
    ------
    InputError
        If the file can't be read, or is empty.
    """
    file = Path(path)
    try:
        with closing(text_lines(file, TABLE, _LONGEST, [])) as lines:
            return table_layout(_numbered(lines)).header
    except InputError as error:
        raise with_path(file, error) from None


def strictly_increasing(table: TableFile, column: str) -> TableFile:
    """Return a table without the rows at which a column does not increase; raise if it decreases or is constant.

    Raises
    ------
    InputError
        If the column decreases, with the line, or is constant throughout.
    """
    steps = np.diff(table.columns[column])
    back = np.flatnonzero(steps < 0.0)
    if back.size:
        at = int(back[0])
        one, other = table.columns[column][at : at + 2]
        raise InputError(f"{table.path}, line {table.lines[at + 1]}: {column} goes backwards, from {one:.9g} to {other:.9g}")
    if not (steps > 0.0).any():
        raise InputError(f"{table.path}: {column} stands still; a record has more than one moment")
    kept = np.append(True, steps > 0.0)
    lines = [line for line, keep in zip(table.lines, kept, strict=True) if keep]
    return TableFile(table.path, {name: values[kept] for name, values in table.columns.items()}, lines)


def _numbered(text: Iterable[str]) -> Iterator[tuple[int, str]]:
    """Yield number and text of each line."""
    for number, whole in enumerate(text, 1):
        if number > MOST_LINES:
            raise InputError(f"the file has more than {MOST_LINES:,} lines; keep the part with the impacts, or fewer samples a second")
        if len(whole) > _LONGEST:
            raise InputError(f"line {number}: it has more than {_LONGEST:,} characters; this is not a table")
        yield number, whole


def _places(number: int, header: Sequence[str], units: Mapping[str, str]) -> tuple[dict[str, int], list[float]]:
    """Return the positions of the known columns, and their conversion factors to SI."""
    places: dict[str, int] = {}
    factors = []
    for place, cell in enumerate(header):
        name, unit = name_and_unit(cell)
        if name not in units:
            continue
        if name in places:
            raise InputError(f'line {number}: there are two columns "{name}"')
        places[name] = place
        factors.append(_factor(number, cell, unit, units[name]))
    if not places:
        names = [name_and_unit(cell)[0] for cell in header[:_MOST_NAMED]]
        hint = next((words for name in names if len(name) < _LONG_NAME and (words := did_you_mean(name, units))), "")
        listed = ", ".join(shortened(name, _LONG_NAME) for name in names) + (", ..." if len(header) > _MOST_NAMED else "")
        raise InputError(f"line {number}: no column is known among {listed}; {_allowed(units)}.{hint}")
    return places, factors


def name_and_unit(cell: str) -> tuple[str, str | None]:
    """Return name and unit of a header cell; None if it has no unit. The words of other languages for time and force are translated.

    Examples
    --------
    >>> name_and_unit("Rebound height [mm]"), name_and_unit("time_s"), name_and_unit("count"), name_and_unit("Zeit [ms]")
    (('rebound_height', 'mm'), ('time', 's'), ('count', None), ('time', 'ms'))
    """
    whole = cell.strip()
    if whole.endswith(("]", ")")):
        # the unit is between the last two brackets; a regular expression for that takes minutes on a long line of brackets
        inside = whole[:-1]
        start = max(inside.rfind("]"), inside.rfind(")")) + 1
        opening = min((at for at in (inside.find("[", start), inside.find("(", start)) if at >= 0), default=-1)
        if opening >= 0:
            return _plain(inside[:opening]), inside[opening + 1 :].strip()
    for ending, unit in sorted(_ENDINGS.items(), key=lambda item: -len(item[0])):
        if cell.endswith(ending):
            return _plain(cell.removesuffix(ending)), unit
    return _plain(cell), None


def _plain(name: str) -> str:
    plain = re.sub(r"[\s-]+", "_", name.strip().lower())
    return _ENGLISH.get(plain, plain)


def _factor(line: int, cell: str, unit: str | None, wanted: str) -> float:
    where = f"line {line}, column {shown(cell)}"
    if not wanted:
        factor = plain_factor(unit or "")
        if factor is None:
            raise InputError(f"{where}: it is a plain number, and has no unit")
        return factor
    if unit is None or not unit:
        name = shortened(cell.split("[")[0].strip(), _LONG_NAME)
        raise InputError(f"{where}: the unit is missing; write it in brackets, such as {name} [{wanted}]")
    try:
        return to_si(f"1 {unit}", wanted)
    except InputError as error:
        raise InputError(f"{where}: {error.message}") from None


def _number(line: int, column: str, row: list[str], place: int, mark: str | None) -> float:
    if place >= len(row):
        raise InputError(f"line {line}, column {shown(column)}: the cell is missing; the line has {len(row)}")
    text = row[place]
    try:
        if "_" in text:  # allowed in numbers by Python
            raise ValueError(text)
        value = float(text.replace(",", ".") if mark != "," else text)
    except ValueError:
        what = f"{shown(text.strip())} is not a number" if text.strip() else "the cell is empty"
    else:
        if -_LARGEST_NUMBER < value < _LARGEST_NUMBER:
            return value
        what = f"{shown(text.strip())} is not {'finite' if not isfinite(value) else 'a measurement; it must be less than 1e30 in size'}"
    raise InputError(f"line {line}, column {shown(column)}: {what}")


def _allowed(units: Mapping[str, str]) -> str:
    return "known are " + ", ".join(f"{name} [{unit}]" if unit else name for name, unit in units.items() if "deviation" not in name)
