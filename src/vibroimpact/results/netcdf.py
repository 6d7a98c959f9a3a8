"""NetCDF-4 file of a result: groups of variables with units and dimension scales, by h5py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.columns import history_columns, impact_columns, meanings
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.files.check_sums import DamageError
from vibroimpact.files.hdf5 import PACKED, chunk_shape, members, new_array, new_hdf5, read_array
from vibroimpact.files.plain_names import plain_names
from vibroimpact.results.deflection import Deflection
from vibroimpact.results.plate_shape import PlateShape
from vibroimpact.results.result import Result

_BLOCK = 2**20  # sample times that are computed and written at once


def write_groups(result: Result, path: Path) -> None:
    """Write a result to a NetCDF-4 file.

    It has groups for impacts, history and energy, and for signals, deflection and the shape
    of the plate if there are any.
    """
    with new_hdf5(path) as file:
        file.attrs["title"] = result.name
        file.attrs["status"] = result.status
        for key, value in result.provenance.items():
            file.attrs[key] = value
        impact_meanings = meanings(impact_columns(result.impacts))
        _write_group(file, "impacts", "impact", result.impacts, impact_meanings)
        history_meanings = meanings(history_columns(result.history))
        _write_group(file, "history", "time_s", result.history, history_meanings)
        group = file.create_group("energy", track_order=True)
        for name, number in result.energy.items():
            variable = new_array(group, name, float(number))
            variable.attrs["units"] = "J" if name.endswith("_J") else "1"
        write_signals(file, result.signals)
        write_deflection(file, result.deflection)
        _write_plate_shape(file, result.plate_shape)


def read_groups(path: Path) -> dict[str, dict[str, Any]]:
    """Return the variables of each group of a file, after verifying their checksums.

    The file is one written by `write_groups`.

    Returns
    -------
    dict of str to dict
        "impacts", "history" and "energy": arrays by column name; "sensors": signals by sensor name;
        "deflection": the deflection, or None, under the key "deflection"; and "plate": the shape of
        a plate whose mesh was brought, or None, under the key "shape".

    Raises
    ------
    DamageError
        If a variable does not match its checksum.
    OSError, ValueError, KeyError, TypeError
        If the file is missing or otherwise damaged.
    """
    with h5py.File(path, "r") as file:
        in_file = members(file)
        groups: dict[str, dict[str, Any]] = {}
        for group in ("impacts", "history", "energy"):
            variables = members(in_file[group])
            groups[group] = {name: _numbers(variable) for name, variable in variables.items()}
        groups["sensors"] = dict(read_signals(file))
        groups["deflection"] = {"deflection": read_deflection(file)}
        groups["plate"] = {"shape": _read_plate_shape(file)}
        return groups


def _numbers(variable: h5py.Dataset) -> NDArray[Any]:
    """Return the values of a variable, which must be real numbers."""
    if not isinstance(variable, h5py.Dataset) or variable.dtype.kind not in "fiub":
        raise DamageError(f"{variable.name.lstrip('/')} is no variable of real numbers")
    return read_array(variable)


def _write_group(
    file: h5py.File,
    name: str,
    dimension: str,
    columns: Mapping[str, Any],
    meaning: Mapping[str, tuple[str, str]],
) -> None:
    """Write columns of equal length as a group; `dimension` is their coordinate variable.

    `meaning` holds unit and description of each column.
    """
    group = file.create_group(name, track_order=True)
    # the coordinate comes first, as the others refer to it
    names = [dimension, *(column for column in meaning if column != dimension)]
    for column in names:
        numbers = np.asarray(columns[column], dtype=np.float64)
        variable = new_array(group, column, numbers, **PACKED)
        _describe(variable, *meaning[column])
        if column == dimension:
            variable.make_scale(dimension)
        else:
            variable.dims[0].attach_scale(group[dimension])


def write_signals(file: h5py.File, signals: Mapping[str, Signal]) -> None:
    """Write each signal as a subgroup of `sensors` with the variables `time_s` and `value`.

    Without signals there is no such group.
    """
    for name, plain in plain_names(list(signals)).items():
        signal = signals[name]
        sensor = signal.sensor
        group = file.create_group(f"sensors/{plain}", track_order=True)
        group.attrs["name"] = name
        group.attrs["quantity"] = sensor.quantity
        group.attrs["rate_Hz"] = sensor.rate
        group.attrs["direction"] = np.array(sensor.direction)
        group.attrs["filter"] = sensor.filter
        if sensor.corner is not None:
            group.attrs["filter_corner_Hz"] = sensor.corner
        group.attrs["relative_uncertainty"] = signal.uncertainty
        group.attrs["peak_before_range_m_s2"] = signal.peak
        group.attrs["overload_time_s"] = signal.overload_time

        time = _write_times(group, signal)
        value = new_array(group, "value", signal.value)
        value.dims[0].attach_scale(time)
        _describe(value, sensor.unit, f"{sensor.quantity} measured by the sensor {name}")


def _write_times(group: h5py.Group, signal: Signal) -> h5py.Dataset:
    """Write the sample times of a signal as the coordinate variable `time_s` of its group.

    A signal holds no array of times, which would take as much memory as its values: they are
    computed and written in blocks.
    """
    samples = len(signal.value)
    chunks = chunk_shape((samples,), 8)
    time = group.create_dataset("time_s", (samples,), np.float64, chunks=chunks, **PACKED)
    for first in range(0, samples, _BLOCK):
        time[first : first + _BLOCK] = signal.times(first, first + _BLOCK)
    time.make_scale("time_s")
    _describe(time, "s", "time since the start")
    return time


def read_signals(file: h5py.File) -> dict[str, Signal]:
    """Return the signals by sensor name.

    The properties of an accelerometer are not stored, only their effect on the values; the case
    holds them.
    """
    signals: dict[str, Signal] = {}
    if "sensors" not in file:
        return signals
    for group in members(file["sensors"]).values():
        attributes = group.attrs
        x, y, z = (float(component) for component in attributes["direction"])
        corner = attributes.get("filter_corner_Hz")
        if corner is not None:
            corner = float(corner)
        sensor = Sensor(
            str(attributes["name"]),
            quantity=attributes["quantity"],
            direction=(x, y, z),
            rate=float(attributes["rate_Hz"]),
            filter=str(attributes.get("filter", "none")),
            corner=corner,
        )
        value = _numbers(members(group)["value"])
        if value.ndim != 1 or not 0.0 < sensor.rate < np.inf:
            raise DamageError(f"{group.name.lstrip('/')} is no signal of equal steps")
        signals[sensor.name] = Signal(
            sensor,
            value,
            uncertainty=float(attributes.get("relative_uncertainty", np.nan)),
            peak=float(attributes.get("peak_before_range_m_s2", np.nan)),
            overload_time=float(attributes.get("overload_time_s", 0.0)),
        )
    return signals


def write_deflection(file: h5py.File, deflection: Deflection | None) -> None:
    """Write the deflection of the plate's upper side as the group `deflection`, unless it is None.

    The dimensions of the deflection are time, y and x.
    """
    if deflection is None:
        return
    group = file.create_group("deflection", track_order=True)
    contact_x, contact_y = deflection.contact
    group.attrs["contact_x_m"] = contact_x
    group.attrs["contact_y_m"] = contact_y

    time = _new_scale(group, "time_s", deflection.time, "s", "time since the start")
    y = _new_scale(group, "y_m", deflection.y, "m", "y on the plate")
    x = _new_scale(group, "x_m", deflection.x, "m", "x on the plate")
    height = new_array(group, "deflection_m", deflection.height, **PACKED)
    _describe(height, "m", "displacement of the plate's upper side, upwards")
    for dimension, scale in zip(height.dims, (time, y, x), strict=True):
        dimension.attach_scale(scale)

    position = new_array(group, "sphere_position_m", deflection.sphere_position, **PACKED)
    position.dims[0].attach_scale(time)
    _describe(
        position, "m", "height of the sphere's centre above the plate's upper surface at rest"
    )
    contact = new_array(group, "contact_deflection_m", deflection.contact_deflection, **PACKED)
    contact.dims[0].attach_scale(time)
    _describe(
        contact,
        "m",
        "displacement of the plate where the sphere touches it, or will touch it next, upwards",
    )


def _new_scale(
    group: h5py.Group, name: str, values: Floats, unit: str, meaning: str
) -> h5py.Dataset:
    """Return a new coordinate variable of a group."""
    variable = new_array(group, name, values, **PACKED)
    variable.make_scale(name)
    _describe(variable, unit, meaning)
    return variable


def read_deflection(file: h5py.File) -> Deflection | None:
    """Return the deflection of the plate's upper side; None if the file has no such group."""
    if "deflection" not in file:
        return None
    group = file["deflection"]
    variables = members(group)
    deflection = Deflection(
        time=_numbers(variables["time_s"]),
        x=_numbers(variables["x_m"]),
        y=_numbers(variables["y_m"]),
        height=_numbers(variables["deflection_m"]),
        sphere_position=_numbers(variables["sphere_position_m"]),
        contact_deflection=_numbers(variables["contact_deflection_m"]),
        contact=(float(group.attrs["contact_x_m"]), float(group.attrs["contact_y_m"])),
    )
    time = deflection.time
    if (
        deflection.height.shape != (len(time), len(deflection.y), len(deflection.x))
        or deflection.sphere_position.shape != time.shape
        or deflection.contact_deflection.shape != time.shape
    ):
        raise DamageError("the sizes of the variables of deflection do not agree")
    return deflection


_SHAPES = {
    "above": (2, "x and y of the outline of the upper side, closed lines followed by NaN"),
    "below": (2, "x and y of the outline of the lower side, closed lines followed by NaN"),
    "side": (2, "x and z of the outline seen along y, closed lines followed by NaN"),
    "held": (3, "nodes of the sets that are held"),
    "levels": (2, "lowest and highest z that each support holds"),
    "sensors": (2, "x and y of the sensors"),
}
"""Arrays of the shape of a plate: their columns, and what they are."""


def _write_plate_shape(file: h5py.File, shape: PlateShape | None) -> None:
    """Write the shape of a plate as the group `plate`, unless it is None."""
    if shape is None:
        return
    group = file.create_group("plate", track_order=True)
    for name, (_, meaning) in _SHAPES.items():
        _describe(new_array(group, f"{name}_m", getattr(shape, name)), "m", meaning)


def _read_plate_shape(file: h5py.File) -> PlateShape | None:
    """Return the shape of a plate; None if the file has none."""
    if "plate" not in file:
        return None
    variables = members(file["plate"])
    arrays = {name: _numbers(variables[f"{name}_m"]) for name in _SHAPES}
    for name, (columns, _) in _SHAPES.items():
        if arrays[name].ndim != 2 or arrays[name].shape[1] != columns:
            raise DamageError(f"plate/{name}_m does not have {columns} columns")
    return PlateShape(**arrays)


def _describe(variable: h5py.Dataset, unit: str, meaning: str) -> None:
    variable.attrs["units"] = unit
    variable.attrs["long_name"] = meaning
