"""Records from NetCDF-4 files: the sensors of a result, or all variables over time.

Time is their last dimension, at equal steps.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import prod
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.files.check_sums import DamageError, recorded_digest
from vibroimpact.files.damaged_part import check_hdf5
from vibroimpact.files.hdf5 import members, read_array
from vibroimpact.files.reading import FileKind, beginning, with_path
from vibroimpact.signals.reading.equal_steps import rate_of
from vibroimpact.signals.reading.si_units import in_si
from vibroimpact.signals.record import Record
from vibroimpact.structures.finite_elements.free_memory import check_memory
from vibroimpact.units.reading import to_si

NETCDF = FileKind(
    "a NetCDF file holds variables with a dimension of time", 1_000_000_000_000, "split it"
)
"""Requirements on a NetCDF file."""

_COPIES = 3  # of samples, while they are converted
_AT_ONCE = 2**22
"""Samples that are read at once."""


def netcdf_records(path: Path) -> Iterator[Record]:
    """Yield the signals of a NetCDF-4 file.

    Of a variable with further dimensions there is one for each place in them, in their order.

    Raises
    ------
    InputError
        If the file can't be read, or has no signal.
    """
    try:
        first_bytes = beginning(path, NETCDF, 4)
    except InputError as error:
        raise with_path(path, error) from None
    if first_bytes.startswith(b"CDF"):
        raise InputError(
            f"{path}: this is a NetCDF file of the classic format; convert it to NetCDF-4: "
            f"nccopy -k nc4 {path.name} new.nc"
        )
    try:
        check_hdf5(path, recorded_digest(path))
        with h5py.File(path, "r") as file:
            signals = list(_signals(file))
            if not signals:
                raise InputError(
                    "there is no variable whose last dimension is a time at equal steps, "
                    "with a unit of time such as s"
                )
            for data, rate, start in signals:
                yield from _records(data, rate, start)
    except InputError as error:
        raise with_path(path, error) from None
    except DamageError as error:
        raise with_path(path, InputError(str(error))) from None
    except Exception as error:  # of many types, by what is damaged
        cause = " ".join(str(error).split())[:100] or type(error).__name__
        raise InputError(f"{path}: the NetCDF file can't be read ({cause})") from None


def _signals(file: h5py.File) -> Iterator[tuple[h5py.Dataset, float, float]]:
    """Yield the variables over time, their last dimension, with rate [Hz] and first time [s]."""
    group = members(file).get("sensors", file)
    names: list[str] = []
    group.visit(names.append)  # returning None goes on
    for name in names:
        data = group[name]
        is_array = isinstance(data, h5py.Dataset) and data.dtype.kind in "fiu" and data.ndim
        if not is_array or data.is_scale:
            continue
        for scale in data.dims[data.ndim - 1].values():
            second = _seconds(_text(scale.attrs.get("units", "")))
            if second is None or len(scale) < 2:
                continue
            check_memory(
                _COPIES * 8.0 * len(scale), f"the times of variable {name} need", NETCDF.smaller
            )
            time = second * read_array(scale).astype(float)
            stated_rate = data.attrs.get("rate_Hz", data.parent.attrs.get("rate_Hz"))
            try:
                rate = _rate(time, stated_rate)
            except InputError:  # a history at unequal steps is no signal
                continue
            yield data, rate, float(time[0])


def _rate(time: Floats, stated_rate: Any) -> float:
    """Return the rate of samples as the file states it, or else by their times."""
    if stated_rate is None:
        return rate_of(time)
    return float(stated_rate)


def _seconds(unit: str) -> float | None:
    """Return how many seconds a unit has; None if it is none of time."""
    try:
        return to_si(f"1 {unit}", "s")
    except InputError:
        return None


def _records(data: h5py.Dataset, rate: float, start: float) -> Iterator[Record]:
    """Yield the signals of a variable, with rate [Hz] and first time [s]."""
    name = data.name.rpartition("/")[2].removeprefix("signal_")
    if name == "value":
        name = _text(data.parent.attrs.get("name", name))
    try:
        factor, unit = in_si(_text(data.attrs.get("units", "1")))
    except InputError as error:
        raise InputError(f"variable {name}: {error.message}") from None
    *outer, samples = data.shape
    # of one place in the first dimension
    row_samples = samples * prod(outer[1:])
    check_memory(
        _COPIES * 8.0 * max(row_samples, 1),
        f"the signals of variable {name} need",
        NETCDF.smaller,
    )
    if not outer:
        value = factor * read_array(data).astype(float)
        yield Record(name, _without_fill(value), rate, unit, start)
        return
    rows_at_once = max(1, _AT_ONCE // max(1, row_samples))
    for first in range(0, outer[0], rows_at_once):
        rows = factor * read_array(data, slice(first, first + rows_at_once)).astype(float)
        for value in rows.reshape(-1, samples):
            yield Record(name, _without_fill(value), rate, unit, start)


def _without_fill(value: Floats) -> Floats:
    """Return a signal without NaN at its end, which fills the place of a shorter one."""
    known = np.flatnonzero(~np.isnan(value))
    if not known.size:
        return value[:0]
    return value[: known[-1] + 1]


def _text(value: Any) -> str:
    if isinstance(value, (bytes, np.bytes_)):
        return value.decode("utf-8", "replace")
    return str(value)
