"""The result as a NetCDF-4 file: groups of variables with units, on dimension scales, through h5py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from vibroimpact.dynamics.columns import history_columns, impact_columns, meanings
from vibroimpact.files.hdf5 import PACKED, new_array, new_hdf5, read_array
from vibroimpact.results.netcdf_motion import read_deflection, read_signals, write_deflection, write_signals
from vibroimpact.results.result import Result


def write_groups(result: Result, path: Path) -> None:
    """Write a result as groups of a NetCDF-4 file: impacts, history, energy, and the signals and the deflection if there are any."""
    with new_hdf5(path) as file:
        file.attrs["title"] = result.name
        file.attrs["status"] = result.status
        for key, value in result.provenance.items():
            file.attrs[key] = value
        _write_group(file, "impacts", "impact", result.impacts, meanings(impact_columns(result.impacts)))
        _write_group(file, "history", "time_s", result.history, meanings(history_columns(result.history)))
        group = file.create_group("energy", track_order=True)
        for name, number in result.energy.items():
            new_array(group, name, float(number)).attrs["units"] = "J" if name.endswith("_J") else "1"
        write_signals(file, result.signals)
        write_deflection(file, result.deflection)


def read_groups(path: Path) -> dict[str, dict[str, Any]]:
    """Return the variables of each group of a file that `write_groups` wrote, of which all check sums hold.

    Returns
    -------
    dict of str to dict
        "impacts", "history" and "energy" by their columns; "sensors": the signals by the names of their sensors; and
        "deflection": the keyword "deflection", which may be None.

    Raises
    ------
    DamageError
        If a variable is not as it was written.
    OSError, ValueError, KeyError, TypeError
        If the file is missing, or damaged in another way.
    """
    with h5py.File(path, "r") as file:
        groups: dict[str, dict[str, Any]] = {
            group: {name: read_array(file[group][name]) for name in file[group]} for group in ("impacts", "history", "energy")
        }
        return {**groups, "sensors": dict(read_signals(file)), "deflection": {"deflection": read_deflection(file)}}


def _write_group(file: h5py.File, name: str, dimension: str, columns: Mapping[str, Any], meaning: Mapping[str, tuple[str, str]]) -> None:
    """Write columns of one length; the column `dimension` is their coordinate."""
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
