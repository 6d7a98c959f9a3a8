"""What no classifier can do: the bound of a population, its folder and its command."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.bayes_error.bound import Bound, bound_of
from vibroimpact.bayes_error.falls import falls_of_sweep
from vibroimpact.bayes_error.observations import Channel
from vibroimpact.bayes_error.report import headline, scatter_sentences


@pytest.fixture(scope="module")
def bound() -> Bound:
    return bound_of(vi.studies.load_sweep("signals:coal-gangue", 4000))


@pytest.mark.slow
def test_more_measured_tells_more(bound: Bound) -> None:
    errors = {name: one.upper for name, one in bound.errors.items()}
    assert (
        errors["one impact"]
        < errors["one impact, place unknown"]
        < errors["contact time"]
        < errors["impulse"]
        < bound.majority
    )
    for one in bound.errors.values():
        assert 0.0 <= one.lower <= one.upper <= bound.majority + 0.02
    one, more, all_of_it = (
        bound.remaining[name] for name in ("one impact", "height known", "height, bounce and size")
    )
    assert (more <= one + 1e-9).all()
    assert (all_of_it <= more + 1e-9).all()


@pytest.mark.parametrize("samples", [64, 300])
def test_what_is_measured_besides_never_raises_the_bound(samples: int) -> None:
    """Of few falls each further quantity leaves fewer that are alike; the time to the
    next impact raised the bound from 0 to 8 %.
    """
    found = bound_of(vi.studies.load_sweep("signals:coal-gangue", samples))
    more_than = {
        "contact time": "one impact, place unknown",
        "impulse": "one impact",
        "one impact, place unknown": "one impact",
        "one impact": "with the bounce",
        "with the bounce": "height known, with the bounce",
        "height known": "height known, with the bounce",
        "height known, with the bounce": "height, bounce and size",
        "size seen": "height, bounce and size",
    }
    for errors in (found.errors, found.without_scatter):
        for less, more in more_than.items():
            assert errors[more].lower <= errors[more].upper <= errors[less].upper


@pytest.mark.slow
def test_the_headline_of_few_falls_states_what_they_tell(bound: Bound) -> None:
    assert "falls are few" not in headline(bound)
    few = headline(bound_of(vi.studies.load_sweep("signals:coal-gangue", 64)))
    assert few.endswith("64 falls are few: even an error of 0 may in truth be up to 4.6 % (95 %).")


def test_noise_and_a_narrow_band_cost(bound: Bound) -> None:
    assert bound.map[0, 0] > 5 * bound.map[-1, -1]
    assert (np.diff(bound.map.mean(axis=0)) < 0.01).all()  # quieter
    assert (np.diff(bound.map.mean(axis=1)) < 0.01).all()  # wider
    deaf = bound_of(
        vi.studies.load_sweep("signals:coal-gangue", 1000), Channel(signal_to_noise=-60.0)
    )
    assert deaf.errors["contact time"].upper == pytest.approx(deaf.majority, abs=0.06)


def test_the_share_of_the_assumed_scatter(bound: Bound) -> None:
    """An unknown position is of no account with an exact amplitude, and without one at
    least a third of the error is of its scatter.
    """
    with_it, without = bound.errors, bound.without_scatter
    assert without["one impact, place unknown"] == without["one impact"]
    assert (
        without["one impact, place unknown"].upper
        < with_it["one impact, place unknown"].lower * 2.0 / 3.0
    )
    assert without["contact time"] == with_it["contact time"]
    assert all(
        without[name].lower <= without[name].upper <= error.upper for name, error in with_it.items()
    )
    exact = bound_of(
        vi.studies.load_sweep("signals:coal-gangue", 1000), Channel(gain=0.0, place=0.0)
    )
    assert exact.errors["one impact"] == exact.without_scatter["one impact"]
    assert (
        "Each error holds for classifiers that see only the quantities named, with this scatter."
        in scatter_sentences(bound)
    )


def test_the_bound_of_a_computed_data_set(tmp_path: Path) -> None:
    table = vi.studies.load_sweep("signals:coal-gangue").whole_table
    plate = {"size": [1.2, 0.8, 0.02], "material": "steel"}
    sweep = {**table["sweep"], "samples": 600, "keep": ["peaks"]}
    sweep.pop("window")
    sweep["over"] = {
        key: value for key, value in sweep["over"].items() if not key.startswith("plate.")
    }
    rigid = {**table, "plate": plate, "sensors": [], "run": {"impacts": 1}, "sweep": sweep}
    stated = vi.studies.sweep_of(rigid)
    computed = vi.studies.load_study(vi.studies.run_sweep(stated, tmp_path / "falls"))
    of_study, of_sweep = bound_of(computed), bound_of(stated)
    assert of_study.errors == of_sweep.errors
    np.testing.assert_array_equal(of_study.falls.mass, of_sweep.falls.mass)


def test_how_sensors_are_mounted_does_not_matter_to_a_bound() -> None:
    table = vi.studies.load_sweep("signals:coal-gangue", 100).whole_table
    over = {**table["sweep"]["over"], "sensors.a1.position.x": {"from": 0.27, "to": 0.29}}
    mounted = vi.studies.sweep_of({**table, "sweep": {**table["sweep"], "over": over}})
    np.testing.assert_array_equal(
        falls_of_sweep(mounted).duration, falls_of_sweep(vi.studies.sweep_of(table)).duration
    )


def test_the_folder(bound: Bound, tmp_path: Path) -> None:
    folder = bound.save(tmp_path / "bound")
    rows = list(csv.DictReader((folder / "bound.csv").read_text(encoding="utf-8").splitlines()))
    assert [row["measured"] for row in rows] == list(bound.errors)
    assert float(rows[2]["error_upper"]) == bound.errors["one impact"].upper
    assert len((folder / "map.csv").read_text(encoding="utf-8").splitlines()) == bound.map.size + 1
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert summary["falls"] == 4000
    assert (
        summary["bound"][3]["error_upper_without_scatter"]
        == bound.without_scatter["one impact"].upper
    )
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "best possible classifier" in page
    with pytest.raises(vi.InputError, match="is there already"):
        bound.save(folder)
    replace(bound, name="again").save(folder, force=True)


def test_what_has_no_bound() -> None:
    with pytest.raises(
        vi.InputError,
        match=r"sweep.design: the study has no classes; a bound needs design = \"population\"",
    ):
        bound_of(vi.studies.load_sweep("paper:sweep"))
