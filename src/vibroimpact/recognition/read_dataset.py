"""Reads the signals of a data set with their classes and groups; of a large one, whole groups drawn at random."""

from __future__ import annotations

import json
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Indices
from vibroimpact.bounds.bound import least_error
from vibroimpact.bounds.falls import falls_of_study
from vibroimpact.errors import InputError
from vibroimpact.files.check_sums import DamageError, file_digest, read_sealed
from vibroimpact.files.hdf5 import read_array
from vibroimpact.recognition.labelled_signals import GROUPS, LabelledSignals, SensorSignals
from vibroimpact.results.folder import SUMMARY
from vibroimpact.shown import shown
from vibroimpact.studies.study import read_study
from vibroimpact.studies.study_folder import DATASET as STUDY
from vibroimpact.studies.study_folder import is_study

DATASET, FORMAT = "dataset.nc", "vibroimpact dataset 1"
"""File and format of data sets that are no studies; a study is read as `dataset` and `sweep` write it."""

_SIGNAL, _CLASS = "signal_", "class"
_BLOCK = 4096  # signals read at once


def read_labelled_signals(dataset: str | PathLike[str], *, most: int | None = None, group: str = "rock", seed: int = 0) -> LabelledSignals:
    """Return the signals of a data set with their classes and groups.

    Parameters
    ----------
    dataset : path
        Folder of `vibroimpact dataset`, with `study.nc`, or one with a file `dataset.nc` of the same variables; or such a file.
    most : int, optional
        Largest number of signals; of more, whole groups are drawn at random. By default all are read.
    group : str, default "rock"
        What signals of a group share: "rock", "plate" or "fall".
    seed : int, default 0
        Seed of that draw.

    Returns
    -------
    LabelledSignals
        The signals with classes, groups, drawn keys and truth.

    Raises
    ------
    InputError
        If it is not a data set, or it is damaged.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> signals = vi.read_labelled_signals("falls", most=40)
    >>> signals.total, len(signals), sorted(signals.groups)
    (96, 36, ['fall', 'plate', 'rock'])
    """
    path = Path(dataset)
    if path.is_dir():
        path = next((path / name for name in (DATASET, STUDY) if (path / name).is_file()), path)
    if not path.is_file():
        raise InputError(f"{dataset}: this is not a data set; there is no {STUDY} or {DATASET}")
    try:
        with h5py.File(path) as file:
            found = _read(file, path, most, group, seed)
    except DamageError as error:
        raise InputError(f"{path}: {error}") from None
    except OSError:
        raise InputError(f"{path}: this is not a NetCDF-4 file, or it is damaged") from None
    return found


def _read(file: h5py.File, path: Path, most: int | None, group: str, seed: int) -> LabelledSignals:
    if path.name != STUDY and (form := file.attrs.get("format", "")) != FORMAT:
        raise InputError(f'{path}: the attribute "format" is {shown(form)}; this version reads "{FORMAT}"')
    sensors = [name.removeprefix(_SIGNAL) for name, one in file.items() if name.startswith(_SIGNAL) and one.ndim == 2]
    if not sensors:
        raise InputError(f"{path}: there are no signals; a variable signal_SENSOR (signal, time_SENSOR) holds those of a sensor")
    count = len(file[f"{_SIGNAL}{sensors[0]}"])
    columns = {name: read_array(one) for name, one in file.items() if one.ndim == 1 and len(one) == count and not _is_scale(one)}
    groups = {name: columns[name].astype(np.intp) for name in GROUPS if name in columns}
    groups.setdefault("fall", np.arange(count))
    classes, names = _classes(file, path, columns)
    kept = np.arange(count)
    if most is not None and count > most and group in groups:
        kept = _drawn_groups(groups[group], most, seed)
    numbers = {name: one.astype(float) for name, one in columns.items() if one.dtype.kind in "fiu" and name not in (*GROUPS, _CLASS)}
    texts = {name: one.astype(str) for name, one in columns.items() if one.dtype.kind in "OS"}
    values = {sensor: _rows(file[f"{_SIGNAL}{sensor}"], kept) for sensor in sensors}
    found = LabelledSignals(
        str(file.attrs.get("title", path.parent.name)),
        {sensor: SensorSignals(values[sensor], *_rate_and_unit(file, path, sensor)) for sensor in sensors},
        None if classes is None else classes[kept],
        names,
        {name: one[kept] for name, one in groups.items()},
        {name: one[kept] for name, one in {**numbers, **texts}.items() if "." in name},
        {name: one[kept] for name, one in numbers.items() if "." not in name},
        _bayes_error(path),
        count,
        file_digest(path),
    )
    # of a drop that failed there is no sample
    there = np.any([np.isfinite(one).any(axis=1) for one in values.values()], axis=0)
    return found if there.all() else found.only(np.flatnonzero(there))


def _is_scale(one: h5py.Dataset) -> bool:
    return one.attrs.get("CLASS", b"") == b"DIMENSION_SCALE" and one.name.lstrip("/") not in (*GROUPS, _CLASS)


def _classes(file: h5py.File, path: Path, columns: Mapping[str, NDArray[Any]]) -> tuple[Indices | None, tuple[str, ...]]:
    """Return the index of each signal's class, None if there are no classes, and the names of the classes."""
    if _CLASS not in columns:
        return None, ()
    attributes = file[_CLASS].attrs
    if not {"flag_values", "flag_meanings"} <= attributes.keys():
        raise InputError(f"{path}: the variable class has no flag_values and flag_meanings, which name the classes")
    values, names = np.atleast_1d(attributes["flag_values"]), tuple(str(attributes["flag_meanings"]).split())
    place = {int(value): number for number, value in enumerate(values)}
    unknown = sorted({int(value) for value in columns[_CLASS]} - place.keys())
    if len(values) != len(names):
        raise InputError(f"{path}: the variable class has {len(values)} flag_values and {len(names)} flag_meanings")
    if unknown:
        raise InputError(f"{path}: {unknown[0]} is in the variable class and not in its flag_values")
    return np.array([place[int(value)] for value in columns[_CLASS]], dtype=np.intp), names


def _rate_and_unit(file: h5py.File, path: Path, sensor: str) -> tuple[float, str]:
    data = file[f"{_SIGNAL}{sensor}"]
    rate = float(data.attrs["rate_Hz"]) if "rate_Hz" in data.attrs else _rate_of_scale(data)
    if not (np.isfinite(rate) and rate > 0.0):
        raise InputError(f"{path}: signal_{sensor} has neither an attribute rate_Hz that is greater than 0 nor times of its samples")
    return rate, str(data.attrs.get("units", "1"))


def _rate_of_scale(data: h5py.Dataset) -> float:
    """Return the sampling rate by the times that signals are over; NaN if there are none."""
    if not len(data.dims[1]) or data.shape[1] < 2:
        return float("nan")
    time = read_array(data.dims[1][0])
    return float(f"{(len(time) - 1) / (time[-1] - time[0]):.12g}")  # without the rounding of the times


def _drawn_groups(groups: Indices, most: int, seed: int) -> Indices:
    """Return the signals of groups drawn at random: as many whole groups as have at most `most` signals, and one at least."""
    names, sizes = np.unique(groups, return_counts=True)
    order = np.random.default_rng(seed).permutation(len(names))
    count = max(1, int(np.searchsorted(np.cumsum(sizes[order]), most, side="right")))
    return np.flatnonzero(np.isin(groups, names[order[:count]]))


def _rows(data: h5py.Dataset, kept: Indices) -> NDArray[np.float32]:
    """Return some rows of signals; blocks are read whole, since HDF5 reads single rows slowly."""
    found = np.empty((len(kept), data.shape[1]), dtype=np.float32)
    for first in range(0, len(data), _BLOCK):
        start, end = np.searchsorted(kept, (first, first + _BLOCK))
        if end > start:
            found[start:end] = read_array(data, slice(first, first + _BLOCK))[kept[start:end] - first]
    return found


def _bayes_error(path: Path) -> float | None:
    """Return the least error that any classifier can have: as the summary has it, or of a computed population; None if it is not known."""
    summary = path.parent / SUMMARY
    if not summary.is_file():
        return None
    if path.name == STUDY and is_study(path.parent):
        return least_error(falls_of_study(read_study(path.parent)))
    try:
        value = read_sealed(summary).get("bayes_error")
    except (ValueError, OSError, json.JSONDecodeError) as error:
        raise InputError(f"{summary}: {error}") from None
    if value is None:
        return None
    if not isinstance(value, int | float) or isinstance(value, bool) or not 0.0 <= value < 1.0:
        raise InputError(f"{summary}: bayes_error is {shown(value)}; it must be a number from 0 to below 1")
    return float(value)
