"""What the page on recognition says of its example and of its settings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from knock_data import BAYES_ERROR, write_knocks
from stated_numbers import says
from vibroimpact.recognition.bound import SURE
from vibroimpact.recognition.few_groups import FINE
from vibroimpact.recognition.folds import FEW, FOLDS
from vibroimpact.recognition.recognise import MOST_SIGNALS
from vibroimpact.recognition.recogniser import _DIFFERENT
from vibroimpact.recognition.recorder_leaks import _CLOCK
from vibroimpact.recognition.robustness import LEVELS
from vibroimpact.recognition.scores import Score, widening_by_training

PAGE = "docs/recognition.md"


@pytest.mark.slow
def test_the_example_of_a_random_split(tmp_path: Path) -> None:
    found = vi.recognition.recognise(
        write_knocks(tmp_path / "data", rocks=40, falls=15, tone=0.5), folds=4, seeds=1, workers=1
    )
    says(PAGE, "{} simulated impacts of {} rocks", sum(found.counts), found.groups)
    says(PAGE, "is known in closed form, {} %", 100.0 * BAYES_ERROR)
    says(
        PAGE,
        "no classifier can have a balanced accuracy above {} % on unseen rocks",
        100.0 * (1.0 - BAYES_ERROR),
    )
    rows = {}
    for name in (
        "logistic regression",
        "random forest",
        "gradient boosting",
        "support vector machine",
        "true contact time",
    ):
        one = found.scores[name].balanced_accuracy
        rows[name] = [
            100.0 * part
            for part in (one.value, one.low, one.high, found.random[name].balanced_accuracy.value)
        ]
        if name != "true contact time":
            assert one.low < 100.0 * (1.0 - BAYES_ERROR) < rows[name][3]
    says(PAGE, "| logistic regression | {} | {} to {} | {} |", *rows["logistic regression"])
    says(PAGE, "| random forest | {} | {} to {} | {} |", *rows["random forest"])
    says(PAGE, "| gradient boosting | {} | {} to {} | {} |", *rows["gradient boosting"])
    says(PAGE, "| support vector machine | {} | {} to {} | {} |", *rows["support vector machine"])
    says(PAGE, "| true contact time | {} | {} to {} | {} |", *rows["true contact time"])


def test_settings_and_population() -> None:
    says(PAGE, "Of more than {} signals", MOST_SIGNALS)
    per_cent = Score(50.0, np.linspace(0.0, 100.0, 1001), np.zeros(1))
    says(PAGE, "**Intervals** of {} % count groups", per_cent.high - per_cent.low)
    says(PAGE, "if a class has fewer than {} groups, into as many folds as it has", FEW)
    assert FOLDS == 5, "the page says five folds"
    says(PAGE, "by {} for five folds", widening_by_training(FOLDS))
    says(PAGE, "is wider than from {} to +{} %", -100.0 * FINE, 100.0 * FINE)
    says(PAGE, "an interval of {} % on each side", 100.0 * FINE)
    says(PAGE, "with a confidence of {} %, the result reports *leak*", SURE)
    says(PAGE, "and a clock from {} % on", 100.0 * _CLOCK)
    says(PAGE, "below the bound with a confidence of {} %", SURE)
    says(
        PAGE,
        "of the trained classifier for {} % of the signals or more",
        100.0 * (1.0 - _DIFFERENT),
    )
    says(PAGE, "white noise from {} to {} dB", max(LEVELS), min(LEVELS))
    sweep = vi.studies.load_sweep("signals:coal-gangue").whole_table["sweep"]
    classes = {name: one["over"] for name, one in sweep["classes"].items()}

    def mean(name: str, key: str) -> float:
        return float(classes[name][f"sphere.material.{key}"]["mean"].split()[0])

    ratio = mean("gangue", "youngs_modulus") / mean("coal", "youngs_modulus")
    assert np.isclose(ratio, 8.0), "the pages say a factor of eight"
