"""The tables of a recognition: rows of its CSV files, cells of its page, and its summary."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.recognition.bound import SURE
from vibroimpact.recognition.few_groups import (
    coarse,
    groups_for_bound,
    groups_for_error,
    largest_error_of_none,
)
from vibroimpact.recognition.recognise import Recognition
from vibroimpact.recognition.scores import Score, Scores

Row = dict[str, Any]

GROUPED, RANDOM = "grouped", "random"
"""The two splits, as they are named in files."""

_LEAST_SHOWN = 5e-4  # Bayes error below which a tenth of a per cent is not reached


def score_rows(found: Recognition) -> list[Row]:
    """Return a row for each classifier and split, as `scores.csv` has them."""
    kinds = {one.name: one.kind for one in found.compared}
    return [
        {"classifier": name, "kind": kinds[name], "split": split, **_scores(one)}
        for split, scores in ((GROUPED, found.scores), (RANDOM, found.random))
        for name, one in scores.items()
    ]


def optimism_rows(found: Recognition) -> list[Row]:
    """Return what a split at random promises beyond what groups kept apart hold, as
    `optimism.csv` has it.
    """
    return [
        {
            "classifier": name,
            "balanced_accuracy_grouped": found.scores[name].balanced_accuracy.value,
            "balanced_accuracy_random": found.random[name].balanced_accuracy.value,
            **_interval("optimism", one),
        }
        for name, one in found.optimism.items()
    ]


def confusion_rows(found: Recognition) -> list[Row]:
    """Return what is taken for what, mean over the seeds, as `confusion.csv` has it."""
    return [
        {
            "classifier": name,
            "class": truth,
            "taken_for": guess,
            "signals": counts[row, column],
            "part": counts[row, column] / counts[row].sum(),
        }
        for name, counts in found.confusion.items()
        for row, truth in enumerate(found.class_names)
        for column, guess in enumerate(found.class_names)
    ]


def robustness_rows(found: Recognition) -> list[Row]:
    """Return the balanced accuracy in noise, as `robustness.csv` has it."""
    return [
        {
            "signal_to_noise_dB": one.level,
            **_interval("trained_without", one.trained_without),
            **_interval("trained_with", one.trained_with),
        }
        for one in found.noise
    ]


def unseen_rows(found: Recognition) -> list[Row]:
    """Return the balanced accuracy in ranges that are left out in training, as
    `unseen.csv` has it.
    """
    return [
        {
            "key": one.key,
            "range": one.words,
            "signals": one.signals,
            **_interval("trained_on", one.seen),
            **_interval("left_out", one.unseen),
        }
        for one in found.unseen
    ]


def importance_rows(found: Recognition) -> list[Row]:
    """Return the importance of each feature, as `importance.csv` has it."""
    units = dict(
        zip(found.recogniser.card["features"], found.recogniser.card["units"], strict=True)
    )
    return [
        {
            "feature": one.feature,
            "unit": units[one.feature],
            "loss": one.loss,
            "loss_spread": one.spread,
        }
        for one in found.importance
    ]


def reliability_rows(found: Recognition) -> list[Row]:
    """Return the calibration curve, as `reliability.csv` has it."""
    return [
        {
            "class": one.class_name,
            "signals": one.signals,
            "probability": one.probability,
            "part": one.part,
            "part_low": one.low,
            "part_high": one.high,
        }
        for one in found.reliability
    ]


def fraction_rows(found: Recognition) -> list[Row]:
    """Return how well fractions are estimated, as `fraction.csv` has it."""
    return [
        {
            "class": one.class_name,
            "fraction": one.fraction,
            "impacts": one.impacts,
            "counted": one.counted,
            "estimate": one.adjusted,
            "estimate_low": one.low,
            "estimate_high": one.high,
            "error_rms": one.error,
            "covered": one.covered,
        }
        for one in found.streams
    ]


TABLES = {
    "scores.csv": score_rows,
    "optimism.csv": optimism_rows,
    "confusion.csv": confusion_rows,
    "unseen.csv": unseen_rows,
    "robustness.csv": robustness_rows,
    "importance.csv": importance_rows,
    "reliability.csv": reliability_rows,
    "fraction.csv": fraction_rows,
}
"""The rows of each CSV file of the folder."""


def summary_of_recognition(found: Recognition) -> dict[str, Any]:
    """Return the content of `summary.json`, which `recognise --json` prints too."""
    grouped = [row for row in score_rows(found) if row["split"] == GROUPED]
    return {
        "name": found.name,
        "version": __version__,
        "recognition": {
            "group": found.group,
            "groups": found.groups,
            "folds": found.folds,
            "groups_for_5_percent": groups_for_error(found.scores[found.best].error, found.groups),
            "seeds": list(found.seeds),
            "signals": dict(zip(found.class_names, found.counts, strict=True)),
            "best": found.best,
            "bayes_error": found.bayes_error,
            "bayes_error_sees": found.bayes_error_sees,
            "calibration_error": found.calibration_error,
        },
        "scores": grouped,
        "optimism": optimism_rows(found),
        "balanced_accuracy_by_seed": {
            name: one.balanced_accuracy.seeds.tolist() for name, one in found.scores.items()
        },
        "model": {
            key: found.recogniser.card[key]
            for key in ("classifier", "parameters", "packages", "data")
        },
        "doubts": list(found.doubts),
    }


SCORE_HEADERS: list[str | tuple[str, str]] = [
    "Classifier",
    ("Error", "%"),
    ("95 % interval", "%"),
    ("Balanced accuracy", "%"),
    ("95 % interval", "%"),
    ("Split at random", "%"),
    ("Optimism", "%"),
    "Brier score",
]


def score_cells(found: Recognition) -> list[tuple[str, ...]]:
    """Return the table of scores with the optimism, a row a classifier, as pages and
    terminals show it.
    """
    digits = _digits(found)
    return [
        (
            name,
            _percent(one.error.value, digits),
            _percents(one.error, digits),
            _percent(one.balanced_accuracy.value, digits),
            _percents(one.balanced_accuracy, digits),
            _percent(found.random[name].balanced_accuracy.value, digits),
            f"{100.0 * found.optimism[name].value:+.{digits}f}",
            f"{one.brier.value:.{digits + 2}f}",
        )
        for name, one in found.scores.items()
    ]


def confusion_cells(found: Recognition) -> tuple[list[str | tuple[str, str]], list[list[str]]]:
    """Return headers and rows of the table of what the best classifier takes for what."""
    counts = found.confusion[found.best]
    parts = counts / counts.sum(axis=1, keepdims=True)
    rows = [
        [name, *(_percent(one, _digits(found)) for one in row)]
        for name, row in zip(found.class_names, parts, strict=True)
    ]
    return ["True class", *((f"Classified as {name}", "%") for name in found.class_names)], rows


def sentences(found: Recognition) -> Iterator[str]:
    """Yield what the scores say, in sentences."""
    best, digits = found.scores[found.best], _digits(found)
    yield (
        f"The best classifier, {found.best}, has a balanced accuracy of "
        f"{_percent(best.balanced_accuracy.value, digits)} % "
        f"({_percents(best.balanced_accuracy, digits)} %) on {found.group}s not used in "
        "training; a random split gives "
        f"{_percent(found.random[found.best].balanced_accuracy.value, digits)} %."
    )
    yield from _few(found)
    if found.bayes_error is not None:
        least = (
            f"{_percent(found.bayes_error)} %"
            if found.bayes_error >= _LEAST_SHOWN
            else "less than 0.05 %, which excludes nothing"
        )
        bound = (
            f"The lower bound on the error that the data set states is {least}."
            if found.bayes_error_sees is None
            else "The lower bound on the error of a classifier that sees only "
            f"{found.bayes_error_sees}, measured up to 50 kHz and 80 dB "
            f"above the noise with a sensitivity known to 0.1 %, is {least}. A classifier "
            "that sees more can be better. For a "
            "band, a noise and a scatter of a sensor vibroimpact bound computes such bounds."
        )
        yield (
            f"{bound} The error of the best classifier is {_percent(best.error.value, digits)} "
            f"% ({_percents(best.error, digits)} %)."
        )
        most = largest_error_of_none(found.groups, found.folds)
        if _LEAST_SHOWN <= found.bayes_error <= most:
            yield (
                f"With {found.groups} {found.group}s no classifier can be shown to be "
                "better than this bound: one without any error may "
                f"err in up to {_percent(most, digits)} % of further signals (confidence "
                f"{SURE:g} %). At least some "
                f"{groups_for_bound(found.bayes_error, found.folds):,} {found.group}s are needed."
            )
    hardest = [
        one for one in found.streams if one.impacts == max(row.impacts for row in found.streams)
    ]
    if hardest:
        worst = max(hardest, key=lambda row: row.error)
        yield (
            f"The fraction of {worst.class_name} in a stream of {worst.impacts} impacts "
            f"has an error of {_percent(worst.error, digits)} "
            "percentage points (root mean square, at the fraction with the largest error, "
            f"{worst.fraction:g})."
        )


def _few(found: Recognition) -> Iterator[str]:
    """Yield what the number of groups does not allow to tell."""
    best = found.scores[found.best]
    if not coarse(best.error):
        return
    yield (
        f"With {found.groups} {found.group}s errors between {_percent(best.error.low, 0)} "
        f"and {_percent(best.error.high, 0)} % can't be "
        f"told apart; for +-5 % some {groups_for_error(best.error, found.groups):,} "
        f"{found.group}s are needed. More signals of the same "
        f"{found.group}s do not replace them."
    )
    chance = 1.0 / len(found.class_names)
    if best.balanced_accuracy.low <= chance:
        yield (
            f"Whether the best classifier is better than guessing, {_percent(chance, 0)} %, "
            "can't be told."
        )


def _digits(found: Recognition) -> int:
    """Return the number of decimals of scores in per cent."""
    return 0 if coarse(found.scores[found.best].error) else 1


def _scores(one: Scores) -> Row:
    row: Row = {}
    for name in ("error", "balanced_accuracy", "brier", "log_loss"):
        row |= _interval(name, getattr(one, name))
    return {
        **row,
        "balanced_accuracy_spread_over_seeds": float(np.std(one.balanced_accuracy.seeds)),
    }


def _interval(name: str, one: Score) -> Row:
    return {name: one.value, f"{name}_low": one.low, f"{name}_high": one.high}


def _percent(value: float, digits: int = 1) -> str:
    return f"{100.0 * value:.{digits}f}"


def _percents(one: Score, digits: int) -> str:
    return f"{_percent(one.low, digits)} to {_percent(one.high, digits)}"
