"""Compute the drops at some points of a study.

Drops of rigid bodies are computed in vectorized batches, those of deformable ones in small groups.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Drops
from vibroimpact.cases.case import Case
from vibroimpact.cases.rigid.oblique import is_oblique
from vibroimpact.cases.rigid.rigid_problem import deforms, rigid_problem
from vibroimpact.dynamics.first_touch import first_touch
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.sensors.instruments.sensor import sample_count
from vibroimpact.dynamics.simulate import simulate_together
from vibroimpact.dynamics.statement.outcome import Outcome
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.tabulate import tabulate
from vibroimpact.errors import ComputationError, InputError, lines_of
from vibroimpact.studies.computation.chunk_file import ChunkResult
from vibroimpact.studies.planning.axes import Values
from vibroimpact.studies.planning.drop_variables import (
    FIRST,
    LARGEST,
    OUTCOME,
    SENSOR_PEAK,
    SIGNAL,
    SIGNAL_START,
    TOTAL,
)
from vibroimpact.studies.planning.limit_columns import (
    batch_conditions,
    drop_conditions,
    limit_columns,
)
from vibroimpact.studies.planning.swept_keys import case_at, is_array_key, with_arrays
from vibroimpact.studies.planning.window import Window

_GROUP_SIZE = 32
"""Number of drops with individual bodies that are computed together.

It is enough for efficiency, and few enough for their histories to fit in memory.
"""


class _Chunk(NamedTuple):
    """A case, the kept results, and the points of a chunk."""

    table: Mapping[str, Any]
    keep: tuple[str, ...]
    first: int
    points: Mapping[str, Values]
    window: Window | None

    def case(self, drop: np.intp | int) -> Case:
        """Return the case of the drop at an index in the chunk."""
        return case_at(self.table, {key: column[drop] for key, column in self.points.items()})


class _DropResults(NamedTuple):
    """The results of the drops at some indices of a chunk."""

    drops: Drops
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
    >>> result = compute_points(
    ...     load_table("paper:type1-theory"), ("impacts",), 0, {"drop.height": np.array([2.0, 4.0])}
    ... )
    >>> result.arrays["max_force_N"].shape
    (2, 5)
    """
    from threadpoolctl import threadpool_limits  # imported late: it inspects all loaded libraries

    chunk = _Chunk(table, keep, first, points, window)
    results: list[_DropResults] = []
    # small matrix products gain nothing from threads, and results must not depend on their number
    with threadpool_limits(1):
        for drops in _vectorizable_groups(points):
            results.extend(_compute_group(chunk, drops))
    count = len(next(iter(points.values())))
    failures: dict[int, str] = {}
    for result in results:
        failures |= result.failures
    return ChunkResult(_gathered(results, count), dict(sorted(failures.items())))


def _vectorizable_groups(points: Mapping[str, Values]) -> Iterator[Drops]:
    """Yield the indices of drops that differ only in numbers that can be vectorized."""
    other_columns = [values for key, values in points.items() if not is_array_key(key, values)]
    count = len(next(iter(points.values())))
    if not other_columns:
        yield np.arange(count)
        return
    groups: dict[str, list[int]] = {}
    for drop in range(count):
        # by text, as values may be tables, which can't be keys of a mapping
        group = repr([values[drop] for values in other_columns])
        groups.setdefault(group, []).append(drop)
    for drops in groups.values():
        yield np.array(drops)


def _compute_group(chunk: _Chunk, drops: Drops) -> Iterator[_DropResults]:
    """Compute a group of drops that differ only in numbers that can be vectorized."""
    # the first drop with a valid case stands for the group; those before it fail singly
    while drops.size:
        try:
            case = chunk.case(drops[0])
            break
        except InputError:
            yield _compute_alone(chunk, drops[0])
            drops = drops[1:]
    else:
        return
    arrays = {
        key: values[drops] for key, values in chunk.points.items() if is_array_key(key, values)
    }
    if not _is_vectorizable(case, arrays):
        yield from _compute_in_groups(chunk, drops)
        return
    height: Any = arrays.get("drop.height", case.drop.height)
    # drops that would start inside the plate are computed singly, and fail there
    if height is not None:
        radius = arrays.get("sphere.radius", case.sphere.radius)
        above = np.broadcast_to(height > radius, drops.shape)
        for drop in drops[~above]:
            yield _compute_alone(chunk, drop)
        drops = drops[above]
        arrays = {key: values[above] for key, values in arrays.items()}
    try:
        problem = rigid_problem(with_arrays(case, arrays))
        table = tabulate(problem)
    except Exception:  # of one of them, or of a law of another package: only that one shall fail
        for drop in drops:
            yield _compute_alone(chunk, drop)
        return
    columns = _columns(table, chunk.keep)
    failures = table.failures
    # the swept values, such as the thickness of a rigid plate, have no effect: one drop represents
    # all
    if len(table) < drops.size:
        columns = {name: np.repeat(values, drops.size, axis=0) for name, values in columns.items()}
        failures = {drop: reason for reason in failures.values() for drop in range(drops.size)}
    columns |= limit_columns(batch_conditions(case, arrays, problem.laws[0], columns), drops.size)
    # failed drops have no results
    failed = np.zeros(drops.size, dtype=bool)
    failed[list(failures)] = True
    yield _DropResults(
        drops[~failed],
        {name: values[~failed] for name, values in columns.items()},
        {int(drops[row]): reason for row, reason in failures.items()},
    )


def _is_vectorizable(case: Case, arrays: Mapping[str, Values]) -> bool:
    """Return whether drops with arrays at some keys can be computed as one batch.

    They can unless something deforms, the plate is moved, or a sphere may fall off its edge.
    """
    sweeps_size = any(key.startswith("plate.size.") for key in arrays)
    if sweeps_size and is_oblique(with_arrays(case, arrays)):
        return False
    return bool(arrays) and not deforms(case) and case.plate.motion is None


def _compute_alone(chunk: _Chunk, drop: np.intp) -> _DropResults:
    """Compute a single drop."""
    return next(_compute_in_groups(chunk, np.array([drop])))


def _compute_in_groups(chunk: _Chunk, drops: Drops) -> Iterator[_DropResults]:
    """Compute drops with individual bodies in small groups.

    An error of one drop becomes its reason and does not affect the others.
    """
    for start in range(0, len(drops), _GROUP_SIZE):
        cases: dict[int, Case] = {}
        problems: dict[int, Problem] = {}
        for drop in drops[start : start + _GROUP_SIZE].tolist():
            try:
                cases[drop] = chunk.case(drop)
            except Exception as error:
                yield _failed(drop, error)
        if any(map(deforms, cases.values())):
            # imports the finite-element code
            from vibroimpact.cases.elastic.shared_statics import solve_together

            solve_together(cases.values())
        for drop, case in cases.items():
            try:
                problem = case.to_problem()
                sensors = tuple(sensor.of_drop(chunk.first + drop) for sensor in problem.sensors)
                problems[drop] = replace(problem, sensors=sensors, duration=_end(chunk, problem))
            except Exception as error:
                yield _failed(drop, error)
        responses = simulate_together(list(problems.values()))
        for drop, response in zip(problems, responses, strict=True):
            if isinstance(response, Exception):
                yield _failed(drop, response)
                continue
            try:
                yield _kept_results(chunk, drop, response)
            except Exception as error:
                yield _failed(drop, error)


def _end(chunk: _Chunk, problem: Problem) -> float | None:
    """Return when the run of a drop ends [s]: at the latest with the window of its signals."""
    if chunk.window is None or problem.duration is None:
        return problem.duration
    window_end = first_touch(problem) - chunk.window.before + chunk.window.length
    return min(problem.duration, window_end)


def _failed(drop: int, error: Exception) -> _DropResults:
    """Return the results of a drop that failed: none, and the reason in one line."""
    is_own = isinstance(error, (InputError, ComputationError))
    name = "" if is_own else f"{type(error).__name__}: "
    reason = "; ".join(lines_of(f"{name}{error}".split("\n")))
    return _DropResults(np.array([drop]), {}, {drop: reason})


def _kept_results(chunk: _Chunk, drop: int, response: Response) -> _DropResults:
    """Return the kept results of one drop."""
    columns = _columns(response, chunk.keep)
    if response.problem.vibrates:
        columns["left_in_vibration_J"] = response.rest.left
    columns |= limit_columns(drop_conditions(response, columns), 1)
    if "signals" in chunk.keep:
        columns |= _signal_columns(chunk, response)
    return _DropResults(np.array([drop]), columns, {})


def _signal_columns(chunk: _Chunk, response: Response) -> dict[str, NDArray[Any]]:
    """Return the signals of one drop, their largest magnitudes, and where their windows start."""
    columns: dict[str, NDArray[Any]] = {}
    # required by the study if signals are kept
    duration = response.problem.duration or 0.0
    for name, signal in response.signals().items():
        rate = signal.sensor.rate
        expected_samples = sample_count(duration, rate)
        # a signal is longer where a contact in progress at that time was completed
        value = signal.value[:expected_samples]
        if chunk.window is not None:
            begin, end = chunk.window.samples(
                response.impacts["time_s"], rate, len(value), ended=len(value) < expected_samples
            )
            value = value[begin:end]
            columns[f"{name}{SIGNAL_START}"] = np.array([begin / rate])
        columns[f"{SIGNAL}{name}"] = value.astype(np.float32)[None]
        columns[f"{name}{SENSOR_PEAK}"] = np.array([np.abs(value).max()])
    return columns


def _columns(response: Response, keep: tuple[str, ...]) -> dict[str, NDArray[Any]]:
    """Return peaks, outcomes, and if kept the impact table of the drops of a response.

    Columns of the impact table are of shape (drops, impacts), with NaN after the last impact.
    """
    impacts = {name: np.atleast_2d(values) for name, values in response.impacts.items()}
    happened = np.isfinite(impacts["impact"])
    columns: dict[str, NDArray[Any]] = {
        "number_of_impacts": happened.sum(axis=1).astype(float),
        "end_time_s": response.end_time,
    }
    for peak, name in TOTAL.items():
        columns[peak] = np.nansum(impacts[name], axis=1)
    columns["closure_relative"] = np.atleast_1d(response.energy["closure_relative"])
    columns[OUTCOME] = np.array([outcome.code for outcome in response.outcomes], dtype=np.int8)
    for peak, name in FIRST.items():
        if name in impacts:
            columns[peak] = np.full(len(response), np.nan)
            if impacts[name].size:
                columns[peak] = impacts[name][:, 0]
    for peak, name in LARGEST.items():
        # fmax ignores NaN without a warning for drops that have no impact
        columns[peak] = np.fmax.reduce(impacts[name], axis=1, initial=np.nan)
    if "impacts" in keep:
        columns |= {name: values for name, values in impacts.items() if name != "impact"}
    return columns


def _gathered(results: list[_DropResults], count: int) -> dict[str, NDArray[Any]]:
    """Return the arrays of all drops of a chunk in order.

    Missing values are NaN or 0, and the outcome of failed drops is FAILED.
    """
    gathered: dict[str, NDArray[Any]] = {
        OUTCOME: np.full(count, Outcome.FAILED.code, dtype=np.int8)
    }
    for result in results:
        for name, values in result.arrays.items():
            if name not in gathered:
                fill_value = np.nan if values.dtype.kind == "f" else 0
                shape = (count, *_widest(results, name))
                gathered[name] = np.full(shape, fill_value, dtype=values.dtype)
            own_lengths = [slice(length) for length in values.shape[1:]]
            index: Any = (result.drops, *own_lengths)
            gathered[name][index] = values
    return gathered


def _widest(results: list[_DropResults], name: str) -> list[int]:
    """Return the shape that holds an array of each drop.

    Drops may differ in the number of impacts and of samples.
    """
    shapes = [result.arrays[name].shape[1:] for result in results if name in result.arrays]
    return [max(lengths) for lengths in zip(*shapes, strict=True)]
