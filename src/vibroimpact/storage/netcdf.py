"""The result as a NetCDF-4 file: groups of variables with units, on dimension scales, through h5py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from vibroimpact.dynamics.columns import HISTORY_COLUMNS, IMPACT_COLUMNS
from vibroimpact.storage.result import Result


def write_groups(result: Result, path: Path) -> None:
    """Write impacts, history and energy as groups of a NetCDF-4 file."""
    with h5py.File(path, "w", track_order=True) as file:
        file.attrs["title"] = result.name
        file.attrs["status"] = result.status
        for key, value in result.provenance.items():
            file.attrs[key] = value
        _write_group(file, "impacts", "impact", result.impacts, IMPACT_COLUMNS)
        _write_group(file, "history", "time_s", result.history, HISTORY_COLUMNS)
        group = file.create_group("energy", track_order=True)
        for name, number in result.energy.items():
            group.create_dataset(name, data=float(number)).attrs["units"] = "J" if name.endswith("_J") else "1"


def read_groups(path: Path) -> dict[str, dict[str, Any]]:
    """Return the variables of each group of a file that `write_groups` wrote."""
    with h5py.File(path, "r") as file:
        return {group: {name: np.asarray(file[group][name]) for name in file[group]} for group in ("impacts", "history", "energy")}


def _write_group(file: h5py.File, name: str, dimension: str, columns: Mapping[str, Any], meaning: Mapping[str, tuple[str, str]]) -> None:
    """Write columns of one length; the column `dimension` is their coordinate."""
    group = file.create_group(name, track_order=True)
    scale = None
    for column in (dimension, *(key for key in meaning if key != dimension)):
        data = group.create_dataset(column, data=np.asarray(columns[column], dtype=np.float64))
        data.attrs["units"], data.attrs["long_name"] = meaning[column]
        if scale is None:
            scale = data
            scale.make_scale(dimension)
        else:
            data.dims[0].attach_scale(scale)
