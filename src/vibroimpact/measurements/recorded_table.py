"""Channels that a table records over time, each with its own times: of several rates,
with cells that are missing or over the range.
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
_ROUNDED_TIMES, _OFF = 1e-6, 0.01
"""Distance of times from a clock within which both agree: that of times with six decimals
[s], and a part of a step.
"""


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
    found: dict[int, tuple[str, str]] = {}
    times: dict[int, int | None] = {}

    def wanted(layout: Layout) -> dict[int, float]:
        factors = {}
        at = [
            place
            for place, cell in enumerate(layout.header)
            if cell and is_time(*name_and_unit(cell))
        ]
        if not at and not layout.clocks:
            remedy = (
                "state time=s for it" if layout.is_stated else f"Name the times so, {layout.remedy}"
            )
            words = (
                f"there is no column time [s]; {layout.understood}. {remedy[0].upper()}{remedy[1:]}"
            )
            raise InputError(
                f'{words}; rows without times need their rate, --columns "rate=10 kHz,force=N"'
            )
        for place, cell in enumerate(layout.header):
            name, unit = name_and_unit(cell)
            if place in at:
                factors[place] = factor_to_si(layout, cell, unit, "s")
            elif cell and (told := unit_of(layout, cell)) is not None:
                factors[place], found[place] = told[0], (name, told[1])
        if not found:
            raise InputError(
                "there is no column beside the time; each other one is a channel, such as "
                f"geophone [V]; {layout.understood}"
            )
        times.update({place: _time_of(place, at, found) for place in found})
        return factors

    cells = read_cells(path, wanted, _missing, doubts, columns)
    try:
        names = _names(found)
        return [
            _channel(cells, place, times[place], names[place], found[place][1]) for place in found
        ]
    except InputError as error:
        raise in_table(path, error) from None


def filled_in(channel: RecordedChannel) -> tuple[Floats, Floats, str]:
    """Return times and samples of a channel, by cubic splines where they are missing, and what that
    adds, as a sentence.

    Raises
    ------
    InputError
        If more are missing, in a row or altogether, than can be filled in.
    """
    from scipy.interpolate import CubicSpline

    count, where = len(channel.missing), f"line {channel.missing[0]}, column {quoted(channel.cell)}"
    time = np.concatenate([channel.time, channel.missing_time])
    order = np.argsort(time, kind="stable")
    time = time[order]
    longest = int(np.diff(np.flatnonzero(order < len(channel.time))).max()) - 1
    if longest > _LONGEST_GAP or count > _MOST_MISSING * len(time):
        words = (
            f"{count} cells from there on have no number, up to {longest} in a row"
            if count > 1
            else "the cell has no number"
        )
        limit = f"only {_LONGEST_GAP} in a row and {100.0 * _MOST_MISSING:g} % of all are filled in"
        them = "them" if count > 1 else "it"
        raise InputError(
            f"{where}: {words}; {limit}. Fill {them} in, or keep the part before or after {them}"
        )
    if not (np.diff(channel.time) > 0.0).all():
        raise InputError(
            f"{where}: the cell has no number, and the times do not rise; fill it in, or "
            "leave out the line"
        )
    new = np.array(CubicSpline(channel.time, channel.value)(time))
    part = (
        100.0
        * float(np.abs(new - np.interp(time, channel.time, channel.value)).max())
        / (float(np.ptp(channel.value)) or 1.0)
    )
    words = (
        f"{count} of its samples {'is' if count == 1 else 'are'} missing, the first in line "
        f"{channel.missing[0]}"
    )
    return (
        time,
        new,
        f"{words}: filled in by cubic splines, which adds an error, by estimate, of up to "
        f"{part:.2g} % of its range there",
    )


def rising(channel: RecordedChannel) -> Bools:
    """Return which samples of a channel are later than the one before.

    Raises
    ------
    InputError
        If the times decrease, with the line, or are all the same.
    """
    steps = np.diff(channel.time)
    back = np.flatnonzero(steps < 0.0)
    if back.size:
        at = int(back[0])
        one, other = channel.time[at : at + 2]
        words = f"time goes backwards, from {one:.9g} s to {other:.9g} s"
        raise InputError(
            f"line {channel.lines[at + 1]}: {words}; if the file has "
            "several records, keep one of them"
        )
    if not (steps > 0.0).any():
        raise InputError("all samples have the same time; a record needs at least two times")
    return np.append(True, steps > 0.0)


def _channel(
    cells: Cells, place: int, time_at: int | None, name: str, unit: str
) -> RecordedChannel:
    """Return a channel: without the cells that are missing, and with what is over the
    range at the range.
    """
    cell, value = cells.layout.header[place], cells.columns[place]
    time = _times(
        None if time_at is None else cells.columns[time_at],
        cells.layout.clocks.get(place),
        len(value),
    )
    is_there = ~np.isnan(value)
    where = f"column {quoted(cell)}"
    if not is_there.any():
        raise InputError(
            f"{where}: there is no number in it; delete the column, {cells.layout.remedy}"
        )
    untimed = np.flatnonzero(is_there & ~np.isfinite(time))
    if untimed.size:
        raise InputError(
            f"line {cells.lines[int(untimed[0])]}, {where}: the sample has no time; fill "
            "it in, or leave out the line"
        )
    first, last = np.flatnonzero(is_there)[[0, -1]]
    missing = first + np.flatnonzero(
        ~is_there[first : last + 1] & np.isfinite(time[first : last + 1])
    )
    lines = np.asarray(cells.lines)
    value, doubts = _in_range(value[is_there], where)
    granted = (cells.layout.doubts[place],) if place in cells.layout.doubts else ()
    times_from = "" if time_at is None else f"column {quoted(cells.layout.header[time_at])}: "
    where_missing = tuple(lines[missing].tolist())
    told = (*granted, *doubts)
    return RecordedChannel(
        name,
        cell,
        unit,
        time[is_there],
        value,
        lines[is_there].tolist(),
        where_missing,
        time[missing],
        told,
        times_from,
    )


def _in_range(value: Floats, where: str) -> tuple[Floats, tuple[str, ...]]:
    """Return samples with the largest finite ones in place of those over the range, and a
    sentence on them.
    """
    over: Bools = np.isinf(value)
    if not over.any():
        return value, ()
    if over.all():
        raise InputError(f"{where}: all samples are over the range; record it with a larger one")
    finite = value[~over]
    are, they_are = ("are", "they are") if over.sum() > 1 else ("is", "it is")
    words = (
        f"{over.sum()} of its samples {are} over the range (infinite): {they_are} set to the "
        "largest or smallest of the others"
    )
    return np.clip(value, finite.min(), finite.max()), (
        f"{words}, so that the peak is too small; record it with a larger range",
    )


def _times(column: Floats | None, clock: Clock | None, rows: int) -> Floats:
    """Return the times of a channel: those of a clock, which has more digits, if its
    column of times agrees with it.
    """
    if clock is None:
        assert column is not None
        return column
    regular: Floats = clock.start + clock.step * np.arange(rows, dtype=np.float64)
    if column is None or clock.alone:
        return regular
    known = np.isfinite(column)
    return (
        regular
        if np.all(np.abs(column - regular)[known] <= max(_ROUNDED_TIMES, _OFF * clock.step))
        else column
    )


def _time_of(place: int, times: Sequence[int], channels: dict[int, tuple[str, str]]) -> int | None:
    """Return the column of times of a channel: the nearest on its left, of several side
    by side the first; without one the first of all.
    """
    left = [at for at in times if at < place]
    if not left:
        return times[0] if times else None
    at = left[-1]
    while (before := max((one for one in times if one < at), default=None)) is not None and not any(
        before < one < at for one in channels
    ):
        at = before
    return at


def _names(channels: dict[int, tuple[str, str]]) -> dict[int, str]:
    """Return the names of channels, with a number where several have one."""
    every = [name for name, _ in channels.values()]
    return {
        place: name if every.count(name) == 1 else f"{name}_{every[:at].count(name) + 1}"
        for at, (place, (name, _)) in enumerate(channels.items())
    }


def _missing(value: float, _: str) -> float:
    """Return what a cell without a number has: nan, or infinity where it is over the range."""
    return value
