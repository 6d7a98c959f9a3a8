"""Compute the drops at some points of a study: rigid bodies in vectorized batches,
deformable ones in small groups.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Indices
from vibroimpact.cases.case import Case
from vibroimpact.cases.oblique import is_oblique
from vibroimpact.cases.rigid_problem import deforms, rigid_problem
from vibroimpact.dynamics.first_touch import first_touch
from vibroimpact.dynamics.outcome import Outcome
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.sensors.sensor import sample_count
from vibroimpact.dynamics.simulate import simulate_together
from vibroimpact.dynamics.tabulate import tabulate
from vibroimpact.errors import ComputationError, InputError, lines_of
from vibroimpact.studies.axes import Values
from vibroimpact.studies.chunk_file import ChunkResult
from vibroimpact.studies.drop_variables import (
    FIRST,
    LARGEST,
    OUTCOME,
    SENSOR_PEAK,
    SIGNAL,
    SIGNAL_START,
    TOTAL,
)
from vibroimpact.studies.limit_columns import batch_conditions, drop_conditions, limit_columns
from vibroimpact.studies.swept_keys import case_at, is_array_key, with_arrays
from vibroimpact.studies.window import Window

_TOGETHER = 32
"""Drops with individual bodies that are computed together: enough for efficiency, few
enough for their histories to fit in memory.
"""


class _Study(NamedTuple):
    """A case, the kept results, and the points of a chunk."""

    table: Mapping[str, Any]
    keep: tuple[str, ...]
    first: int
    points: Mapping[str, Values]
    window: Window | None

    def case(self, place: np.intp | int) -> Case:
        """Return the case of the drop at an index in the chunk."""
        return case_at(self.table, {key: column[place] for key, column in self.points.items()})


class _Part(NamedTuple):
    """The results of the drops at some indices of a chunk."""

    places: Indices
    arrays: dict[str, NDArray[Any]]
    failures: dict[int, str]


def compute_points(
    table: Mapping[str, Any],
    keep: tuple[str, ...],
    first: int,
    points: Mapping[str, Values],
    window: Window | None = None,
) -> ChunkResult:
    """Return the results of the drops at some points of a study.

    Parameters
    ----------
    table : mapping
        The case, with the structure of a TOML case file.
    keep : tuple of str
        The kept results besides the peaks: "impacts", "signals".
    first : int
        Number in the study of the first of the drops; the numbers seed the noise of the sensors.
    points : mapping of str to array
        The values of the drops by swept key.
    window : Window, optional
        The part of the signals that is kept; by default all.

    Returns
    -------
    ChunkResult
        Columns of the impact table (drops, impacts), peaks (drops,) and signals (drops, samples),
        and the reasons of failed drops, which do not affect the others.

    Examples
    --------
    >>> from vibroimpact.cases.reader import load_table
    >>> found = compute_points(
    ...     load_table("paper:type1-theory"), ("impacts",), 0, {"drop.height": np.array([2.0, 4.0])}
    ... )
    >>> found.arrays["max_force_N"].shape
    (2, 5)
    """
    from threadpoolctl import threadpool_limits  # imported late: it inspects all loaded libraries

    study = _Study(table, keep, first, points, window)
    # small matrix products gain nothing from threads, and results must not depend on their number
    with threadpool_limits(1):
        parts = [part for places in _alike(points) for part in _parts(study, places)]
    count = len(next(iter(points.values())))
    failures = {place: part.failures[place] for part in parts for place in part.failures}
    return ChunkResult(_gathered(parts, count), dict(sorted(failures.items())))


def _alike(points: Mapping[str, Values]) -> Iterator[Indices]:
    """Yield the indices of drops that differ only in numbers that can be vectorized."""
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
    """Compute a group of drops that differ only in numbers that can be vectorized."""
    while places.size:
        try:
            case = study.case(places[0])
            break
        except InputError:
            yield _alone(study, places[0])
            places = places[1:]
    else:
        return
    arrays = {
        key: values[places] for key, values in study.points.items() if is_array_key(key, values)
    }
    off_the_edge = any(key.startswith("plate.size.") for key in arrays) and is_oblique(
        with_arrays(case, arrays)
    )
    if deforms(case) or off_the_edge or case.plate.motion is not None or not arrays:
        yield from _side_by_side(study, places)
        return
    height: Any = arrays.get("drop.height", case.drop.height)
    # drops that would start inside the plate are computed singly, and fail there
    if height is not None:
        above = np.broadcast_to(
            height > arrays.get("sphere.radius", case.sphere.radius), places.shape
        )
        yield from (_alone(study, place) for place in places[~above])
        places, arrays = places[above], {key: values[above] for key, values in arrays.items()}
    try:
        problem = rigid_problem(with_arrays(case, arrays))
        table = tabulate(problem)
    except InputError:  # caused by one of them: compute all singly, so that only that one fails
        yield from (_alone(study, place) for place in places)
        return
    columns, failures = _columns(table, study.keep), table.failures
    # the swept values, such as the thickness of a rigid plate, have no effect: one drop represents
    # all
    if len(table) < places.size:
        columns = {name: np.repeat(values, places.size, axis=0) for name, values in columns.items()}
        failures = {drop: reason for reason in failures.values() for drop in range(places.size)}
    columns |= limit_columns(batch_conditions(case, arrays, problem.laws[0], columns), places.size)
    failed = np.zeros(places.size, dtype=bool)
    failed[list(failures)] = True
    # failed drops have no results
    columns = {name: values[~failed] for name, values in columns.items()}
    yield _Part(
        places[~failed], columns, {int(places[drop]): reason for drop, reason in failures.items()}
    )


def _alone(study: _Study, place: np.intp) -> _Part:
    """Compute a single drop."""
    return next(_side_by_side(study, np.array([place])))


def _side_by_side(study: _Study, places: Indices) -> Iterator[_Part]:
    """Compute drops with individual bodies in small groups; an error of one drop becomes
    its reason and does not affect the others.
    """
    for begin in range(0, len(places), _TOGETHER):
        cases, problems = {}, {}
        for place in places[begin : begin + _TOGETHER].tolist():
            try:
                cases[place] = study.case(place)
            except Exception as error:
                yield _failed(place, error)
        if any(map(deforms, cases.values())):
            # imports the finite-element code
            from vibroimpact.cases.elastic.shared_statics import solve_together

            solve_together(cases.values())
        for place, case in cases.items():
            try:
                problem = case.to_problem()
                noisy = tuple(sensor.of_drop(study.first + place) for sensor in problem.sensors)
                problems[place] = replace(problem, sensors=noisy, duration=_end(study, problem))
            except Exception as error:
                yield _failed(place, error)
        for place, response in zip(
            problems, simulate_together(list(problems.values())), strict=True
        ):
            try:
                yield (
                    _failed(place, response)
                    if isinstance(response, Exception)
                    else _part_of(study, place, response)
                )
            except Exception as error:
                yield _failed(place, error)


def _end(study: _Study, problem: Problem) -> float | None:
    """Return when the run of a drop ends [s]: at the latest with the window of its signals."""
    if study.window is None or problem.duration is None:
        return problem.duration
    return min(problem.duration, first_touch(problem) - study.window.before + study.window.length)


def _failed(place: int, error: Exception) -> _Part:
    name = "" if isinstance(error, (InputError, ComputationError)) else f"{type(error).__name__}: "
    return _Part(np.array([place]), {}, {place: "; ".join(lines_of(f"{name}{error}".split("\n")))})


def _part_of(study: _Study, place: int, response: Response) -> _Part:
    """Return the kept results of one drop."""
    problem, signals = response.problem, {}
    if "signals" in study.keep:
        # required by the study if signals are kept; a contact in progress at that time was
        # completed
        duration = problem.duration or 0.0
        for name, signal in response.signals().items():
            rate = signal.sensor.rate
            asked = sample_count(duration, rate)
            value = signal.value[:asked]
            if study.window is not None:
                begin, end = study.window.samples(
                    response.impacts["time_s"], rate, len(value), ended=len(value) < asked
                )
                value, signals[f"{name}{SIGNAL_START}"] = value[begin:end], np.array([begin / rate])
            signals[f"{SIGNAL}{name}"] = value.astype(np.float32)[None]
            signals[f"{name}{SENSOR_PEAK}"] = np.array([np.abs(value).max()])
    columns = _columns(response, study.keep)
    if problem.vibrates:
        columns["left_in_vibration_J"] = response.rest.left
    columns |= limit_columns(drop_conditions(response, columns), 1)
    return _Part(np.array([place]), {**columns, **signals}, {})


def _columns(response: Response, keep: tuple[str, ...]) -> dict[str, NDArray[Any]]:
    """Return peaks, outcomes, and if kept the impact table of the drops of a response."""
    impacts = {name: np.atleast_2d(values) for name, values in response.impacts.items()}
    firsts = {peak: impacts[name] for peak, name in FIRST.items() if name in impacts}
    first = {
        peak: values[:, 0] if values.size else np.full(len(response), np.nan)
        for peak, values in firsts.items()
    }
    peaks = {
        "number_of_impacts": np.isfinite(impacts["impact"]).sum(axis=1).astype(float),
        "end_time_s": response.end_time,
        **{peak: np.nansum(impacts[name], axis=1) for peak, name in TOTAL.items()},
        "closure_relative": np.atleast_1d(response.energy["closure_relative"]),
        OUTCOME: np.array([outcome.code for outcome in response.outcomes], dtype=np.int8),
        **first,
        **{
            peak: np.fmax.reduce(impacts[name], axis=1, initial=np.nan)
            for peak, name in LARGEST.items()
        },
    }
    kept = (
        {name: values for name, values in impacts.items() if name != "impact"}
        if "impacts" in keep
        else {}
    )
    return {**peaks, **kept}


def _gathered(parts: list[_Part], count: int) -> dict[str, NDArray[Any]]:
    """Return the arrays of all drops of a chunk in order; missing values are NaN or 0,
    and the outcome of failed drops is FAILED.
    """
    found: dict[str, NDArray[Any]] = {OUTCOME: np.full(count, Outcome.FAILED.code, dtype=np.int8)}
    for part in parts:
        for name, values in part.arrays.items():
            if name not in found:
                widest = np.max(
                    [other.arrays[name].shape[1:] for other in parts if name in other.arrays],
                    axis=0,
                )
                found[name] = np.full(
                    (count, *widest.astype(int)),
                    np.nan if values.dtype.kind == "f" else 0,
                    dtype=values.dtype,
                )
            place: Any = (part.places, *(slice(length) for length in values.shape[1:]))
            found[name][place] = values
    return found
