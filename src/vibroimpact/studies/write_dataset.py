"""The dataset of a study, put together from its chunks."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from math import prod
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from vibroimpact._version import __version__
from vibroimpact.cases.limit import limits
from vibroimpact.dynamics.outcome import OUTCOMES, Outcome
from vibroimpact.files.check_sums import CHECK_SUMS, file_digest, read_sealed, sealed
from vibroimpact.files.hdf5 import CHECKED, chunk_shape, new_array, new_hdf5
from vibroimpact.files.write_file import new_file, write_file
from vibroimpact.results.folder import SUMMARY
from vibroimpact.studies.chunk_file import chunk_layout, read_chunk
from vibroimpact.studies.drop_variables import DOUBTS, LIMIT, OUTCOME, SIGNAL
from vibroimpact.studies.ledger import Span
from vibroimpact.studies.plan import SAMPLE, Plan
from vibroimpact.studies.study import FAILED_POINT, FAILED_REASON
from vibroimpact.studies.study_folder import DATASET, study_toml

Meanings = Mapping[str, tuple[str, str]]
"""Unit and meaning of variables by their names."""

_IMPACT, _TIME = "impact", "time"
_MORE = 2**20  # bytes that a file of HDF5 has beside its data, at most


def write_dataset(
    folder: Path,
    name: str,
    chunks: Sequence[Span],
    study: str,
    plan: Plan,
    table: Mapping[str, Any],
    meanings: Meanings,
    rates: Mapping[str, float],
) -> None:
    """Write `study.nc` from the chunks of a study; chunk by chunk, so that never all of it lies in memory.

    Parameters
    ----------
    folder : Path
        That of the study.
    name : str
        What the study is called.
    chunks : sequence of Span
        All of its chunks.
    study : str
        Its fingerprint.
    plan : Plan
        Its points.
    table : mapping
        The case with its [sweep] section.
    meanings : mapping
        Unit and meaning of swept keys and of what the chunks hold.
    rates : mapping of str to float
        The rate of each sensor [Hz].

    Raises
    ------
    OSError
        If there is no room for it.
    """
    layout: dict[str, tuple[tuple[int, ...], np.dtype[Any]]] = {}
    for chunk in chunks:
        for variable, ((_, *wide), dtype) in chunk_layout(folder, chunk.number).items():
            before = layout.get(variable, (wide, dtype))[0]
            layout[variable] = (tuple(map(max, before, wide)), dtype)
    with new_file(folder / DATASET) as working:  # last: once it is there, all is
        columns = sum(values.nbytes for values in plan.columns.values()) + 8 * plan.size
        _reserve_space(working, columns + plan.size * sum(prod(wide) * dtype.itemsize for wide, dtype in layout.values()))
        with new_hdf5(working) as file:
            file.attrs["title"] = name
            file.attrs["version"] = __version__
            file.attrs["study"] = study_toml(table)
            scales = _write_coordinates(file, plan, meanings)
            data = {one: _new_variable(file, one, layout[one], scales, meanings, rates) for one in meanings if one in layout}
            failures: dict[int, str] = {}
            for chunk in chunks:
                result = read_chunk(folder, chunk, study)
                for variable, values in result.arrays.items():
                    _put(data[variable], (), tuple(plan.dimensions.values()), chunk.first, values)
                failures |= {chunk.first + place: reason for place, reason in result.failures.items()}
            _write_failures(file, failures)
        summary = {**read_sealed(folder / SUMMARY), CHECK_SUMS: {DATASET: file_digest(working)}}
        write_file(folder / SUMMARY, sealed(summary).encode())  # before the dataset is there: it is never without


def as_text(value: Any) -> Any:
    """Return a value as tables hold it: numbers and names as they are, lists and tables as JSON."""
    return value if isinstance(value, (str, float, int)) and not isinstance(value, bool) else json.dumps(value)


def _reserve_space(path: Path, size: int) -> None:
    """Raise OSError unless so many bytes, and some more, can be written, before the work is done."""
    with path.open("wb") as file:
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), 0, size + _MORE)


def _write_coordinates(file: h5py.File, plan: Plan, meanings: Meanings) -> list[h5py.Dataset]:
    """Write the swept keys; return the scales of the dimensions."""
    scales = []
    if not plan.is_grid:
        scales = [_scale(file, SAMPLE, np.arange(plan.size), ("1", "number of the drop, from 0"))]
    for key, values in plan.columns.items():
        texts = values.dtype == object
        shown = np.array([str(as_text(one)) for one in values], dtype=object) if texts else values
        if plan.is_grid:
            scales.append(_scale(file, key, shown, meanings[key]))
        else:
            _described(_values(file, key, shown), meanings[key], scales)
    return scales


def _scale(file: h5py.File, name: str, values: NDArray[Any], meaning: tuple[str, str]) -> h5py.Dataset:
    data = _values(file, name, values)
    data.make_scale(name)
    return _described(data, meaning, [])


def _values(file: h5py.File, name: str, values: NDArray[Any]) -> h5py.Dataset:
    """Write numbers; or texts, for which HDF5 has no check sum, while that of the file holds them too."""
    if values.dtype != object:
        return new_array(file, name, values)
    return file.create_dataset(name, data=values, dtype=h5py.string_dtype())


def _described(data: h5py.Dataset, meaning: tuple[str, str], scales: Sequence[h5py.Dataset]) -> h5py.Dataset:
    data.attrs["units"], data.attrs["long_name"] = meaning
    for place, scale in enumerate(scales):
        data.dims[place].attach_scale(scale)
    return data


def _new_variable(
    file: h5py.File,
    name: str,
    layout: tuple[tuple[int, ...], Any],
    scales: list[h5py.Dataset],
    meanings: Meanings,
    rates: Mapping[str, float],
) -> h5py.Dataset:
    """Make a variable without values: what is not there is not a number, and a drop that is not there failed."""
    wide, dtype = layout
    own = list(scales)
    if wide and name.startswith(SIGNAL):
        own.append(_time_scale(file, rates, name.removeprefix(SIGNAL), wide[0]))
    elif wide:
        own.append(
            file[_IMPACT] if _IMPACT in file else _scale(file, _IMPACT, np.arange(1, wide[0] + 1), ("1", "number of the impact, from 1"))
        )
    fill = np.nan if dtype.kind == "f" else Outcome.FAILED.code if name == OUTCOME else 0
    shape = tuple(len(scale) for scale in own)
    chunks = {"chunks": chunk_shape(shape, dtype.itemsize), **CHECKED} if prod(shape) else {}
    data = file.create_dataset(name, shape=shape, dtype=dtype, fillvalue=fill, **chunks)
    if name == OUTCOME:
        data.attrs["flag_values"] = np.arange(len(OUTCOMES), dtype=dtype)
        data.attrs["flag_meanings"] = " ".join(outcome.value.replace(": ", "_").replace(" ", "_") for outcome in OUTCOMES)
    if name == DOUBTS:
        data.attrs["flag_masks"] = np.left_shift(1, np.arange(len(limits())), dtype=dtype)
        data.attrs["flag_meanings"] = " ".join(limits())
    if name.startswith(LIMIT):
        data.attrs["threshold"] = limits()[name.removeprefix(LIMIT)].threshold
    return _described(data, meanings[name], own)


def _time_scale(file: h5py.File, rates: Mapping[str, float], sensor: str, samples: int) -> h5py.Dataset:
    """Return the time of a signal: one for all sensors of one rate."""
    name = _TIME if len(set(rates.values())) == 1 else f"{_TIME}_{sensor}"
    if name in file:
        return file[name]
    return _scale(file, name, np.arange(samples) / rates[sensor], ("s", "time since the start"))


def _put(data: h5py.Dataset, above: tuple[int, ...], shape: tuple[int, ...], first: int, rows: NDArray[Any]) -> None:
    """Write rows into the points from `first` on of an array whose points have a shape of several dimensions."""
    if len(shape) == 1:
        data[(*above, slice(first, first + len(rows)), *(slice(length) for length in rows.shape[1:]))] = rows
        return
    inner = prod(shape[1:])
    while len(rows):
        place, start = divmod(first, inner)
        count = min(inner - start, len(rows))
        _put(data, (*above, place), shape[1:], start, rows[:count])
        first, rows = first + count, rows[count:]


def _write_failures(file: h5py.File, failures: Mapping[int, str]) -> None:
    points = _scale(file, FAILED_POINT, np.array(list(failures), dtype=np.int64), ("1", "number of a drop that failed, from 0"))
    reasons = _values(file, FAILED_REASON, np.array(list(failures.values()), dtype=object))
    _described(reasons, ("1", "why it failed"), [points])
