"""A completed study: a NetCDF-4 dataset whose dimensions are the swept keys or `sample`."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import prod
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.files.check_sums import DamageError, recorded_digest
from vibroimpact.files.damaged_part import check_hdf5
from vibroimpact.files.hdf5 import members, read_array, short_reason
from vibroimpact.files.toml_reading import parse_toml
from vibroimpact.report.reported import WithReport
from vibroimpact.studies.computation.study_folder import DATASET, STUDY, recover_study, swept_keys
from vibroimpact.studies.planning.drop_variables import DOUBTS, LIMIT, SIGNAL
from vibroimpact.studies.planning.plan import SAMPLE
from vibroimpact.studies.planning.population import LABELS

FAILED_POINT = "failed_point"
"""The variable with the numbers of failed drops."""

FAILED_REASON = "failed_reason"
"""The variable with the reasons of failed drops."""


class StudyDoubt(NamedTuple):
    """A limit of the theory that some drops of a study exceed.

    Attributes
    ----------
    limit : str
        Name of the limit, such as "air_drag".
    drops : int
        Number of drops that exceed it.
    worst : int
        Number of the drop that exceeds it most, from 0.
    number : float
        The value of `limit_NAME` in the dataset for that drop.
    """

    limit: str
    drops: int
    worst: int
    number: float


@dataclass(frozen=True, eq=False)
class Study(WithReport, reported_in="vibroimpact.studies.report.report"):
    """A completed study; its variables are read on demand.

    Its folder has its report already: `remake_report` writes that anew.

    Attributes
    ----------
    path : Path
        Path of the dataset.
    name : str
        Title of the study.
    table : dict
        The case with its [sweep] section.
    version : str
        Version of the package that computed it.
    dimensions : dict of str to int
        Leading dimensions of every variable in order, with their lengths: the swept keys, or
        `sample`.
    coordinates : dict of str to array
        By swept key its levels, or its values along `sample`.
    meanings : dict of str to (str, str)
        Unit and meaning of every variable and every swept key.
    shapes : dict of str to tuple
        Shape of every variable: that of `dimensions`, followed by impacts or samples in time.
    failures : dict of int to str
        Reason of each failed drop, by its number in the sequence of all points, from 0.
    labels : dict of str to array
        Of the falls of a population the `class`, by its name, and the numbers of `rock` and
        `plate`.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type1-theory").to_problem().source
    >>> sweep = vi.studies.sweep_of({**case, "sweep": {"over": {"drop.height": ["1 m", "2 m"]}}})
    >>> with TemporaryDirectory() as folder:
    ...     study = vi.studies.load_study(vi.studies.run_sweep(sweep, f"{folder}/heights"))
    ...     study.dimensions, study.values("largest_force_N").round(1).tolist()
    ({'drop.height': 2}, [4406.8, 6730.2])
    """

    path: Path
    name: str
    table: dict[str, Any]
    version: str
    dimensions: dict[str, int]
    coordinates: dict[str, NDArray[Any]]
    meanings: dict[str, tuple[str, str]]
    shapes: dict[str, tuple[int, ...]]
    failures: dict[int, str]
    labels: dict[str, NDArray[Any]] = field(default_factory=dict)

    @property
    def design(self) -> str:
        """The name of its design, such as "grid"."""
        return _design(self.table)

    @property
    def is_grid(self) -> bool:
        """Whether its points are all combinations of the levels of its keys."""
        return SAMPLE not in self.dimensions

    @property
    def size(self) -> int:
        """The number of drops."""
        return prod(self.dimensions.values())

    @property
    def doubts(self) -> list[StudyDoubt]:
        """The limits of the theory that drops exceed, with their number and the worst of them."""
        with _reported_damage(self.path):
            return study_doubts(self.path)

    def values(self, name: str, *place: Any) -> NDArray[Any]:
        """Return a variable, or a part of it by NumPy indexing.

        Parameters
        ----------
        name : str
            Name, such as "max_force_N".
        *place : int or slice
            Index along the first dimension, the second, ...

        Raises
        ------
        InputError
            If there is no such variable, or it is damaged.
        """
        self._check(name)
        with _reported_damage(self.path), h5py.File(self.path, "r") as file:
            return read_array(file[name], place or ())

    def __repr__(self) -> str:
        lengths = ", ".join(f"{name} {length}" for name, length in self.dimensions.items())
        drops = "drop" if self.size == 1 else "drops"
        return f"<Study of {self.size} {drops}: {lengths}>"

    def times(self, sensor: str) -> Floats:
        """Return the time of each sample in the signal of a sensor [s].

        Parameters
        ----------
        sensor : str
            Name of the sensor.

        Raises
        ------
        InputError
            If its signal was not kept, or is damaged.
        """
        name = f"{SIGNAL}{sensor}"
        self._check(name)
        with _reported_damage(self.path), h5py.File(self.path, "r") as file:
            (scale,) = file[name].dims[len(self.dimensions)].values()
            return np.asarray(read_array(scale), dtype=np.float64)

    def _check(self, name: str) -> None:
        if name not in self.shapes:
            raise InputError(f'there is no variable "{name}"; there are {", ".join(self.shapes)}')


def study_doubts(dataset: Path) -> list[StudyDoubt]:
    """Return the limits of the theory that drops of a study exceed, most frequent first.

    Parameters
    ----------
    dataset : Path
        The `study.nc` of the study; the result is empty for one of a version that stored no limits.
    """
    with h5py.File(dataset, "r") as file:
        if DOUBTS not in file:
            return []
        # each bit of the flags of a drop stands for a limit
        flags = read_array(file[DOUBTS]).ravel()
        masks = file[DOUBTS].attrs["flag_masks"]
        limits = str(file[DOUBTS].attrs["flag_meanings"]).split()
        doubts = []
        for mask, limit in zip(masks, limits, strict=True):
            exceeds = (flags & mask) != 0
            if exceeds.any():
                numbers = read_array(file[f"{LIMIT}{limit}"]).ravel()
                # numbers of other drops may be NaN, which would be the largest
                worst = int(np.argmax(np.where(exceeds, numbers, -np.inf)))
                doubts.append(StudyDoubt(limit, int(exceeds.sum()), worst, float(numbers[worst])))
    return sorted(doubts, key=lambda doubt: -doubt.drops)


def load_study(directory: str | PathLike[str]) -> Study:
    """Return a completed study from its folder; the variables are read later.

    Parameters
    ----------
    directory : path
        The folder of the study.

    Raises
    ------
    InputError
        If there is no completed study, or its dataset is damaged.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type1-theory").to_problem().source
    >>> sweep = vi.studies.sweep_of(
    ...     {**case, "sweep": {"over": {"contact.restitution": [0.5, 0.7]}}}
    ... )
    >>> with TemporaryDirectory() as folder:
    ...     study = vi.studies.load_study(vi.studies.run_sweep(sweep, f"{folder}/restitutions"))
    ...     study.size, study.coordinates["contact.restitution"].tolist()
    (2, [0.5, 0.7])
    """
    folder = Path(directory)
    path = folder / DATASET
    recover_study(path.parent)
    if not path.is_file():
        raise InputError(_why_no_dataset(folder))
    with _reported_damage(path):
        check_hdf5(path, recorded_digest(path))
    with _reported_damage(path), h5py.File(path, "r") as file:
        return _study_in(file, path)


def _why_no_dataset(folder: Path) -> str:
    """Return why a folder holds no completed study, and what to do."""
    if not (folder / STUDY).is_file():
        return f"{folder}: this is not the folder of a study; it has no {DATASET}"
    command = (
        f"vibroimpact sweep {shlex.quote(str(folder / STUDY))} -o "
        f"{shlex.quote(str(folder))} --resume"
    )
    return f"{folder}: the study is not done; if nothing is at work on it, go on with: {command}"


def _study_in(file: h5py.File, path: Path) -> Study:
    """Return the study in an open dataset, after checking its variables."""
    variables = members(file)
    table = parse_toml(str(file.attrs["study"]))
    keys = swept_keys(table)
    coordinates = {key: _coordinate(file[key]) for key in keys}
    if _design(table) == "grid":
        dimensions = {key: len(coordinates[key]) for key in keys}
    else:
        dimensions = {SAMPLE: len(file[SAMPLE])}
    labels = {}
    if table["sweep"].get("classes"):
        labels = {label: _label(file[label]) for label in LABELS if label in file}

    not_results = {*keys, *labels, FAILED_REASON}
    results = {
        name: variable
        for name, variable in variables.items()
        if not variable.is_scale and name not in not_results
    }
    _check_variables(results, tuple(dimensions.values()))
    meanings = {}
    for name in (*keys, *labels, *results):
        attributes = file[name].attrs
        meanings[name] = (str(attributes["units"]), str(attributes["long_name"]))
    reasons = [reason.decode() for reason in read_array(file[FAILED_REASON])]
    return Study(
        path=path,
        name=str(file.attrs["title"]),
        table=table,
        version=str(file.attrs["version"]),
        dimensions=dimensions,
        coordinates=coordinates,
        meanings=meanings,
        shapes={name: tuple(variable.shape) for name, variable in results.items()},
        failures=dict(zip(read_array(file[FAILED_POINT]).tolist(), reasons, strict=True)),
        labels=labels,
    )


def _check_variables(variables: dict[str, h5py.Dataset], points: tuple[int, ...]) -> None:
    """Check that the results of a study are numbers, with one entry for every drop.

    Raises
    ------
    DamageError
        If one is not.
    """
    for name, variable in variables.items():
        if variable.dtype.kind not in "fiub":
            raise DamageError(f"{name} is no variable of real numbers")
        if name != FAILED_POINT and variable.shape[: len(points)] != points:
            raise DamageError(
                f"{name} is of the shape {variable.shape}, which does not begin with {points}"
            )


@contextmanager
def _reported_damage(path: Path) -> Iterator[None]:
    """Report read errors of a dataset as damage, with the command to compute it again."""
    try:
        yield
    except InputError:
        raise
    except Exception as error:  # damage raises errors of many types
        if isinstance(error, DamageError):
            damage = str(error)
        else:
            damage = f"the file is damaged: {short_reason(error)}"
        folder = shlex.quote(str(path.parent))
        command = f"vibroimpact sweep {shlex.quote(str(path.parent / STUDY))} -o {folder} --force"
        raise InputError(f"{path}: {damage}; make it anew with: {command}") from None


def _design(table: dict[str, Any]) -> str:
    return str(table["sweep"].get("design", "grid"))


def _label(variable: h5py.Dataset) -> NDArray[Any]:
    """Return a label of each fall: a name, or a number."""
    codes = read_array(variable)
    names = str(variable.attrs.get("flag_meanings", "")).split()
    if not names:
        return np.asarray(codes)
    return np.asarray(np.array(names, dtype=object)[codes])


def _coordinate(variable: h5py.Dataset) -> NDArray[Any]:
    """Return the values of a coordinate, numbers or strings."""
    values = read_array(variable)
    if values.ndim != 1 or not len(values) or values.dtype.kind not in "fiubO":
        raise DamageError(f"{variable.name.lstrip('/')} is no row of numbers or texts")
    if values.dtype == object:
        return np.array([text.decode() for text in values], dtype=object)
    if not np.isfinite(values).all():
        raise DamageError(f"{variable.name.lstrip('/')} has values that are not finite")
    return np.asarray(values)
