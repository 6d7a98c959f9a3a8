"""Every mark of a chart is drawn with the same numbers by matplotlib, by plotly in
Python, and by the script of a page.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, get_args

import numpy as np
import pytest

from drawn_points import (
    NODE,
    in_a_page,
    in_pages,
    in_python,
    missing,
    points_of_plotly,
    points_of_print,
)
from support import one_in
from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.files import FORMATS
from vibroimpact.charts.marks import (
    Arrow,
    Band,
    Bars,
    Facets,
    Label,
    Layer,
    Level,
    Line,
    Map,
    Mark,
    Outline,
    Points,
    Rug,
    Spans,
    Stack,
    across,
    upwards,
)
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.charts.palette import DIVERGING

pytestmark = pytest.mark.filterwarnings("error")

X = np.array([0.0, 0.5, 1.5, 2.0, 3.5])
Y = np.array([-1.0, 4.0, 2.5, 6.0, 0.5])
SQUARES = np.array(
    [
        [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]],
        [[1.0, 0.0], [2.0, 0.0], [2.0, 3.0], [1.0, 3.0]],
    ]
)


def at(x: Floats | float, y: Floats | float) -> Floats:
    return np.column_stack(np.broadcast_arrays(np.atleast_1d(x), np.atleast_1d(y))).astype(float)


def marks() -> dict[str, tuple[Mark, Floats]]:
    """Marks, and where they lie, in thousandths across and in thousands upwards."""
    x, y = 1e-3 * X, 1e3 * Y
    layers = (Layer("one", np.abs(y), "kinetic"), Layer("two", np.full(5, 2e3), "potential"))
    signs = (Layer("one", -np.abs(y), "kinetic"), Layer("two", np.full(5, 2e3), "potential"))
    return {
        "line": (Line(x, y, "a"), at(X, Y)),
        "marked line": (Line(x, y, "a", "series 1", marked=True), at(X, Y)),
        "interrupted line": (Line(x, np.where(X == 1.5, np.nan, y)), at(X[X != 1.5], Y[X != 1.5])),
        "line back and forth": (Line(y * 1e-6, x * 1e6), at(Y, X)),
        "points": (Points(x, y, "a"), at(X, Y)),
        "points with keys": (
            Points(
                x,
                y,
                "a",
                texts=("p", "q", "r", "s", "t"),
                keys={"of": X, "name": np.array(list("aabbc"))},
            ),
            at(X, Y),
        ),
        "points with intervals": (Points(x, y, "a", low=y - 500.0, high=y + 500.0), at(X, Y)),
        "band": (Band(x, y - 1e3, y + 2e3, "b"), np.concatenate([at(X, Y - 1.0), at(X, Y + 2.0)])),
        "stack": (
            Stack(x, layers),
            np.concatenate([at(X, 0.0), at(X, np.abs(Y)), at(X, np.abs(Y) + 2.0)]),
        ),
        "stack below zero": (
            Stack(x, signs, np.arange(5)),
            np.concatenate([at(X, -np.abs(Y)), at(X, 2.0 - np.abs(Y))]),
        ),
        "bars": (Bars(x, y, "c", width=2e-4), at(X, Y)),
        "bars on a base": (Bars(x, y, base=np.full(5, 1e3), width=2e-4), at(X, Y + 1.0)),
        "lying bars": (Bars(1e3 * X, 1e-3 * Y, "c", lying=True, width=200.0), at(Y, X)),
        "histogram": (Bars(x, y[:4]), at(0.5 * (X[1:] + X[:-1]), Y[:4])),
        "bars with intervals": (Bars(x, y, low=y - 100.0, high=y + 100.0, width=2e-4), at(X, Y)),
        "facets": (Facets(SQUARES * [1e-3, 1e3], np.array([0.0, 1.0])), SQUARES.reshape(-1, 2)),
        "facets of both signs": (
            Facets(SQUARES * [1e-3, 1e3], np.array([-1.0, 1.0]), diverging=True),
            SQUARES.reshape(-1, 2),
        ),
        "level": (Level(2.5e3, "d"), at(np.nan, 2.5)),
        "upright level": (Level(1.5e-3, "d", upright=True, label="here"), at(1.5, np.nan)),
        "spans": (
            Spans(x[:2], x[:2] + 2e-4, "in contact"),
            at(np.concatenate([X[:2], X[:2] + 0.2]), np.nan),
        ),
        "rug": (Rug(x, "modes"), at(X, np.nan)),
        "outline": (Outline(x, y, "e"), at(X, Y)),
        "arrow": (Arrow((0.0, 1e3), (2e-3, 5e3)), at(np.array([0.0, 2.0]), np.array([1.0, 5.0]))),
        "dimension": (
            Arrow((0.0, 1e3), (2e-3, 5e3), both=True),
            at(np.array([0.0, 2.0]), np.array([1.0, 5.0])),
        ),
        "label": (Label(1e-3, 3e3, "words", "left"), at(1.0, 3.0)),
        "map": (
            Map(x[[0, 1]], y[[0, 1, 3]], 1e-3 * np.arange(6.0).reshape(3, 2), Axis("Depth", "m")),
            np.empty((0, 2)),
        ),
    }


MARKS = marks()


def chart_of(*marks: Mark, time: Axis | None = None, force: Axis | None = None) -> Chart:
    """A chart that is shown in milliseconds and kilonewtons, whatever else is in it."""
    frame = Line(np.array([0.0, 5e-3]), np.array([-2e3, 9e3]), role="dotted")
    return Chart(
        "a",
        "A chart",
        ((Panel(time or Axis("Time", "s"), force or Axis("Force", "N"), (frame, *marks)),),),
        "What is seen.",
    )


def test_every_mark_is_tried() -> None:
    assert {type(mark) for mark, _ in MARKS.values()} == set(get_args(Mark))


@pytest.mark.parametrize("name", MARKS)
def test_print_draws_a_mark_where_it_is(name: str) -> None:
    mark, expected = MARKS[name]
    figure = matplotlib_figure(chart_of(mark))
    assert (figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()) == ("Time [ms]", "Force [kN]")
    if name != "histogram":  # which has edges
        assert not missing(expected, points_of_print(figure))
    assert len(FORMATS["png"](figure)) > 1000


@pytest.mark.parametrize("kind", ["svg", "pdf"])
@pytest.mark.parametrize("name", one_in(4, MARKS))
def test_a_mark_can_be_drawn_in_every_format(name: str, kind: str) -> None:
    assert len(FORMATS[kind](matplotlib_figure(chart_of(MARKS[name][0])))) > 1000


@pytest.mark.parametrize("name", MARKS)
def test_plotly_draws_a_mark_where_it_is(name: str) -> None:
    mark, expected = MARKS[name]
    figure = in_python(chart_of(mark))
    assert figure["layout"]["xaxis"]["title"]["text"] == "Time [ms]"
    assert not missing(expected, points_of_plotly(figure))


@pytest.fixture(scope="module")
def pages() -> dict[str, dict[str, Any]]:
    """The marks in pages."""
    return dict(zip(MARKS, in_pages([chart_of(mark) for mark, _ in MARKS.values()]), strict=True))


@pytest.mark.skipif(NODE is None, reason="node is not there")
@pytest.mark.parametrize("name", MARKS)
def test_a_page_draws_a_mark_as_plotly_in_python_does(
    name: str, pages: dict[str, dict[str, Any]]
) -> None:
    mark, expected = MARKS[name]
    page, python = pages[name], in_python(chart_of(mark))
    assert not missing(expected, points_of_plotly(page))
    ours, theirs = points_of_plotly(page), points_of_plotly(python)
    assert not missing(ours[np.isfinite(ours).all(axis=1)], theirs)
    assert not missing(theirs[np.isfinite(theirs).all(axis=1)], ours)
    assert [trace["type"] for trace in page["data"]] == [trace["type"] for trace in python["data"]]
    for one, other in zip(page["data"], python["data"], strict=True):
        for part in (
            "name",
            "showlegend",
            "mode",
            "fill",
            "orientation",
            "width",
            "xaxis",
            "yaxis",
        ):
            assert np.all(one.get(part) == np.asarray(other.get(part))) or np.allclose(
                one[part], other[part]
            ), part


def test_values_along_the_axes_are_those_of_the_marks() -> None:
    for name, (mark, expected) in MARKS.items():
        for values, axis, size in ((across(mark), 0, 1e-3), (upwards(mark), 1, 1e3)):
            found = np.concatenate(
                [np.empty(0), *(np.ravel(np.asarray(part, dtype=float)) for part in values)]
            )
            wanted = expected[np.isfinite(expected[:, axis]), axis]
            if len(wanted) and (name, axis) != ("histogram", 0):  # which has edges
                assert not missing(at(size * wanted, 0.0), at(found, 0.0)), name


def grids() -> dict[str, tuple[Map, Axis]]:
    depth, size = Axis("Depth", "m"), Axis("Count", "1", log=True)
    x, y = np.array([0.0, 1e-3, 2e-3]), np.array([0.0, 1e3])
    both = 1e-3 * np.array([[-4.0, 1.0, 2.0], [0.0, 3.0, np.nan]])
    return {
        "cells": (Map(x, y, both, depth), depth),
        "of both signs": (Map(x, y, both, depth, diverging=True), depth),
        "smooth": (
            Map(x, y, np.nan_to_num(both), depth, diverging=True, contours=True, cells=False),
            depth,
        ),
        "logarithmic": (Map(x, y, np.array([[1.0, 10.0, 100.0], [2.0, 20.0, 200.0]]), size), size),
        "logarithmic with zero": (
            Map(x, y, np.array([[0.0, 10.0, 100.0], [2.0, 20.0, 200.0]]), size),
            size,
        ),
        "nothing": (Map(x, y, np.full((2, 3), np.nan), depth), depth),
    }


@pytest.mark.parametrize("name", grids())
def test_a_map_has_its_values_and_its_scale(name: str) -> None:
    mark, scale = grids()[name]
    chart = chart_of(mark)
    shown = mark.values * (1e3 if scale.unit == "m" and np.isfinite(mark.values).any() else 1.0)
    log = name == "logarithmic"
    figures: list[dict[str, Any]] = [in_python(chart)] + ([in_a_page(chart)] if NODE else [])
    for figure in figures:
        heat = next(trace for trace in figure["data"] if trace["type"] == "heatmap")
        z = np.array(heat["customdata"] if log else heat["z"], dtype=float)
        np.testing.assert_allclose(z, shown, rtol=1e-6)
        if log:
            np.testing.assert_allclose(np.array(heat["z"], dtype=float), np.log10(shown), rtol=1e-6)
        colours = figure["layout"]["coloraxis"]
        ends = (colours["cmin"], colours["cmax"])
        if mark.diverging:
            assert ends == pytest.approx((-4.0, 4.0))
            assert [tuple(stop) for stop in colours["colorscale"]] == list(DIVERGING)
        elif log:
            assert ends == pytest.approx((0.0, np.log10(200.0)))
        elif name != "nothing":
            assert ends == pytest.approx((np.nanmin(shown), np.nanmax(shown)))
        assert sum(trace["type"] == "contour" for trace in figure["data"]) == (
            3 if mark.contours else 0
        )
    picture = matplotlib_figure(chart)
    panel = picture.axes[0]
    artist = (
        panel.images[0]
        if not mark.cells
        else next(one for one in panel.collections if one.get_array() is not None)
    )
    drawn = artist.get_array()
    assert drawn is not None
    np.testing.assert_allclose(
        np.ma.filled(np.ma.asarray(drawn, dtype=float), np.nan).reshape(2, 3), shown
    )
    low, high = artist.get_clim()
    if mark.diverging:
        assert (low, high) == pytest.approx((-4.0, 4.0))
    FORMATS["png"](picture)


def test_labels_and_arrows_on_a_logarithmic_axis_are_where_the_values_are() -> None:
    force = Axis("Force", "N", log=True)
    line = Line(np.array([0.0, 5e-3]), np.array([1e3, 1e5]))
    chart = Chart(
        "a",
        "A",
        (
            (
                Panel(
                    Axis("Time", "s"),
                    force,
                    (line, Label(1e-3, 1e4, "words"), Arrow((0.0, 1e3), (1e-3, 1e5))),
                ),
            ),
        ),
    )
    figure = in_python(chart)
    words, arrow = figure["layout"]["annotations"]
    assert words["y"] == pytest.approx(1.0)  # of 10 kN
    assert (arrow["ay"], arrow["y"]) == pytest.approx((0.0, 2.0))
    assert (words["x"], arrow["x"]) == pytest.approx((1.0, 1.0))
    assert not missing(at(1.0, 10.0), points_of_print(matplotlib_figure(chart)))


def view() -> Chart:
    parts = (
        View("First", 1e-3, 2e-3, 1e-3, "Since it began", "largest 3 N"),
        View("Second", 2e-3, 4e-3, 2e-3, level=1e3),
    )
    x = np.linspace(0.0, 5e-3, 11)
    line = Line(x, np.where(x < 2.2e-3, 3.0, 9e3))
    return Chart(
        "a",
        "A",
        (
            (
                Panel(
                    Axis("Time", "s", views=parts),
                    Axis("Force", "N"),
                    (line, Spans(x[2:3], x[4:5], "in contact")),
                ),
            ),
        ),
    )


def test_print_shows_views_in_panels_of_their_own() -> None:
    whole, first, second = matplotlib_figure(view()).axes
    assert whole.get_ylabel() == "Force [kN]"
    assert first.get_ylabel() == "Force [N]"
    assert first.get_xlabel() == "Since it began [ms]"
    assert first.get_xlim() == pytest.approx((0.0, 1.0))
    assert second.get_xlim() == pytest.approx((0.0, 2.0))
    assert first.get_title(loc="left") == "First: largest 3 N"
    assert np.max(first.lines[0].get_ydata()) == pytest.approx(3.0)
    assert np.max(second.lines[0].get_ydata()) == pytest.approx(8.0)  # kN above the level


@pytest.mark.skipif(NODE is None, reason="node is not there")
def test_a_page_shows_a_view_in_its_own_units() -> None:
    figure = in_a_page(view(), view=0)
    assert figure["layout"]["xaxis"]["range"] == pytest.approx([0.0, 1.0])
    assert figure["layout"]["yaxis"]["title"]["text"] == "Force [N]"
    (line,) = (trace for trace in figure["data"] if len(trace["y"]) > 3)
    assert max(line["x"]) >= 1.0
    near = [y for x, y in zip(line["x"], line["y"], strict=True) if 0.0 <= x <= 1.0]
    assert near == pytest.approx([3.0] * len(near))
    whole = in_a_page(view())
    assert whole["layout"]["yaxis"]["title"]["text"] == "Force [kN]"


def peaked(count: int) -> Line:
    x = np.linspace(0.0, 5e-3, count)
    return Line(x, np.where(np.arange(count) == count // 3, 8e3, 0.0))


def test_a_long_line_keeps_its_peak_everywhere() -> None:
    chart = chart_of(peaked(200_001))
    figures: list[Callable[[], Floats]] = [
        lambda: points_of_print(matplotlib_figure(chart)),
        lambda: points_of_plotly(in_python(chart)),
    ]
    if NODE:
        figures.append(lambda: points_of_plotly(in_a_page(chart)))
    for points in figures:
        found = points()
        assert len(found) < 40_010
        assert not missing(at(5.0 * (200_001 // 3) / 200_000, 8.0), found)


@pytest.mark.parametrize("every", [3, 7, 1000])
def test_a_long_line_with_gaps_is_drawn_in_all_of_its_parts_and_not_across_its_gaps(
    every: int,
) -> None:
    parts = 60_000 // every
    number = np.arange(parts * every)
    y = np.where(number % every == 0, np.nan, 1e3 * np.sin(number))
    first = number[1::every]
    wanted = np.concatenate([first, first + every - 2, [np.nanargmin(y), np.nanargmax(y)]])
    whole = chart_of(Line(np.linspace(0.0, 5e-3, len(y)), y))
    drawn = [max((line.get_xydata() for line in matplotlib_figure(whole).axes[0].lines), key=len)]
    for figure in [in_python(whole)] + ([in_a_page(whole)] if NODE else []):
        line = max(figure["data"], key=lambda trace: len(trace["x"]))
        drawn.append(points_of_plotly({"data": [line], "layout": {}}))
    for points in drawn:
        kept = np.rint(points[:, 0] / 5.0 * (len(y) - 1)).astype(int)
        there = np.isfinite(points[:, 1])
        joined = there[1:] & there[:-1]
        before, after = kept[:-1][joined], kept[1:][joined]
        assert np.array_equal(before // every, after // every)
        assert np.isin(wanted, np.concatenate([before, after])).all()
        assert len(kept) < len(y) or every < 10  # or there is nothing to be left out


@pytest.mark.skipif(NODE is None, reason="node is not there")
def test_a_zoom_shows_the_points_that_the_whole_leaves_out() -> None:
    count = 200_001
    chart = chart_of(peaked(count))
    line = max(
        in_a_page(chart, ranges={"x": [1e-3, 1.01e-3]})["data"], key=lambda trace: len(trace["x"])
    )
    inside = [x for x in line["x"] if 1.0 <= x <= 1.01]
    assert len(inside) == pytest.approx(400, abs=2)


def test_axes_of_names_ticks_and_whole_numbers() -> None:
    names = ("hertz", "<b>flores</b>")
    bars = Bars(np.arange(2.0), np.array([1.0, 2.0]))
    panel = Panel(
        Axis("Law", "", names=names),
        Axis("Impacts", "", integer=True, range=(0.0, np.nan)),
        (bars,),
    )
    chart = Chart("a", "A", ((panel,),))
    layout = in_python(chart)["layout"]
    assert layout["xaxis"]["ticktext"] == ["hertz", "&lt;b&gt;flores&lt;/b&gt;"]
    assert layout["yaxis"]["range"] == [0.0, None]
    figure = matplotlib_figure(chart)
    figure.canvas.draw()
    assert [label.get_text() for label in figure.axes[0].get_xticklabels()] == list(names)
    assert figure.axes[0].get_ylim()[0] == 0.0
    assert all(float(tick).is_integer() for tick in figure.axes[0].get_yticks())


def test_the_pointer_tells_what_a_bar_is() -> None:
    # as names that have no room are left out
    across, up = Axis("Part", "%"), Axis(names=("speed", ""))
    bars = Bars(
        np.array([0.2, 1.2]), np.array([3.0, 4.0]), "alone", lying=True, texts=("speed", "a < b")
    )
    chart = Chart(
        "a",
        "A",
        (
            (
                Panel(
                    across, up, (bars, Bars(np.array([0.0, 1.0]), np.array([1.0, 2.0]), lying=True))
                ),
            ),
        ),
    )
    for figure in [in_python(chart)] + ([in_a_page(chart)] if NODE else []):
        named, nameless = figure["data"]
        assert list(named["hovertext"]) == ["speed", "a &lt; b"]
        assert named["hovertemplate"] == "%{hovertext}<br>%{x:.5~g} %"
        assert nameless["hovertemplate"] == "%{y:.5~g} <br>%{x:.5~g} %<extra></extra>"
        assert "text" not in named


def test_a_legend_names_each_look_once() -> None:
    x = np.array([0.0, 1.0])
    panels = tuple(
        Panel(Axis(), Axis(), (Line(x, x, "same"), Line(x, x + 1.0, "other", "series 2")))
        for _ in range(2)
    )
    figure = in_python(Chart("a", "A", (panels,)))
    assert [trace["name"] for trace in figure["data"] if trace["showlegend"]] == ["same", "other"]
    (legend,) = matplotlib_figure(Chart("a", "A", (panels,))).legends
    assert [text.get_text() for text in legend.get_texts()] == ["same", "other"]
