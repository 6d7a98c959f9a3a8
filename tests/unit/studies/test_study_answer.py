"""The answer of a study: how much its results change or what their medians are, with the cause; and
few drops, each of which has a row.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from studies import coal_on_steel
from support import plain_case
from vibroimpact.charts.marks import Band, Line, Points
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.report.report import Quantity, Report, Table
from vibroimpact.studies.report.percentiles import median_interval
from vibroimpact.units.display import text

LOSSY = {"law": "hunt-crossley", "restitution": 0.6}
HEIGHTS = {"drop.height": ["2 m", "1 m", "3 m"]}
DRAWN = {
    "sphere.radius": {"from": "10 mm", "to": "20 mm"},
    "contact.restitution": {"from": 0.5, "to": 0.9},
}


def study_of(folder: Path, sweep: Mapping[str, Any], **sections: Any) -> vi.studies.Study:
    table = {**plain_case(**{"contact": LOSSY, **sections}), "sweep": dict(sweep)}
    return vi.studies.load_study(vi.studies.run_sweep(vi.studies.sweep_of(table), folder / "study"))


def by_name(report: Report) -> dict[str, Quantity]:
    return {quantity.name: quantity for quantity in report.quantities}


def table_of(report: Report) -> Table:
    """Return the table of the results."""
    section = next(section for section in report.sections if section.name == "spread")
    return next(block for block in section.blocks if isinstance(block, Table))


def test_one_key_tells_how_far_each_result_goes_and_where(tmp_path: Path) -> None:
    study = study_of(tmp_path, {"over": HEIGHTS})
    answer = by_name(study.report)
    force = study.values("largest_force_N")
    largest = answer["Largest force"]
    assert (largest.value, largest.largest) == (force.min(), force.max())
    assert largest.note.replace("\u00a0", " ") == "smallest at drop height 1 m, largest at 3 m"
    duration = answer["Duration of the first contact"].note.replace("\u00a0", " ")
    assert duration == "smallest at drop height 3 m, largest at 1 m"
    changes = [one.largest / one.value for one in study.report.quantities]
    assert changes == sorted(changes, reverse=True)
    (stored,) = (one for one in study.document["answer"] if one["name"] == "Largest force")
    assert (stored["value"], stored["largest"]) == (force.min(), force.max())
    page = page_of_report(study.report)
    assert page.index('<dl class="answer ranges">') < page.index('<nav aria-label="Contents">')


def test_few_drops_have_a_row_each_and_no_percentiles(tmp_path: Path) -> None:
    study = study_of(tmp_path, {"over": HEIGHTS})
    table = table_of(study.report)
    columns = {column.heading: column.cells for column in table.columns}
    assert columns["Drop"] == ["0", "1", "2"]
    assert columns["drop.height"] == ["2.000", "1.000", "3.000"]
    scaled = [float(cell) for cell in columns["Largest force"]]
    assert scaled == pytest.approx(study.values("largest_force_N") / 1e3, rel=1e-3)
    assert not any("%" in heading for heading in columns)
    lines = [
        mark
        for mark in study.report.charts[0].panels[0].marks
        if isinstance(mark, Line) and mark.marked
    ]
    assert lines
    assert all(len(line.x) == 3 for line in lines)


def test_several_keys_tell_which_one_changes_most(tmp_path: Path) -> None:
    over = {**HEIGHTS, "contact.restitution": [0.5, 0.6, 0.7, 0.8, 0.9]}
    study = study_of(tmp_path, {"over": over})
    answer = by_name(study.report)
    force = study.values("largest_force_N")[[1, 0, 2], 2]
    change = 100.0 * np.ptp(force) / force[1]
    assert answer["Largest force"].note == f"drop.height alone changes it by {change:.0f} %"
    restitution = answer["Restitution achieved, first impact"]
    assert restitution.note.startswith("contact.restitution alone changes it by ")
    # of fifteen drops, which are no longer few
    assert "5 %" in [column.heading for column in table_of(study.report).columns]


def test_samples_tell_medians_with_intervals_and_ranks(tmp_path: Path) -> None:
    sweep = {"design": "latin-hypercube", "samples": 60, "over": DRAWN}
    study = study_of(tmp_path, sweep)
    force = study.values("largest_force_N")
    median = by_name(study.report)["Largest force, median"]
    assert median.value == np.median(force)
    assert median.interval is not None
    below, above = np.searchsorted(np.sort(force), median.interval)
    assert (below, above) == (21, 38)  # the 22nd and the 39th of 60: tables of the sign test
    assert median.note.startswith("most with sphere.radius (rank correlation ")


def test_points_of_keys_that_change_together_lie_on_a_line(tmp_path: Path) -> None:
    over = {"drop.height": ["3 m", "1 m", "2 m"], "contact.restitution": [0.5, 0.6, 0.7]}
    study = study_of(tmp_path, {"design": "zip", "over": over})
    chart = next(chart for chart in study.report.charts if chart.name == "largest_force_N")
    (line,) = chart.panels[0].marks
    assert isinstance(line, Line)
    assert line.marked
    assert line.x.tolist() == [1.0, 2.0, 3.0]
    assert line.y.tolist() == study.values("largest_force_N")[[1, 2, 0]].tolist()
    assert [text.split("\n")[0] for text in line.texts] == ["drop 1", "drop 2", "drop 0"]
    sampled = study_of(
        tmp_path / "sampled", {"design": "latin-hypercube", "samples": 8, "over": DRAWN}
    )
    chart = next(chart for chart in sampled.report.charts if chart.name == "largest_force_N")
    assert all(isinstance(mark, Points) for panel in chart.panels for mark in panel.marks)


def test_levels_of_few_drops_have_no_bands(tmp_path: Path) -> None:
    over = {
        "drop.height": ["1 m", "2 m"],
        "contact.restitution": [0.5, 0.7],
        "sphere.radius": ["10 mm", "20 mm"],
    }
    study = study_of(tmp_path, {"over": over})
    marks = [
        mark for chart in study.report.charts for mark in (m for p in chart.panels for m in p.marks)
    ]
    assert not any(isinstance(mark, Band) for mark in marks)


def test_a_data_set_tells_its_falls_classes_and_signals(tmp_path: Path) -> None:
    table = {
        **coal_on_steel(),
        "drop": {"height": "0.5 m"},
        "contact": {"law": "hertz"},
        "run": {"impacts": 1, "duration": "0.4 s"},
        "sensors": [{"name": "a", "position": ["60 mm", "30 mm"], "rate": "20 kHz"}],
        "sweep": {
            "design": "population",
            "samples": 24,
            "falls_per_rock": 2,
            "keep": ["signals"],
            "window": {"length": "5 ms"},
            "over": {"sphere.radius": {"from": "10 mm", "to": "30 mm"}},
            "classes": {
                "coal": {"over": {"sphere.material.density": [1380.0]}},
                "gangue": {"over": {"sphere.material.density": [2600.0]}},
            },
        },
    }
    sweep = vi.studies.sweep_of(table)
    study = vi.studies.load_study(vi.studies.run_sweep(sweep, tmp_path / "set"))
    answer = by_name(study.report)
    labels = study.labels["class"]
    coal = int((labels == "coal").sum())
    falls = answer["Falls"]
    assert (falls.value, falls.text) == (24, "24")
    assert falls.note == f"{coal} coal, {24 - coal} gangue; of 12 rocks"
    assert answer["Signals"].value == 24
    assert answer["Signals"].note.startswith("of a, 100 samples each; ")
    force = study.values("largest_force_N")
    median = answer["Largest force, median"]
    # falls of one rock are alike: the interval is that of 12 rocks, not of 24 falls
    assert median.interval == median_interval(force, 12)
    coals = float(np.median(force[labels == "coal"]))
    assert median.note.startswith(f"coal {text(coals, 'N', 3)}, gangue ")


def test_the_interval_of_a_median_holds_as_often_as_it_says() -> None:
    random = np.random.default_rng(5)
    hits = 0
    for _ in range(2000):
        interval = median_interval(random.exponential(size=30), 30)
        assert interval is not None
        hits += interval[0] <= np.log(2.0) <= interval[1]
    assert 0.94 < hits / 2000 < 0.98  # 30 tosses: 0.957
    assert median_interval(np.array([1.0, 2.0, 3.0, np.nan, 4.0, 5.0]), 6) is None
