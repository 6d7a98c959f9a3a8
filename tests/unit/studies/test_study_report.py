"""The report of a study: its files, words and charts for every design, and for studies of
which little is left.
"""

from __future__ import annotations

import csv
import os
import re
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from markupsafe import escape
from rich.console import Console

from support import plain_case
from vibroimpact.dynamics.response import Outcome
from vibroimpact.errors import InputError
from vibroimpact.regenerate import remake_report
from vibroimpact.report.terminal_report import terminal_report
from vibroimpact.studies.computation import compute_study as computing
from vibroimpact.studies.computation.chunk_file import ChunkResult
from vibroimpact.studies.computation.study import Study, load_study
from vibroimpact.studies.planning.drop_variables import OUTCOME
from vibroimpact.studies.planning.sweep_file import sweep_of
from vibroimpact.studies.report.axes import study_axes
from vibroimpact.studies.report.outputs import (
    drawn_outputs,
    output_names,
    sampled_output,
    study_outputs,
)
from vibroimpact.studies.report.scales import key_axis, places
from vibroimpact.studies.report.sensitivity_table import sensitivity_of, strongest
from vibroimpact.studies.report.tables import percentiles_table, sensitivity_table, without_effect
from vibroimpact.studies.run_sweep import run_sweep

LOSSY = {"law": "lankarani-nikravesh", "restitution": 0.7}
RADII = {"from": "5 mm", "to": "50 mm", "scale": "log"}
GRID = {
    "over": {"sphere.radius": {**RADII, "number": 3}, "contact.restitution": [0.6, 0.7, 0.8, 0.9]},
    "keep": ["impacts"],
}
RESULTS = [
    "largest_force_N",
    "largest_indentation_m",
    "first_restitution_achieved",
    "first_duration_s",
    "total_energy_lost_J",
    "first_rebound_height_m",
]
PLATE = {"material": "steel-paper", "size": ["300 mm", "200 mm", "8 mm"]}
DRAWN = {
    "over": {
        "sphere.radius": RADII,
        "contact.restitution": {"distribution": "uniform", "from": 0.5, "to": 0.9},
    }
}


def study_of(folder: Path, sweep: Mapping[str, Any], **sections: Any) -> Study:
    table = {**plain_case(**{"contact": LOSSY, **sections}), "sweep": dict(sweep)}
    return load_study(run_sweep(sweep_of(table), folder / "study"))


@pytest.fixture(scope="module")
def grid(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """A grid of two axes with its whole report; a test that writes takes a copy."""
    return study_of(tmp_path_factory.mktemp("grid"), GRID)


@pytest.fixture
def copy_of_grid(grid: Study, tmp_path: Path) -> Path:
    return Path(shutil.copytree(grid.path.parent, tmp_path / "copy"))


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def charts_of(study: Study) -> set[str]:
    """Return the names of the charts that the page has."""
    return set(re.findall(r'<div class="chart" data-chart="([^"]*)"', page_of(study)))


def page_of(study: Study) -> str:
    return (study.path.parent / "report.html").read_text(encoding="utf-8")


def told(study: Study, width: int = 100) -> str:
    console = Console(width=width, color_system=None)
    with console.capture() as capture:
        console.print(terminal_report(study.report))
    return capture.get()


def test_axes_are_in_the_order_of_the_points(grid: Study) -> None:
    # TOML writes what is a table after what is not, so that the order of the keys in the file's
    # study could be another one
    axes = study_axes(grid)
    assert [axis.key for axis in axes] == ["sphere.radius", "contact.restitution"]
    assert tuple(len(axis.values) for axis in axes) == grid.shapes[OUTCOME] == (3, 4)
    found = sensitivity_of(grid, study_outputs(grid))
    assert found is not None
    assert strongest(found, "first_restitution_achieved") == "contact.restitution"
    assert strongest(found, "largest_force_N") == "sphere.radius"
    asked = grid.values("first_restitution_asked")
    assert found.rows["first_restitution_asked"]["highest"][1] == asked.max()


def test_grid_of_two_axes(grid: Study) -> None:
    assert charts_of(grid) == {"curves", "restitution", "sensitivity"}
    folder = grid.path.parent
    force = grid.values("largest_force_N")
    row = next(
        row for row in rows_of(folder / "percentiles.csv") if row["output"] == "largest_force_N"
    )
    assert float(row["percentile_50"]) == pytest.approx(np.median(force), rel=1e-12)
    assert int(row["drops"]) == 12
    ranges = [
        row for row in rows_of(folder / "sensitivity.csv") if row["output"] == "largest_force_N"
    ]
    assert [row["key"] for row in ranges] == ["sphere.radius", "contact.restitution"]
    assert float(ranges[0]["highest"]) == force[:, 2].max()
    page = page_of(grid)
    assert "12 drops; none failed." in page
    assert "Results of the drops" in page  # few of them
    assert "percentiles.csv" not in page
    assert "contact.restitution" in page
    assert str(escape((folder / "study.toml").read_text(encoding="utf-8"))).rstrip() in page
    assert re.findall(r'(?:src|href)="(?!#)[^"]*"', page) == []


@pytest.mark.parametrize(
    ("over", "charts"),
    [
        ({"contact.restitution": [0.6, 0.7, 0.8]}, {"curves", "restitution"}),
        (
            {"sphere.radius": ["10 mm"], "contact.law": ["hunt-crossley", "flores"]},
            {"curves", "restitution"},
        ),
        ({"sphere.radius": ["10 mm"]}, {"restitution"}),
        (
            {
                "sphere.radius": ["10 mm", "20 mm"],
                "contact.restitution": [0.6, 0.7],
                "drop.height": ["1 m", "3 m"],
            },
            {"curves", "restitution", "sensitivity", *RESULTS},
        ),
    ],
)
def test_charts_suit_the_number_of_axes(
    tmp_path: Path, over: dict[str, Any], charts: set[str]
) -> None:
    assert charts_of(study_of(tmp_path, {"over": over})) == charts


def test_six_results_of_the_bodies_are_drawn(grid: Study) -> None:
    assert [one.name for one in drawn_outputs(study_outputs(grid))] == RESULTS


def test_samples_tell_how_they_spread_and_what_moves_them(tmp_path: Path) -> None:
    study = study_of(tmp_path, {**DRAWN, "design": "latin-hypercube", "samples": 64})
    assert {"inputs", "outputs", "largest_force_N", "sensitivity", "restitution"} <= charts_of(
        study
    )
    ranks = {
        (row["output"], row["key"]): float(row["rank_correlation"])
        for row in rows_of(study.path.parent / "sensitivity.csv")
    }
    assert ranks["first_restitution_achieved", "contact.restitution"] > 0.99
    assert ranks["largest_force_N", "sphere.radius"] > 0.95
    assert "most with sphere.radius (rank correlation" in told(study, 160)


def test_saltelli_counts_its_independent_blocks_alone(tmp_path: Path) -> None:
    study = study_of(tmp_path, {**DRAWN, "design": "saltelli", "samples": 64})
    assert study.size == 256
    force = next(one for one in study_outputs(study) if one.name == "largest_force_N")
    assert force.spread.drops == 128
    assert force.spread.mean == pytest.approx(
        study.values("largest_force_N")[:128].mean(), rel=1e-12
    )
    total = {
        (row["output"], row["key"]): float(row["total"])
        for row in rows_of(study.path.parent / "sensitivity.csv")
    }
    assert total["first_restitution_achieved", "contact.restitution"] == pytest.approx(1.0, abs=0.2)
    assert total["first_restitution_achieved", "sphere.radius"] == pytest.approx(0.0, abs=1e-3)


def test_keys_of_a_zip_are_not_told_apart(tmp_path: Path) -> None:
    over = {"sphere.radius": ["10 mm", "20 mm", "30 mm"], "drop.height": ["1 m", "2 m", "3 m"]}
    study = study_of(tmp_path, {"over": over, "design": "zip"})
    assert "change together" in page_of(study)
    assert not (study.path.parent / "sensitivity.csv").exists()


def test_names_have_no_ranks_and_the_page_says_so(tmp_path: Path) -> None:
    over = {"contact.law": ["hunt-crossley", "flores"], "sphere.radius": RADII}
    study = study_of(tmp_path, {"over": over, "design": "latin-hypercube", "samples": 30})
    assert "contact.law: names have no order" in page_of(study)
    assert {row["key"] for row in rows_of(study.path.parent / "sensitivity.csv")} == {
        "sphere.radius"
    }


def test_failures_are_told_with_their_points_and_left_out_of_the_numbers(tmp_path: Path) -> None:
    study = study_of(
        tmp_path,
        {"over": {"drop.height": ["1 m", "30 mm"], "sphere.radius": ["10 mm", "20 mm", "40 mm"]}},
    )
    assert len(study.failures) == 1
    page = page_of(study)
    assert "6 drops; 1 failed (17 %)." in page
    assert '<th scope="row">5</th><td>30.00\u00a0mm</td><td>40.00\u00a0mm</td>' in page
    spreads = {one.name: one.spread for one in study_outputs(study)}
    assert spreads["number_of_impacts"].drops == 5
    assert "1 drop: drop.height: 0.03 m does not lift the sphere off the surface" in told(
        study, 200
    )


def test_a_study_of_which_every_drop_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def failing(
        table: Any, keep: Any, first: int, points: Mapping[str, Any], window: Any
    ) -> ChunkResult:
        count = len(next(iter(points.values())))
        codes = np.full(count, list(Outcome).index(Outcome.FAILED), dtype=np.int8)
        return ChunkResult({OUTCOME: codes}, dict.fromkeys(range(count), "no luck"))

    monkeypatch.setattr(computing, "compute_points", failing)
    study = study_of(tmp_path, GRID)
    assert "12 drops; all of them failed." in page_of(study)
    assert not charts_of(study)
    assert rows_of(study.path.parent / "percentiles.csv") == []
    assert "12 drops, such as: no luck" in told(study)


def test_laws_without_restitution_and_without_force(tmp_path: Path) -> None:
    over = {"sphere.radius": ["10 mm", "20 mm", "30 mm"]}
    hertz = study_of(tmp_path, {"over": over}, contact={"law": "hertz"})
    assert charts_of(hertz) == {"curves"}
    assert "No restitution is asked of the law" in page_of(hertz)
    over = {"contact.restitution": [0.3, 0.5], "drop.height": ["1 m", "2 m"]}
    newton = study_of(
        tmp_path / "newton", {"over": over}, contact={"law": "newton", "restitution": 0.5}
    )
    assert charts_of(newton) == {"curves", "restitution", "sensitivity"}
    assert "Without a value in any drop: largest force" in page_of(newton)


def test_signals_of_sensors_whatever_they_are_called(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    name = "left.a[1] $x$"

    def ringing(
        table: Any, keep: Any, first: int, points: Mapping[str, Any], window: Any
    ) -> ChunkResult:
        height = np.asarray(points["drop.height"], dtype=float)
        time = np.arange(501) / 50e3
        signals = height[:, None] * np.where(
            time > 2e-3, np.sin(6e3 * time) * np.exp(-300.0 * time), 0.0
        )
        arrays = {
            OUTCOME: np.ones(len(height), np.int8),
            f"{name}_max_magnitude": np.abs(signals).max(axis=1),
        }
        return ChunkResult({**arrays, f"signal_{name}": signals.astype(np.float32)}, {})

    monkeypatch.setattr(computing, "compute_points", ringing)
    study = study_of(
        tmp_path,
        {"over": {"drop.height": ["1 m", "2 m", "3 m"]}, "keep": ["signals"]},
        plate={
            "material": "steel",
            "model": "elastic",
            "size": ["500 mm", "400 mm", "8 mm"],
            "supports": "simply-supported",
            "modes": 2,
        },
        sensors=[{"name": name, "position": [0.1, 0.05]}],
        run={"duration": 0.01},
    )
    assert charts_of(study) == {"curves", "signal_left_a_1_x"}
    assert f"Sensor {name}" in page_of(study)
    assert "3 levels, 1.000 to 3.000\u00a0m" in page_of(study)
    assert study.times(name) == pytest.approx(np.arange(501) / 50e3, rel=1e-15)
    with pytest.raises(InputError, match='no variable "signal_right"'):
        study.times("right")
    assert f"Largest reading of {name}" in told(study, 160)
    (row,) = [
        row
        for row in rows_of(study.path.parent / "sensitivity.csv")
        if row["output"] == f"{name}_max_magnitude"
    ]
    assert float(row["relative_range"]) == pytest.approx(1.0)  # from 1 m to 3 m, of what 2 m gives


def test_levels_that_are_whole_numbers_or_one_alone(tmp_path: Path) -> None:
    study = study_of(tmp_path, {"over": {"run.impacts": [3, 1, 2], "sphere.radius": ["10 mm"]}})
    axes = study_axes(study)
    assert axes[0].numeric
    assert axes[0].values.tolist() == [3.0, 1.0, 2.0]
    assert "curves" in charts_of(study)


def test_names_with_signs_that_mean_something_elsewhere(tmp_path: Path) -> None:
    study = study_of(
        tmp_path,
        {"over": {"sphere.radius": ["10 mm", "20 mm"]}},
        name="a [b]$x^$ <i>study</i>.{{ 1 }}",
    )
    assert study.name == "a [b]$x^$ <i>study</i>.{{ 1 }}"
    assert study.name in told(study)
    assert "A [b]$x^$ &lt;i&gt;study&lt;/i&gt;.{{ 1 }}" in page_of(study)


def test_the_report_is_remade_as_it_was_and_figures_are_left(copy_of_grid: Path) -> None:
    def files() -> dict[Path, bytes]:
        return {
            file: file.read_bytes()
            for file in copy_of_grid.rglob("*.*")
            if file.suffix in (".png", ".csv", ".html", ".json")
        }

    (copy_of_grid / "figures").mkdir()
    (copy_of_grid / "figures" / "maps.png").write_bytes(b"drawn before")
    before = files()
    assert remake_report(copy_of_grid) == copy_of_grid
    assert files() == before
    assert not list(copy_of_grid.glob(".report*"))


@pytest.mark.skipif(os.name != "posix", reason="files are taken out of reach by their mode")
def test_a_report_that_cannot_be_written_leaves_the_old_one(
    copy_of_grid: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = (copy_of_grid / "report.html").read_bytes()

    def full(*_: Any, **__: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("vibroimpact.report.save_report.page_of_report", full)
    with pytest.raises(InputError, match="No space left"):
        remake_report(copy_of_grid)
    assert (copy_of_grid / "report.html").read_bytes() == before


def test_what_is_thinned_stands_for_all(tmp_path: Path, grid: Study) -> None:
    assert len(sampled_output(grid, "largest_force_N", 7)) <= 7
    assert set(sampled_output(grid, "largest_force_N", 7)) <= set(
        grid.values("largest_force_N").ravel()
    )
    drawn = study_of(tmp_path / "drawn", {**DRAWN, "design": "sobol", "samples": 32})
    # as many as are even
    assert np.array_equal(
        sampled_output(drawn, "largest_force_N", 20), drawn.values("largest_force_N")[:16]
    )
    assert output_names(drawn)[0] == "largest_force_N"


def test_names_on_an_axis_lie_side_by_side(tmp_path: Path) -> None:
    axes = study_axes(
        study_of(
            tmp_path,
            {
                "over": {
                    "contact.law": ["hunt-crossley", "flores"],
                    "sphere.radius": ["10 mm", "20 mm"],
                }
            },
        )
    )
    assert places(axes[0], axes[0].values).tolist() == [0.0, 1.0]
    assert key_axis(axes[0]).names == ("hunt-crossley", "flores")
    assert (key_axis(axes[1]).label, key_axis(axes[1]).unit) == ("Radius of the sphere", "m")
    assert places(axes[1], axes[1].values).tolist() == [0.01, 0.02]


def test_tables_have_no_rows_of_zeros_and_no_columns_of_dashes(tmp_path: Path) -> None:
    study = study_of(
        tmp_path,
        {"over": {"plate.size.thickness": ["5 mm", "8 mm"], "sphere.radius": ["10 mm"]}},
        plate=PLATE,
    )
    columns = percentiles_table(study_outputs(study)).columns
    # no result differs: the plate is rigid
    assert "Standard deviation" not in [column.heading for column in columns]
    rows = list(zip(*(column.cells for column in columns[3:]), strict=True))
    assert rows
    assert all(any(set(cell) - set("0.\u2013") for cell in row) for row in rows)
    # the closure may be zero to the last digit
    zeros = re.findall(r"Zero in all drops: ([^.<]*)", page_of(study))
    assert zeros in ([], ["closure of the energy, relative"]), zeros


def test_keys_without_effect_are_named_and_not_a_row(tmp_path: Path) -> None:
    over = {"plate.size.thickness": ["5 mm", "8 mm"], "sphere.radius": ["10 mm", "20 mm"]}
    study = study_of(tmp_path, {"over": over}, plate=PLATE)
    found = sensitivity_of(study, study_outputs(study))
    assert found is not None
    outputs = drawn_outputs(study_outputs(study))
    assert list(sensitivity_table(found, outputs).columns[0].cells) == ["sphere.radius"]
    assert without_effect(found, outputs) == ["plate.size.thickness"]
    assert (
        "Left out, as all their numbers are missing or zero once rounded: plate.size.thickness."
        in page_of(study)
    )
