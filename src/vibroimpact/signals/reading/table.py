"""Records from tables: columns of times, and a column with its unit for each channel."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.measurements.header_cells import name_and_unit
from vibroimpact.measurements.recorded_table import RecordedChannel, filled_in, recorded_channels
from vibroimpact.measurements.table_file import in_table
from vibroimpact.measurements.table_layout import Layout
from vibroimpact.quoting import quoted
from vibroimpact.signals.reading.equal_steps import (
    Sampled,
    at_equal_steps,
    is_regular,
    written_twice,
)
from vibroimpact.signals.reading.si_units import in_si
from vibroimpact.signals.record import Record

ENDINGS = (".csv", ".txt", ".tsv", ".asc", ".lvm")
"""Endings of the names of tables."""


def table_records(path: Path, columns: str | None = None) -> Iterator[Record]:
    """Yield the channels of a table: all columns but those of times.

    Parameters
    ----------
    path : path
        The file.
    columns : str, optional
        The columns as a user states them in place of a header, "time=s,force=N".

    Raises
    ------
    InputError
        If the file can't be read, there is no time, no other column, a unit is missing or unknown,
        samples are missing, or the times do not rise by equal steps.
    """
    doubts: list[str] = []
    for channel in recorded_channels(path, _unit_of, doubts, columns):
        try:
            sampled, filling_doubts = _sampled(channel)
        except InputError as error:
            raise in_table(path, error) from None
        channel_doubts = (*channel.doubts, *filling_doubts, *filter(None, sampled.doubts))
        name = quoted(channel.name)
        yield Record(
            channel.name,
            sampled.values[0],
            sampled.rate,
            channel.unit,
            sampled.start,
            doubts=(*doubts, *(f"{name}: {doubt}" for doubt in channel_doubts)),
        )


def _unit_of(layout: Layout, cell: str) -> tuple[float, str]:
    """Return the factor to SI and the SI unit of a channel."""
    name, unit = name_and_unit(cell)
    where = f"{layout.where}, column {quoted(cell)}"
    if unit is None:
        raise InputError(
            f"{where}: the unit is missing; {layout.with_unit(name, 'V')}, or 1 for a "
            f"plain number; {layout.understood}"
        )
    try:
        return in_si(unit)
    except InputError as error:
        raise InputError(
            f"{where}: {error.message}; correct the unit, or state it by --columns (in a "
            "case the key columns)"
        ) from None


def _sampled(channel: RecordedChannel) -> tuple[Sampled, tuple[str, ...]]:
    """Return the samples of a channel at equal steps, and what was done where some are missing.

    A channel that has a number in every tenth row is one of a tenth of the rate.
    """
    if not channel.missing or is_regular(channel.time):
        return _at_equal_steps(channel, channel.time, channel.value, channel.lines), ()
    twice, left_out = written_twice(channel.time, [channel.value], channel.lines)
    lines = np.asarray(channel.lines)[~twice].tolist()
    channel = channel._replace(time=channel.time[~twice], value=channel.value[~twice], lines=lines)
    doubts = (left_out,) if left_out else ()
    try:
        time, value, filled = filled_in(channel)
    except InputError as too_many:
        try:
            # of another rate, with times that jitter
            return _at_equal_steps(channel, channel.time, channel.value), doubts
        except InputError:
            raise too_many from None
    return _at_equal_steps(channel, time, value), (*doubts, filled)


def _at_equal_steps(
    channel: RecordedChannel, time: Floats, value: Floats, lines: Sequence[int] | None = None
) -> Sampled:
    """Return samples at equal steps; errors name the column of the times."""
    try:
        return at_equal_steps(time, [value], lines)
    except InputError as error:
        raise InputError(f"{channel.times_from}{error}") from None
