"""Data drawn by the figures of a run: selected contacts, time windows of the history, and min-max decimated lines."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.report.style import ENLARGED
from vibroimpact.results.result import Result

MARGIN = 0.15
"""Time shown before first touch and after release of an enlarged contact, relative to its duration."""

_COLUMNS = 1500
"""Number of columns into which a long line is divided: more than the resolution of a figure."""

_AT_ONCE = 2**17  # points sorted at once, which bounds the memory of the sort


def contacts_with_duration(result: Result) -> Indices:
    """Return the indices of the impacts with a finite contact duration, counted from 0; empty for an instantaneous law."""
    found: Indices = np.flatnonzero(result.impacts["duration_s"] > 0.0)
    return found


def enlarged_contacts(result: Result) -> Indices:
    """Return the indices of the contacts drawn enlarged, counted from 0: the first five shorter than half of the run."""
    span = result.history["time_s"][-1] - result.history["time_s"][0]
    found = contacts_with_duration(result)
    short: Indices = found[result.impacts["duration_s"][found] < 0.5 * span]
    return short[:ENLARGED]


def history_around(result: Result, impact: int) -> dict[str, Floats]:
    """Return the history from shortly before to shortly after a contact, with time counted from first touch [s]."""
    touch, duration = result.impacts["time_s"][impact], result.impacts["duration_s"][impact]
    part = history_window(result.history, touch - MARGIN * duration, touch + (1.0 + MARGIN) * duration)
    return {**part, "time_s": part["time_s"] - touch}


def contact_history(result: Result, impact: int) -> dict[str, Floats]:
    """Return the history of a contact from first touch to release, as drawn over indentation.

    At each end the history has a point in flight as well, which shows the jump of the force but has zero indentation. It is left out
    where contact begins or ends at another indentation: in a permanent dent, or with an adhesive neck. The rest of a sphere that stays
    is left out too.
    """
    touch = result.impacts["time_s"][impact]
    part = history_window(result.history, touch, touch + result.impacts["duration_s"][impact])
    away = np.abs(part["indentation_m"]) > 1e-9 * np.max(np.abs(part["indentation_m"]))
    first, last = int(away[1] and not away[0]), len(away) - int(away[-2] and not away[-1])
    if result.impacts["separation_speed_m_s"][impact] == 0.0:
        # the sphere stays: the last point is its state of rest, which is not the end of the computed motion
        last = int(np.searchsorted(part["time_s"], part["time_s"][-1])) + 1
    return {name: values[first:last] for name, values in part.items()}


def history_window(history: dict[str, Floats], start: float, end: float) -> dict[str, Floats]:
    """Return the history between two times [s], interpolated linearly at each of them that lies within the run."""
    time = history["time_s"]
    first, last = np.searchsorted(time, start, side="left"), np.searchsorted(time, end, side="right")
    before = [start] if first < len(time) and time[0] < start < time[first] else []
    after = [end] if last > 0 and time[last - 1] < end < time[-1] else []

    def cut(values: Floats) -> Floats:
        return np.concatenate([np.interp(before, time, values), values[first:last], np.interp(after, time, values)])

    return {name: cut(values) for name, values in history.items()}


def touch_height(result: Result) -> float:
    """Return the height of the sphere's centre at first touch [m]; NaN without an impact."""
    if not len(result.impacts["time_s"]):
        return float("nan")
    first = np.searchsorted(result.history["time_s"], result.impacts["time_s"][0])
    return float(result.history["position_m"][first])


def gravity_of(result: Result) -> float:
    """Return the gravitational acceleration [m/s2]: that of the first point of the history, as every run begins in free flight."""
    return -float(result.history["acceleration_m_s2"][0])


def decimated(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Return a line reduced to its visible points: the first, last, lowest and highest in each column of the figure.

    `x` ascends. Lines of up to 6000 points are returned as they are.
    """
    return _decimated(len(x), lambda first, last: (x[first:last], y[first:last]))


def decimated_samples(signal: Signal) -> tuple[Floats, Floats]:
    """Return times [s] and values of a signal, reduced to its visible samples as by `decimated`."""
    return _decimated(len(signal.value), lambda first, last: (signal.times(first, last), signal.value[first:last]))


def _decimated(count: int, part: Callable[[int, int], tuple[Floats, Floats]]) -> tuple[Floats, Floats]:
    """Return the visible points of a line of `count` points, of which `part(first, last)` returns x and y.

    A long line is decimated in blocks, and the blocks' points once more: sorting all points at once would take several times the
    memory of the line.
    """
    if count <= 4 * _COLUMNS:
        return part(0, count)
    edges = np.linspace(part(0, 1)[0][0], part(count - 1, count)[0][0], _COLUMNS + 1)[1:-1]
    found = [_showing(*part(first, min(first + _AT_ONCE, count)), edges) for first in range(0, count, _AT_ONCE)]
    x, y = (np.concatenate(side) for side in zip(*found, strict=True))
    return (x, y) if len(found) == 1 else _showing(x, y, edges)


def _showing(x: Floats, y: Floats, edges: Floats) -> tuple[Floats, Floats]:
    """Return the first, last, lowest and highest point of a line in each column, given the x of the edges between the columns."""
    column = np.searchsorted(edges, x, side="right")
    starts = np.flatnonzero(np.diff(column, prepend=-1))
    ends = np.append(starts[1:], len(x)) - 1
    by_height = np.lexsort((y, column))
    kept = np.unique(np.concatenate([starts, ends, by_height[starts], by_height[ends]]))
    return x[kept], y[kept]
