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
from vibroimpact.cases.limits.limit import limits
from vibroimpact.dynamics.statement.outcome import OUTCOMES, Outcome
from vibroimpact.files.atomic_write import atomic_file, write_file
from vibroimpact.files.check_sums import CHECK_SUMS, file_digest, sealed
from vibroimpact.files.hdf5 import CHECKED, chunk_shape, new_array, new_hdf5
from vibroimpact.files.result_folder import SUMMARY
from vibroimpact.studies.computation.chunk_file import chunk_layout, read_chunk
from vibroimpact.studies.computation.ledger import Span
from vibroimpact.studies.computation.study import FAILED_POINT, FAILED_REASON
from vibroimpact.studies.computation.study_folder import DATASET, study_toml
from vibroimpact.studies.planning.drop_variables import DOUBTS, LIMIT, OUTCOME, SIGNAL
from vibroimpact.studies.planning.plan import SAMPLE, Plan
from vibroimpact.studies.planning.population import LABELS

Meanings = Mapping[str, tuple[str, str]]
"""Unit and meaning of variables by name."""

_IMPACT = "impact"
_TIME = "time"
_MOST_OVERHEAD = 2**20  # of an HDF5 file, beyond its arrays [bytes]

_Layout = Mapping[str, tuple[tuple[int, ...], np.dtype[Any]]]
"""Shape for each drop, and type, of variables by name."""


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
    layout = _common_layout(folder, chunks)
    # written last: its presence marks a complete study
    with atomic_file(folder / DATASET) as working:
        _reserve_space(working, _expected_size(plan, layout))
        with new_hdf5(working) as file:
            file.attrs["title"] = name
            file.attrs["version"] = __version__
            file.attrs["study"] = study_toml(table)
            scales = _write_coordinates(file, plan, meanings)
            _write_labels(file, plan, scales)
            variables = {
                variable: _new_variable(file, variable, layout[variable], scales, meanings, rates)
                for variable in meanings
                if variable in layout
            }
            grid = tuple(plan.dimensions.values())
            failures: dict[int, str] = {}
            for chunk in chunks:
                result = read_chunk(folder, chunk, study)
                for variable, values in result.arrays.items():
                    _write_rows(variables[variable], (), grid, chunk.first, values)
                for index, reason in result.failures.items():
                    failures[chunk.first + index] = reason
            _write_failures(file, failures)
        content = {**summary, CHECK_SUMS: {DATASET: file_digest(working)}}
        # before the dataset appears, so that it always has a checksum
        write_file(folder / SUMMARY, sealed(content))


def _common_layout(folder: Path, chunks: Sequence[Span]) -> _Layout:
    """Return the layout of the variables of a study.

    The lengths of their axes may differ between chunks: each variable gets the largest.
    """
    layout: dict[str, tuple[tuple[int, ...], np.dtype[Any]]] = {}
    for chunk in chunks:
        for variable, (shape, dtype) in chunk_layout(folder, chunk.number).items():
            drop_shape = shape[1:]
            widest, _ = layout.get(variable, (drop_shape, dtype))
            layout[variable] = (tuple(map(max, widest, drop_shape)), dtype)
    return layout


def _expected_size(plan: Plan, layout: _Layout) -> int:
    """Return the size of the arrays of a dataset [bytes]."""
    coordinates = sum(values.nbytes for values in plan.columns.values()) + 8 * plan.size
    drop = sum(prod(shape) * dtype.itemsize for shape, dtype in layout.values())
    return coordinates + plan.size * drop


def as_text(value: Any) -> Any:
    """Return a value as a table cell: numbers and names unchanged, lists and tables as JSON."""
    if isinstance(value, (str, float, int)) and not isinstance(value, bool):
        return value
    return json.dumps(value)


def _reserve_space(path: Path, size: int) -> None:
    """Reserve disk space for a file of a size [bytes] plus overhead.

    This raises OSError early if there is not enough.
    """
    with path.open("wb") as file:
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), 0, size + _MOST_OVERHEAD)


def _write_coordinates(file: h5py.File, plan: Plan, meanings: Meanings) -> list[h5py.Dataset]:
    """Write the swept keys, and return the dimension scales."""
    scales = []
    if not plan.is_grid:
        scales = [
            _new_scale(file, SAMPLE, np.arange(plan.size), ("1", "number of the drop, from 0"))
        ]
    for key, column in plan.columns.items():
        values = column
        if column.dtype == object:
            values = np.array([str(as_text(value)) for value in column], dtype=object)
        if plan.is_grid:
            scales.append(_new_scale(file, key, values, meanings[key]))
        else:
            _describe(_new_array(file, key, values), meanings[key], scales)
    return scales


def _write_labels(file: h5py.File, plan: Plan, scales: Sequence[h5py.Dataset]) -> None:
    """Write the labels of the points: names as flags, numbers as they are."""
    for label, column in plan.labels.items():
        if column.dtype != object:
            numbers = new_array(file, label, column.astype(np.int32))
            _describe(numbers, LABELS[label], scales)
            continue
        # flags as in the CF conventions, whose meanings are words separated by blanks
        names, codes = np.unique(column.astype(str), return_inverse=True)
        flags = new_array(file, label, codes.astype(np.int16))
        _describe(flags, LABELS[label], scales)
        flags.attrs["flag_values"] = np.arange(len(names), dtype=np.int16)
        flag_words = [name.replace(" ", "_") for name in names.tolist()]
        flags.attrs["flag_meanings"] = " ".join(flag_words)


def _new_scale(
    file: h5py.File, name: str, values: NDArray[Any], meaning: tuple[str, str]
) -> h5py.Dataset:
    """Write a dimension scale."""
    scale = _new_array(file, name, values)
    scale.make_scale(name)
    _describe(scale, meaning, [])
    return scale


def _new_array(file: h5py.File, name: str, values: NDArray[Any]) -> h5py.Dataset:
    """Write numbers with checksums, or strings, for which HDF5 has none.

    The checksum of the file covers both.
    """
    if values.dtype != object:
        return new_array(file, name, values)
    return file.create_dataset(name, data=values, dtype=h5py.string_dtype())


def _describe(
    variable: h5py.Dataset, meaning: tuple[str, str], scales: Sequence[h5py.Dataset]
) -> None:
    """Give a variable its unit and description, and the scales of its first dimensions."""
    unit, description = meaning
    variable.attrs["units"] = unit
    variable.attrs["long_name"] = description
    for dimension, scale in enumerate(scales):
        variable.dims[dimension].attach_scale(scale)


def _new_variable(
    file: h5py.File,
    name: str,
    layout: tuple[tuple[int, ...], Any],
    scales: list[h5py.Dataset],
    meanings: Meanings,
    rates: Mapping[str, float],
) -> h5py.Dataset:
    """Create an empty variable.

    Its fill value is NaN for floats, the code of a failed drop for outcomes, else 0.
    """
    drop_shape, dtype = layout
    own_scales = list(scales)
    if drop_shape and name.startswith(SIGNAL):
        own_scales.append(_time_scale(file, rates, name.removeprefix(SIGNAL), drop_shape[0]))
    elif drop_shape:
        own_scales.append(_impact_scale(file, drop_shape[0]))
    fill_value: float = 0
    if dtype.kind == "f":
        fill_value = np.nan
    elif name == OUTCOME:
        fill_value = Outcome.FAILED.code
    shape = tuple(len(scale) for scale in own_scales)
    chunks: dict[str, Any] = {}
    if prod(shape):  # an empty variable has no chunks, and so no checksums
        chunks = {"chunks": chunk_shape(shape, dtype.itemsize), **CHECKED}
    variable = file.create_dataset(name, shape=shape, dtype=dtype, fillvalue=fill_value, **chunks)
    # flags as in the CF conventions
    if name == OUTCOME:
        variable.attrs["flag_values"] = np.arange(len(OUTCOMES), dtype=dtype)
        variable.attrs["flag_meanings"] = " ".join(
            outcome.value.replace(": ", "_").replace(" ", "_") for outcome in OUTCOMES
        )
    if name == DOUBTS:
        variable.attrs["flag_masks"] = np.left_shift(1, np.arange(len(limits())), dtype=dtype)
        variable.attrs["flag_meanings"] = " ".join(limits())
    if name.startswith(LIMIT):
        variable.attrs["threshold"] = limits()[name.removeprefix(LIMIT)].threshold
    _describe(variable, meanings[name], own_scales)
    return variable


def _impact_scale(file: h5py.File, impacts: int) -> h5py.Dataset:
    """Return the scale of the impacts of a drop, which all variables share."""
    if _IMPACT in file:
        return file[_IMPACT]
    return _new_scale(
        file, _IMPACT, np.arange(1, impacts + 1), ("1", "number of the impact, from 1")
    )


def _time_scale(
    file: h5py.File, rates: Mapping[str, float], sensor: str, samples: int
) -> h5py.Dataset:
    """Return the time scale of a signal.

    It is one for all sensors if their rates are equal, else one for each.
    """
    name = _TIME
    if len(set(rates.values())) > 1:
        name = f"{_TIME}_{sensor}"
    if name in file:
        return file[name]
    time = np.arange(samples) / rates[sensor]
    return _new_scale(file, name, time, ("s", "time since the start"))


def _write_rows(
    variable: h5py.Dataset,
    outer: tuple[int, ...],
    shape: tuple[int, ...],
    first: int,
    rows: NDArray[Any],
) -> None:
    """Write rows, one for each drop, into a variable whose leading dimensions are a grid.

    The points are counted through the grid, the last dimension fastest; a grid of several
    dimensions is written one index of its first dimension after the other.

    Parameters
    ----------
    variable : Dataset
        The variable.
    outer : tuple of int
        Indices along the dimensions before those of `shape`.
    shape : tuple of int
        Lengths of the remaining dimensions of the grid.
    first : int
        Number of the first point within `shape`.
    rows : array
        The rows of this and the following points.
    """
    if len(shape) == 1:
        inner = (slice(length) for length in rows.shape[1:])
        variable[(*outer, slice(first, first + len(rows)), *inner)] = rows
        return
    points_per_index = prod(shape[1:])
    while len(rows):
        index, start = divmod(first, points_per_index)
        count = min(points_per_index - start, len(rows))
        _write_rows(variable, (*outer, index), shape[1:], start, rows[:count])
        first += count
        rows = rows[count:]


def _write_failures(file: h5py.File, failures: Mapping[int, str]) -> None:
    numbers = np.array(list(failures), dtype=np.int64)
    points = _new_scale(file, FAILED_POINT, numbers, ("1", "number of a drop that failed, from 0"))
    texts = np.array(list(failures.values()), dtype=object)
    reasons = _new_array(file, FAILED_REASON, texts)
    _describe(reasons, ("1", "reason for the failure"), [points])
