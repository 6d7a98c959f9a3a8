"""Records from CSV files: a column of times, and a column with its unit for each channel."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from vibroimpact.errors import InputError
from vibroimpact.files.reading import with_path
from vibroimpact.measurements.table_file import header_of, name_and_unit, read_table_file
from vibroimpact.shown import shown
from vibroimpact.signals.reading.equal_steps import at_equal_steps
from vibroimpact.signals.reading.si_units import in_si
from vibroimpact.signals.record import Record

_TIME = "time"


def table_records(path: Path) -> Iterator[Record]:
    """Yield the channels of a table: all columns but that of the time.

    Raises
    ------
    InputError
        If the file can't be read, there is no time, no other column, a unit is missing or unknown, or the times do not rise by equal steps.
    """
    names = {}
    for cell in header_of(path):
        name, unit = name_and_unit(cell)
        if name == _TIME:
            names[name] = "s"
            continue
        if unit is None:
            raise InputError(f"{path}, column {shown(cell)}: the unit is missing; write it in brackets, such as {name} [V], or [1]")
        try:
            names[name] = in_si(unit)[1]
        except InputError as error:
            raise InputError(f"{path}, column {shown(cell)}: {error.message}") from None
    if _TIME not in names:
        raise InputError(f"{path}: there is no column time [s] in the header; the rate follows from the times of the samples")
    if len(names) < 2:
        raise InputError(f"{path}: there is no column beside the time; each other one is a channel, such as geophone [V]")
    doubts: list[str] = []
    table = read_table_file(path, {name: "" if unit == "1" else unit for name, unit in names.items()}, doubts)
    channels = [name for name in names if name != _TIME]
    try:
        sampled = at_equal_steps(table.columns[_TIME], [table.columns[name] for name in channels])
    except InputError as error:
        raise with_path(path, error) from None
    for name, value, doubt in zip(channels, sampled.values, sampled.doubts, strict=True):
        of_times = (f"{shown(name)}: {doubt}",) if doubt else ()
        yield Record(name, value, sampled.rate, names[name], sampled.start, doubts=(*doubts, *of_times))
