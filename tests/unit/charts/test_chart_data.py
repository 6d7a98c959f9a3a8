"""What stands between a chart and what draws it: fewer points of long lines, multiples of
units, and arrays as bytes.
"""

from __future__ import annotations

import json

import numpy as np
import pytest

from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.chart import Chart, Panel, values_on
from vibroimpact.charts.contours import contours_of
from vibroimpact.charts.decimation import COLUMNS, decimated, visible_points
from vibroimpact.charts.frame import ends_on, frame_of, frames_of, is_log
from vibroimpact.charts.marks import Band, Label, Level, Line, Map, Points, Stack
from vibroimpact.charts.pack import pack, unpack
from vibroimpact.charts.palette import LOOKS, series
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.runs.chart_data import line_over_time, windows_of

RANDOM = np.random.default_rng(5)

# fewer points of long lines


def test_a_short_line_stays_as_it_is() -> None:
    x = np.linspace(0.0, 1.0, 4 * COLUMNS)
    shown = decimated(x, x)
    assert shown[0] is x
    assert shown[1] is x


def test_what_is_left_of_a_long_line_has_the_extremes_of_every_column() -> None:
    count = 300_000
    x, y = np.sort(RANDOM.uniform(size=count)), RANDOM.standard_normal(count)
    few = decimated(x, y)
    assert len(few[0]) <= 4 * COLUMNS
    assert np.all(np.diff(few[0]) >= 0.0)
    places = np.searchsorted(x, few[0])
    assert np.all(np.isin(few[1], y))
    assert places[0] == 0
    assert places[-1] == count - 1
    edges = np.linspace(x[0], x[-1], COLUMNS + 1)
    whole, kept = (np.searchsorted(edges[1:-1], part, side="right") for part in (x, few[0]))
    for column in range(0, COLUMNS, 37):
        assert few[1][kept == column].max() == y[whole == column].max()
        assert few[1][kept == column].min() == y[whole == column].min()


def test_a_line_that_goes_back_and_forth_is_not_decimated() -> None:
    """As loops of force over indentation do: points in order of x would be another line."""
    turn = np.linspace(0.0, 40.0 * np.pi, 50_000)
    x, y = decimated(np.cos(turn), np.sin(turn))
    assert len(x) == len(y) == 50_000


def test_a_line_with_gaps_keeps_its_gaps_and_its_extremes() -> None:
    count = 100_000
    x, y = np.linspace(0.0, 1.0, count), np.zeros(count)
    y[50_000], y[70_001] = 5.0, -5.0
    y[20_000:20_100], y[70_000] = np.nan, np.nan
    few = decimated(x, y)
    assert len(few[0]) < 4 * COLUMNS + 4
    assert (np.nanmax(few[1]), np.nanmin(few[1])) == (5.0, -5.0)
    assert few[0][np.isnan(few[1])].tolist() == [x[20_000], x[20_099], x[70_000]]


def test_the_points_of_a_line_in_parts_are_those_of_the_whole(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    y = np.round(RANDOM.standard_normal(100_000), 1)  # with many equal extremes
    x = np.sort(np.abs(RANDOM.standard_normal(100_000)))
    whole = decimated(x, y)
    monkeypatch.setattr("vibroimpact.charts.decimation._AT_ONCE", 1777)
    for ours, theirs in zip(decimated(x, y), whole, strict=True):
        np.testing.assert_array_equal(ours, theirs)
    assert visible_points(10, lambda first, last: (x[first:last], y[first:last])) is None


# multiples of units


def chart(
    *marks: object, time: Axis | None = None, force: Axis | None = None
) -> tuple[Chart, Axis, Axis]:
    time, force = time or Axis("Time", "s"), force or Axis("Force", "N")
    return Chart("a", "A", ((Panel(time, force, marks),),)), time, force  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("values", "title", "size"),
    [
        ([0.0, 7000.0], "Force [kN]", 1e3),
        ([0.0, -7000.0], "Force [kN]", 1e3),
        ([np.nan, 0.02], "Force [mN]", 1e-3),
        ([0.0, 0.0], "Force [N]", 1.0),
        ([], "Force [N]", 1.0),
    ],
)
def test_an_axis_is_shown_in_the_unit_of_its_largest_value(
    values: list[float], title: str, size: float
) -> None:
    drawn, _, force = chart(Line(np.arange(len(values), dtype=float), np.array(values)))
    frame = frames_of(drawn)[force]
    assert (frame.title, frame.size) == (title, size)


def test_a_range_that_is_given_decides_on_the_unit() -> None:
    drawn, _, force = chart(
        Line(np.array([0.0]), np.array([9e6])), force=Axis("Force", "N", range=(0.0, 500.0))
    )
    assert frame_of(force, drawn.panels).unit == "N"


def test_panels_with_one_axis_share_their_unit() -> None:
    time, force = Axis("Time", "s"), Axis("Force", "N")
    few, many = (
        Panel(time, force, (Line(np.array([0.0, 1.0]), np.array([0.0, top])),))
        for top in (5.0, 5e3)
    )
    frames = frames_of(Chart("a", "A", ((few,), (many,))))
    assert frames[force].unit == "kN"
    assert values_on(force, (few, many)).tolist() == [0.0, 5.0, 0.0, 5e3]
    other = Axis("Force", "N")
    assert (
        frames_of(Chart("a", "A", ((Panel(time, other, few.marks),), (many,))))[other].unit == "N"
    )


def test_views_have_units_of_what_is_seen_in_them() -> None:
    x = np.linspace(0.0, 1.0, 1001)
    force = np.where((x > 0.5) & (x < 0.503), 5e-3, 2e3)
    part = View(
        "A", 0.501, 0.502, 0.501, "Since first touch", level=4e-3, level_label="From first touch"
    )
    time = Axis("Time", "s", views=(part,))
    drawn, _, _ = chart(
        Line(x, force), Points(x[:2], np.array([9e9, 9e9])), Band(x, force, force), time=time
    )
    figure = plotly_chart(drawn)
    across, upwards = (figure["views"][0]["frames"][side] for side in "xy")
    assert (across["title"], across["origin"], across["size"]) == (
        "Since first touch [ms]",
        0.501,
        1e-3,
    )
    assert (upwards["title"], upwards["origin"], upwards["size"]) == (
        "From first touch [mN]",
        4e-3,
        1e-3,
    )
    assert across["range"] == pytest.approx([0.0, 1.0])
    assert figure["frames"]["y"]["title"] == "Force [MN]"


def test_a_view_of_nothing_that_has_values_keeps_the_unit() -> None:
    drawn, _, _ = chart(
        Level(5e3), Stack(np.zeros(0), ()), time=Axis("Time", "s", views=(View("A", 0.2, 0.3),))
    )
    figure = plotly_chart(drawn)
    assert (
        figure["views"][0]["frames"]["y"]["title"] == figure["frames"]["y"]["title"] == "Force [kN]"
    )


def test_labels_in_a_corner_have_no_place_on_the_axes() -> None:
    drawn, time, _ = chart(Label(0.5, 0.5, "a", corner=True), Label(3.0, 2.0, "b"))
    assert values_on(time, drawn.panels).tolist() == [3.0]


def test_a_logarithmic_scale_needs_positive_values() -> None:
    x = np.arange(2.0)
    for lowest, log in ((1.0, True), (0.0, False), (np.nan, True)):
        scale = Axis("Count", "", log=True)
        drawn, _, _ = chart(Map(x, x, np.array([[lowest, 2.0], [3.0, 4.0]]), scale))
        assert is_log(scale, drawn) == log
        assert ends_on(scale, drawn) == (2.0 if np.isnan(lowest) else lowest, 4.0)


def test_lines_of_equal_value_avoid_what_rests() -> None:
    """A held edge rests but for rounding, and inside the plate bends down: no line of
    zero runs along the edge.
    """
    y, x = np.meshgrid(np.linspace(-1.0, 1.0, 41), np.linspace(-1.0, 1.0, 61), indexing="ij")
    values = np.where(
        np.hypot(x, y) < 0.6, -np.cos(0.5 * np.pi * np.hypot(x, y) / 0.6), 0.0
    ) + 1e-17 * RANDOM.choice([-1.0, 1.0], x.shape)
    found = {lines.dashed: lines for lines in contours_of(values)}
    assert found[True].levels == pytest.approx((-0.9, -0.6, -0.3), rel=0.01)
    rest = [lines for lines in contours_of(values) if lines.levels == (0.0,)]
    assert all(np.isnan(lines.values[np.hypot(x, y) > 0.7]).all() for lines in rest)
    assert list(contours_of(np.zeros((3, 3)))) == []
    assert list(contours_of(np.full((3, 3), np.nan))) == []


def test_looks_of_lines_of_one_kind_differ() -> None:
    looks = [LOOKS[series(number)] for number in range(8)]
    assert len({look.light for look in looks}) == len({look.dark for look in looks}) == 8
    assert len({(look.dashes, look.symbol) for look in looks}) == 8


# arrays as bytes


def test_a_document_is_read_back() -> None:
    single = RANDOM.standard_normal(7).astype(np.float32)
    document = {
        "name": "Größe <b>",
        "nothing": None,
        "not a number": float("nan"),
        "true": True,
        "number": np.float64(2.5),
        "list": [1, "two", {"three": single}],
        "even": np.linspace(0.0, 1.0, 1001),
        "grid": RANDOM.standard_normal((3, 4)),
        "whole": np.array([3, -1, 2**31 - 1]),
        "empty": np.empty(0),
        "gap": np.array([1.0, np.nan, -np.inf]),
        "again": single,
    }
    found = unpack(pack(document))
    assert {key: found[key] for key in ("name", "nothing", "not a number", "true", "number")} == {
        "name": "Größe <b>",
        "nothing": None,
        "not a number": None,
        "true": True,
        "number": 2.5,
    }
    assert found["list"][:2] == [1, "two"]
    for ours, theirs in (
        (found["list"][2]["three"], single),
        (found["again"], single),
        (found["whole"], document["whole"]),
    ):
        np.testing.assert_array_equal(ours, theirs)
    np.testing.assert_allclose(found["even"], document["even"], rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(found["grid"], document["grid"], rtol=1e-6)
    np.testing.assert_array_equal(found["gap"], document["gap"])
    assert found["empty"].size == 0


def test_times_late_in_a_run_stay_apart() -> None:
    """Of a contact of microseconds after a hundred seconds single precision would leave
    one point.
    """
    time = 100.0 + np.cumsum(RANDOM.uniform(1e-8, 2e-8, 200))
    found = unpack(pack({"time": time, "even": 100.0 + 1e-8 * np.arange(200.0)}))
    np.testing.assert_allclose(np.diff(found["time"]), np.diff(time), rtol=1e-5)
    np.testing.assert_allclose(np.diff(found["even"]), 1e-8, rtol=1e-4)


def test_an_array_is_stored_once_and_values_in_single_precision() -> None:
    values = RANDOM.standard_normal(1000)
    once, twice = pack({"a": values}), pack({"a": values, "b": values, "c": {"d": values}})
    assert len(twice) - len(once) < 100
    assert len(once) < 4 * 1000 + 100
    assert np.abs(unpack(once)["a"] - values).max() < 1e-6


def test_arrays_that_are_made_on_the_way_are_not_confused() -> None:
    """Identities of arrays that are no longer there are given again."""
    found = unpack(
        pack([np.full(3, float(number)) + np.array([0.0, 0.3, 1.0]) for number in range(50)])
    )
    assert [values[0] for values in found] == list(range(50))


def test_evenly_spaced_values_are_described() -> None:
    header = pack({"time": np.arange(1e5) / 48e3})
    assert len(header) < 200
    assert (
        json.loads(header[4 : 4 + int.from_bytes(header[:4], "little")])["time"]["$"][0] == "even"
    )
    for odd in (
        np.array([0.0, 1.0, 2.0, 3.001]),
        np.array([1.0, 1.0, 1.0]),
        np.array([0.0, np.nan, 2.0]),
    ):
        np.testing.assert_array_equal(unpack(pack({"a": odd}))["a"], odd.astype(np.float32))


def test_a_line_over_time_is_what_is_seen_of_it_in_every_view() -> None:
    """Points that no pixel shows are left out: the rest lies within a tenth of a pixel."""
    time = np.union1d(np.linspace(0.0, 2.0, 5001), np.linspace(1.0, 1.001, 5001))
    values = np.sin(40.0 * time) + (time > 1.0) * np.exp(-np.abs(time - 1.0) / 1e-4)
    axis = Axis("Time", "s", views=(View("Impact 1", 0.999, 1.002, 1.0, "Time"),))
    line = line_over_time(time, values, axis)
    assert len(line.x) < 0.25 * len(time)
    for start, end in [(0.0, 2.0), *windows_of(axis, time)]:
        seen = (time >= start) & (time <= end)
        distance = np.abs(np.interp(time[seen], line.x, line.y) - values[seen])
        # more points are seen in the whole than its columns hold, of which the extremes stay
        assert distance.max() < 3.1e-4 * np.ptp(values[seen]), (start, end)


def test_short_lines_are_drawn_in_full() -> None:
    time = np.linspace(0.0, 1.0, 2000)
    assert line_over_time(time, time, Axis("Time", "s")).x is time
