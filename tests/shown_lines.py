"""What the charts of the reproduction show over time, beside the simulations that they
should show.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.chart import Panel
from vibroimpact.charts.frame import own_view
from vibroimpact.charts.marks import Line
from vibroimpact.dynamics.response import Response
from vibroimpact.paper.measures import Timeline


def lines_of(panel: Panel) -> list[Line]:
    return [mark for mark in panel.marks if isinstance(mark, Line)]


def assert_shows(line: Line, timeline: Timeline, response: Response, panel: Panel) -> None:
    """The line is that of a simulation: in the whole as far as it is seen, and in each
    view, where it counts from its own first touch.
    """
    time, values = timeline(response)
    assert np.isin(line.x, time).all()
    for pick in (np.nanmin, np.nanmax):
        assert pick(line.y) == pick(values)
    assert_same(line, time, values, _extremes(time, values))
    assert line.origins == tuple(response.impacts["time_s"][: len(panel.x.views)])
    for impact, view in enumerate(panel.x.views):
        own = own_view(line, panel, view)
        assert (
            own.start
            < own.origin
            < own.origin + float(response.impacts["duration_s"][impact])
            < own.end
        )
        assert_same(
            line, time, values, time[(time >= own.start) & (time <= own.end) & np.isfinite(values)]
        )


def assert_same(line: Line, time: Floats, values: Floats, at: Floats) -> None:
    """At some times the line is as high as the values, within what is seen."""
    expected, drawn = np.interp(at, time, values), np.interp(at, line.x, line.y)
    seen = 2e-3 * (np.nanmax(expected) - np.nanmin(expected))
    assert np.nanmax(np.abs(drawn - expected)) <= seen, line.name


def _extremes(time: Floats, values: Floats, columns: int = 1500) -> Floats:
    """Return the times of the lowest and the highest value in each column of a picture."""
    there = np.flatnonzero(np.isfinite(values))
    column = np.searchsorted(
        np.linspace(time[0], time[-1], columns + 1)[1:-1], time[there], side="right"
    )
    order = np.lexsort((values[there], column))
    ends = np.flatnonzero(np.diff(column[order], append=columns))
    return np.unique(time[there[order[np.concatenate([[0], ends[:-1] + 1, ends])]]])
