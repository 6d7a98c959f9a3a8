"""Views of charts: lines that count from origins of their own, the range of what a view
shows, and what is kept of long lines.
"""

from __future__ import annotations

import numpy as np
import pytest

from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.decimation import thinned
from vibroimpact.charts.frame import (
    frames_of,
    own_view,
    panels_without_label,
    view_frames,
    view_range,
)
from vibroimpact.charts.marks import Level, Line, Points
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.charts.notebook import plotly_figure
from vibroimpact.charts.plotly import plotly_chart

TOUCHES = (0.4, 0.5)
"""The times at which two lines touch: their pulses are alike."""


def pulse(touch: float, height: float) -> Line:
    time = np.linspace(0.0, 1.0, 100_001)
    values = np.where(
        (time >= touch) & (time <= touch + 1e-3),
        height * np.sin(np.pi * (time - touch) / 1e-3),
        0.0,
    )
    return Line(time, values, f"at {touch}", origins=(touch,))


@pytest.fixture
def chart() -> Chart:
    view = View(
        "Impact 1", TOUCHES[0] - 1e-4, TOUCHES[0] + 1.1e-3, TOUCHES[0], "Time since first touch"
    )
    time, force = Axis("Time", "s", views=(view,)), Axis("Force", "N")
    pulses = [pulse(touch, height) for touch, height in zip(TOUCHES, (800.0, 2000.0), strict=True)]
    rows = tuple((Panel(time, force, (one,), one.name),) for one in pulses)
    return Chart("pulses", "Two pulses", rows)


def test_a_line_counts_from_its_own_origin(chart: Chart) -> None:
    for panel, touch in zip(chart.panels, TOUCHES, strict=True):
        own = own_view(panel.marks[0], panel, panel.x.views[0])
        assert [own.start, own.end, own.origin] == pytest.approx(
            [touch - 1e-4, touch + 1.1e-3, touch]
        )
    points = Points(np.array([0.4]), np.array([1.0]))
    assert own_view(points, chart.panels[0], chart.views[0]) is chart.views[0]


def test_panels_with_one_axis_have_one_unit_and_one_range_in_a_view(chart: Chart) -> None:
    """A view of the smaller pulse alone would be in newtons."""
    base = frames_of(chart)
    for panel in chart.panels:
        across, up = view_frames(panel, panel.x.views[0], base[panel.y], chart.panels)
        assert (across.title, up.title) == ("Time since first touch [ms]", "Force [kN]")
        assert view_range(panel, panel.x.views[0], chart.panels) == pytest.approx((-120.0, 2120.0))


def test_a_range_has_the_values_at_the_ends_of_a_view_and_levels_near() -> None:
    view = View("middle", 0.25, 0.75)
    axis, height = Axis("Time", "s", views=(view,)), Axis("Height", "m")

    def found(*levels: float) -> tuple[float, float] | None:
        panel = Panel(
            axis, height, (Line(np.array([0.0, 1.0]), np.array([0.0, 8.0])), *map(Level, levels))
        )
        return view_range(panel, view, (panel,))

    assert found() == pytest.approx((2.0 - 0.24, 6.0 + 0.24))
    # the second is farther than 0.35 of the range
    assert found(7.0, 7.5) == pytest.approx((2.0 - 0.3, 7.0 + 0.3))
    given = Panel(
        axis,
        Axis("Height", "m", range=(0.0, 9.0)),
        (Line(np.array([0.0, 1.0]), np.array([0.0, 8.0])),),
    )
    assert view_range(given, view, (given,)) is None
    flat = Panel(axis, height, (Line(np.array([0.0, 1.0]), np.zeros(2)),))
    assert view_range(flat, view, (flat,)) is None


def test_plotly_gets_origins_and_ranges(chart: Chart) -> None:
    drawn = plotly_chart(chart)
    assert [trace["origins"] for trace in drawn["data"]] == [[touch] for touch in TOUCHES]
    frames = drawn["views"][0]["frames"]
    assert frames["y"]["range"] == frames["y2"]["range"] == pytest.approx([-0.12, 2.12])  # in kN
    assert frames["x"]["range"] == pytest.approx([-0.1, 1.1])
    assert plotly_figure(chart).data[0].name == "at 0.4"  # plotly itself knows no origins


def test_print_lays_first_touches_upon_each_other(chart: Chart) -> None:
    axes = matplotlib_figure(chart).axes
    views = [one for one in axes if one.get_title("left").startswith("Impact 1")]
    assert len(views) == 2
    for one, height in zip(views, (0.8, 2.0), strict=True):
        time, force = one.lines[0].get_data()
        assert float(time[np.argmax(force)]) == pytest.approx(0.5, abs=0.02)  # ms after first touch
        assert float(np.max(force)) == pytest.approx(height, rel=1e-3)
        assert one.get_ylim() == pytest.approx((-0.12, 2.12))
    whole = [one for one in axes if one not in views]
    assert whole[0].get_ylim() == whole[1].get_ylim()


def test_a_level_far_from_a_view_is_not_in_it() -> None:
    view = View("end", 0.9, 1.0)
    line, near, far = (
        Line(np.array([0.0, 1.0]), np.array([0.0, 1.0])),
        Level(0.95, "near"),
        Level(0.2, "far"),
    )
    panel = Panel(Axis("Time", "s", views=(view,)), Axis("Height", "m"), (line, near, far))
    whole, enlarged = matplotlib_figure(Chart("levels", "Levels", ((panel,),))).axes
    assert [len(axes.lines) for axes in (whole, enlarged)] == [3, 2]


def test_a_label_is_not_repeated_beside_itself() -> None:
    line = Line(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    left, right, other = (
        Panel(Axis("Step", "s"), Axis("Force", unit), (line,)) for unit in ("N", "N", "m")
    )
    chart = Chart("row", "Row", ((left, right, other),))
    assert panels_without_label(chart, frames_of(chart)) == {right}
    layout = plotly_chart(chart)["layout"]
    assert [layout[f"yaxis{number}"]["title"]["text"] for number in ("", 2, 3)] == [
        "Force [N]",
        "",
        "Force [m]",
    ]
    assert [axes.get_ylabel() for axes in matplotlib_figure(chart).axes] == [
        "Force [N]",
        "",
        "Force [m]",
    ]


# what is kept of long lines
# -------------------------------------------------------------------------------------------


def test_a_thinned_line_is_the_line_in_the_whole_and_in_windows() -> None:
    time = np.linspace(0.0, 1.0, 200_001)
    values = np.sin(20.0 * time) + 1e-3 * np.sin(2e4 * time)
    window = (0.5, 0.502)
    x, y = thinned(time, values, [window])
    assert len(x) < 6000
    assert np.isin(x, time).all()
    assert np.array_equal(y, values[np.isin(time, x)])
    assert (x[0], x[-1]) == (0.0, 1.0)
    inside = (time >= window[0]) & (time <= window[1])
    assert np.abs(np.interp(time[inside], x, y) - values[inside]).max() < 1e-3 * np.ptp(
        values[inside]
    )
    assert np.abs(np.interp(time, x, y) - values).max() < 2e-3 * np.ptp(values)
    assert max(y.max() - values.max(), values.min() - y.min()) == 0.0


def test_a_straight_line_keeps_points_to_read_off() -> None:
    time = np.linspace(0.0, 1.0, 10_001)
    x, _ = thinned(time, time, [(0.2, 0.21)])
    assert np.diff(x).max() < 0.02
    assert 100 < len(x) < 200


def test_a_window_between_two_points_reaches_its_ends() -> None:
    time = np.array([0.0, 1.0, 2.0, 3.0])
    assert thinned(time, time, [(1.2, 1.4)])[0].tolist() == time.tolist()
    assert thinned(np.empty(0), np.empty(0), [(0.0, 1.0)])[0].tolist() == []


def test_gaps_of_a_thinned_line_stay() -> None:
    time = np.sort(np.append(np.linspace(0.0, 2.0, 20_001), 1.0))
    values = np.where(time < 1.0, time, time - 2.0)
    values[np.flatnonzero(time == 1.0)[0]] = np.nan
    x, y = thinned(time, values)
    gap = int(np.flatnonzero(np.isnan(y))[0])
    assert np.isnan(y).sum() == 1
    assert y[gap - 1] == pytest.approx(1.0, abs=1e-3)
    assert y[gap + 1] == -1.0
    assert len(x) < 200
