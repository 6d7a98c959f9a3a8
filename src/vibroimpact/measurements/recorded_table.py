"""Channels that a table records over time, each with its own times.

They may be of several rates, with cells that are missing or over the range.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.errors import InputError
from vibroimpact.measurements.header_cells import is_time, name_and_unit
from vibroimpact.measurements.table_file import Cells, factor_to_si, in_table, read_cells
from vibroimpact.measurements.table_layout import Layout
from vibroimpact.measurements.table_lines import Clock
from vibroimpact.quoting import quoted

_LONGEST_GAP = 3
"""Largest number of samples in a row that are filled in where they are missing."""
_MOST_MISSING = 0.05
"""Largest part of the samples that is filled in."""
_ROUNDED_TIMES = 1e-6
"""Distance of times from a clock within which both agree [s]: that of six decimals."""
_PART_OF_STEP = 0.01
"""The same as a part of a step."""


class RecordedChannel(NamedTuple):
    """A channel of a table.

    Parameters
    ----------
    name, cell, unit : str
        Its name, the cell of the header, and its SI unit.
    time, value : array, shape (samples,)
        Times [s] and samples, in SI, without those that are missing.
    lines : sequence of int
        Their lines.
    missing : tuple of int
        Lines between them in which the channel has no number.
    missing_time : array, shape (missing,)
        Times of these lines [s].
    doubts : tuple of str
        What was done to its samples, as sentences.
    times_from : str
        The column of its times, for messages; "" for the times of a clock.
    """

    name: str
    cell: str
    unit: str
    time: Floats
    value: Floats
    lines: Sequence[int]
    missing: tuple[int, ...]
    missing_time: Floats
    doubts: tuple[str, ...]
    times_from: str


def recorded_channels(
    path: str | PathLike[str],
    unit_of: Callable[[Layout, str], tuple[float, str] | None],
    doubts: list[str] | None = None,
    columns: str | None = None,
) -> list[RecordedChannel]:
    """Return the channels of a table that records something over time.

    The times of a channel are those of the nearest column of times on its left; or they follow from
    a clock that the file states. Cells that are empty, or nan, before the first sample of a channel
    and after its last are no part of it.

    Parameters
    ----------
    path : path
        The file.
    unit_of : callable
        Returns the factor that converts a column to SI, and the SI unit; None for a column that is
        not read.
    doubts, columns
        As those of `read_table_file`.

    Raises
    ------
    InputError
        If the file can't be read, there is no time, a unit is missing or unknown, or a channel has
        no samples.
    """
    channels: dict[int, _ChannelColumn] = {}

    def wanted(layout: Layout) -> dict[int, float]:
        factors = _channel_columns(layout, unit_of, channels)
        if not channels:
            raise InputError(
                "there is no column beside the time; each other one is a channel, such as "
                f"geophone [V]; {layout.understood}"
            )
        return factors

    cells = read_cells(path, wanted, _missing, doubts, columns)
    try:
        time_columns = _time_columns(cells.layout)
        names = _names(channels)
        recorded = []
        for column, channel in channels.items():
            time_column = _time_of(column, time_columns, channels)
            recorded.append(_channel(cells, column, time_column, names[column], channel.unit))
        return recorded
    except InputError as error:
        raise in_table(path, error) from None


class _ChannelColumn(NamedTuple):
    """Name and SI unit of a column of a channel."""

    name: str
    unit: str


def _time_columns(layout: Layout) -> list[int]:
    """Return the indices of the columns of times.

    Raises
    ------
    InputError
        If there is none, and no clock either.
    """
    columns = [
        column
        for column, cell in enumerate(layout.header)
        if cell and is_time(*name_and_unit(cell))
    ]
    if not columns and not layout.clocks:
        if layout.is_stated:
            remedy = "State time=s for it"
        else:
            remedy = f"Name the times so, {layout.remedy}"
        raise InputError(
            f"there is no column time [s]; {layout.understood}. {remedy}; rows without times need "
            'their rate, --columns "rate=10 kHz,force=N"'
        )
    return columns


def _channel_columns(
    layout: Layout,
    unit_of: Callable[[Layout, str], tuple[float, str] | None],
    channels: dict[int, _ChannelColumn],
) -> dict[int, float]:
    """Return the factors to SI of the columns of times and of channels; add these to `channels`."""
    time_columns = _time_columns(layout)
    factors = {}
    for column, cell in enumerate(layout.header):
        name, unit = name_and_unit(cell)
        if column in time_columns:
            factors[column] = factor_to_si(layout, cell, unit, "s")
        elif cell:
            factor_and_unit = unit_of(layout, cell)
            if factor_and_unit is not None:
                factors[column], si_unit = factor_and_unit
                channels[column] = _ChannelColumn(name, si_unit)
    return factors


def filled_in(channel: RecordedChannel) -> tuple[Floats, Floats, str]:
    """Return times and samples of a channel, by cubic splines where they are missing.

    The third is what that adds, as a sentence.

    Raises
    ------
    InputError
        If more are missing, in a row or altogether, than can be filled in.
    """
    from scipy.interpolate import CubicSpline

    count = len(channel.missing)
    where = f"line {channel.missing[0]}, column {quoted(channel.cell)}"
    time = np.concatenate([channel.time, channel.missing_time])
    order = np.argsort(time, kind="stable")
    time = time[order]
    is_recorded = order < len(channel.time)
    longest_gap = int(np.diff(np.flatnonzero(is_recorded)).max()) - 1
    if longest_gap > _LONGEST_GAP or count > _MOST_MISSING * len(time):
        if count > 1:
            cells = f"{count} cells from there on have no number, up to {longest_gap} in a row"
            them = "them"
        else:
            cells = "the cell has no number"
            them = "it"
        raise InputError(
            f"{where}: {cells}; only {_LONGEST_GAP} in a row and {100.0 * _MOST_MISSING:g} % of "
            f"all are filled in. Fill {them} in, or keep the part before or after {them}"
        )
    if not (np.diff(channel.time) > 0.0).all():
        raise InputError(
            f"{where}: the cell has no number, and the times do not rise; fill it in, or "
            "leave out the line"
        )
    value = np.array(CubicSpline(channel.time, channel.value)(time))
    # what lines between the samples would give tells how much the splines may be off
    linear = np.interp(time, channel.time, channel.value)
    span = float(np.ptp(channel.value)) or 1.0
    error = 100.0 * float(np.abs(value - linear).max()) / span
    are = "is" if count == 1 else "are"
    sentence = (
        f"{count} of its samples {are} missing, the first in line "
        f"{channel.missing[0]}: filled in by cubic splines, which adds an error, by estimate, of "
        f"up to {error:.2g} % of its range there"
    )
    return time, value, sentence


def rising(channel: RecordedChannel) -> Bools:
    """Return which samples of a channel are later than the one before.

    Raises
    ------
    InputError
        If the times decrease, with the line, or are all the same.
    """
    steps = np.diff(channel.time)
    backwards = np.flatnonzero(steps < 0.0)
    if backwards.size:
        sample = int(backwards[0])
        earlier = channel.time[sample]
        later = channel.time[sample + 1]
        raise InputError(
            f"line {channel.lines[sample + 1]}: time goes backwards, from {earlier:.9g} s to "
            f"{later:.9g} s; if the file has several records, keep one of them"
        )
    if not (steps > 0.0).any():
        raise InputError("all samples have the same time; a record needs at least two times")
    return np.append(True, steps > 0.0)


def _channel(
    cells: Cells, column: int, time_column: int | None, name: str, unit: str
) -> RecordedChannel:
    """Return a channel without the cells that are missing.

    What is over the range is set to the range.
    """
    layout = cells.layout
    cell = layout.header[column]
    value = cells.columns[column]
    stated_times = None
    times_from = ""
    if time_column is not None:
        stated_times = cells.columns[time_column]
        times_from = f"column {quoted(layout.header[time_column])}: "
    time = _times(stated_times, layout.clocks.get(column), len(value))
    has_number = ~np.isnan(value)
    has_time = np.isfinite(time)
    where = f"column {quoted(cell)}"
    if not has_number.any():
        raise InputError(f"{where}: there is no number in it; delete the column, {layout.remedy}")
    untimed = np.flatnonzero(has_number & ~has_time)
    if untimed.size:
        raise InputError(
            f"line {cells.lines[int(untimed[0])]}, {where}: the sample has no time; fill "
            "it in, or leave out the line"
        )
    # what is empty before the first sample and after the last is no part of the channel
    first, last = np.flatnonzero(has_number)[[0, -1]]
    inside = slice(first, last + 1)
    missing = first + np.flatnonzero(~has_number[inside] & has_time[inside])
    lines = np.asarray(cells.lines)
    in_range, doubts = _in_range(value[has_number], where)
    if column in layout.doubts:
        doubts = (layout.doubts[column], *doubts)
    return RecordedChannel(
        name=name,
        cell=cell,
        unit=unit,
        time=time[has_number],
        value=in_range,
        lines=lines[has_number].tolist(),
        missing=tuple(lines[missing].tolist()),
        missing_time=time[missing],
        doubts=doubts,
        times_from=times_from,
    )


def _in_range(value: Floats, where: str) -> tuple[Floats, tuple[str, ...]]:
    """Return samples with the largest finite ones in place of those over the range.

    With them comes a sentence, if there are some.
    """
    over: Bools = np.isinf(value)
    if not over.any():
        return value, ()
    if over.all():
        raise InputError(f"{where}: all samples are over the range; record it with a larger one")
    finite = value[~over]
    count = over.sum()
    are, they_are = ("are", "they are") if count > 1 else ("is", "it is")
    doubt = (
        f"{count} of its samples {are} over the range (infinite): {they_are} set to the "
        "largest or smallest of the others, so that the peak is too small; record it with a "
        "larger range"
    )
    return np.clip(value, finite.min(), finite.max()), (doubt,)


def _times(stated: Floats | None, clock: Clock | None, rows: int) -> Floats:
    """Return the times of a channel, by its column of times or by its clock.

    A clock has more digits; its times are taken if those of the column agree with it.
    """
    if clock is None:
        assert stated is not None
        return stated
    regular: Floats = clock.start + clock.step * np.arange(rows, dtype=np.float64)
    if stated is None or clock.alone:
        return regular
    known = np.isfinite(stated)
    distance = np.abs(stated - regular)[known]
    agrees = np.all(distance <= max(_ROUNDED_TIMES, _PART_OF_STEP * clock.step))
    return regular if agrees else stated


def _time_of(
    column: int, time_columns: Sequence[int], channels: dict[int, _ChannelColumn]
) -> int | None:
    """Return the column of times of a channel: the nearest on its left, or the first of all.

    Of several side by side, with no channel between them, it is the first.
    """
    on_left = [time_column for time_column in time_columns if time_column < column]
    if not on_left:
        return time_columns[0] if time_columns else None
    nearest = on_left.pop()
    while on_left:
        before = on_left.pop()
        if any(before < channel < nearest for channel in channels):
            break
        nearest = before
    return nearest


def _names(channels: dict[int, _ChannelColumn]) -> dict[int, str]:
    """Return the names of channels by their column, with a number where several have one."""
    all_names = [channel.name for channel in channels.values()]
    names = {}
    for number, (column, channel) in enumerate(channels.items()):
        name = channel.name
        if all_names.count(name) > 1:
            name = f"{name}_{all_names[:number].count(name) + 1}"
        names[column] = name
    return names


def _missing(value: float, _: str) -> float:
    """Return what a cell without a number has: nan, or infinity where it is over the range."""
    return value
