"""Figures of comparisons, plates and sensors: labels apart, no lines from rounding, the range of an accelerometer; doubts said once."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure

import vibroimpact as vi
from support import plain_case
from vibroimpact.comparison.comparison import compare_laws
from vibroimpact.comparison.figures import draw_comparison, spread_labels
from vibroimpact.results.deflection import Deflection
from vibroimpact.results.result import Result, result_of
from vibroimpact.runs.deflection_figure import draw_deflection
from vibroimpact.runs.sensor_figures import draw_sensor
from vibroimpact.units.display import multiple


@pytest.fixture(scope="module")
def struck() -> Result:
    """A plate with two accelerometers at one point, one of them overdriven, and a third beside them."""
    meters = ({"range": 100.0}, {"range": 1e6}, {})
    sensors = [
        {"name": f"a{place}", "position": [0.1, 0.05], "rate": 50e3, **({"accelerometer": meter} if meter else {})}
        for place, meter in enumerate(meters, 1)
    ]
    plate = {"model": "elastic", "material": "steel", "size": [0.3, 0.2, 0.01], "modes": 12, "damping": 0.01, "supports": "clamped"}
    case = plain_case(plate=plate, drop={"height": 0.1, "position": [0.02, 0.01]}, run={"impacts": 1}, sensors=sensors)
    return result_of(vi.simulate(vi.read_case(case)))


def test_labels_of_a_comparison_at_one_restitution_do_not_overlap() -> None:
    laws = ["hunt-crossley", "flores", "lankarani-nikravesh", "newton", "gonthier", "zhiying-qishao", "hu-guo"]
    found = compare_laws(vi.load_case("paper:type1-theory"), laws, achieving=0.7)
    figure = draw_comparison(found.results, found.speeds, found.restitutions)["restitution"]
    figure.canvas.draw()
    labels = [label.get_window_extent() for label in figure.axes[0].texts if label.get_text().startswith("asked")]
    assert len(labels) > 3
    assert all(below.y1 <= above.y0 for below, above in pairwise(sorted(labels, key=lambda box: box.y0)))
    assert len({round(label.x1) for label in labels}) == 1


@pytest.mark.parametrize("places", [[], [0.5], [0.1, 0.1001, 0.1002, 0.9], list(np.linspace(0.6, 0.62, 7))])
def test_places_are_brought_apart_and_no_further(places: list[float]) -> None:
    found = spread_labels(places, 0.05)
    assert all(above - below >= 0.05 - 1e-12 for below, above in pairwise(found))
    assert all(there >= here for here, there in zip(places, found, strict=True))
    assert found[:1] == places[:1]
    if len(places) == 4:
        assert found[-1] == 0.9  # which has room


def contours(figure: Figure) -> list[QuadContourSet]:
    return [one for axes in figure.axes for one in axes.collections if isinstance(one, QuadContourSet)]


def test_a_held_edge_shows_no_lines_from_rounding() -> None:
    """Edges that rest, but for rounding of either sign, and inside a plate that bends down."""
    x, y, time = np.linspace(-0.15, 0.15, 31), np.linspace(-0.1, 0.1, 21), np.linspace(0.0, 1e-3, 12)
    bend = -1e-5 * np.outer(np.cos(np.pi * y / 0.2), np.cos(np.pi * x / 0.3))
    noise = 1e-20 * np.random.default_rng(3).choice([-1.0, 1.0], size=(12, 21, 31))
    inside = np.zeros((21, 31))
    inside[1:-1, 1:-1] = 1.0
    height = (inside * bend * np.linspace(0.2, 1.0, 12)[:, None, None] + noise).astype(np.float32)
    deflection = Deflection(time, x, y, height, np.zeros(12), np.zeros(12), (0.0, 0.0))
    impacts = {"time_s": np.zeros(1), "duration_s": np.full(1, 1e-4)}
    figure = draw_deflection(Result({}, impacts, {}, {}, "", deflection=deflection))
    found = contours(figure)
    assert len(found) > 3
    levels, at_rest = found[0].levels, int(np.argmin(np.abs(found[0].levels)))
    assert levels[at_rest] == 0.0
    for one in found:
        assert not len(one.get_paths()[at_rest].vertices)
        assert sum(len(path.vertices) for path in one.get_paths())  # it is drawn where it bends
    ranges = [words.get_text() for axes in figure.axes for words in axes.texts if " to " in words.get_text()]
    assert len(ranges) == len(found)
    assert all(words.endswith(" to 0") for words in ranges)


def levels_of(axes: Axes) -> list[float]:
    """Where lines go straight across."""
    return sorted(float(line.get_ydata()[0]) for line in axes.lines if len(line.get_ydata()) == 2 and len(set(line.get_ydata())) == 1)


def test_the_range_of_an_accelerometer_is_drawn_where_the_signal_comes_near_it(struck: Result) -> None:
    overdriven, calm, bare = (draw_sensor(struck, f"a{place}") for place in (1, 2, 3))
    end = 100.0 / multiple("m/s2", struck.signals["a1"].value).size
    for axes in overdriven.axes[:2]:
        assert levels_of(axes) == pytest.approx([-end, end])
    assert "(dashed: range ±100 m/s²)" in overdriven.axes[0].get_title()
    assert "range ±" in calm.axes[0].get_title()
    assert calm.axes[0].get_title().endswith("beyond the axes)")
    assert "range" not in bare.axes[0].get_title()
    assert levels_of(calm.axes[0]) == levels_of(bare.axes[0]) == []


def test_what_is_said_of_two_sensors_at_one_point_is_said_once(struck: Result) -> None:
    of_modes = [doubt for doubt in struck.doubts if "modes" in doubt and "sensor" in doubt]
    assert len(of_modes) == 1
    assert '"a1"' in of_modes[0]
    assert '"a2"' in of_modes[0]
    assert '"a3"' in of_modes[0]
    (driven,) = (doubt for doubt in struck.doubts if "beyond its range" in doubt)
    assert '"a1"' in driven
    assert '"a2"' not in driven
