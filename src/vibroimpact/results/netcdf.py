"""NetCDF-4 file of a result: groups of variables with units and dimension scales, written
and read with h5py.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.columns import history_columns, impact_columns, meanings
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.dynamics.sensors.sensor import Sensor
from vibroimpact.files.check_sums import DamageError
from vibroimpact.files.hdf5 import PACKED, chunk_shape, members, new_array, new_hdf5, read_array
from vibroimpact.files.plain_names import plain_names
from vibroimpact.results.deflection import Deflection
from vibroimpact.results.result import Result

_AT_ONCE = 2**20  # sample times that are computed and written in one block


def write_groups(result: Result, path: Path) -> None:
    """Write a result to a NetCDF-4 file: groups for impacts, history and energy, and for
    signals and deflection if there are any.
    """
    with new_hdf5(path) as file:
        file.attrs["title"] = result.name
        file.attrs["status"] = result.status
        for key, value in result.provenance.items():
            file.attrs[key] = value
        _write_group(
            file, "impacts", "impact", result.impacts, meanings(impact_columns(result.impacts))
        )
        _write_group(
            file, "history", "time_s", result.history, meanings(history_columns(result.history))
        )
        group = file.create_group("energy", track_order=True)
        for name, number in result.energy.items():
            new_array(group, name, float(number)).attrs["units"] = (
                "J" if name.endswith("_J") else "1"
            )
        write_signals(file, result.signals)
        write_deflection(file, result.deflection)


def read_groups(path: Path) -> dict[str, dict[str, Any]]:
    """Return the variables of each group of a file written by `write_groups`, after verifying their
    checksums.

    Returns
    -------
    dict of str to dict
        "impacts", "history" and "energy": arrays by column name; "sensors": signals by sensor name;
        and "deflection": the deflection, or None, under the key "deflection".

    Raises
    ------
    DamageError
        If a variable does not match its checksum.
    OSError, ValueError, KeyError, TypeError
        If the file is missing or otherwise damaged.
    """
    with h5py.File(path, "r") as file:
        parts = members(file)
        groups: dict[str, dict[str, Any]] = {
            group: {name: _numbers(data) for name, data in members(parts[group]).items()}
            for group in ("impacts", "history", "energy")
        }
        return {
            **groups,
            "sensors": dict(read_signals(file)),
            "deflection": {"deflection": read_deflection(file)},
        }


def _numbers(data: h5py.Dataset) -> NDArray[Any]:
    """Return a variable, which must hold real numbers."""
    if not isinstance(data, h5py.Dataset) or data.dtype.kind not in "fiub":
        raise DamageError(f"{data.name.lstrip('/')} is no variable of real numbers")
    return read_array(data)


def _write_group(
    file: h5py.File,
    name: str,
    dimension: str,
    columns: Mapping[str, Any],
    meaning: Mapping[str, tuple[str, str]],
) -> None:
    """Write columns of equal length as a group; the column `dimension` is their
    coordinate variable.
    """
    group = file.create_group(name, track_order=True)
    scale = None
    for column in (dimension, *(key for key in meaning if key != dimension)):
        data = new_array(group, column, np.asarray(columns[column], dtype=np.float64), **PACKED)
        data.attrs["units"], data.attrs["long_name"] = meaning[column]
        if scale is None:
            scale = data
            scale.make_scale(dimension)
        else:
            data.dims[0].attach_scale(scale)


def write_signals(file: h5py.File, signals: Mapping[str, Signal]) -> None:
    """Write each signal as a subgroup of `sensors` with the variables `time_s` and
    `value`; no group without signals.
    """
    for name, plain in plain_names(list(signals)).items():
        signal = signals[name]
        sensor, group = signal.sensor, file.create_group(f"sensors/{plain}", track_order=True)
        group.attrs["name"], group.attrs["quantity"], group.attrs["rate_Hz"] = (
            name,
            sensor.quantity,
            sensor.rate,
        )
        group.attrs["direction"], group.attrs["filter"] = np.array(sensor.direction), sensor.filter
        if sensor.corner is not None:
            group.attrs["filter_corner_Hz"] = sensor.corner
        facts = ("relative_uncertainty", "peak_before_range_m_s2", "overload_time_s")
        for fact, value in zip(
            facts, (signal.uncertainty, signal.peak, signal.overload_time), strict=True
        ):
            group.attrs[fact] = value
        number = len(signal.value)
        # a signal holds no array of times, which would take as much memory as its values: they are
        # written in blocks
        time = group.create_dataset(
            "time_s", (number,), np.float64, chunks=chunk_shape((number,), 8), **PACKED
        )
        for first in range(0, number, _AT_ONCE):
            time[first : first + _AT_ONCE] = signal.times(first, first + _AT_ONCE)
        time.make_scale("time_s")
        _describe(time, "s", "time since the start")
        value = new_array(group, "value", signal.value)
        value.dims[0].attach_scale(time)
        _describe(value, sensor.unit, f"{sensor.quantity} measured by the sensor {name}")


def read_signals(file: h5py.File) -> dict[str, Signal]:
    """Return the signals by sensor name.

    The properties of an accelerometer are not stored, only their effect on the values; the case
    holds them.
    """
    found = {}
    for group in members(file["sensors"]).values() if "sensors" in file else ():
        name, told = str(group.attrs["name"]), group.attrs
        x, y, z = (float(part) for part in told["direction"])
        corner = float(told["filter_corner_Hz"]) if "filter_corner_Hz" in told else None
        sensor = Sensor(
            name,
            told["quantity"],
            (x, y, z),
            float(told["rate_Hz"]),
            None,
            str(told.get("filter", "none")),
            corner,
        )
        facts = (
            told.get("relative_uncertainty", np.nan),
            told.get("peak_before_range_m_s2", np.nan),
            told.get("overload_time_s", 0.0),
        )
        value = _numbers(members(group)["value"])
        if value.ndim != 1 or not 0.0 < sensor.rate < np.inf:
            raise DamageError(f"{group.name.lstrip('/')} is no signal of equal steps")
        found[name] = Signal(sensor, value, *map(float, facts))
    return found


def write_deflection(file: h5py.File, deflection: Deflection | None) -> None:
    """Write the deflection of the plate's upper side as the group `deflection`; no group
    if it is None.
    """
    if deflection is None:
        return
    group = file.create_group("deflection", track_order=True)
    group.attrs["contact_x_m"], group.attrs["contact_y_m"] = deflection.contact
    scales = []
    for name, values, unit, meaning in (
        ("time_s", deflection.time, "s", "time since the start"),
        ("y_m", deflection.y, "m", "y on the plate"),
        ("x_m", deflection.x, "m", "x on the plate"),
    ):
        scales.append(new_array(group, name, values, **PACKED))
        scales[-1].make_scale(name)
        _describe(scales[-1], unit, meaning)
    height = new_array(group, "deflection_m", deflection.height, **PACKED)
    _describe(height, "m", "displacement of the plate's upper side, upwards")
    for dimension, scale in zip(height.dims, scales, strict=True):
        dimension.attach_scale(scale)
    for name, values, meaning in (
        (
            "sphere_position_m",
            deflection.sphere_position,
            "height of the sphere's centre above the plate's upper surface at rest",
        ),
        (
            "contact_deflection_m",
            deflection.contact_deflection,
            "displacement of the plate where the sphere touches it, or will touch it next, upwards",
        ),
    ):
        data = new_array(group, name, values, **PACKED)
        data.dims[0].attach_scale(scales[0])
        _describe(data, "m", meaning)


def read_deflection(file: h5py.File) -> Deflection | None:
    """Return the deflection of the plate's upper side; None if the file has no such group."""
    if "deflection" not in file:
        return None
    group = file["deflection"]
    names = ("time_s", "x_m", "y_m", "deflection_m", "sphere_position_m", "contact_deflection_m")
    variables = members(group)
    time, x, y, height, position, contact = (_numbers(variables[name]) for name in names)
    if (
        height.shape != (len(time), len(y), len(x))
        or position.shape != time.shape
        or contact.shape != time.shape
    ):
        raise DamageError("the sizes of the variables of deflection do not agree")
    return Deflection(
        time,
        x,
        y,
        height,
        position,
        contact,
        (float(group.attrs["contact_x_m"]), float(group.attrs["contact_y_m"])),
    )


def _describe(data: h5py.Dataset, unit: str, meaning: str) -> None:
    data.attrs["units"], data.attrs["long_name"] = unit, meaning
