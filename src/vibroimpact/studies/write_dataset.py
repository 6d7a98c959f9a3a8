"""Write the dataset of a study, `study.nc`, from its chunks."""

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
from vibroimpact.files.atomic_write import atomic_file, write_file
from vibroimpact.files.check_sums import CHECK_SUMS, file_digest, sealed
from vibroimpact.files.hdf5 import CHECKED, chunk_shape, new_array, new_hdf5
from vibroimpact.results.folder import SUMMARY
from vibroimpact.studies.chunk_file import chunk_layout, read_chunk
from vibroimpact.studies.drop_variables import DOUBTS, LIMIT, OUTCOME, SIGNAL
from vibroimpact.studies.ledger import Span
from vibroimpact.studies.plan import SAMPLE, Plan
from vibroimpact.studies.population import LABELS
from vibroimpact.studies.study import FAILED_POINT, FAILED_REASON
from vibroimpact.studies.study_folder import DATASET, study_toml

Meanings = Mapping[str, tuple[str, str]]
"""Unit and meaning of variables by name."""

_IMPACT, _TIME = "impact", "time"
_MORE = 2**20  # upper bound of the overhead of an HDF5 file [bytes]


def write_dataset(
    folder: Path,
    name: str,
    chunks: Sequence[Span],
    study: str,
    plan: Plan,
    table: Mapping[str, Any],
    meanings: Meanings,
    rates: Mapping[str, float],
    summary: Mapping[str, Any],
) -> None:
    """Write `study.nc` from the chunks of a study, one chunk in memory at a time.

    Parameters
    ----------
    folder : Path
        Folder of the study.
    name : str
        Title of the study.
    chunks : sequence of Span
        All its chunks.
    study : str
        Its fingerprint.
    plan : Plan
        Its points.
    table : mapping
        The case with its [sweep] section.
    meanings : mapping
        Unit and meaning of the swept keys and of the variables in the chunks.
    rates : mapping of str to float
        Sampling rate of each sensor [Hz].
    summary : mapping
        Content of `summary.json`, which gets the checksum of the dataset.

    Raises
    ------
    OSError
        If it can't be written, such as on a full disk.
    """
    # shapes may differ between chunks: each variable gets the largest
    layout: dict[str, tuple[tuple[int, ...], np.dtype[Any]]] = {}
    for chunk in chunks:
        for variable, ((_, *wide), dtype) in chunk_layout(folder, chunk.number).items():
            before = layout.get(variable, (wide, dtype))[0]
            layout[variable] = (tuple(map(max, before, wide)), dtype)
    # written last: its presence marks a complete study
    with atomic_file(folder / DATASET) as working:
        columns = sum(values.nbytes for values in plan.columns.values()) + 8 * plan.size
        _reserve_space(
            working,
            columns
            + plan.size * sum(prod(wide) * dtype.itemsize for wide, dtype in layout.values()),
        )
        with new_hdf5(working) as file:
            file.attrs["title"] = name
            file.attrs["version"] = __version__
            file.attrs["study"] = study_toml(table)
            scales = _write_coordinates(file, plan, meanings)
            _write_labels(file, plan, scales)
            data = {
                one: _new_variable(file, one, layout[one], scales, meanings, rates)
                for one in meanings
                if one in layout
            }
            failures: dict[int, str] = {}
            for chunk in chunks:
                result = read_chunk(folder, chunk, study)
                for variable, values in result.arrays.items():
                    _write_rows(
                        data[variable], (), tuple(plan.dimensions.values()), chunk.first, values
                    )
                failures |= {
                    chunk.first + place: reason for place, reason in result.failures.items()
                }
            _write_failures(file, failures)
        content = {**summary, CHECK_SUMS: {DATASET: file_digest(working)}}
        # before the dataset appears, so that it always has a checksum
        write_file(folder / SUMMARY, sealed(content))


def as_text(value: Any) -> Any:
    """Return a value as a table cell: numbers and names unchanged, lists and tables as JSON."""
    return (
        value
        if isinstance(value, (str, float, int)) and not isinstance(value, bool)
        else json.dumps(value)
    )


def _reserve_space(path: Path, size: int) -> None:
    """Reserve disk space for a file of a size plus overhead, and raise OSError early if
    there is not enough.
    """
    with path.open("wb") as file:
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), 0, size + _MORE)


def _write_coordinates(file: h5py.File, plan: Plan, meanings: Meanings) -> list[h5py.Dataset]:
    """Write the swept keys, and return the dimension scales."""
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


def _write_labels(file: h5py.File, plan: Plan, scales: Sequence[h5py.Dataset]) -> None:
    """Write the labels of the points: names as flags, numbers as they are."""
    for name, values in plan.labels.items():
        if values.dtype != object:
            _described(new_array(file, name, values.astype(np.int32)), LABELS[name], scales)
            continue
        names, codes = np.unique(values.astype(str), return_inverse=True)
        data = _described(new_array(file, name, codes.astype(np.int16)), LABELS[name], scales)
        data.attrs["flag_values"] = np.arange(len(names), dtype=np.int16)
        data.attrs["flag_meanings"] = " ".join(one.replace(" ", "_") for one in names.tolist())


def _scale(
    file: h5py.File, name: str, values: NDArray[Any], meaning: tuple[str, str]
) -> h5py.Dataset:
    data = _values(file, name, values)
    data.make_scale(name)
    return _described(data, meaning, [])


def _values(file: h5py.File, name: str, values: NDArray[Any]) -> h5py.Dataset:
    """Write numbers with checksums, or strings, for which HDF5 has none; the checksum of
    the file covers both.
    """
    if values.dtype != object:
        return new_array(file, name, values)
    return file.create_dataset(name, data=values, dtype=h5py.string_dtype())


def _described(
    data: h5py.Dataset, meaning: tuple[str, str], scales: Sequence[h5py.Dataset]
) -> h5py.Dataset:
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
    """Create an empty variable; its fill value is NaN for floats, the code of a failed
    drop for outcomes, else 0.
    """
    wide, dtype = layout
    own = list(scales)
    if wide and name.startswith(SIGNAL):
        own.append(_time_scale(file, rates, name.removeprefix(SIGNAL), wide[0]))
    elif wide:
        own.append(
            file[_IMPACT]
            if _IMPACT in file
            else _scale(
                file, _IMPACT, np.arange(1, wide[0] + 1), ("1", "number of the impact, from 1")
            )
        )
    fill = np.nan if dtype.kind == "f" else Outcome.FAILED.code if name == OUTCOME else 0
    shape = tuple(len(scale) for scale in own)
    chunks = {"chunks": chunk_shape(shape, dtype.itemsize), **CHECKED} if prod(shape) else {}
    data = file.create_dataset(name, shape=shape, dtype=dtype, fillvalue=fill, **chunks)
    if name == OUTCOME:
        data.attrs["flag_values"] = np.arange(len(OUTCOMES), dtype=dtype)
        data.attrs["flag_meanings"] = " ".join(
            outcome.value.replace(": ", "_").replace(" ", "_") for outcome in OUTCOMES
        )
    if name == DOUBTS:
        data.attrs["flag_masks"] = np.left_shift(1, np.arange(len(limits())), dtype=dtype)
        data.attrs["flag_meanings"] = " ".join(limits())
    if name.startswith(LIMIT):
        data.attrs["threshold"] = limits()[name.removeprefix(LIMIT)].threshold
    return _described(data, meanings[name], own)


def _time_scale(
    file: h5py.File, rates: Mapping[str, float], sensor: str, samples: int
) -> h5py.Dataset:
    """Return the time scale of a signal: one for all sensors if their rates are equal,
    else one for each.
    """
    name = _TIME if len(set(rates.values())) == 1 else f"{_TIME}_{sensor}"
    if name in file:
        return file[name]
    return _scale(file, name, np.arange(samples) / rates[sensor], ("s", "time since the start"))


def _write_rows(
    data: h5py.Dataset,
    above: tuple[int, ...],
    shape: tuple[int, ...],
    first: int,
    rows: NDArray[Any],
) -> None:
    """Write rows into an array at the points from `first` on, counted through the
    dimensions of the grid `shape`.
    """
    if len(shape) == 1:
        data[
            (*above, slice(first, first + len(rows)), *(slice(length) for length in rows.shape[1:]))
        ] = rows
        return
    inner = prod(shape[1:])
    while len(rows):
        place, start = divmod(first, inner)
        count = min(inner - start, len(rows))
        _write_rows(data, (*above, place), shape[1:], start, rows[:count])
        first, rows = first + count, rows[count:]


def _write_failures(file: h5py.File, failures: Mapping[int, str]) -> None:
    points = _scale(
        file,
        FAILED_POINT,
        np.array(list(failures), dtype=np.int64),
        ("1", "number of a drop that failed, from 0"),
    )
    reasons = _values(file, FAILED_REASON, np.array(list(failures.values()), dtype=object))
    _described(reasons, ("1", "reason for the failure"), [points])
