"""Data drawn by the charts of a run: selected contacts, time windows of the history, and
the points of long runs that are kept.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.decimation import thinned, visible_points
from vibroimpact.charts.marks import Line, Spans
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.results.result import Result

MARGIN = 0.15
"""Time shown before first touch and after release of an enlarged contact, relative to its
duration.
"""

MOST_VIEWS = 200
"""Largest number of contacts that can be shown enlarged."""

MOST_POINTS = 100_000
"""Points of a history drawn, and samples of a signal; of longer ones those that show the
whole, and the first contacts in full.
"""


_FEW_POINTS = 2000
"""Points of a line up to which all are drawn."""


def contacts_with_duration(result: Result) -> Indices:
    """Return the indices of the impacts with a finite contact duration, counted from 0;
    empty for an instantaneous law.
    """
    contacts: Indices = np.flatnonzero(result.impacts["duration_s"] > 0.0)
    return contacts


def enlarged_contacts(result: Result) -> Indices:
    """Return the indices of the contacts that are shown enlarged, counted from 0: the
    first ones shorter than half of the run.
    """
    span = result.history["time_s"][-1] - result.history["time_s"][0]
    contacts = contacts_with_duration(result)
    short: Indices = contacts[result.impacts["duration_s"][contacts] < 0.5 * span]
    return short[:MOST_VIEWS]


def views_of_contacts(
    result: Result,
    span: Callable[[int], float] | None = None,
    *,
    headline: Callable[[int], str] = lambda impact: "",
    level: float = 0.0,
    level_label: str = "",
) -> tuple[View, ...]:
    """Return views of the contacts, over the time since their first touch.

    Parameters
    ----------
    result : Result
        The result.
    span : callable, optional
        Time shown after the first touch of an impact, counted from 0 [s]; by default its contact
        with a margin.
    headline : callable, optional
        What an impact, counted from 0, shows.
    level, level_label : float and str, optional
        Value from which the vertical axis counts in the views, and its label.
    """
    views = []
    for impact in enlarged_contacts(result).tolist():
        touch = float(result.impacts["time_s"][impact])
        duration = float(result.impacts["duration_s"][impact])
        if span is None:
            before = MARGIN * duration
            after = (1.0 + MARGIN) * duration
        else:
            after = span(impact)
            before = 0.06 * after
        name = f"Impact {impact + 1}"
        since = f"Time since first touch of impact {impact + 1}"
        views.append(
            View(
                name,
                touch - before,
                touch + after,
                touch,
                since,
                headline(impact),
                level,
                level_label,
            )
        )
    return tuple(views)


def time_axis(result: Result, views: tuple[View, ...]) -> Axis:
    """Return the axis of time of a chart, over the whole run with room for symbols at its ends."""
    start = float(result.history["time_s"][0])
    end = float(result.history["time_s"][-1])
    room = 0.01 * (end - start)
    limits = None
    if room > 0.0:
        limits = (start - room, end + room)
    return Axis("Time", "s", range=limits, views=views)


def spans_of_contact(result: Result) -> Spans:
    """Return the times in contact; a visit may consist of several contacts."""
    if not np.any(result.impacts.get("contacts", np.ones(1)) > 1.0):
        starts = result.impacts["time_s"]
        return Spans(starts, starts + result.impacts["duration_s"], "in contact")
    inside = (result.history["indentation_m"] > 0.0) | (result.history["force_N"] != 0.0)
    edges = np.diff(np.concatenate([[False], inside, [False]]).astype(int))
    time = result.history["time_s"]
    return Spans(
        time[np.flatnonzero(edges == 1)], time[np.flatnonzero(edges == -1) - 1], "in contact"
    )


def contact_history(result: Result, impact: int) -> dict[str, Floats]:
    """Return time, force and indentation of a contact from first touch to release, as drawn over
    indentation.

    At each end the history has a point in flight as well, which shows the jump of the force but has
    zero indentation. It is left out where contact begins or ends at another indentation: in a
    permanent dent, or with an adhesive neck. The rest of a sphere that stays is left out too.
    """
    touch = result.impacts["time_s"][impact]
    drawn = {name: result.history[name] for name in ("time_s", "force_N", "indentation_m")}
    part = history_window(drawn, touch, touch + result.impacts["duration_s"][impact])
    away = np.abs(part["indentation_m"]) > 1e-9 * np.max(np.abs(part["indentation_m"]))
    first = int(away[1] and not away[0])
    last = len(away) - int(away[-2] and not away[-1])
    if result.impacts["separation_speed_m_s"][impact] == 0.0:
        # the sphere stays: the last point is its state of rest, which is not the end of the
        # computed motion
        last = int(np.searchsorted(part["time_s"], part["time_s"][-1])) + 1
    return {name: values[first:last] for name, values in part.items()}


def history_window(history: Mapping[str, Floats], start: float, end: float) -> dict[str, Floats]:
    """Return the history between two times [s], interpolated linearly at each of them
    that lies within the run.
    """
    time = history["time_s"]
    first = np.searchsorted(time, start, side="left")
    last = np.searchsorted(time, end, side="right")
    # an end gets a point of its own where it lies between two of the history
    before = []
    if first < len(time) and time[0] < start < time[first]:
        before.append(start)
    after = []
    if last > 0 and time[last - 1] < end < time[-1]:
        after.append(end)

    def cut(values: Floats) -> Floats:
        at_start = np.interp(before, time, values)
        at_end = np.interp(after, time, values)
        return np.concatenate([at_start, values[first:last], at_end])

    return {name: cut(values) for name, values in history.items()}


def touch_height(result: Result) -> float:
    """Return the height of the sphere's centre at first touch [m]; NaN without an impact."""
    if not len(result.impacts["time_s"]):
        return float("nan")
    first = np.searchsorted(result.history["time_s"], result.impacts["time_s"][0])
    return float(result.history["position_m"][first])


def gravity_of(result: Result) -> float:
    """Return the gravitational acceleration [m/s2]: that of the first point of the
    history, as every run begins in free flight.
    """
    return -float(result.history["acceleration_m_s2"][0])


def drawn_history(result: Result) -> Mapping[str, Floats]:
    """Return the history that is drawn: all of it, or of a very long one the points that
    show the whole, and the first contacts in full.
    """
    history = result.history
    count = len(history["time_s"])
    if count <= MOST_POINTS:
        return history
    kept = [
        _visible(history["time_s"], history[name])
        for name in ("position_m", "velocity_m_s", "force_N", "acceleration_m_s2")
    ]
    touches = result.impacts["time_s"]
    first = np.searchsorted(
        history["time_s"], touches[:MOST_VIEWS] - MARGIN * result.impacts["duration_s"][:MOST_VIEWS]
    )
    last = np.searchsorted(
        history["time_s"],
        touches[:MOST_VIEWS] + (1.0 + MARGIN) * result.impacts["duration_s"][:MOST_VIEWS],
    )
    inside = np.concatenate(
        [np.arange(low, high) for low, high in zip(first, last, strict=True)]
        or [np.empty(0, dtype=np.intp)]
    )
    chosen = np.unique(np.concatenate([*kept, inside[: MOST_POINTS // 2], [0, count - 1]]))
    return {name: values[chosen] for name, values in history.items()}


def line_over_time(
    time: Floats, values: Floats, axis: Axis, name: str = "", role: str = "main"
) -> Line:
    """Return a line over the time of a run, of the points that are seen in it, in each of its views
    and in each range of time between two of them.

    Parameters
    ----------
    time, values : array
        The line.
    axis : Axis
        The axis of time, with its views.
    name, role : str
        Name in the legend, and role.
    """
    if len(time) <= _FEW_POINTS:
        return Line(time, values, name, role)
    return Line(*thinned(time, values, windows_of(axis, time)), name, role)


def windows_of(axis: Axis, time: Floats) -> list[tuple[float, float]]:
    """Return the views of an axis of time, and the ranges of time between them [s].

    Examples
    --------
    >>> view = View("Impact 1", 0.4, 0.5, 0.41, "Time")
    >>> windows_of(Axis("Time", "s", views=(view,)), np.array([0.0, 1.0]))
    [(0.4, 0.5), (0.0, 0.4), (0.5, 1.0)]
    """
    views = [(view.start, view.end) for view in axis.views]
    starts = [float(time[0]), *(end for _, end in views)]
    ends = [*(start for start, _ in views), float(time[-1])]
    between = [(start, end) for start, end in zip(starts, ends, strict=True) if start < end]
    return views + between


def _visible(x: Floats, y: Floats) -> Indices:
    points = visible_points(len(x), lambda first, last: (x[first:last], y[first:last]))
    if points is None:
        return np.arange(len(x))
    return points


def drawn_signal(signal: Signal, first: int, last: int) -> tuple[Floats, Floats]:
    """Return times [s] and values of a signal that are drawn: all samples, or of a long signal
    those that show it, and a range in full.

    Parameters
    ----------
    signal : Signal
        The signal.
    first, last : int
        The range of samples kept in full, or as many of its first samples as are drawn.
    """
    count = len(signal.value)
    if count <= 2 * MOST_POINTS:
        return signal.time, signal.value
    shown = visible_points(
        count, lambda low, high: (signal.times(low, high), signal.value[low:high])
    )
    kept = np.arange(first, min(last, first + MOST_POINTS))
    if shown is not None:
        kept = np.union1d(shown, kept)
    return kept / signal.sensor.rate, signal.value[kept]
