"""The work of a study: the drops at some of its points, those with rigid bodies as arrays, the others side by side."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Indices
from vibroimpact.cases.case import Case
from vibroimpact.cases.rigid import deforms, rigid_problem
from vibroimpact.dynamics.outcome import Outcome
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.sensors.sensor import Sensor, sample_count
from vibroimpact.dynamics.simulate import simulate_together
from vibroimpact.dynamics.tabulate import ImpactTable, tabulate
from vibroimpact.errors import ComputationError, InputError, lines_of
from vibroimpact.studies.axes import Values
from vibroimpact.studies.chunk_file import ChunkResult
from vibroimpact.studies.drop_variables import FIRST, LARGEST, OUTCOME, SENSOR_PEAK, SIGNAL
from vibroimpact.studies.limit_columns import batch_conditions, drop_conditions, limit_columns
from vibroimpact.studies.swept_keys import case_at, is_array_key, with_arrays

_TOGETHER = 16
"""Drops with bodies of their own that are computed at once: enough to pay, and few enough for their histories to lie in memory."""


class _Study(NamedTuple):
    """A case, what is kept of it, and the points of a chunk."""

    table: Mapping[str, Any]
    keep: tuple[str, ...]
    first: int
    points: Mapping[str, Values]

    def case(self, place: np.intp | int) -> Case:
        """Return the case of the drop at a place in the chunk."""
        return case_at(self.table, {key: column[place] for key, column in self.points.items()})


class _Part(NamedTuple):
    """What came of the drops at some places of a chunk."""

    places: Indices
    arrays: dict[str, NDArray[Any]]
    failures: dict[int, str]


def compute_points(table: Mapping[str, Any], keep: tuple[str, ...], first: int, points: Mapping[str, Values]) -> ChunkResult:
    """Compute the drops at some points of a study.

    Parameters
    ----------
    table : mapping
        The case, as a TOML file would hold it.
    keep : tuple of str
        What is kept of each drop: "impacts", "signals"; its peaks always are.
    first : int
        The number of the first of the drops in the study: the noise of their sensors is drawn from their numbers.
    points : mapping of str to array
        The values of each drop at the keys that are swept.

    Returns
    -------
    ChunkResult
        With the columns of the impact table (drops, impacts), the peaks (drops,), and the signals (drops, samples). A drop that
        failed has its reason, and the others go on.

    Examples
    --------
    >>> from vibroimpact.cases.reader import load_table
    >>> found = compute_points(load_table("paper:type1-theory"), ("impacts",), 0, {"drop.height": np.array([2.0, 4.0])})
    >>> found.arrays["max_force_N"].shape
    (2, 5)
    """
    from threadpoolctl import threadpool_limits  # which looks at all libraries that are loaded

    study = _Study(table, keep, first, points)
    with threadpool_limits(1):  # many small products gain nothing from threads, and their number must not change a digit
        parts = [part for places in _alike(points) for part in _parts(study, places)]
    count = len(next(iter(points.values())))
    failures = {place: part.failures[place] for part in parts for place in part.failures}
    return ChunkResult(_gathered(parts, count), dict(sorted(failures.items())))


def _alike(points: Mapping[str, Values]) -> Iterator[Indices]:
    """Yield the places of drops that differ in nothing but numbers that may run as arrays."""
    others = [values for key, values in points.items() if not is_array_key(key, values)]
    count = len(next(iter(points.values())))
    if not others:
        yield np.arange(count)
        return
    groups: dict[str, list[int]] = {}
    for place in range(count):
        groups.setdefault(repr([values[place] for values in others]), []).append(place)
    yield from (np.array(places) for places in groups.values())


def _parts(study: _Study, places: Indices) -> Iterator[_Part]:
    """Compute the drops at places that are alike."""
    while places.size:
        try:
            case = study.case(places[0])
            break
        except InputError:
            yield _alone(study, places[0])
            places = places[1:]
    else:
        return
    arrays = {key: values[places] for key, values in study.points.items() if is_array_key(key, values)}
    if deforms(case) or not arrays:
        yield from _side_by_side(study, places)
        return
    height: Any = arrays.get("drop.height", case.drop.height)
    if height is not None:  # those that would begin inside the plate fail by themselves
        above = np.broadcast_to(height > arrays.get("sphere.radius", case.sphere.radius), places.shape)
        yield from (_alone(study, place) for place in places[~above])
        places, arrays = places[above], {key: values[above] for key, values in arrays.items()}
    try:
        problem = rigid_problem(with_arrays(case, arrays))
        table = tabulate(problem)
    except InputError:  # of one of them: the others must not suffer
        yield from (_alone(study, place) for place in places)
        return
    columns, failures = _columns(table, study.keep), table.failures
    if len(table) < places.size:  # what is swept has no effect on rigid bodies, such as the plate's thickness: it is one drop for all
        columns = {name: np.repeat(values, places.size, axis=0) for name, values in columns.items()}
        failures = {drop: reason for reason in failures.values() for drop in range(places.size)}
    columns |= limit_columns(batch_conditions(case, arrays, problem.laws[0], columns), places.size)
    failed = np.zeros(places.size, dtype=bool)
    failed[list(failures)] = True
    columns = {name: values[~failed] for name, values in columns.items()}  # nothing that failed is a result
    yield _Part(places[~failed], columns, {int(places[drop]): reason for drop, reason in failures.items()})


def _alone(study: _Study, place: np.intp) -> _Part:
    """Compute one drop by itself."""
    return next(_side_by_side(study, np.array([place])))


def _side_by_side(study: _Study, places: Indices) -> Iterator[_Part]:
    """Compute drops that each have bodies of their own, some at once; whatever fails one of them is its reason, and the others go on."""
    for begin in range(0, len(places), _TOGETHER):
        some, problems = places[begin : begin + _TOGETHER], {}
        for place in some.tolist():
            try:
                problem = study.case(place).to_problem()
                noisy = tuple(_noise(sensor, study.first + place) for sensor in problem.sensors)
                problems[place] = replace(problem, sensors=noisy)
            except Exception as error:
                yield _failed(place, error)
        for place, response in zip(problems, simulate_together(list(problems.values())), strict=True):
            try:
                yield _failed(place, response) if isinstance(response, Exception) else _part_of(study, place, response)
            except Exception as error:
                yield _failed(place, error)


def _failed(place: int, error: Exception) -> _Part:
    name = "" if isinstance(error, (InputError, ComputationError)) else f"{type(error).__name__}: "
    return _Part(np.array([place]), {}, {place: "; ".join(lines_of(f"{name}{error}".split("\n")))})


def _part_of(study: _Study, place: int, response: Response) -> _Part:
    """Return what is kept of one drop."""
    problem, signals = response.problem, {}
    if "signals" in study.keep:
        duration = problem.duration or 0.0  # the study has seen to it; a contact under way at its end was finished
        for name, signal in response.signals().items():
            signals[f"{SIGNAL}{name}"] = signal.value[: sample_count(duration, signal.sensor.rate)].astype(np.float32)[None]
            signals[f"{name}{SENSOR_PEAK}"] = np.array([np.abs(signal.value).max()])
    columns = _columns(response, study.keep)
    if problem.vibrates:
        columns["left_in_vibration_J"] = response.rest.left
    columns |= limit_columns(drop_conditions(response, columns), 1)
    return _Part(np.array([place]), {**columns, **signals}, {})


def _noise(sensor: Sensor, number: int) -> Sensor:
    """Return a sensor whose noise is that of one drop alone."""
    meter = sensor.accelerometer
    if meter is None:
        return sensor
    seed = meter.seed if isinstance(meter.seed, tuple) else (meter.seed,)
    return replace(sensor, accelerometer=replace(meter, seed=(*seed, number)))


def _columns(response: Response | ImpactTable, keep: tuple[str, ...]) -> dict[str, NDArray[Any]]:
    """Return impact table and peaks of the drops of a response."""
    impacts = {name: np.atleast_2d(values) for name, values in response.impacts.items()}
    first = {peak: impacts[name][:, 0] if impacts[name].size else np.full(len(response), np.nan) for peak, name in FIRST.items()}
    peaks = {
        "number_of_impacts": np.isfinite(impacts["impact"]).sum(axis=1).astype(float),
        "end_time_s": response.end_time,
        "total_energy_lost_J": np.nansum(impacts["energy_lost_J"], axis=1),
        "closure_relative": np.atleast_1d(response.energy["closure_relative"]),
        OUTCOME: np.array([outcome.code for outcome in response.outcomes], dtype=np.int8),
        **first,
        **{peak: np.fmax.reduce(impacts[name], axis=1, initial=np.nan) for peak, name in LARGEST.items()},
    }
    kept = {name: values for name, values in impacts.items() if name != "impact"} if "impacts" in keep else {}
    return {**peaks, **kept}


def _gathered(parts: list[_Part], count: int) -> dict[str, NDArray[Any]]:
    """Return the arrays of all drops of a chunk in order; what a drop does not have is NaN, and a failed drop is one that failed."""
    found: dict[str, NDArray[Any]] = {OUTCOME: np.full(count, Outcome.FAILED.code, dtype=np.int8)}
    for part in parts:
        for name, values in part.arrays.items():
            if name not in found:
                widest = np.max([other.arrays[name].shape[1:] for other in parts if name in other.arrays], axis=0)
                found[name] = np.full((count, *widest.astype(int)), np.nan if values.dtype.kind == "f" else 0, dtype=values.dtype)
            place: Any = (part.places, *(slice(length) for length in values.shape[1:]))
            found[name][place] = values
    return found
