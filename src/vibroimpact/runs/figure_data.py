"""Parts of a result that a figure shows: contacts, windows of the history, as many points as show."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.report.style import ENLARGED
from vibroimpact.results.result import Result

MARGIN = 0.15
"""What an enlarged contact shows before touch and after release, as a part of its duration."""

_COLUMNS = 1500
"""Into how many columns a long history is sorted: more than a figure has pixels that matter."""

_AT_ONCE = 2**17  # points that are sorted at once


def contacts_with_duration(result: Result) -> Indices:
    """Return which impacts, counted from 0, have a duration; none with an instantaneous law."""
    found: Indices = np.flatnonzero(result.impacts["duration_s"] > 0.0)
    return found


def enlarged_contacts(result: Result) -> Indices:
    """Return which contacts, counted from 0, are worth enlarging: the first few, unless one fills the run by itself."""
    span = result.history["time_s"][-1] - result.history["time_s"][0]
    found = contacts_with_duration(result)
    short: Indices = found[result.impacts["duration_s"][found] < 0.5 * span]
    return short[:ENLARGED]


def history_around(result: Result, impact: int) -> dict[str, Floats]:
    """Return the history around a contact, with time counted from first touch [s]."""
    touch, duration = result.impacts["time_s"][impact], result.impacts["duration_s"][impact]
    part = history_window(result.history, touch - MARGIN * duration, touch + (1.0 + MARGIN) * duration)
    return {**part, "time_s": part["time_s"] - touch}


def contact_history(result: Result, impact: int) -> dict[str, Floats]:
    """Return the history of a contact, from where the surfaces meet to where they part.

    The flight's side of both ends shows the jump of the force there; but in flight there is no indentation, so it is left
    out where the surfaces meet in a dent or part with their neck drawn out. So is the rest of a sphere that stays.
    """
    touch = result.impacts["time_s"][impact]
    part = history_window(result.history, touch, touch + result.impacts["duration_s"][impact])
    away = np.abs(part["indentation_m"]) > 1e-9 * np.max(np.abs(part["indentation_m"]))
    first, last = int(away[1] and not away[0]), len(away) - int(away[-2] and not away[-1])
    if result.impacts["separation_speed_m_s"][impact] == 0.0:
        # it stays: what follows is its rest, to which its motion was not followed
        last = int(np.searchsorted(part["time_s"], part["time_s"][-1])) + 1
    return {name: values[first:last] for name, values in part.items()}


def history_window(history: dict[str, Floats], start: float, end: float) -> dict[str, Floats]:
    """Return the history between two times [s], with a point on each edge that lies within the run."""
    time = history["time_s"]
    first, last = np.searchsorted(time, start, side="left"), np.searchsorted(time, end, side="right")
    before = [start] if first < len(time) and time[0] < start < time[first] else []
    after = [end] if last > 0 and time[last - 1] < end < time[-1] else []

    def cut(values: Floats) -> Floats:
        return np.concatenate([np.interp(before, time, values), values[first:last], np.interp(after, time, values)])

    return {name: cut(values) for name, values in history.items()}


def touch_height(result: Result) -> float:
    """Return the height of the sphere's centre at first touch [m]; NaN if the plate is never touched."""
    if not len(result.impacts["time_s"]):
        return float("nan")
    first = np.searchsorted(result.history["time_s"], result.impacts["time_s"][0])
    return float(result.history["position_m"][first])


def gravity_of(result: Result) -> float:
    """Return the acceleration of gravity [m/s2]: every run begins in flight."""
    return -float(result.history["acceleration_m_s2"][0])


def decimated(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Return a long line with the points that show: in each column of the figure its ends and its extremes."""
    return _decimated(len(x), lambda first, last: (x[first:last], y[first:last]))


def decimated_samples(signal: Signal) -> tuple[Floats, Floats]:
    """Return times [s] and values of the samples of a signal that show, as `decimated` does."""
    return _decimated(len(signal.value), lambda first, last: (signal.times(first, last), signal.value[first:last]))


def _decimated(count: int, part: Callable[[int, int], tuple[Floats, Floats]]) -> tuple[Floats, Floats]:
    """Return the points that show of a line of so many points, which is looked at in parts: columns of a long one fill gigabytes."""
    if count <= 4 * _COLUMNS:
        return part(0, count)
    edges = np.linspace(part(0, 1)[0][0], part(count - 1, count)[0][0], _COLUMNS + 1)[1:-1]
    found = [_showing(*part(first, min(first + _AT_ONCE, count)), edges) for first in range(0, count, _AT_ONCE)]
    x, y = (np.concatenate(side) for side in zip(*found, strict=True))
    return (x, y) if len(found) == 1 else _showing(x, y, edges)


def _showing(x: Floats, y: Floats, edges: Floats) -> tuple[Floats, Floats]:
    """Return the ends and the extremes of a line in each of the columns between edges."""
    column = np.searchsorted(edges, x, side="right")
    starts = np.flatnonzero(np.diff(column, prepend=-1))
    ends = np.append(starts[1:], len(x)) - 1
    by_height = np.lexsort((y, column))
    kept = np.unique(np.concatenate([starts, ends, by_height[starts], by_height[ends]]))
    return x[kept], y[kept]
