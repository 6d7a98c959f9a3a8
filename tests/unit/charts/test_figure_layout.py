"""Figures for print are tidy: no words collide or are cut, no unit is said twice, maps
fill their places and hold their names.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

import vibroimpact as vi
from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.frame import frames_of
from vibroimpact.charts.marks import Line, Spans
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.charts.palette import LOOKS, SERIES
from vibroimpact.charts.print_style import print_style
from vibroimpact.results.deflection import Deflection
from vibroimpact.results.result import Result, result_of
from vibroimpact.runs.charts import run_charts
from vibroimpact.runs.deflection_chart import deflection_chart
from vibroimpact.runs.setup import setup_chart


def drawn(chart: Chart) -> Figure:
    with print_style():
        figure = matplotlib_figure(chart)
        figure.draw_without_rendering()
    return figure


def titles(figure: Figure) -> list[str]:
    return [axes.get_title("left") for axes in figure.axes]


def words_in(figure: Figure) -> list[tuple[str, Bbox]]:
    """What is written, but for the numbers at the axes."""
    numbers = {
        id(text)
        for axes in figure.axes
        for line in (axes.xaxis, axes.yaxis)
        for text in line.get_ticklabels()
    }
    found = [
        text
        for text in figure.findobj(Text)
        if text.get_visible() and text.get_text().strip() and id(text) not in numbers
    ]
    return [(text.get_text(), text.get_window_extent()) for text in found]


def check_words(figure: Figure) -> None:
    words = words_in(figure)
    for text, box in words:
        assert figure.bbox.padded(1.0).contains(box.x0, box.y0), text
        assert figure.bbox.padded(1.0).contains(box.x1, box.y1), text
    for (first, one), (second, other) in combinations(words, 2):
        assert not one.overlaps(other), (first, second)


@pytest.fixture(scope="module")
def figures(theory: vi.Response) -> dict[str, Figure]:
    result = result_of(theory)
    return {chart.name: drawn(chart) for chart in (setup_chart(result), *run_charts(result))}


def test_pictures_are_to_scale() -> None:
    """A small ball on a plate of metres: both axes have the same unit, whatever the
    extent across.
    """
    steel = {"density": 7850, "youngs_modulus": "210 GPa", "poissons_ratio": 0.3}
    case = {
        "sphere": {"radius": "2.5 mm", "material": steel},
        "plate": {"size": ["4 m", "2 m", "25 mm"], "material": steel},
        "drop": {"speed": 3.0},
        "contact": {"law": "hertz"},
        "run": {"impacts": 1},
    }
    chart = setup_chart(result_of(vi.simulate(vi.case_of(case))))
    frames = frames_of(chart)
    for panel in chart.panels:
        assert frames[panel.x].size == frames[panel.y].size


@pytest.mark.slow
def test_words_of_a_run_neither_collide_nor_are_cut(figures: dict[str, Figure]) -> None:
    assert len(figures) == 7
    for figure in figures.values():
        check_words(figure)


@pytest.mark.slow
def test_a_small_panel_tells_its_number_below_its_name(figures: dict[str, Figure]) -> None:
    assert titles(figures["acceleration"])[1:3] == ["Impact 1\n113355 m/s²", "Impact 2\n83454 m/s²"]
    assert titles(figures["velocity"])[1] == "Impact 1\nrestitution 0.7748"


def test_a_unit_is_said_once(figures: dict[str, Figure]) -> None:
    """With the number, or at the label of the first small panel; only where neither has
    it behind the name.
    """
    for figure in figures.values():
        assert not any("[" in title for title in titles(figure))
    x = np.array([0.0, 1e-3, 1.0001e-3, 2e-3, 2.0001e-3, 3e-3])
    line = Line(x, np.array([0.0, 5e3, 0.0, 6e3, 0.0, 7.0]))
    for headline, last in (
        ("", "Part 2 [N]"),
        ("peak 0.7", "Part 2 [N]: peak 0.7"),
        ("peak 7 N", "Part 2: peak 7 N"),
        ("7 kN", "Part 2 [N]: 7 kN"),
    ):
        parts = tuple(
            View(f"Part {number}", 1e-3 * number + 1e-5, 1e-3 * number + 1e-3, headline=headline)
            for number in range(3)
        )
        chart = Chart(
            "a", "A", ((Panel(Axis("Time", "s", views=parts), Axis("Force", "N"), (line,)),),)
        )
        assert titles(matplotlib_figure(chart))[-1] == last


def test_a_span_thinner_than_a_dot_is_drawn_in_its_view_alone() -> None:
    view = View("contact", 0.4999, 0.5003)
    marks = (
        Line(np.array([0.0, 1.0]), np.array([0.0, 1.0])),
        Spans(np.array([0.5]), np.array([0.5002]), "in contact"),
    )
    whole, enlarged = matplotlib_figure(
        Chart("a", "A", ((Panel(Axis("Time", "s", views=(view,)), Axis(), marks),),))
    ).axes
    assert (len(whole.patches), len(enlarged.patches)) == (0, 1)


PLATES = [(0.52, 0.42), (0.6, 0.2), (0.15, 0.6)]


NAMES = ("the plate's centre", "a long name at an edge", "a1")


def deflected(size: tuple[float, float], frames: int = 40) -> Chart:
    """The chart of a plate that bends, with sensors in its middle and near its sides."""
    (length, width), time = size, np.linspace(0.0, 1e-3, frames)
    x, y = np.linspace(-0.5 * length, 0.5 * length, 41), np.linspace(-0.5 * width, 0.5 * width, 33)
    bend = -1e-5 * np.outer(np.cos(np.pi * y / width), np.cos(np.pi * x / length))
    # rounding of either sign where it is held
    noise = 1e-10 * np.random.default_rng(3).choice([-1.0, 1.0], size=(frames, *bend.shape))
    held = np.hypot(*np.meshgrid(x + 0.25 * length, y)) <= 0.05
    height = np.where(held, noise, bend * np.linspace(0.2, 1.0, frames)[:, None, None]).astype(
        np.float32
    )
    places = ((0.0, 0.0), (0.4 * length, 0.3 * width), (-0.4 * length, -0.3 * width))
    sensors = [{"name": name, "position": place} for name, place in zip(NAMES, places, strict=True)]
    supports = [{"type": "patch", "position": (-0.25 * length, 0.0), "radius": 0.05}]
    case = {"plate": {"size": (length, width, 0.008), "supports": supports}, "sensors": sensors}
    impacts = {"time_s": np.zeros(1), "duration_s": np.full(1, 1e-4)}
    deflection = Deflection(time, x, y, height, np.zeros(frames), np.zeros(frames), (0.0, 0.0))
    return deflection_chart(Result(case, impacts, {}, {}, "", deflection=deflection), "a caption")


@pytest.mark.slow
@pytest.mark.parametrize("size", PLATES)
def test_names_of_sensors_stay_on_the_plate(size: tuple[float, float]) -> None:
    figure = drawn(deflected(size))
    check_words(figure)
    maps = [axes for axes in figure.axes if axes.images]
    assert len(maps) == 6
    for axes in maps:
        edge = axes.lines[0].get_window_extent()
        names = [text for text in axes.texts if " to " not in text.get_text()]
        assert "a1" in [text.get_text() for text in names]
        for text in names:
            box = text.get_window_extent()
            assert edge.x0 < box.x0 < box.x1 < edge.x1, text.get_text()


def test_maps_fill_the_figure() -> None:
    figure = drawn(deflected(PLATES[0]))
    maps = [axes.get_window_extent() for axes in figure.axes if axes.images]
    assert sum(box.width for box in maps[:3]) > 0.9 * figure.bbox.width
    assert sum(box.height for box in maps[::3]) > 0.6 * figure.bbox.height
    assert len({round(box.y1) for box in maps[:3]}) == 1


def test_maps_of_a_row_that_is_not_full_are_as_large_as_the_others() -> None:
    boxes = [
        axes.get_window_extent()
        for axes in drawn(deflected(PLATES[0], frames=12)).axes
        if axes.images
    ]
    assert len(boxes) == 5
    assert max(box.width for box in boxes) == pytest.approx(
        min(box.width for box in boxes), rel=1e-3
    )


def test_a_support_at_rest_has_no_lines_from_rounding() -> None:
    chart = deflected(PLATES[0])
    for panel in chart.panels:
        values = panel.marks[0].values  # type: ignore[union-attr]
        x, y = panel.marks[0].x, panel.marks[0].y  # type: ignore[union-attr]
        held = np.hypot(*np.meshgrid(x + 0.13, y)) <= 0.05
        inner = np.hypot(*np.meshgrid(x + 0.13, y)) <= 0.045  # the outline is a polygon
        assert held.sum() > inner.sum() > 20
        assert np.all(values[inner] == 0.0)
        assert np.all(
            values[
                ~held & (np.abs(np.meshgrid(x, y)[0]) < 0.25) & (np.abs(np.meshgrid(x, y)[1]) < 0.2)
            ]
            < 0.0
        )


def test_a_chart_is_drawn_into_a_given_figure(theory: vi.Response) -> None:
    """A figure that a window of pyplot shows becomes the one that files have."""
    (chart,) = (chart for chart in run_charts(result_of(theory)) if chart.name == "force")
    given, new = Figure(), matplotlib_figure(chart)
    assert matplotlib_figure(chart, given) is given
    assert titles(given) == titles(new)
    np.testing.assert_array_equal(given.get_size_inches(), new.get_size_inches())


def test_figures_of_ones_own_may_have_the_style_of_print() -> None:
    import matplotlib.pyplot as plt

    with print_style():
        look = dict(plt.rcParams)
    with plt.style.context("vibroimpact.charts.print"):
        assert {name for name in look if plt.rcParams[name] != look[name]} <= {
            "backend",
            "backend_fallback",
        }
        assert plt.rcParams["axes.prop_cycle"].by_key()["color"] == [
            LOOKS[f"series {number}"].light for number in range(SERIES)
        ]
