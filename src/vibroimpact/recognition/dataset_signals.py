"""Reads the signals of a data set with their classes and groups.

Of a large one, whole groups are drawn at random.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import isfinite
from os import PathLike
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats, Indices
from vibroimpact.bayes_error.bound import SEEN_AT_BEST, least_error
from vibroimpact.bayes_error.falls import falls_of_study
from vibroimpact.errors import InputError
from vibroimpact.files.check_sums import DamageError, file_digest, read_sealed, recorded_digest
from vibroimpact.files.damaged_part import check_hdf5
from vibroimpact.files.hdf5 import attribute, members, read_array, short_reason
from vibroimpact.files.plain_names import one_line
from vibroimpact.files.reading import with_path
from vibroimpact.files.result_folder import SUMMARY
from vibroimpact.quoting import quoted
from vibroimpact.recognition.labelled_signals import GROUPS, LabelledSignals, SensorSignals
from vibroimpact.studies.computation.study import load_study
from vibroimpact.studies.computation.study_folder import DATASET as STUDY
from vibroimpact.studies.computation.study_folder import is_study

DATASET = "dataset.nc"
"""File of data sets that are no studies; a study is read as `dataset` and `sweep` write it."""

FORMAT = "vibroimpact dataset 1"
"""Format of that file."""

_SIGNAL = "signal_"
_CLASS = "class"
_BLOCK = 4096  # signals read at once
_MOST_CLASSES = 100


def load_labelled_signals(
    dataset: str | PathLike[str], *, most: int | None = None, group: str = "rock", seed: int = 0
) -> LabelledSignals:
    """Return the signals of a data set with their classes and groups.

    Parameters
    ----------
    dataset : path
        Folder of `vibroimpact dataset`, with `study.nc`, or one with a file `dataset.nc` of the
        same variables; or such a file.
    most : int, optional
        Largest number of signals; of more, whole groups are drawn at random. By default all are
        read.
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
    >>> signals = vi.recognition.load_labelled_signals("falls", most=40)
    >>> signals.total, len(signals), sorted(signals.groups)
    (96, 36, ['fall', 'plate', 'rock'])
    """
    path = Path(dataset)
    if path.is_dir():
        path = next((path / name for name in (DATASET, STUDY) if (path / name).is_file()), path)
    if not path.is_file():
        raise InputError(f"{dataset}: this is not a data set; there is no {STUDY} or {DATASET}")
    with _faults_of(path):
        check_hdf5(path, recorded_digest(path))
        with h5py.File(path) as file:
            return _read(file, path, most, group, seed)


@contextmanager
def _faults_of(path: Path) -> Iterator[None]:
    """Report what is wrong with a data set, whose damage raises errors of many types."""
    try:
        yield
    except DamageError as error:
        raise with_path(path, InputError(str(error))) from None
    except InputError as error:
        if str(path.parent) in str(error):
            raise
        raise with_path(path, error) from None
    except (PermissionError, BlockingIOError) as error:
        raise with_path(path, InputError(f"it can't be opened: {short_reason(error)}")) from None
    except OSError:
        raise with_path(path, InputError("this is not a NetCDF-4 file, or it is damaged")) from None
    except Exception as error:
        raise with_path(path, InputError(f"the file is damaged: {short_reason(error)}")) from None


def _read(file: h5py.File, path: Path, most: int | None, group: str, seed: int) -> LabelledSignals:
    """Return the signals in an open file."""
    if path.name != STUDY:
        file_format = attribute(file, "format", "")
        if file_format != FORMAT:
            raise InputError(
                f'the attribute "format" is {quoted(file_format)}; this version reads "{FORMAT}"'
            )
    variables = members(file)
    signal_variables = _signals(variables)
    count = len(next(iter(signal_variables.values())))
    columns = {
        name: read_array(variable)
        for name, variable in variables.items()
        if _is_column(name, variable, count)
    }
    groups = {name: _whole_numbers(name, columns[name]) for name in GROUPS if name in columns}
    groups.setdefault("fall", np.arange(count))
    classes, class_names = _classes(file, columns)
    kept = np.arange(count)
    if most is not None and count > most and group in groups:
        kept = _drawn_groups(groups[group], most, seed)
    drawn, truth = _drawn_and_truth(columns, kept)
    sample_values = {sensor: _rows(variable, kept) for sensor, variable in signal_variables.items()}
    sensors = {}
    for sensor, variable in signal_variables.items():
        rate, unit = _rate_and_unit(variable, sensor)
        sensors[sensor] = SensorSignals(sample_values[sensor], rate, unit)
    if classes is not None:
        classes = classes[kept]
    sees = SEEN_AT_BEST if _is_computed(path) else None
    signals = LabelledSignals(
        name=one_line(str(attribute(file, "title", path.parent.name))),
        sensors=sensors,
        classes=classes,
        class_names=class_names,
        groups={name: numbers[kept] for name, numbers in groups.items()},
        drawn=drawn,
        truth=truth,
        bayes_error=_bayes_error(path),
        total=count,
        check_sum=file_digest(path),
        bayes_error_sees=sees,
        rows=kept,
    )
    # of a drop that failed there is no sample
    has_samples = np.any(
        [np.isfinite(values).any(axis=1) for values in sample_values.values()], axis=0
    )
    if not has_samples.any():
        raise InputError("no signal has a sample that is a finite number")
    if has_samples.all():
        return signals
    return signals.only(np.flatnonzero(has_samples))


def _drawn_and_truth(
    columns: Mapping[str, NDArray[Any]], kept: Indices
) -> tuple[dict[str, NDArray[Any]], dict[str, Floats]]:
    """Return the drawn keys, and what the simulation knows, of the signals that are kept.

    Drawn keys have a point in their names, such as "drop.height".
    """
    drawn: dict[str, NDArray[Any]] = {}
    truth: dict[str, Floats] = {}
    for name, values in columns.items():
        if values.dtype.kind in "fiu" and name not in (*GROUPS, _CLASS):
            numbers = values.astype(float)[kept]
            if "." in name:
                drawn[name] = numbers
            else:
                truth[name] = numbers
    for name, values in columns.items():
        if values.dtype.kind in "OS" and "." in name:
            drawn[name] = _texts(values)[kept]
    return drawn, truth


def _signals(variables: Mapping[str, h5py.Dataset | h5py.Group]) -> dict[str, h5py.Dataset]:
    """Return the variable with the signals of each sensor, all of as many rows."""
    signals = {}
    misshapen = ""  # what is wrong with a variable that was passed over
    for name, variable in variables.items():
        if not name.startswith(_SIGNAL):
            continue
        if not isinstance(variable, h5py.Dataset):
            raise InputError(
                f"{name} is a group; it must be a variable of two dimensions (signal, time)"
            )
        if variable.ndim != 2:
            misshapen = f"; {name} is of the shape {variable.shape}"
            continue
        if variable.dtype.kind not in "fiu":
            raise InputError(
                f"{name} is of the type {variable.dtype}; the samples of signals must be real "
                "numbers"
            )
        if not variable.size:
            raise InputError(f"{name} has no samples; its shape is {variable.shape}")
        signals[name.removeprefix(_SIGNAL)] = variable
    if not signals:
        raise InputError(
            "there are no signals; a variable signal_SENSOR (signal, time_SENSOR) holds "
            f"those of a sensor{misshapen}"
        )
    first, *others = signals
    count = len(signals[first])
    for sensor in others:
        if len(signals[sensor]) != count:
            raise InputError(
                f"signal_{first} has {count} signals, and signal_{sensor} has "
                f"{len(signals[sensor])}; a row of each must be of the same impact"
            )
    return signals


def _is_column(name: str, variable: h5py.Dataset | h5py.Group, count: int) -> bool:
    """Return whether a variable has a value for each signal."""
    is_label = name in (*GROUPS, _CLASS)
    if not isinstance(variable, h5py.Dataset):
        if is_label:
            raise InputError(
                f"{name} is a group; it must be a variable with a value for each signal"
            )
        return False
    if is_label and variable.shape != (count,):
        raise InputError(
            f"{name} is of the shape {variable.shape}; it must have a value for each of {count} "
            "signals"
        )
    if variable.shape != (count,):
        return False
    return is_label or attribute(variable, "CLASS", "") != "DIMENSION_SCALE"


def _whole_numbers(name: str, values: NDArray[Any]) -> Indices:
    """Return labels, which must be whole numbers."""
    if values.dtype.kind not in "fiub":
        raise InputError(
            f"{name} is of the type {values.dtype}; number each {name} with whole numbers"
        )
    not_whole = np.flatnonzero(
        ~np.isfinite(values)
        | (values != np.floor(values))
        | (np.abs(values.astype(float)) > 2.0**53)
    )
    if len(not_whole):
        signal = not_whole[0]
        raise InputError(
            f"{name} of signal {signal} is {quoted(values[signal].item())}; "
            "it must be a whole number"
        )
    return values.astype(np.intp)


def _texts(values: NDArray[Any]) -> NDArray[Any]:
    return np.array([_text(value) for value in values.tolist()])


def _text(value: Any) -> str:
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return str(value)


def _classes(
    file: h5py.File, columns: Mapping[str, NDArray[Any]]
) -> tuple[Indices | None, tuple[str, ...]]:
    """Return the index of each signal's class and the names of the classes.

    Without classes the index is None.
    """
    if _CLASS not in columns:
        return None, ()
    flags = attribute(file[_CLASS], "flag_values")
    meanings = attribute(file[_CLASS], "flag_meanings")
    if flags is None or meanings is None:
        raise InputError(
            "the variable class lacks flag_values or flag_meanings, which name the classes"
        )
    if not isinstance(flags, list):  # a single number
        flags = [flags]
    if not all(map(_is_whole_number, flags)) or len(set(flags)) < len(flags):
        raise InputError(
            f"flag_values of the variable class is {quoted(flags)}; it must be a list of "
            "different whole numbers"
        )
    names: tuple[str, ...] = ()
    if isinstance(meanings, str):
        names = tuple(meanings.split())
    if not names or len(set(names)) < len(names) or not all(map(str.isprintable, names)):
        raise InputError(
            f"flag_meanings of the variable class is {quoted(meanings)}; it must be "
            "different names, separated by blanks"
        )
    if len(flags) != len(names):
        raise InputError(
            f"the variable class has {len(flags)} flag_values and {len(names)} flag_meanings"
        )
    if len(names) > _MOST_CLASSES:
        raise InputError(f"there are {len(names)} classes; {_MOST_CLASSES} are the most")
    numbers = _whole_numbers(_CLASS, columns[_CLASS]).tolist()
    index_of_flag = {int(flag): index for index, flag in enumerate(flags)}
    unknown = sorted(set(numbers) - index_of_flag.keys())
    if unknown:
        raise InputError(f"{unknown[0]} is in the variable class and not in its flag_values")
    return np.array([index_of_flag[number] for number in numbers], dtype=np.intp), names


def _is_whole_number(flag: Any) -> bool:
    return type(flag) in (int, float) and isfinite(flag) and flag == int(flag)


def _rate_and_unit(variable: h5py.Dataset, sensor: str) -> tuple[float, str]:
    """Return the sampling rate [Hz] and the unit of the signals of a sensor."""
    rate = attribute(variable, "rate_Hz")
    unit = attribute(variable, "units", "1")
    if rate is None:
        rate = _rate_of_scale(variable)
    elif isinstance(rate, list) and len(rate) == 1:
        (rate,) = rate
    if rate is None:
        raise InputError(
            f"signal_{sensor} has neither an attribute rate_Hz nor increasing times of its samples"
        )
    if type(rate) not in (int, float) or not 0.0 < rate < np.inf:
        raise InputError(
            f"rate_Hz of signal_{sensor} is {quoted(rate)}; it must be "
            "a number greater than 0, in Hz"
        )
    if not isinstance(unit, str):
        raise InputError(f"units of signal_{sensor} is {quoted(unit)}; it must be a text")
    return float(rate), one_line(unit)


def _rate_of_scale(variable: h5py.Dataset) -> float | None:
    """Return the sampling rate by the times of the samples [Hz].

    It is None if there are none, or they do not increase.
    """
    if not len(variable.dims[1]) or variable.shape[1] < 2:
        return None
    time: Floats = read_array(variable.dims[1][0])
    if time.dtype.kind not in "fiu" or len(time) != variable.shape[1]:
        return None
    span = float(time[-1]) - float(time[0])
    if not 0.0 < span < np.inf:
        return None
    # without the rounding of the times
    return float(f"{min((len(time) - 1) / span, np.finfo(float).max):.12g}")


def _drawn_groups(groups: Indices, most: int, seed: int) -> Indices:
    """Return the signals of groups drawn at random.

    They are as many whole groups as have at most `most` signals, and one at least.
    """
    names, sizes = np.unique(groups, return_counts=True)
    order = np.random.default_rng(seed).permutation(len(names))
    count = max(1, int(np.searchsorted(np.cumsum(sizes[order]), most, side="right")))
    return np.flatnonzero(np.isin(groups, names[order[:count]]))


def _rows(variable: h5py.Dataset, kept: Indices) -> NDArray[np.float32]:
    """Return some rows of signals; blocks are read whole, since HDF5 reads single rows slowly."""
    # which refuses a shape that the file does not hold, before memory is taken for it
    read_array(variable, slice(0, 0))
    rows = np.empty((len(kept), variable.shape[1]), dtype=np.float32)
    for first in range(0, len(variable), _BLOCK):
        # the part of the kept rows, which ascend, that lies in this block
        start, end = np.searchsorted(kept, (first, first + _BLOCK))
        if end > start:
            block = read_array(variable, slice(first, first + _BLOCK))
            # beyond single precision a sample is infinite, which is a feature's reason to have no
            # value
            with np.errstate(over="ignore"):
                rows[start:end] = block[kept[start:end] - first]
    return rows


def _is_computed(path: Path) -> bool:
    """Return whether the signals are of a study that this program computed."""
    return path.name == STUDY and (path.parent / SUMMARY).is_file() and is_study(path.parent)


def _bayes_error(path: Path) -> float | None:
    """Return a lower bound on the error, None if it is not known.

    It is that of a computed population, or as the summary states it.
    """
    summary = path.parent / SUMMARY
    if not summary.is_file():
        return None
    if _is_computed(path):
        return least_error(falls_of_study(load_study(path.parent)))
    try:
        value = read_sealed(summary).get("bayes_error")
    except (DamageError, InputError) as error:
        raise with_path(summary, InputError(str(error))) from None
    if value is None:
        return None
    if not isinstance(value, int | float) or isinstance(value, bool) or not 0.0 <= value < 1.0:
        raise InputError(
            f"{summary}: bayes_error is {quoted(value)}; it must be a number from 0 to below 1"
        )
    return float(value)
