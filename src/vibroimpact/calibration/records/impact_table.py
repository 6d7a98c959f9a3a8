"""Tables with one impact, or the mean of several, in each row.

Here are the names of their columns, and checks that name the line.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from os import PathLike

import numpy as np

from vibroimpact.calibration.observed.matchable import ALONG_PLATE, MATCHABLE
from vibroimpact.errors import InputError
from vibroimpact.measurements.header_cells import name_and_unit
from vibroimpact.measurements.table_file import TableFile, header_of, read_table_file

DEVIATION = "_standard_deviation"
"""Ending of the names of columns with standard deviations."""

_SYNONYMS = {
    "approach_speed": "speed impact_speed incident_speed velocity impact_velocity "
    "approach_velocity incident_velocity v",
    "separation_speed": "rebound_speed rebound_velocity separation_velocity",
    "restitution": "e cor coefficient_of_restitution",
    "count": "n number counts",
}
"""Other names of columns, in a table without times; of a record of motion `velocity` is something
else.
"""

_RESTITUTION_UNITS = {
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
    """A table whose columns have standard names.

    `written`: the name in the file of each column that has another one there.
    """

    written: Mapping[str, str] = field(default_factory=dict)


def name_in_file(table: TableFile, column: str) -> str:
    """Return the name that a column has in its file, for messages."""
    if isinstance(table, ImpactTable):
        return table.written.get(column, column)
    return column


def is_impact_table(names: Collection[str]) -> bool:
    """Return whether columns are those of restitutions over the approach speed.

    Examples
    --------
    >>> is_impact_table(["approach_speed", "restitution"]), is_impact_table(["time", "position"])
    (True, False)
    """
    return "approach_speed" in names and ("restitution" in names or "separation_speed" in names)


def holds_restitutions(path: str | PathLike[str], columns: str | None = None) -> bool:
    """Return whether a file is a table of restitutions over the approach speed, by its header.

    False if it can't be read.
    """
    try:
        names = [name_and_unit(cell)[0] for cell in header_of(path, columns)]
    except InputError:  # the reader of the file reports the error
        return False
    standard_names = _standard_names(names)
    return "time" not in names and is_impact_table(
        [standard_names.get(name, name) for name in names]
    )


def read_impact_table(
    path: str | PathLike[str],
    units: Mapping[str, str] = _RESTITUTION_UNITS,
    columns: str | None = None,
) -> ImpactTable:
    """Read the known columns of a table of impacts.

    Some may have another usual name, such as `speed`, `e` or `n`.

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
    standard_names = {
        name: standard
        for name, standard in _standard_names(names).items()
        if standard in units and "time" not in names
    }
    for standard in set(standard_names.values()):
        synonyms = [name for name in names if standard_names.get(name, name) == standard]
        if len(synonyms) > 1:
            together = "all" if len(synonyms) > 2 else "both"
            raise InputError(
                f"{path}: the columns {' and '.join(synonyms)} {together} mean {standard}; "
                "keep one of them"
            )
    units_in_file = {
        **units,
        **{name: units[standard] for name, standard in standard_names.items()},
    }
    table = read_table_file(path, units_in_file, [], columns)
    return ImpactTable(
        table.path,
        {standard_names.get(name, name): values for name, values in table.columns.items()},
        table.lines,
        table.empty,
        table.doubts,
        written={standard: name for name, standard in standard_names.items()},
    )


def _standard_names(names: Collection[str]) -> dict[str, str]:
    """Return the standard names of columns, and of their standard deviations, with another name."""
    standard_names = {}
    for standard, synonyms in _SYNONYMS.items():
        for synonym in synonyms.split():
            for ending in ("", DEVIATION):
                if f"{synonym}{ending}" in names:
                    standard_names[f"{synonym}{ending}"] = f"{standard}{ending}"
    return standard_names


def check_positive(table: TableFile, column: str) -> None:
    """Check that all values of a column are greater than zero.

    Raises
    ------
    InputError
        If one is not, with its line.
    """
    wrong = np.flatnonzero(~(table.columns[column] > 0.0))
    if wrong.size:
        row = wrong[0]
        unit = _UNITS.get(column.removesuffix(DEVIATION), "")
        value = f"{table.columns[column][row]:g} {unit}".rstrip()
        raise InputError(
            f"{table.path}, line {table.lines[row]}: {name_in_file(table, column)} is {value}; "
            "it must be greater than 0",
            "target",
        )


def check_counts(table: TableFile) -> None:
    """Check that the column `count`, if there is one, has whole numbers greater than zero.

    Raises
    ------
    InputError
        If one is not, with its line.
    """
    count = table.columns.get("count")
    if count is None:
        return
    wrong = np.flatnonzero((count < 1.0) | (count != np.round(count)))
    if wrong.size:
        row = wrong[0]
        raise InputError(
            f"{table.path}, line {table.lines[row]}: {name_in_file(table, 'count')} is "
            f"{count[row]:g}; it must be a whole number, 1 or more: of the impacts in this mean",
            "target",
        )
