"""A table of measurements from a CSV file: columns with units, read with the row of every fault."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.units import to_si

Floats = NDArray[np.float64]

LARGEST = 500_000_000
"""Bytes of a file that is read."""

_LONGEST = 100_000  # characters of a line

_BRACKETS = re.compile(r"(.*?)\s*[\[(]\s*([^\])]*)\s*[\])]\s*")
_ENDINGS = {
    "_m_s2": "m/s^2",
    "_m_s": "m/s",
    "_s": "s",
    "_ms": "ms",
    "_us": "us",
    "_m": "m",
    "_mm": "mm",
    "_um": "um",
    "_N": "N",
    "_kN": "kN",
}


@dataclass(frozen=True)
class TableFile:
    """What a file holds: columns (rows,) in SI by their names, the line that each row stands on, and empty lines before the last."""

    path: Path
    columns: Mapping[str, Floats]
    lines: Sequence[int]
    empty: Sequence[int] = ()


def read_table_file(path: str | PathLike[str], units: Mapping[str, str]) -> TableFile:
    """Read those columns of a CSV file that are known.

    The first line that is not a comment (#) names the columns with their units: `time_s`, `time [ms]`, `force (kN)`. Fields are
    separated by commas, semicolons or tabs; with semicolons or tabs a comma may be the decimal point.

    Parameters
    ----------
    path : path
        The file.
    units : mapping of str to str
        The SI unit of each column that is known; "" of a plain number.

    Raises
    ------
    InputError
        If it can't be read, a column has no unit or one of another kind, or a cell is not a finite number; with the line.

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
    raw = _text(file).splitlines()
    longest = max(map(len, raw), default=0)
    if longest > _LONGEST:
        raise InputError(f"{file}: a line has {longest} characters; this is not a table")
    plain = (line.partition("#")[0].rstrip() for line in raw)  # without comments
    lines = [(number, line) for number, line in enumerate(plain, 1) if line.strip(" ,;\t")]
    if not lines:
        raise InputError(f"{file}: the file is empty")
    first = lines[0][1]
    mark = next((mark for mark in ("\t", ";", ",") if mark in first), ",")
    header = [cell.strip() for cell in next(csv.reader([first], delimiter=mark))]
    found: dict[str, tuple[int, float]] = {}
    for place, cell in enumerate(header):
        name, unit = name_and_unit(cell)
        if name not in units:
            continue
        if name in found:
            raise InputError(f'{file}, line {lines[0][0]}: there are two columns "{name}"')
        found[name] = (place, _factor(file, lines[0][0], cell, unit, units[name]))
    if not found:
        names = [name_and_unit(cell)[0] for cell in header]
        hint = next((words for name in names if (words := did_you_mean(name, units))), "")
        raise InputError(f"{file}, line {lines[0][0]}: no column is known among {', '.join(names)}; {_allowed(units)}.{hint}")
    rows = []
    for number, line in lines[1:]:
        cells = next(csv.reader([line], delimiter=mark))
        if len(cells) > len(header):
            hint = "; where a comma is the decimal point, semicolons separate the fields" if mark == "," else ""
            raise InputError(f"{file}, line {number}: there are {len(cells)} fields, and the header has {len(header)}{hint}")
        rows.append([_number(file, number, header[place], cells, place, mark) * factor for place, factor in found.values()])
    if not rows:
        raise InputError(f"{file}: there are no rows under the header")
    table = np.array(rows, dtype=float).T
    empty = [number for number, line in enumerate(raw, 1) if not line.strip(" ,;\t") and number < lines[-1][0]]
    return TableFile(file, dict(zip(found, table, strict=True)), [number for number, _ in lines[1:]], empty)


def rising(table: TableFile, column: str) -> TableFile:
    """Return a table without the rows at which a column stands still; raise if it goes backwards.

    Raises
    ------
    InputError
        With the line where it does not.
    """
    steps = np.diff(table.columns[column])
    back = np.flatnonzero(steps < 0.0)
    if back.size:
        at = int(back[0])
        one, other = table.columns[column][at : at + 2]
        raise InputError(f"{table.path}, line {table.lines[at + 1]}: {column} goes backwards, from {one:.9g} to {other:.9g}")
    kept = np.append(True, steps > 0.0)
    lines = [line for line, keep in zip(table.lines, kept, strict=True) if keep]
    return TableFile(table.path, {name: values[kept] for name, values in table.columns.items()}, lines)


def _text(file: Path) -> str:
    try:
        if file.is_dir():
            raise InputError(f"{file}: this is a directory; a table is a CSV file")
        if file.stat().st_size > LARGEST:
            raise InputError(f"{file}: the file is larger than {LARGEST // 1_000_000} MB; keep the part with the impacts")
        return file.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"{file}: there is no such file") from None
    except UnicodeDecodeError:
        raise InputError(f"{file}: the file is not UTF-8 text; a table is a CSV file") from None
    except OSError as error:
        raise InputError(f"{file}: the file can't be read: {error.strerror}") from None


def name_and_unit(cell: str) -> tuple[str, str | None]:
    """Return name and unit of a header's cell; None where it has no unit.

    Examples
    --------
    >>> name_and_unit("Rebound height [mm]"), name_and_unit("time_s"), name_and_unit("count")
    (('rebound_height', 'mm'), ('time', 's'), ('count', None))
    """
    match = _BRACKETS.fullmatch(cell)
    if match:
        return _plain(match[1]), match[2].strip()
    for ending, unit in sorted(_ENDINGS.items(), key=lambda item: -len(item[0])):
        if cell.endswith(ending):
            return _plain(cell.removesuffix(ending)), unit
    return _plain(cell), None


def _plain(name: str) -> str:
    return re.sub(r"[\s-]+", "_", name.strip().lower())


def _factor(file: Path, line: int, cell: str, unit: str | None, wanted: str) -> float:
    where = f'{file}, line {line}, column "{cell}"'
    if not wanted:
        if unit == "%":
            return 0.01
        if unit not in (None, "", "-", "1"):
            raise InputError(f"{where}: it is a plain number, and has no unit")
        return 1.0
    if unit is None or not unit:
        raise InputError(f"{where}: the unit is missing; write it in brackets, such as {cell.split('[')[0].strip()} [{wanted}]")
    try:
        return to_si(f"1 {unit}", wanted)
    except InputError as error:
        raise InputError(f"{where}: {error.message}") from None


def _number(file: Path, line: int, column: str, row: list[str], place: int, mark: str) -> float:
    where = f'{file}, line {line}, column "{column}"'
    if place >= len(row):
        raise InputError(f"{where}: the cell is missing; the line has {len(row)}")
    text = row[place].strip()
    try:
        if "_" in text:  # which Python takes in a number
            raise ValueError(text)
        value = float(text.replace(",", ".") if mark != "," else text)
    except ValueError:
        raise InputError(f'{where}: "{text[:40]}" is not a number' if text else f"{where}: the cell is empty") from None
    if not np.isfinite(value):
        raise InputError(f'{where}: "{text[:40]}" is not finite')
    return value


def _allowed(units: Mapping[str, str]) -> str:
    return "known are " + ", ".join(f"{name} [{unit}]" if unit else name for name, unit in units.items() if "deviation" not in name)
