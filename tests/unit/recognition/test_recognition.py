"""Recognition: what it refuses, what its scores are, leaks that are planted and found,
and the model that is saved.
"""

from __future__ import annotations

import csv
import json
import re
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import vibroimpact as vi
from knock_data import BAYES_ERROR, write_knocks
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.cli import main
from vibroimpact.files.check_sums import read_sealed, sealed
from vibroimpact.recognition.bound import bound_doubts
from vibroimpact.recognition.charts import recognition_charts
from vibroimpact.recognition.classifiers import (
    Classifier,
    all_classifiers,
    fit_tuned,
    probabilities,
)
from vibroimpact.recognition.cross_validation import cross_validate
from vibroimpact.recognition.folds import split_signals
from vibroimpact.recognition.fraction import Rates, draw_rates, estimate_fraction, try_streams
from vibroimpact.recognition.input_faults import check_signals, separation
from vibroimpact.recognition.jobs import silent
from vibroimpact.recognition.labelled_signals import LabelledSignals
from vibroimpact.recognition.recogniser import graph_of, run_graph
from vibroimpact.recognition.reliability import reliability
from vibroimpact.recognition.report import TABLES, sentences
from vibroimpact.recognition.scores import Bootstrap, Score, score
from vibroimpact.recognition.signal_features import features_of, with_noise

SMALL = {"rocks": 16, "falls": 6}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_knocks(tmp_path_factory.mktemp("knocks") / "data", **SMALL)


@pytest.fixture(scope="module")
def found(folder: Path) -> vi.recognition.Recognition:
    return vi.recognition.recognise(folder, folds=3, seeds=2)


@pytest.fixture(scope="module")
def saved(found: vi.recognition.Recognition, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return found.save(tmp_path_factory.mktemp("recognised") / "out")


def refused(tmp_path: Path, change: Callable[[dict[str, Any]], None], **settings: Any) -> str:
    """Return the message with which a data set is refused."""
    group = settings.pop("group", "rock")
    signals = vi.recognition.load_labelled_signals(
        write_knocks(tmp_path / "data", change, **{**SMALL, **settings})
    )
    with pytest.raises(vi.InputError) as raised:
        check_signals(signals.of_present_classes(), group, 5)
    assert "\n" not in str(raised.value)
    return str(raised.value)


# what is read


def test_a_data_set_is_read(folder: Path) -> None:
    signals = vi.recognition.load_labelled_signals(folder)
    assert len(signals) == 96
    assert signals.class_names == ("coal", "gangue")
    assert signals.bayes_error == pytest.approx(BAYES_ERROR)
    assert set(signals.groups) == {"rock", "plate", "fall"}
    assert set(signals.drawn) == {"drop.height", "plate.size.thickness"}
    assert set(signals.truth) == {"first_duration_s", "largest_force_N"}
    assert (signals.sensors["a1"].rate, signals.sensors["a1"].unit) == (20e3, "V")
    with h5py.File(folder / "dataset.nc") as file:
        np.testing.assert_array_equal(signals.sensors["a1"].values, file["signal_a1"][:])


def test_of_a_large_data_set_whole_groups_are_drawn(folder: Path) -> None:
    whole, part = (
        vi.recognition.load_labelled_signals(folder),
        vi.recognition.load_labelled_signals(folder / "dataset.nc", most=40, seed=3),
    )
    rocks = np.unique(part.groups["rock"])
    assert len(part) == 36
    assert len(rocks) == 6
    kept = np.isin(whole.groups["rock"], rocks)
    np.testing.assert_array_equal(part.sensors["a1"].values, whole.sensors["a1"].values[kept])
    np.testing.assert_array_equal(part.drawn["drop.height"], whole.drawn["drop.height"][kept])
    assert part.total == 96


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda file: file.attrs.update(format="other 2"),
            'the attribute "format" is "other 2"; this version reads',
        ),
        (lambda file: file.pop("signal_a1"), "there are no signals"),
        (
            lambda file: file["signal_a1"].attrs.update(rate_Hz=0.0),
            "rate_Hz of signal_a1 is 0.0; it must be a number greater than 0",
        ),
        (
            lambda file: file["class"].attrs.pop("flag_meanings"),
            "lacks flag_values or flag_meanings",
        ),
        (
            lambda file: file["class"].attrs.update(flag_meanings="coal"),
            "2 flag_values and 1 flag_meanings",
        ),
        (
            lambda file: file["class"].attrs.update(flag_values=[0, 7]),
            "1 is in the variable class and not in its flag_values",
        ),
    ],
)
def test_what_is_no_data_set_is_said(
    change: Callable[[h5py.File], Any], message: str, tmp_path: Path
) -> None:
    place = write_knocks(tmp_path / "data", **SMALL)
    with h5py.File(place / "dataset.nc", "a") as file:
        change(file)
    with pytest.raises(vi.InputError, match=message):
        vi.recognition.load_labelled_signals(place)


def test_files_that_are_no_data_sets(tmp_path: Path) -> None:
    with pytest.raises(
        vi.InputError, match=r"this is not a data set; there is no study\.nc or dataset\.nc"
    ):
        vi.recognition.load_labelled_signals(tmp_path)
    (tmp_path / "dataset.nc").write_text("no")
    with pytest.raises(vi.InputError, match="not a NetCDF-4 file"):
        vi.recognition.load_labelled_signals(tmp_path)
    place = write_knocks(tmp_path / "data", **SMALL)
    (place / "summary.json").write_text(json.dumps({"bayes_error": 1.5}))
    with pytest.raises(
        vi.InputError, match=r"bayes_error is 1\.5; it must be a number from 0 to below 1"
    ):
        vi.recognition.load_labelled_signals(place)


def test_a_study_is_a_data_set(tmp_path: Path) -> None:
    """As `vibroimpact dataset` writes it: a rate by the times alone, no falls, a drop
    that failed.
    """
    place = write_knocks(tmp_path / "data", lambda data: data.pop("fall"), **SMALL)
    (place / "dataset.nc").rename(place / "study.nc")
    with h5py.File(place / "study.nc", "a") as file:
        for name in ("format", "seed"):
            del file.attrs[name]
        del file["signal_a1"].attrs["rate_Hz"]
        file["signal_a1"].dims[1].attach_scale(file["time_a1"])
        file["signal_a1"][7] = np.nan
    signals = vi.recognition.load_labelled_signals(place)
    assert signals.sensors["a1"].rate == 20e3
    assert signals.groups["fall"].tolist() == [one for one in range(96) if one != 7]
    assert len(signals) == 95


# what is refused


def test_one_class_only(tmp_path: Path) -> None:
    assert "one class only: all 96 signals are coal" in refused(
        tmp_path, lambda data: data.update({"class": np.zeros(96, np.int16)})
    )


def test_no_class(tmp_path: Path) -> None:
    assert "the signals have no classes" in refused(tmp_path, lambda data: data.pop("class"))


@pytest.mark.parametrize(
    ("rocks", "message"),
    [
        (lambda classes: np.zeros(96), "all 96 signals are of one rock"),
        (lambda classes: classes, "each class is in one rock only"),
        (
            lambda classes: np.where(classes == 1, 50, np.arange(96)),
            "gangue is in 1 rock, too few for 5 folds",
        ),
        (
            lambda classes: np.where(classes == 1, np.arange(96) // 2 % 3 + 100, np.arange(96)),
            "in 3 rocks, too few for 5 folds; .*3 folds",
        ),
    ],
)
def test_groups_that_can_not_be_split(
    rocks: Callable[[Any], Any], message: str, tmp_path: Path
) -> None:
    assert re.search(
        message,
        refused(tmp_path, lambda data: data.update(rock=rocks(data["class"]).astype(np.int32))),
    )


def test_a_group_that_is_not_there(tmp_path: Path) -> None:
    assert 'there are fall, plate. Did you mean "plate"?' in refused(
        tmp_path, lambda data: data.pop("rock"), group="plates"
    ).replace("plate, fall", "fall, plate")


@pytest.mark.parametrize("padding", [np.nan, 0.0])
def test_the_length_of_a_signal_may_not_tell_its_class(padding: float, tmp_path: Path) -> None:
    def shorten(data: dict[str, Any]) -> None:
        data["signal_a1"][data["class"] == 1, 300:] = padding

    assert "those of coal have 384 samples at a1, and no signal of another class has" in refused(
        tmp_path, shorten
    )


def test_lengths_that_overlap_are_allowed(tmp_path: Path) -> None:
    def shorten(data: dict[str, Any]) -> None:
        data["signal_a1"][::3, 300:] = np.nan

    signals = vi.recognition.load_labelled_signals(
        write_knocks(tmp_path / "data", shorten, **SMALL)
    )
    check_signals(signals, "rock", 5)
    assert np.isfinite(features_of(signals).values).any(axis=1).all()  # zeros stand after the end


def test_the_same_signal_in_two_rocks(tmp_path: Path) -> None:
    def copy(data: dict[str, Any]) -> None:
        data["signal_a1"][80] = data["signal_a1"][3]

    assert (
        "signals 3 and 80, counted from 0, are the same and lie in two rocks (0 and 13)"
        in refused(tmp_path, copy)
    )


def test_signals_are_numbered_as_in_the_file_where_drops_failed(tmp_path: Path) -> None:
    def copy(data: dict[str, Any]) -> None:
        data["signal_a1"][80] = data["signal_a1"][3]
        data["signal_a1"][[0, 50]] = np.nan

    assert "signals 3 and 80, counted from 0, are the same" in refused(tmp_path, copy)


def test_more_signals_are_asked_for_only_where_there_are_more(tmp_path: Path) -> None:
    def one_rock(data: dict[str, Any]) -> None:
        data["rock"][:] = 0

    assert refused(tmp_path, one_rock).endswith("give signals of several rocks")


def test_the_same_signal_twice_in_one_rock_and_silence_are_allowed(tmp_path: Path) -> None:
    def copy(data: dict[str, Any]) -> None:
        data["signal_a1"][1] = data["signal_a1"][0]
        data["signal_a1"][[30, 60]] = 0.0

    check_signals(
        vi.recognition.load_labelled_signals(write_knocks(tmp_path / "data", copy, **SMALL)),
        "rock",
        5,
    )


def test_sampling_too_slow_is_said_with_the_number(tmp_path: Path) -> None:
    message = refused(tmp_path, lambda _: None, rate=2e3)
    assert "a1 samples at 2000 Hz and resolves up to 1000 Hz" in message
    duration = float(message.split("contacts of ")[1].split(" us")[0]) * 1e-6
    needed = float(message.split("contact times need ")[1].split(" Hz")[0])
    assert needed == pytest.approx(2 * 0.67 / duration, rel=5e-3)


def test_slow_sampling_is_a_doubt_where_forces_tell_the_classes_too(tmp_path: Path) -> None:
    def forceful(data: dict[str, Any]) -> None:
        data["largest_force_N"] = data["largest_force_N"] * np.where(data["class"] == 1, 4.0, 1.0)

    signals = vi.recognition.load_labelled_signals(
        write_knocks(tmp_path / "data", forceful, rate=2e3, **SMALL)
    )
    (doubt,) = check_signals(signals, "rock", 5)
    assert doubt.startswith("contact times can't be resolved: a1 samples at 2000 Hz")


def test_groups_of_one_signal_are_a_doubt(folder: Path) -> None:
    (doubt,) = check_signals(vi.recognition.load_labelled_signals(folder), "fall", 5)
    assert doubt == "each signal has a fall of its own, so the grouped split is a random split"


def test_separation_is_that_of_the_area_under_the_curve() -> None:
    from sklearn.metrics import roc_auc_score

    generator = np.random.default_rng(0)
    classes = generator.integers(0, 2, 200)
    values = np.round(generator.standard_normal(200) + classes, 1)  # with ties
    assert separation(values, classes) == pytest.approx(
        abs(2 * roc_auc_score(classes, values) - 1), abs=1e-12
    )


@pytest.mark.parametrize(("setting", "value"), [("folds", 1), ("seeds", 0), ("most", 3)])
def test_settings_that_are_not_allowed(setting: str, value: int, folder: Path) -> None:
    with pytest.raises(vi.InputError, match=f"{setting}: {value} is not allowed"):
        vi.recognition.recognise(folder, **{setting: value})


def test_a_missing_extra_is_said(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "sklearn", None)
    with pytest.raises(
        vi.InputError,
        match=r"recognition needs scikit-learn, which is not installed: pip install "
        r'"vibroimpact\[ml\]"',
    ):
        vi.recognition.recognise(folder)


# how it is scored


def test_no_group_is_trained_on_and_tested_on() -> None:
    groups = np.repeat(np.arange(20), 7)
    classes = groups % 2
    for split in split_signals(classes, groups, 5, 0):
        assert not set(groups[split.train]) & set(groups[split.test])
        assert len(np.unique(classes[split.test])) == 2
    assert any(
        set(groups[one.train]) & set(groups[one.test]) for one in split_signals(classes, None, 5, 0)
    )


def test_groups_are_kept_apart_where_parameters_are_chosen_too() -> None:
    """The value of each signal is its number, by which a classifier that learns nothing
    tells what it was trained and tried on.
    """
    from sklearn.dummy import DummyClassifier

    groups = np.repeat(np.arange(20), 7)
    apart = []

    class Watcher(DummyClassifier):
        def fit(self, values: np.ndarray, classes: np.ndarray) -> Any:
            self.trained = set(groups[values[:, 0]])
            return super().fit(values, classes)

        def predict(self, values: np.ndarray) -> np.ndarray:
            apart.append(not self.trained & set(groups[values[:, 0]]))
            return super().predict(values)

    watched = Classifier(
        "watcher",
        "classifier",
        "numbers",
        lambda parameters, seed, parts: Watcher(),
        ({"a": 1}, {"a": 2}),
    )
    tables = {"numbers": np.arange(len(groups))[:, None]}
    settings: Any = {"what": "", "workers": 1, "progress": silent}
    cross_validate([watched], tables, groups % 2, groups, 5, [0], **settings)
    assert len(apart) == 5 * 3 * 2  # of each training part three inner ones, with both parameters
    assert all(apart)


def test_scores_are_those_of_scikit_learn() -> None:
    from sklearn.metrics import accuracy_score, balanced_accuracy_score, brier_score_loss, log_loss

    generator = np.random.default_rng(1)
    classes = generator.integers(0, 2, 120)
    told = generator.dirichlet([1.0, 1.0], 120)
    bootstrap = Bootstrap(np.arange(120) // 6, classes)
    scores = score(told[np.newaxis], classes, bootstrap)
    guessed = told.argmax(axis=1)
    assert scores.error.value == pytest.approx(1 - accuracy_score(classes, guessed))
    assert scores.balanced_accuracy.value == pytest.approx(
        balanced_accuracy_score(classes, guessed)
    )
    assert scores.brier.value == pytest.approx(brier_score_loss(classes, told[:, 1]))
    assert scores.log_loss.value == pytest.approx(log_loss(classes, told))


def test_intervals_over_groups_are_wider_than_over_signals() -> None:
    """Signals of a rock that are right or wrong together are one piece of evidence: their
    interval is that of the mean of the rocks.
    """
    generator = np.random.default_rng(2)
    rocks = np.repeat(np.arange(50), 10)
    classes = rocks % 2
    right = (generator.random(50) < 0.8)[rocks].astype(float)[np.newaxis]
    grouped, single = (Bootstrap(groups, classes).mean(right) for groups in (rocks, np.arange(500)))
    deviation = right.std() / np.sqrt(50)
    assert np.std(grouped.draws) == pytest.approx(deviation, rel=0.1)
    assert np.std(single.draws) == pytest.approx(deviation / np.sqrt(10), rel=0.1)


def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    generator, held = np.random.default_rng(3), 0
    rocks = np.repeat(np.arange(40), 5)
    for _ in range(200):
        # of being right, another for each rock; 0.8 in the mean
        chance = generator.beta(8.0, 2.0, 40)[rocks]
        found = Bootstrap(rocks, rocks % 2).mean(
            (generator.random(200) < chance).astype(float)[np.newaxis]
        )
        held += found.low <= 0.8 <= found.high
    assert 0.9 <= held / 200 <= 0.98


def test_probabilities_that_are_true_are_on_the_diagonal() -> None:
    generator = np.random.default_rng(4)
    told = generator.random(4000)
    classes = (generator.random(4000) < told).astype(int)
    curve = reliability(
        np.stack([1 - told, told], axis=1),
        classes,
        ("coal", "gangue"),
        Bootstrap(np.arange(4000) // 4, classes),
    )
    assert len(curve) == 10
    assert {one.class_name for one in curve} == {"gangue"}
    assert all(abs(one.part - one.probability) < 0.06 for one in curve)
    assert sum(one.low <= one.probability <= one.high for one in curve) >= 8


def test_noise_has_its_level(folder: Path) -> None:
    signals = vi.recognition.load_labelled_signals(folder)
    power = np.median(np.mean(np.square(signals.sensors["a1"].values, dtype=float), axis=1))
    for level in (20.0, -10.0):
        added = with_noise(signals, level, 0).sensors["a1"].values - signals.sensors["a1"].values
        assert 10 * np.log10(power / np.mean(np.square(added, dtype=float))) == pytest.approx(
            level, abs=0.1
        )


# the fraction in a stream


def test_a_fraction_is_found_although_the_count_is_wrong() -> None:
    generator = np.random.default_rng(5)
    rates = Rates(generator.normal(0.8, 0.01, 400), generator.normal(0.3, 0.01, 400))
    held = 0
    for _ in range(200):
        counted = generator.binomial(1000, 0.3 + (0.8 - 0.3) * 0.2)
        found = estimate_fraction(int(counted), 1000, Rates(rates.true, rates.false), generator)
        assert abs(found.value - 0.2) < 0.15
        held += found.low <= 0.2 <= found.high
    assert held >= 190


def test_a_classifier_that_knows_nothing_says_so() -> None:
    same = np.random.default_rng(6).normal(0.5, 0.02, 400)
    found = estimate_fraction(500, 1000, Rates(same, same[::-1]), np.random.default_rng(0))
    assert found.high - found.low > 0.95


def test_rates_are_those_of_the_confusion() -> None:
    own = np.arange(2000) % 2 == 0
    taken = np.where(own, np.arange(2000) % 10 < 8, np.arange(2000) % 10 == 1)
    rates = draw_rates(taken, own, np.arange(2000) // 10, np.random.default_rng(0))
    assert rates.true.mean() == pytest.approx(0.8, abs=0.01)
    assert rates.false.mean() == pytest.approx(0.2, abs=0.01)


def test_streams_of_other_rocks_are_within_their_intervals() -> None:
    generator = np.random.default_rng(7)
    rocks = np.repeat(np.arange(80), 20)
    classes = rocks % 2
    right = generator.random(1600) < generator.beta(8.0, 2.0, 80)[rocks]
    streams = try_streams(
        np.where(right, classes, 1 - classes), classes, ("coal", "gangue"), rocks, 0
    )
    for one in streams:
        assert one.class_name == "gangue"
        assert one.error < 0.15
        assert abs(one.adjusted - one.fraction) < abs(one.counted - one.fraction) + 0.05
        assert one.covered > 0.85 or one.fraction in (0.0, 1.0)


# the whole


@pytest.mark.slow
def test_everything_is_compared(found: vi.recognition.Recognition) -> None:
    assert list(found.scores) == [one.name for one in all_classifiers()] == list(found.random)
    assert found.best in (
        "logistic regression",
        "random forest",
        "gradient boosting",
        "support vector machine",
    )
    assert found.seeds == (0, 1)
    assert found.counts == (48, 48)
    for name, one in found.scores.items():
        assert one.error.low <= one.error.value <= one.error.high
        assert found.confusion[name].sum() == pytest.approx(96)
        assert found.optimism[name].value == pytest.approx(
            found.random[name].balanced_accuracy.value - one.balanced_accuracy.value
        )
        assert len(one.balanced_accuracy.seeds) == 2
    assert {one.key for one in found.unseen} == {"plate", "drop.height", "plate.size.thickness"}
    assert [one.level for one in found.noise] == [20, 15, 10, 5, 0, -5, -10]
    assert len(found.importance) == len(found.recogniser.card["features"])


@pytest.mark.slow
def test_the_same_seed_gives_the_same_scores(
    found: vi.recognition.Recognition, folder: Path
) -> None:
    again = vi.recognition.recognise(folder, folds=3, seeds=2, workers=1)
    assert again.document == found.document


def test_the_folder(saved: Path, found: vi.recognition.Recognition) -> None:
    assert {path.name for path in saved.iterdir()} == {
        *TABLES,
        "summary.json",
        "report.html",
        "model",
    }
    assert {path.name for path in (saved / "model").iterdir()} == {"model.onnx", "card.json"}
    for name, rows_of in TABLES.items():
        with (saved / name).open(newline="") as file:
            assert len(list(csv.DictReader(file))) == len(rows_of(found)) > 0
    page = (saved / "report.html").read_text()
    assert "Classification errors and optimism" in page
    assert "Bayes error" in page
    assert json.loads((saved / "summary.json").read_text())["recognition"]["best"] == found.best


def test_charts_are_drawn(found: vi.recognition.Recognition) -> None:
    charts = recognition_charts(found)
    assert [one.name for one in charts] == [
        "scores",
        "confusion",
        "unseen",
        "robustness",
        "reliability",
        "importance",
        "fraction",
    ]
    for chart in charts:
        assert plotly_chart(chart)["data"]
        assert matplotlib_figure(chart).axes


@pytest.mark.slow
def test_plates_that_were_never_trained_on(folder: Path) -> None:
    """Three plates are three folds; within the two that are trained on there are two."""
    found = vi.recognition.recognise(folder, group="plate", folds=3, seeds=1)
    assert found.groups == 3
    assert {one.key for one in found.unseen} >= {"drop.height"}
    with pytest.raises(
        vi.InputError,
        match="coal is in 3 plates, too few for 5 folds; give signals of it from 5 plates or "
        "more, or ask for 3 folds",
    ):
        vi.recognition.recognise(folder, group="plate", folds=5)


# leaks


@pytest.mark.slow
def test_a_label_in_the_last_sample_is_found(tmp_path: Path) -> None:
    def leak(data: dict[str, Any]) -> None:
        data["signal_a1"][:, -1] = np.where(data["class"] == 1, 5e-3, -5e-3)

    found = vi.recognition.recognise(
        write_knocks(tmp_path / "data", leak, bayes_error=False, **SMALL), folds=5, seeds=1
    )
    (doubt,) = (one for one in found.doubts if one.startswith("leak"))
    assert (
        "leak: length, first and last sample alone classify better (balanced accuracy "
        "1.000) than all features" in doubt
    )


@pytest.mark.slow
def test_a_classifier_above_the_bound_is_a_leak(
    tmp_path: Path, found: vi.recognition.Recognition
) -> None:
    assert not any("leak" in one for one in found.doubts)

    # a faint tone of the recorder that gangue was recorded with
    def leak(data: dict[str, Any]) -> None:
        time = np.arange(data["signal_a1"].shape[1]) / data["rate"]
        data["signal_a1"][data["class"] == 1] += 0.05 * np.sin(2 * np.pi * 9500.0 * time).astype(
            np.float32
        )

    leaky = vi.recognition.recognise(
        write_knocks(tmp_path / "data", leak, rocks=40, falls=6), folds=2, seeds=1
    )
    words = (
        "below the Bayes error of 23.1% that the data set states; if the bound counts all that "
        "an impact tells, it has used information"
    )
    assert any(
        one.startswith(f"possible leak: {leaky.best} errs in") and words in one
        for one in leaky.doubts
    )


def test_a_computed_bound_names_what_it_counts(found: vi.recognition.Recognition) -> None:
    """A classifier below the bound for two quantities may have seen a third."""
    rocks = np.repeat(np.arange(60), 5)
    right = np.eye(2)[rocks % 2]
    perfect = {"any": score(right[np.newaxis], rocks % 2, Bootstrap(rocks, rocks % 2))}
    (doubt,) = bound_doubts(perfect, 0.2, "any", "any", "impulse and contact time")
    assert doubt.startswith(
        "possible leak: any errs in 0.0%, below the Bayes error of 20.0% of classifiers "
        "that see only impulse and contact"
    )
    assert "such as the position of the impact" in doubt
    stated, computed = (
        "".join(sentences(replace(found, bayes_error_sees=sees)))
        for sees in (None, "impulse and contact time")
    )
    assert "The lower bound on the error that the data set states is 23.1 %." in stated
    assert (
        "The lower bound on the error of a classifier that sees only impulse and contact "
        "time, measured up to 50 kHz and 80 dB" in computed
    )
    assert "A classifier that sees more can be better." in computed
    assert "is less than 0.05 %, which excludes nothing." in "".join(
        sentences(replace(found, bayes_error=0.0))
    )


def test_a_bound_is_not_passed_by_chance() -> None:
    """Classifiers as good as the bound are called leaks hardly ever."""
    generator, called = np.random.default_rng(8), 0
    rocks = np.repeat(np.arange(60), 5)
    for _ in range(200):
        wrong = (generator.random(300) < 0.2).astype(float)[np.newaxis]
        bootstrap = Bootstrap(rocks, rocks % 2)
        told = np.stack([1 - wrong[0], wrong[0]], axis=1)
        scores = {
            "any": score(
                np.where((rocks % 2 == 0)[:, None], told, told[:, ::-1])[np.newaxis],
                rocks % 2,
                bootstrap,
            )
        }
        assert scores["any"].error.value == pytest.approx(wrong.mean())
        called += bool(bound_doubts(scores, 0.2, "any", "any"))
    assert called <= 8


def test_no_error_at_all_counts_as_none_in_so_many_groups() -> None:
    from vibroimpact.recognition.bound import below_bound

    assert below_bound(Score(0.0, np.zeros(1000), np.zeros(1), 60.0), 0.1)
    # 0.9^20 = 0.12: such luck is not rare enough
    assert not below_bound(Score(0.0, np.zeros(1000), np.zeros(1), 20.0), 0.1)


# the model


@pytest.mark.parametrize(
    "name", ["logistic regression", "random forest", "gradient boosting", "support vector machine"]
)
@pytest.mark.parametrize("count", [2, 3])
def test_each_classifier_is_the_same_when_saved(name: str, count: int) -> None:
    generator = np.random.default_rng(9)
    classes = np.arange(240) % count
    values = generator.standard_normal((240, 6)) + classes[:, None] * np.array(
        [1.0, 0.5, 0, 0, 0, 0]
    )
    values[generator.random(values.shape) < 0.05] = np.nan
    values[:, 5] = np.nan  # a feature that no signal has
    values = values.astype(np.float32).astype(float)
    (classifier,) = (one for one in all_classifiers() if one.name == name)
    fitted, _ = fit_tuned(classifier, values, classes, np.arange(240) // 6, 0)
    told = run_graph(graph_of(fitted, values, count), values, count)
    np.testing.assert_allclose(told, probabilities(fitted, values, count), atol=1e-4)


def test_a_saved_model_recognises_other_signals(saved: Path, tmp_path: Path) -> None:
    other = write_knocks(tmp_path / "data", lambda data: data.pop("class"), seed=5, **SMALL)
    done = vi.recognition.apply_recogniser(saved, other)
    assert done.probabilities.shape == (96, 2)
    np.testing.assert_allclose(done.probabilities.sum(axis=1), 1.0, atol=1e-5)
    assert done.accuracy is None
    assert done.doubts == ()
    assert done.fractions["coal"].value == pytest.approx(
        1.0 - done.fractions["gangue"].value, abs=1e-6
    )
    known = vi.recognition.apply_recogniser(
        vi.recognition.load_recogniser(saved / "model"),
        write_knocks(tmp_path / "known", seed=5, **SMALL),
    )
    np.testing.assert_array_equal(known.probabilities, done.probabilities)
    assert known.accuracy is not None
    assert known.accuracy > 0.5


def test_signals_that_a_model_was_trained_on_are_a_doubt(saved: Path, folder: Path) -> None:
    assert vi.recognition.apply_recogniser(saved, folder).doubts == (
        "the model was trained on signals of this data set, so it may "
        "recognise them better than others",
    )


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"rate": 40e3}, "trained at 20000 Hz in V, and these signals are at 40000 Hz in V"),
        ({"samples": 256}, "trained on 384 samples"),
    ],
)
def test_other_signals_than_a_model_knows(
    settings: dict, message: str, saved: Path, tmp_path: Path
) -> None:
    with pytest.raises(vi.InputError, match=message):
        vi.recognition.apply_recogniser(saved, write_knocks(tmp_path / "data", **SMALL, **settings))


def change_card(saved: Path, tmp_path: Path, **changes: Any) -> Path:
    place = tmp_path / "model"
    place.mkdir()
    (place / "model.onnx").write_bytes((saved / "model" / "model.onnx").read_bytes())
    (place / "card.json").write_bytes(
        sealed({**read_sealed(saved / "model" / "card.json"), **changes})
    )
    return place


def test_a_model_of_another_format_is_refused(saved: Path, tmp_path: Path) -> None:
    place = change_card(saved, tmp_path, format="vibroimpact model 9", version="7.0")
    message = (
        'saved in the format "vibroimpact model 9" by vibroimpact 7.0; this version reads '
        '"vibroimpact model 1": train it anew'
    )
    with pytest.raises(vi.InputError, match=message):
        vi.recognition.load_recogniser(place)


def test_a_model_of_another_version_is_a_doubt(saved: Path, tmp_path: Path) -> None:
    place = change_card(saved, tmp_path, version="7.0")
    (doubt,) = vi.recognition.apply_recogniser(
        place, write_knocks(tmp_path / "data", seed=5, **SMALL)
    ).doubts
    assert doubt.startswith("the model was saved by vibroimpact 7.0 and this is")


def test_a_model_with_a_feature_of_another_version_is_refused(
    saved: Path, tmp_path: Path, folder: Path
) -> None:
    place = change_card(saved, tmp_path, features=["a1.loudness"])
    with pytest.raises(
        vi.InputError,
        match=r"the model needs the feature a1\.loudness, which this version does not compute",
    ):
        vi.recognition.apply_recogniser(place, folder)


def test_a_damaged_model_is_refused(saved: Path, tmp_path: Path) -> None:
    place = change_card(saved, tmp_path)
    graph = bytearray((place / "model.onnx").read_bytes())
    graph[len(graph) // 2] ^= 1
    (place / "model.onnx").write_bytes(graph)
    with pytest.raises(vi.InputError, match="check sum does not match"):
        vi.recognition.load_recogniser(place)
    (place / "card.json").write_text((place / "card.json").read_text().replace("coal", "goal"))
    with pytest.raises(vi.InputError, match="check sum does not match"):
        vi.recognition.load_recogniser(place)
    with pytest.raises(vi.InputError, match=r"this is no saved model; there is no card\.json"):
        vi.recognition.load_recogniser(saved.parent)


# the command


def run(monkeypatch: pytest.MonkeyPatch, *words: str) -> int:
    monkeypatch.setattr(sys, "argv", ["vibroimpact", *words])
    with pytest.raises(SystemExit) as left:
        main()
    return int(left.value.code or 0)


def test_the_command_trains_and_applies(
    folder: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    out = str(tmp_path / "out")
    assert (
        run(
            monkeypatch,
            "recognise",
            str(folder),
            "-o",
            out,
            "--folds",
            "2",
            "--seeds",
            "1",
            "--json",
        )
        == 0
    )
    printed = capsys.readouterr()
    document = json.loads(printed.out)
    assert document == {"folder": out, **json.loads((Path(out) / "summary.json").read_text())}
    assert document["recognition"]["folds"] == 2
    assert "vibroimpact: cross-validation by rock" in printed.err
    other = write_knocks(tmp_path / "other", seed=4, **SMALL)
    assert (
        run(monkeypatch, "recognise", str(other), "--model", out, "-o", str(tmp_path / "applied"))
        == 0
    )
    assert "96 signals, classified by" in capsys.readouterr().out
    with (tmp_path / "applied" / "predictions.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 96
    assert set(rows[0]) == {"signal", "class", "probability_coal", "probability_gangue"}
    assert run(monkeypatch, "recognise", str(other), "-o", out) == 2
    assert "the folder is there already" in capsys.readouterr().err


def test_the_command_refuses_in_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    place = write_knocks(
        tmp_path / "data", lambda data: data.update({"class": np.ones(96, np.int16)}), **SMALL
    )
    assert run(monkeypatch, "recognise", str(place), "-o", str(tmp_path / "out")) == 2
    assert (
        capsys.readouterr().err.splitlines()[-1]
        == "vibroimpact: there is one class only: all 96 signals are gangue"
    )
    assert not (tmp_path / "out").exists()


def test_the_command_does_not_replace_what_it_reads(
    folder: Path, saved: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, "recognise", str(folder), "-o", str(folder), "--force") == 2
    assert "lies there, and would be replaced" in capsys.readouterr().err
    assert (
        run(
            monkeypatch,
            "recognise",
            str(folder),
            "--model",
            str(saved / "model"),
            "-o",
            str(saved),
            "--force",
        )
        == 2
    )
    assert (saved / "model" / "card.json").is_file()
    assert (folder / "dataset.nc").is_file()


# what it is for


@pytest.mark.slow
def test_a_random_split_is_optimistic_and_the_grouped_one_is_not(tmp_path: Path) -> None:
    """Rocks have tones of their own: split at random a classifier seems to pass the
    bound, and with rocks kept apart it stays above.
    """
    found = vi.recognition.recognise(
        write_knocks(tmp_path / "data", rocks=60, falls=20, tone=0.5), seeds=5
    )
    best = found.scores[found.best]
    assert found.optimism[found.best].low > 0.05
    assert found.random[found.best].error.value < BAYES_ERROR < best.error.high
    assert best.error.value > BAYES_ERROR - 0.02
    assert best.balanced_accuracy.low > found.scores["majority"].balanced_accuracy.value
    assert not any("leak" in one for one in found.doubts)


@pytest.mark.slow
@pytest.mark.whole
def test_without_tones_the_best_is_near_the_bound_and_the_split_does_not_matter(
    tmp_path: Path,
) -> None:
    found = vi.recognition.recognise(
        write_knocks(tmp_path / "data", rocks=100, falls=10, tone=0.0), seeds=5
    )
    best = found.scores[found.best]
    assert BAYES_ERROR - 0.03 < best.error.value < BAYES_ERROR + 0.06
    assert abs(found.optimism[found.best].value) < 0.04
    assert found.scores["true contact time"].error.value == pytest.approx(BAYES_ERROR, abs=0.03)
    assert found.calibration_error < 0.06


def test_labelled_signals_of_python(found: vi.recognition.Recognition, folder: Path) -> None:
    signals = vi.recognition.load_labelled_signals(folder)
    assert isinstance(signals, LabelledSignals)
    assert found.recogniser.probabilities(signals).shape == (96, 2)
