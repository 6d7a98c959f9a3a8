"""The page of a run of every kind: it holds its charts and numbers, what has names is
shown as it is, and no other script runs.
"""

from __future__ import annotations

import re
import zlib
from base64 import b64decode, b64encode
from dataclasses import replace
from hashlib import sha256
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from many_runs import HOSTILE, RUNS, SUPPORTS, held, run_of
from pages import Page
from support import one_in
from vibroimpact.charts.chart import Panel, values_on
from vibroimpact.charts.files import save_charts
from vibroimpact.charts.marks import Label, Line, Outline, Points
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.runs import chart_data
from vibroimpact.runs.charts import run_charts
from vibroimpact.runs.setup import setup_chart, setup_rows
from vibroimpact.runs.tables import impact_table

pytestmark = pytest.mark.filterwarnings("error")


@pytest.mark.parametrize("name", RUNS)
def test_a_run_of_every_kind_has_a_page(name: str) -> None:
    result = run_of(name)
    page = Page(page_of_report(result.report))
    assert result.status in page.text
    data = page.data()
    names = [chart["name"] for chart in data["charts"]]
    assert names[0] == "setup"
    assert {"position", "velocity", "energy"} <= set(names)
    assert len(set(names)) == len(names)
    assert ("force" in names) == bool(np.any(result.impacts["duration_s"] > 0.0))
    assert ("plate_motion" in names) == (
        "plate" in result.peaks and len(result.impacts["impact"]) > 0
    )
    assert [value for key, value in page.attributes if key == "data-chart"] == names
    assert (data["scene"] is None) == (result.deflection is None)
    traces = next(chart for chart in data["charts"] if chart["name"] == "position")["data"]
    drawn = next(trace for trace in traces if trace.get("mode") == "lines" and len(trace["x"]) > 2)
    # the line passes within a tenth of a pixel of every point of the history
    time, position = result.history["time_s"], result.history["position_m"]
    away = np.abs(np.interp(time, drawn["x"], drawn["y"]) - position)
    # at a jump two points have the same time, of which interpolation gives one
    is_jump = np.isin(time, time[1:][np.diff(time) == 0.0])
    away = away[~is_jump]
    assert away.max(initial=0.0) <= 3.1e-4 * np.ptp(position) + 1e-6 * np.abs(position).max()
    for cells in impact_table(result).rows:
        assert all(cell in page.text for cell in cells)


@pytest.mark.parametrize("name", one_in(6, RUNS))
def test_the_charts_of_every_kind_are_drawn_for_print(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("vibroimpact.charts.files._DPI", 30)
    charts = [setup_chart(run_of(name)), *run_charts(run_of(name))]
    assert [path.name for path in save_charts(charts, tmp_path)] == [
        f"{chart.name}.png" for chart in charts
    ]


def test_what_runs_in_a_page_is_what_its_policy_allows() -> None:
    text = page_of_report(run_of("sensors").report)
    page = Page(text)
    policy = next(
        value
        for key, value in page.attributes
        if key == "content" and value and value.startswith("default-src")
    )
    allowed = set(re.findall(r"'sha256-([^']+)'", policy))
    plotly = zlib.decompress(b64decode(page.script("plotly"))).decode()
    run = [script for attributes, script in page.scripts if not attributes]
    assert len(run) == 4
    digests = [b64encode(sha256(script.encode()).digest()).decode() for script in (*run, plotly)]
    assert set(digests) == allowed
    assert re.findall(r"(?:script|default|connect)-src ([^;]*)", policy)[0] == "'none'"
    assert "unsafe-inline" not in policy.split("style-src")[0]
    assert not [
        key for key, _ in page.attributes if key.startswith("on") or key in ("src", "srcdoc")
    ]
    assert not [
        value for key, value in page.attributes if key == "href" and not str(value).startswith("#")
    ]
    assert "plotly.js" in plotly[:300]


def test_names_that_are_scripts_are_shown_as_text() -> None:
    text = page_of_report(run_of("hostile names").report)
    page = Page(text)
    assert HOSTILE not in text
    assert "alert(1)</script>" not in text
    assert sum(attributes == {} for attributes, _ in page.scripts) == 4
    assert page.text.count(HOSTILE) > 6  # title, tables, headings, contents and case
    assert "b" not in page.tags
    data = page.data()
    for chart in data["charts"]:
        for words in texts_of(chart["layout"]) + [
            word for trace in chart["data"] for word in texts_of(trace)
        ]:
            assert "<script" not in words, words
            assert "<b>" not in words, words
    sensor = next(chart for chart in data["charts"] if chart["title"].startswith("Sensor <script>"))
    assert sensor["layout"]["annotations"]
    setup = data["charts"][0]
    assert any(unescape(words).startswith("<script>al") for words in texts_of(setup["layout"]))


def texts_of(part: Any) -> list[str]:
    """The words that plotly reads as HTML."""
    if isinstance(part, dict):
        own = [
            value
            for key, value in part.items()
            if key in ("text", "name", "ticktext", "hovertemplate") and isinstance(value, str)
        ]
        many = [
            word
            for key, value in part.items()
            if key in ("text", "ticktext") and isinstance(value, list)
            for word in value
        ]
        return own + many + [word for value in part.values() for word in texts_of(value)]
    return [word for one in part for word in texts_of(one)] if isinstance(part, list) else []


def test_a_name_without_end_does_not_fill_the_page() -> None:
    result = run_of("hostile names")
    setup = setup_rows(
        replace(
            result,
            case={**result.case, "sensors": [{**result.case["sensors"][0], "name": "x" * 10_000}]},
        )
    )
    assert all(len(name) < 100 and len(words) < 400 for name, words in setup)
    for chart in run_charts(result):
        assert len(chart.title) < 100


@pytest.mark.parametrize("name", SUPPORTS)
def test_supports_of_every_kind_are_drawn_below_the_plate_and_on_it(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("vibroimpact.charts.files._DPI", 30)
    result = held(name)
    chart = setup_chart(result)
    side, above = chart.panels
    supports = [
        mark
        for mark in side.marks
        if isinstance(mark, Outline) and mark.role in ("support", "held")
    ]
    outlines = [mark for mark in above.marks if isinstance(mark, Outline) and mark.role == "held"]
    assert bool(supports) == bool(outlines) == (name != "free")
    for mark in supports:
        assert mark.y.min() < -0.01 + 1e-12  # a clamp reaches above the plate too
        assert -0.172 <= mark.x.min() < mark.x.max() <= 0.172
    for mark in outlines:
        assert -0.15 - 1e-12 <= mark.x.min() < mark.x.max() <= 0.15 + 1e-12
        assert -0.1 - 1e-12 <= mark.y.min() < mark.y.max() <= 0.1 + 1e-12
    count = {
        "free": 0,
        "two edges": 2,
        "patches of both kinds": 2,
        "a bar and points": 3,
        "springs": 2,
    }.get(name, 4)
    assert len(outlines) == count
    words = dict(setup_rows(result))["Plate"]
    told = {
        "two edges": "clamped at x-min",
        "patches": "4 rigid patches",
        "bars": "4 elastic columns",
        "springs": "2 springs",
    }
    assert told.get(name, "") in words
    save_charts([chart], tmp_path)
    assert page_of_report(result.report)


def words_of(panel: Panel) -> list[str]:
    return [mark.words.replace("\u00a0", " ") for mark in panel.marks if isinstance(mark, Label)]


def test_the_sketch_gives_the_dimensions_as_they_were_given() -> None:
    side, above = setup_chart(run_of("sensors")).panels
    assert words_of(side) == ["300 mm", "10 mm thick", "radius 25 mm", "100 mm above the plate"]
    assert words_of(above) == ["300 mm", "200 mm", "a1, a2", "v"]
    (below,) = setup_chart(run_of("a sphere below")).panels
    assert "radius 40 mm" in words_of(below)
    assert dict(setup_rows(run_of("a sphere below")))["Lower sphere"].endswith("held fixed")
    (made,) = setup_chart(run_of("modes made in Python")).panels
    assert words_of(made) == ["radius 25 mm", "arrives at 3 m/s"]
    assert setup_rows(run_of("made in Python")) == []


def test_parameters_of_the_law_have_their_units() -> None:
    words = dict(setup_rows(run_of("a sphere on a half space")))["Contact law"].replace(
        "\u00a0", " "
    )
    assert words.startswith(
        "lankarani-nikravesh: stiffness 5.11545·10⁸ N/m¹·⁵, exponent 1.5, restitution 0.7"
    )
    result = run_of("a sphere on a half space")
    elsewhere = replace(
        result, case={**result.case, "contact": {"law": "of another package", "restitution": 0.5}}
    )
    assert dict(setup_rows(elsewhere))["Contact law"] == "of another package"


def test_a_very_long_run_is_drawn_whole_with_its_first_contacts_in_full(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    case = {
        "sphere": {"radius": 0.025, "material": "rock-paper"},
        "plate": {"material": "steel-paper"},
        "drop": {"height": 0.5},
        "contact": {"law": "hertz"},
        "run": {"impacts": 60},
    }
    result = vi.result_of(vi.simulate(vi.case_of(case)))
    monkeypatch.setattr(chart_data, "MOST_POINTS", 6000)
    assert len(result.history["time_s"]) > 6000
    drawn = chart_data.drawn_history(result)
    assert len(drawn["time_s"]) < len(result.history["time_s"])
    assert drawn["force_N"].max() == result.history["force_N"].max()
    assert drawn["time_s"][-1] == result.history["time_s"][-1]
    first = result.history["time_s"] < result.impacts["time_s"][0] + result.impacts["duration_s"][0]
    first &= result.history["time_s"] > result.impacts["time_s"][0]
    assert set(result.history["time_s"][first]) <= set(drawn["time_s"])
    charts = {chart.name: chart for chart in run_charts(result)}
    assert len(charts["force"].views) == 60
    assert Page(page_of_report(result.report)).text


def test_charts_over_time_share_their_range() -> None:
    charts = run_charts(run_of("sensors"))
    over_time = [
        panel.x.range for chart in charts for panel in chart.panels if panel.x.label == "Time"
    ]
    assert len(over_time) > 10
    assert len(set(over_time)) == 1
    low, high = over_time[0] or (0.0, 0.0)
    end = run_of("sensors").history["time_s"][-1]
    assert low < 0.0 < end < high < 1.02 * end


def test_points_of_two_kinds_look_different() -> None:
    (panel,) = next(
        chart for chart in run_charts(run_of("a dent")) if chart.name == "position"
    ).panels
    roles = [mark.role for mark in panel.marks if isinstance(mark, Points)]
    assert len(set(roles)) == len(roles) == 2


def test_every_view_shows_its_contact(theory: vi.Response) -> None:
    result = vi.result_of(theory)
    for chart in run_charts(result):
        if chart.name == "force_indentation":
            continue
        assert [view.name for view in chart.views] == [f"Impact {number}" for number in range(1, 6)]
        for view, touch, duration in zip(
            chart.views, result.impacts["time_s"], result.impacts["duration_s"], strict=True
        ):
            assert view.start < touch < touch + duration < view.end
            assert view.origin == touch


def test_the_energy_is_shown_whole(theory: vi.Response) -> None:
    chart = next(chart for chart in run_charts(vi.result_of(theory)) if chart.name == "energy")
    (panel,) = chart.panels
    edges = values_on(panel.y, (panel,))
    assert edges.max() == pytest.approx(theory.energy["input_J"], rel=1e-9)


def test_lines_hold_the_whole_history(theory: vi.Response) -> None:
    result = vi.result_of(theory)
    charts = {chart.name: chart for chart in run_charts(result)}
    for column in ("position_m", "force_N", "velocity_m_s", "acceleration_m_s2"):
        (line,) = (
            mark for mark in charts[column.split("_")[0]].panels[0].marks if isinstance(mark, Line)
        )
        np.testing.assert_array_equal(line.x, result.history["time_s"])
        np.testing.assert_array_equal(line.y, result.history[column])


def test_a_chart_is_named_for_a_file(theory: vi.Response) -> None:
    names = [
        chart.name
        for chart in (*run_charts(vi.result_of(theory)), *run_charts(run_of("hostile names")))
    ]
    assert all(re.fullmatch(r"[a-z0-9_-]+", name, flags=re.I) for name in names)
