"""Charts of plates and sensors: no lines from rounding, the range of an accelerometer,
the spectrum; doubts said once.
"""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.contour import QuadContourSet

import vibroimpact as vi
from support import plain_case
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.contours import contours_of
from vibroimpact.charts.marks import Label, Level, Line, Map, Rug
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.results.deflection import Deflection
from vibroimpact.results.result import Result, result_of
from vibroimpact.runs.deflection_chart import deflection_chart
from vibroimpact.runs.sensor_charts import sensor_chart
from vibroimpact.runs.spectrum import amplitude_spectrum, first_response


@pytest.fixture(scope="module")
def struck() -> Result:
    """A plate with two accelerometers at one point, one of them overdriven, and a third
    beside them.
    """
    meters = ({"range": 100.0}, {"range": 1e6}, {})
    sensors = [
        {
            "name": f"a{place}",
            "position": [0.1, 0.05],
            "rate": 50e3,
            **({"accelerometer": meter} if meter else {}),
        }
        for place, meter in enumerate(meters, 1)
    ]
    plate = {
        "model": "elastic",
        "material": "steel",
        "size": [0.3, 0.2, 0.01],
        "modes": 12,
        "damping": 0.01,
        "supports": "clamped",
    }
    case = plain_case(
        plate=plate,
        drop={"height": 0.1, "position": [0.02, 0.01]},
        run={"impacts": 1},
        sensors=sensors,
    )
    return result_of(vi.simulate(vi.case_of(case)))


def words_of(chart: Chart) -> list[str]:
    return [mark.words for panel in chart.panels for mark in panel.marks if isinstance(mark, Label)]


def test_a_held_edge_shows_no_lines_from_rounding() -> None:
    """Edges that rest, but for rounding of either sign, and inside a plate that bends down."""
    x, y, time = (
        np.linspace(-0.15, 0.15, 31),
        np.linspace(-0.1, 0.1, 21),
        np.linspace(0.0, 1e-3, 12),
    )
    bend = -1e-5 * np.outer(np.cos(np.pi * y / 0.2), np.cos(np.pi * x / 0.3))
    noise = 1e-20 * np.random.default_rng(3).choice([-1.0, 1.0], size=(12, 21, 31))
    inside = np.zeros((21, 31))
    inside[1:-1, 1:-1] = 1.0
    height = (inside * bend * np.linspace(0.2, 1.0, 12)[:, None, None] + noise).astype(np.float32)
    deflection = Deflection(time, x, y, height, np.zeros(12), np.zeros(12), (0.0, 0.0))
    impacts = {"time_s": np.zeros(1), "duration_s": np.full(1, 1e-4)}
    chart = deflection_chart(Result({}, impacts, {}, {}, "", deflection=deflection), "a caption")
    maps = [mark for panel in chart.panels for mark in panel.marks if isinstance(mark, Map)]
    assert len(maps) > 3
    for one in maps:
        assert np.all(one.values[[0, -1]] == 0.0)
        assert np.all(one.values[:, [0, -1]] == 0.0)
        # it is drawn where it bends, and nowhere else
        assert [lines.dashed for lines in contours_of(one.values)] == [True]
    lines = [
        one
        for axes in matplotlib_figure(chart).axes
        for one in axes.collections
        if isinstance(one, QuadContourSet)
    ]
    assert len(lines) == len(maps)
    assert all(sum(len(path.vertices) for path in one.get_paths()) for one in lines)
    ranges = [words for words in words_of(chart) if " to " in words]
    assert len(ranges) == len(maps)
    assert all(words.endswith(" to 0 µm") for words in ranges)


def levels_of(panel: Panel) -> list[float]:
    """Where lines go straight across [SI]."""
    return sorted(mark.value for mark in panel.marks if isinstance(mark, Level))


def test_the_range_of_an_accelerometer_is_drawn_where_the_signal_comes_near_it(
    struck: Result,
) -> None:
    overdriven, calm, bare = (
        sensor_chart(struck, "a", f"a{place}", "a caption").panels[0] for place in (1, 2, 3)
    )
    assert levels_of(overdriven) == [-100.0, 100.0]
    assert "(range ±100 m/s²)" in overdriven.title
    assert "range ±" in calm.title
    assert calm.title.endswith("beyond the axes)")
    assert "range" not in bare.title
    assert levels_of(calm) == levels_of(bare) == []


def test_a_sensor_has_its_signal_and_its_spectrum(struck: Result) -> None:
    upper, lower = sensor_chart(struck, "a", "a3", "a caption").panels
    signal = struck.signals["a3"]
    (line,) = (mark for mark in upper.marks if isinstance(mark, Line))
    np.testing.assert_array_equal(line.x, signal.time)
    np.testing.assert_array_equal(line.y, signal.value)
    (spectrum,) = (mark for mark in lower.marks if isinstance(mark, Line))
    found = amplitude_spectrum(signal.value[first_response(struck, "a3")], signal.sensor.rate)
    np.testing.assert_array_equal(spectrum.x, found.frequency[1:])
    assert spectrum.y.max() == found.amplitude[1:].max()
    (ticks,) = (mark for mark in lower.marks if isinstance(mark, Rug))
    modes = struck.frequencies("plate")
    assert ticks.values.tolist() == [mode for mode in modes if mode < 25e3]
    assert lower.y.log
    assert lower.y.range is not None
    assert lower.y.range[1] > spectrum.y.max() > lower.y.range[0] > 0.0


def test_what_is_said_of_two_sensors_at_one_point_is_said_once(struck: Result) -> None:
    of_modes = [doubt for doubt in struck.doubts if "modes" in doubt and "sensor" in doubt]
    assert len(of_modes) == 1
    assert '"a1"' in of_modes[0]
    assert '"a2"' in of_modes[0]
    assert '"a3"' in of_modes[0]
    (driven,) = (doubt for doubt in struck.doubts if "beyond its range" in doubt)
    assert '"a1"' in driven
    assert '"a2"' not in driven
