"""The report of a study: its files, words and figures for every design, and for studies of which little is left."""

from __future__ import annotations

import csv
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from support import plain_case
from vibroimpact.cases.sweep import read_sweep
from vibroimpact.dynamics.response import Outcome
from vibroimpact.errors import InputError
from vibroimpact.report.save import remake_report
from vibroimpact.report.study import folder as study_folder
from vibroimpact.report.study.axes import Ticks, study_axes
from vibroimpact.report.study.outputs import output_names, some, study_outputs
from vibroimpact.report.study.sensitivity import sensitivity_of, strongest
from vibroimpact.report.study.text import study_summary
from vibroimpact.storage.study import Study, read_study
from vibroimpact.studies.chunk_file import ChunkResult
from vibroimpact.studies.columns import OUTCOME
from vibroimpact.studies.percentiles import spread_of
from vibroimpact.studies.sensitivity import rank_correlations, reach_on_grid

LOSSY = {"law": "lankarani-nikravesh", "restitution": 0.7}
RADII = {"from": "5 mm", "to": "50 mm", "scale": "log"}
GRID = {
    "over": {"sphere.radius": {**RADII, "number": 3}, "contact.restitution": [0.6, 0.7, 0.8, 0.9]},
    "keep": ["impacts"],
}
DRAWN = {"over": {"sphere.radius": RADII, "contact.restitution": {"distribution": "uniform", "from": 0.5, "to": 0.9}}}


def study_of(folder: Path, sweep: Mapping[str, Any], **sections: Any) -> Study:
    table = {**plain_case(**{"contact": LOSSY, **sections}), "sweep": dict(sweep)}
    return read_study(study_folder.run_sweep(read_sweep(table), folder / "study"))


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def figures_of(study: Study) -> set[str]:
    return {file.stem for file in (study.path.parent / "figures").glob("*.svg")}


def page_of(study: Study) -> str:
    return (study.path.parent / "report.html").read_text(encoding="utf-8")


def told(study: Study, width: int = 100) -> str:
    console = Console(width=width, color_system=None)
    with console.capture() as capture:
        console.print(study_summary(study, width))
    return capture.get()


def test_spread_is_numpys_and_passes_over_what_is_not_there() -> None:
    values = np.random.default_rng(1).lognormal(size=1001)
    kept = values.copy()
    found = spread_of(np.append(values, [np.nan, np.inf]))
    assert np.array_equal(values, kept)
    assert found.drops == 1001
    assert found.mean == pytest.approx(values.mean(), rel=1e-12)
    assert found.standard_deviation == pytest.approx(values.std(ddof=1), rel=1e-12)
    assert found.percentiles == pytest.approx(np.percentile(values, [5, 25, 50, 75, 95]), rel=1e-12)
    assert spread_of(np.array([np.nan])).drops == 0
    assert not spread_of(np.full(5, 0.1)).varies


def test_ranks_know_order_alone() -> None:
    drops = np.random.default_rng(2).uniform(1.0, 2.0, (2, 500))
    found = rank_correlations(drops, np.append(np.exp(-9.0 * drops[0, :-1]), np.nan))
    assert found[0] == pytest.approx(-1.0)
    assert abs(found[1]) < 0.15
    assert np.isnan(rank_correlations(drops, np.ones(500))).all()


def test_reach_is_taken_at_the_middle_of_sorted_levels() -> None:
    levels = np.array([3.0, 1.0, 2.0])
    found = reach_on_grid(levels[:, None] * np.array([10.0, 20.0, np.nan]), [np.argsort(levels), np.array([0, 1, 2])])
    assert (found.middle, found.lowest.tolist(), found.highest.tolist()) == (40.0, [20.0, 20.0], [60.0, 40.0])
    assert found.relative.tolist() == [1.0, 0.5]


def test_axes_are_in_the_order_of_the_points(tmp_path: Path) -> None:
    # TOML writes what is a table after what is not, so that the order of the keys in the file's study is another one
    study = study_of(tmp_path, GRID)
    axes = study_axes(study)
    assert [axis.key for axis in axes] == ["sphere.radius", "contact.restitution"]
    assert tuple(len(axis.values) for axis in axes) == study.shapes[OUTCOME] == (3, 4)
    found = sensitivity_of(study, study_outputs(study))
    assert found is not None
    assert strongest(found, "first_restitution_achieved") == "contact.restitution"
    assert strongest(found, "largest_force_N") == "sphere.radius"
    asked = study.values("first_restitution_asked")
    assert found.rows["first_restitution_asked"]["highest"][1] == asked.max()


def test_grid_of_two_axes(tmp_path: Path) -> None:
    study = study_of(tmp_path, GRID)
    assert figures_of(study) == {"maps", "restitution", "sensitivity"}
    folder = study.path.parent
    force = study.values("largest_force_N")
    row = next(row for row in rows_of(folder / "percentiles.csv") if row["output"] == "largest_force_N")
    assert float(row["percentile_50"]) == pytest.approx(np.median(force), rel=1e-12)
    assert int(row["drops"]) == 12
    ranges = [row for row in rows_of(folder / "sensitivity.csv") if row["output"] == "largest_force_N"]
    assert [row["key"] for row in ranges] == ["sphere.radius", "contact.restitution"]
    assert float(ranges[0]["highest"]) == force[:, 2].max()
    page = page_of(study)
    assert "12 drops; none failed." in page
    assert "nothing of how likely" in page
    assert "contact.restitution" in page
    assert "http://" not in page.replace("http://www.w3.org", "")


@pytest.mark.parametrize(
    ("over", "figures"),
    [
        ({"contact.restitution": [0.6, 0.7, 0.8]}, {"curves", "restitution"}),
        ({"sphere.radius": ["10 mm"], "contact.law": ["hunt-crossley", "flores"]}, {"curves", "restitution"}),
        ({"sphere.radius": ["10 mm"]}, {"restitution"}),
        (
            {"sphere.radius": ["10 mm", "20 mm"], "contact.restitution": [0.6, 0.7], "drop.height": ["1 m", "3 m"]},
            {"maps", "restitution", "sensitivity", "largest_force_N", "largest_indentation_m", "first_restitution_achieved"}
            | {"first_duration_s", "total_energy_lost_J", "first_rebound_height_m"},
        ),
    ],
)
def test_figures_suit_the_number_of_axes(tmp_path: Path, over: dict[str, Any], figures: set[str]) -> None:
    assert figures_of(study_of(tmp_path, {"over": over})) == figures


def test_samples_tell_how_they_spread_and_what_moves_them(tmp_path: Path) -> None:
    study = study_of(tmp_path, {**DRAWN, "design": "latin-hypercube", "samples": 64})
    assert {"inputs", "outputs", "largest_force_N", "sensitivity", "restitution"} <= figures_of(study)
    ranks = {(row["output"], row["key"]): float(row["rank_correlation"]) for row in rows_of(study.path.parent / "sensitivity.csv")}
    assert ranks["first_restitution_achieved", "contact.restitution"] > 0.99
    assert ranks["largest_force_N", "sphere.radius"] > 0.95
    assert "sphere.radius (rank correlation" in told(study)


def test_saltelli_counts_its_independent_blocks_alone(tmp_path: Path) -> None:
    study = study_of(tmp_path, {**DRAWN, "design": "saltelli", "samples": 64})
    assert study.size == 256
    force = next(one for one in study_outputs(study) if one.name == "largest_force_N")
    assert force.spread.drops == 128
    assert force.spread.mean == pytest.approx(study.values("largest_force_N")[:128].mean(), rel=1e-12)
    total = {(row["output"], row["key"]): float(row["total"]) for row in rows_of(study.path.parent / "sensitivity.csv")}
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
    assert {row["key"] for row in rows_of(study.path.parent / "sensitivity.csv")} == {"sphere.radius"}


def test_failures_are_told_with_their_points_and_left_out_of_the_numbers(tmp_path: Path) -> None:
    study = study_of(tmp_path, {"over": {"drop.height": ["1 m", "30 mm"], "sphere.radius": ["10 mm", "20 mm", "40 mm"]}})
    assert len(study.failures) == 1
    page = page_of(study)
    assert "6 drops; 1 failed (17 %)." in page
    assert "<td>5</td><td>30.00\u00a0mm</td><td>40.00\u00a0mm</td>" in page
    spreads = {one.name: one.spread for one in study_outputs(study)}
    assert spreads["number_of_impacts"].drops == 5
    assert "1: drop.height: 0.03 m is not above the surface" in told(study, 200)


def test_a_study_of_which_every_drop_failed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(table: Any, keep: Any, first: int, points: Mapping[str, Any]) -> ChunkResult:
        count = len(next(iter(points.values())))
        codes = np.full(count, list(Outcome).index(Outcome.FAILED), dtype=np.int8)
        return ChunkResult({OUTCOME: codes}, dict.fromkeys(range(count), "no luck"), 0.0)

    monkeypatch.setattr(study_folder, "compute_points", failing)
    study = study_of(tmp_path, GRID)
    assert "12 drops; all of them failed." in page_of(study)
    assert not figures_of(study)
    assert rows_of(study.path.parent / "percentiles.csv") == []
    assert "12: no luck" in told(study)


def test_laws_without_restitution_and_without_force(tmp_path: Path) -> None:
    over = {"sphere.radius": ["10 mm", "20 mm", "30 mm"]}
    hertz = study_of(tmp_path, {"over": over}, contact={"law": "hertz"})
    assert figures_of(hertz) == {"curves"}
    assert "No restitution is asked of the law" in page_of(hertz)
    over = {"contact.restitution": [0.3, 0.5], "drop.height": ["1 m", "2 m"]}
    newton = study_of(tmp_path / "newton", {"over": over}, contact={"law": "newton", "restitution": 0.5})
    assert figures_of(newton) == {"maps", "restitution", "sensitivity"}
    assert "No drop has: largest force" in page_of(newton)


def test_signals_of_sensors_whatever_they_are_called(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    name = "left.a[1] $x$"

    def ringing(table: Any, keep: Any, first: int, points: Mapping[str, Any]) -> ChunkResult:
        height = np.asarray(points["drop.height"], dtype=float)
        time = np.arange(501) / 50e3
        signals = height[:, None] * np.where(time > 2e-3, np.sin(6e3 * time) * np.exp(-300.0 * time), 0.0)
        arrays = {OUTCOME: np.ones(len(height), np.int8), f"{name}_max_magnitude": np.abs(signals).max(axis=1)}
        return ChunkResult({**arrays, f"signal_{name}": signals.astype(np.float32)}, {}, 0.0)

    monkeypatch.setattr(study_folder, "compute_points", ringing)
    study = study_of(
        tmp_path,
        {"over": {"drop.height": ["1 m", "2 m", "3 m"]}, "keep": ["signals"]},
        plate={"material": "steel", "model": "elastic", "size": ["500 mm", "400 mm", "8 mm"], "supports": "simply-supported"},
        sensors=[{"name": name, "position": [0.1, 0.05]}],
        run={"duration": 0.01},
    )
    assert figures_of(study) == {"curves", "signal_left_a_1_x"}
    assert f"Sensor {name}" in page_of(study)
    assert f"Largest reading of {name}" in told(study, 160)
    (row,) = [row for row in rows_of(study.path.parent / "sensitivity.csv") if row["output"] == f"{name}_max_magnitude"]
    assert float(row["relative_range"]) == pytest.approx(1.0)  # from 1 m to 3 m, of what 2 m gives


def test_levels_that_are_whole_numbers_or_given_twice(tmp_path: Path) -> None:
    study = study_of(tmp_path, {"over": {"run.impacts": [3, 1, 2], "sphere.radius": ["10 mm", "10 mm"]}})
    axes = study_axes(study)
    assert axes[0].numeric
    assert axes[0].values.tolist() == [3.0, 1.0, 2.0]
    assert "maps" in figures_of(study)


def test_names_with_signs_that_mean_something_elsewhere(tmp_path: Path) -> None:
    study = study_of(tmp_path, {"over": {"sphere.radius": ["10 mm", "20 mm"]}}, name="a [b]$x^$ <i>study</i>.{{ 1 }}")
    assert "a [b]$x^$ <i>study</i>.{{ 1 }}" in told(study)
    assert "A [b]$x^$ &lt;i&gt;study&lt;/i&gt;.{{ 1 }}" in page_of(study)


def test_the_report_is_remade_as_it_was_and_old_figures_go(tmp_path: Path) -> None:
    study = study_of(tmp_path, GRID)
    folder = study.path.parent
    before = {file.name: file.read_bytes() for file in folder.rglob("*.*") if file.suffix in (".png", ".svg", ".csv", ".html", ".json")}
    (folder / "figures" / "of_yesterday.png").write_bytes(b"")
    assert remake_report(folder) == folder
    after = {file.name: file.read_bytes() for file in folder.rglob("*.*") if file.suffix in (".png", ".svg", ".csv", ".html", ".json")}
    assert after == before
    assert not list(folder.glob(".report*"))


@pytest.mark.skipif(os.name != "posix", reason="files are taken out of reach by their mode")
def test_a_report_that_cannot_be_written_leaves_the_old_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = study_of(tmp_path, GRID)
    before = page_of(study)

    def full(*_: Any, **__: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("vibroimpact.report.study.page.save_figures", full)
    with pytest.raises(InputError, match="No space left"):
        remake_report(study.path.parent)
    assert page_of(study) == before


def test_what_is_thinned_stands_for_all(tmp_path: Path) -> None:
    grid = study_of(tmp_path, GRID)
    assert len(some(grid, "largest_force_N", 7)) <= 7
    assert set(some(grid, "largest_force_N", 7)) <= set(grid.values("largest_force_N").ravel())
    drawn = study_of(tmp_path / "drawn", {**DRAWN, "design": "sobol", "samples": 32})
    assert np.array_equal(some(drawn, "largest_force_N", 20), drawn.values("largest_force_N")[:16])  # as many as are even
    assert next(iter(output_names(drawn))) == "largest_force_N"


def test_names_on_an_axis_lie_side_by_side(tmp_path: Path) -> None:
    axes = study_axes(study_of(tmp_path, {"over": {"contact.law": ["hunt-crossley", "flores"], "sphere.radius": ["10 mm", "20 mm"]}}))
    assert Ticks(axes[0]).places(axes[0].values).tolist() == [0.0, 1.0]
    assert Ticks(axes[1]).label == "sphere.radius [mm]"
    assert Ticks(axes[1]).places(axes[1].values) == pytest.approx([10.0, 20.0])
