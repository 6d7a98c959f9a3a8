"""Tables with one impact, or the mean of several, in each row: the names of their
columns, and checks that name the line.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from os import PathLike

import numpy as np

from vibroimpact.calibration.matchable import ALONG_PLATE, MATCHABLE
from vibroimpact.errors import InputError
from vibroimpact.measurements.header_cells import name_and_unit
from vibroimpact.measurements.table_file import TableFile, header_of, read_table_file

DEVIATION = "_standard_deviation"
"""Ending of the names of columns with standard deviations."""

_ALSO = {
    "approach_speed": "speed impact_speed incident_speed velocity impact_velocity "
    "approach_velocity incident_velocity v",
    "separation_speed": "rebound_speed rebound_velocity separation_velocity",
    "restitution": "e cor coefficient_of_restitution",
    "count": "n number counts",
}
"""Other names of columns, in a table without times; of a record of motion `velocity` is
something else.
"""

_RESTITUTIONS = {
    "approach_speed": "m/s",
    "restitution": "",
    "separation_speed": "m/s",
    f"restitution{DEVIATION}": "",
    f"separation_speed{DEVIATION}": "m/s",
    "count": "",
}


_UNITS = {
    "approach_speed": "m/s",
    "speed": "m/s",
    **{name: quantity.unit for name, quantity in {**MATCHABLE, **ALONG_PLATE}.items()},
}
"""SI units of columns that are not plain numbers."""


@dataclass(frozen=True)
class ImpactTable(TableFile):
    """A table whose columns have standard names, and the name in the file of each that
    has another one there.
    """

    written: Mapping[str, str] = field(default_factory=dict)


def name_in_file(table: TableFile, column: str) -> str:
    """Return the name that a column has in its file, for messages."""
    return table.written.get(column, column) if isinstance(table, ImpactTable) else column


def is_impact_table(names: Collection[str]) -> bool:
    """Return whether columns are those of restitutions over the approach speed.

    Examples
    --------
    >>> is_impact_table(["approach_speed", "restitution"]), is_impact_table(["time", "position"])
    (True, False)
    """
    return "approach_speed" in names and ("restitution" in names or "separation_speed" in names)


def holds_restitutions(path: str | PathLike[str], columns: str | None = None) -> bool:
    """Return whether a file is a table of restitutions over the approach speed, by its
    header; False if it can't be read.
    """
    try:
        names = [name_and_unit(cell)[0] for cell in header_of(path, columns)]
        return "time" not in names and is_impact_table(
            [_standard(names).get(name, name) for name in names]
        )
    except InputError:  # the reader of the file reports the error
        return False


def read_impact_table(
    path: str | PathLike[str], units: Mapping[str, str] = _RESTITUTIONS, columns: str | None = None
) -> ImpactTable:
    """Read the known columns of a table, some of which may have another usual name, such as
    `speed`, `e` or `n`.

    Parameters
    ----------
    path : path
        The file.
    units : mapping of str to str
        The SI unit of each known column; by default those of restitutions over the approach speed.
    columns : str, optional
        The columns as a user states them in place of a header.

    Raises
    ------
    InputError
        As `read_table_file`, or if a column is there under two names.
    """
    try:
        names = [name_and_unit(cell)[0] for cell in header_of(path, columns)]
    except InputError:  # reported below, with its line
        names = []
    standard = {
        name: other
        for name, other in _standard(names).items()
        if other in units and "time" not in names
    }
    for other in set(standard.values()):
        several = [name for name in names if standard.get(name, name) == other]
        if len(several) > 1:
            raise InputError(
                f"{path}: the columns {' and '.join(several)} "
                f"{'all' if len(several) > 2 else 'both'} mean {other}; keep one of them"
            )
    table = read_table_file(
        path, {**units, **{name: units[other] for name, other in standard.items()}}, [], columns
    )
    renamed = {standard.get(name, name): values for name, values in table.columns.items()}
    written = {other: name for name, other in standard.items()}
    return ImpactTable(table.path, renamed, table.lines, table.empty, table.doubts, written)


def _standard(names: Collection[str]) -> dict[str, str]:
    """Return the standard names of those columns that have another one, and of their
    standard deviations.
    """
    return {
        f"{word}{ending}": f"{name}{ending}"
        for name, words in _ALSO.items()
        for word in words.split()
        for ending in ("", DEVIATION)
        if f"{word}{ending}" in names
    }


def check_positive(table: TableFile, column: str) -> None:
    """Check that all values of a column are greater than zero.

    Raises
    ------
    InputError
        If one is not, with its line.
    """
    wrong = np.flatnonzero(~(table.columns[column] > 0.0))
    if wrong.size:
        value = (
            f"{table.columns[column][wrong[0]]:g} "
            f"{_UNITS.get(column.removesuffix(DEVIATION), '')}".rstrip()
        )
        words = f"{name_in_file(table, column)} is {value}; it must be greater than 0"
        raise InputError(f"{table.path}, line {table.lines[wrong[0]]}: {words}", "target")


def check_counts(table: TableFile) -> None:
    """Check that the column `count`, if there is one, has whole numbers greater than zero.

    Raises
    ------
    InputError
        If one is not, with its line.
    """
    count = table.columns.get("count")
    wrong = (
        np.flatnonzero((count < 1.0) | (count != np.round(count)))
        if count is not None
        else np.zeros(0)
    )
    if count is not None and wrong.size:
        words = (
            f"{name_in_file(table, 'count')} is {count[wrong[0]]:g}; it must be a whole "
            "number, 1 or more: of the impacts in this mean"
        )
        raise InputError(f"{table.path}, line {table.lines[wrong[0]]}: {words}", "target")
