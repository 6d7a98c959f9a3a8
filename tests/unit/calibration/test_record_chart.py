"""What is drawn over a record: the same impacts, simulated with the values found."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.calibration.fit.overlay import Overlay
from vibroimpact.calibration.record_chart import record_chart
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.marks import Line, Points
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.charts.plotly import plotly_chart

CONTACT = {"law": "adams-impact", "damping_max": 200.0}


@pytest.fixture(scope="module")
def response() -> vi.Response:
    return vi.simulate(vi.case_of(plain_case(contact=CONTACT, run={"impacts": 3})))


def found_in(
    response: vi.Response, file: Path, column: str, header: str, step: float
) -> Calibration:
    time = np.arange(0.0, float(response.end_time[0]), step)
    rows = "\n".join(
        f"{at:.9g},{value:.9g}" for at, value in zip(time, response.at(time)[column], strict=True)
    )
    file.write_text(f"time_s,{header}\n{rows}\n")
    table = plain_case(
        contact=CONTACT,
        run={"impacts": 3},
        calibrate={"target": str(file), "degree": 0, "air": False},
    )
    return calibrate_case(calibration_of(table))


def chart_of(found: Calibration, name: str) -> Chart:
    return found.charts[name]


def test_forces(response: vi.Response, tmp_path: Path) -> None:
    """Contact by contact, as near as the record tells; and the page has the picture."""
    found = found_in(response, tmp_path / "force.csv", "force_N", "force_N", 1e-5)
    assert [one.quantity for one in found.overlays] == ["force"] * 3
    for number, one in enumerate(found.overlays):
        simulated = np.interp(*one.measured[:1], *one.simulated, left=0.0, right=0.0)
        largest = response.impacts["max_force_N"][number]
        assert np.abs(one.measured[1] - simulated).max() < 0.06 * largest
        assert one.simulated[1].max() == pytest.approx(largest, rel=5e-3)
    folder = found.save(tmp_path / "out")
    page = (folder / "report.html").read_text()
    assert 'data-chart="record"' in page
    assert all(
        f'<option value="{number}">Impact {number + 1}</option>' in page for number in range(3)
    )
    assert not (folder / "figures").exists()


@pytest.mark.slow
def test_a_force_is_shown_where_it_was_measured(response: vi.Response, tmp_path: Path) -> None:
    """At the times of the record, all samples of it, with the difference below and each
    contact enlarged.
    """
    found = found_in(response, tmp_path / "force.csv", "force_N", "force_N", 1e-5)
    chart = chart_of(found, "record")
    (upper,), (lower,) = chart.rows
    assert upper.x is lower.x
    measured = [mark for mark in upper.marks if isinstance(mark, Points)]
    simulated = [mark for mark in upper.marks if isinstance(mark, Line)]
    apart = [mark for mark in lower.marks if isinstance(mark, Line)]
    assert {mark.name for mark in measured} == {"measured"}
    assert {mark.name for mark in simulated} == {"simulated"}
    assert len(measured) == len(simulated) == len(apart) == len(chart.views) == 3
    touches = response.impacts["time_s"]
    for number, view in enumerate(chart.views):
        assert view.origin == pytest.approx(touches[number], abs=3e-6)
        np.testing.assert_allclose(
            measured[number].y, response.at(measured[number].x)["force_N"], atol=1e-5
        )
        assert view.start < measured[number].x[np.argmax(measured[number].y)] < view.end
        largest = response.impacts["max_force_N"][number]
        assert simulated[number].y.max() == pytest.approx(largest, rel=5e-3)
        np.testing.assert_allclose(np.abs(apart[number].y).max(), 0.0, atol=0.06 * largest)
        np.testing.assert_array_equal(apart[number].x, measured[number].x)
    assert len(matplotlib_figure(chart).axes) == 8  # the whole, and three contacts, in two rows
    assert len(plotly_chart(chart)["views"]) == 3


def test_a_long_record_is_shown_with_its_extremes() -> None:
    time = np.linspace(0.0, 10.0, 300_001)
    height = 1.0 + 0.1 * np.sin(time)
    height[[12_345, 222_222]] = 3.0, -3.0
    simulated = np.where(time > 1.0, height - 1e-3, np.nan)
    chart = record_chart(
        (
            Overlay(
                "", "position", (time, height), (time, simulated), flights=((1.0, 5.0), (5.0, 9.0))
            ),
        )
    )
    (upper,), (lower,) = chart.rows
    drawn = upper.marks[0]
    assert isinstance(drawn, Line)
    assert len(drawn.x) < 1.1e5
    assert (drawn.y.min(), drawn.y.max()) == (-3.0, 3.0)
    (apart,) = lower.marks
    assert isinstance(apart, Line)
    np.testing.assert_allclose(apart.y, 1e-3, atol=1e-12)
    assert apart.x[0] > 1.0
    assert [view.origin for view in chart.views] == [1.0, 5.0]


def test_positions(response: vi.Response, tmp_path: Path) -> None:
    found = found_in(response, tmp_path / "height.csv", "position_m", "position_m", 1e-3)
    (one,) = found.overlays
    apart = (one.measured[1] - one.simulated[1])[np.isfinite(one.simulated[1])]
    assert np.abs(apart).max() < 2e-5
    assert np.isnan(one.simulated[1][one.measured[0] < response.impacts["time_s"][0]]).all()
    chart = chart_of(found, "record")
    (upper,), (lower,) = chart.rows
    (difference,) = lower.marks
    assert isinstance(difference, Line)
    assert np.abs(difference.y).max() == np.abs(apart).max()
    assert [mark.name for mark in upper.marks if isinstance(mark, (Line, Points))] == [
        "measured",
        "simulated",
    ]
    for view, touch in zip(chart.views, response.impacts["time_s"], strict=True):
        assert view.origin == pytest.approx(touch, abs=1e-3)  # contacts are not resolved


def test_no_record_no_picture() -> None:
    table = plain_case(
        contact={"law": "newton", "restitution": 0.5},
        calibrate={"target": {"rebound_heights": [0.3]}, "air": False},
    )
    found = calibrate_case(calibration_of(table))
    assert found.overlays == ()
    assert list(found.charts) == ["parameter"]


def test_a_law_without_a_force_has_none_to_draw(response: vi.Response, tmp_path: Path) -> None:
    time = np.arange(0.0, float(response.end_time[0]), 2e-5)
    (tmp_path / "f.csv").write_text(
        "time_s,force_N\n"
        + "\n".join(
            f"{at:.9g},{value:.9g}"
            for at, value in zip(time, response.at(time)["force_N"], strict=True)
        )
    )
    table = plain_case(
        contact={"law": "newton", "restitution": 0.5},
        calibrate={"target": str(tmp_path / "f.csv"), "air": False},
    )
    assert calibrate_case(calibration_of(table)).overlays == ()
