"""What a recognition tells: scores of the classifiers, what they confuse, and the model."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.recognition.bound import SURE
from vibroimpact.recognition.charts import recognition_charts
from vibroimpact.recognition.classifiers import CLASSIFIER
from vibroimpact.recognition.few_groups import (
    are_too_few,
    coarse,
    groups_for_bound,
    groups_for_error,
    largest_error_of_none,
    simpler_and_as_good,
)
from vibroimpact.recognition.recognise import Recognition
from vibroimpact.recognition.recogniser import FOLDER, save_recogniser
from vibroimpact.recognition.scores import Score, Scores
from vibroimpact.report.report import Explanation, Quantity, Report, Section, Table, table_of
from vibroimpact.results.csv_files import write_csv

Row = dict[str, Any]

GROUPED = "grouped"
RANDOM = "random"
"""The two splits, as they are named in files."""

_LEAST_SHOWN = 5e-4  # Bayes error below which a tenth of a per cent is not reached


_FIRST_COLUMNS = {
    "unseen.csv": ["key", "range", "signals"],
    "fraction.csv": ["class", "fraction", "impacts"],
}
"""First columns of tables that may have no rows."""


def report_of(recognition: Recognition) -> Report:
    """Return the report of a recognition; its folder has the model in `model`."""
    counts = ", ".join(
        f"{count:,} {name}"
        for name, count in zip(recognition.class_names, recognition.counts, strict=True)
    )
    seeds = "1 seed"
    if len(recognition.seeds) > 1:
        seeds = f"{len(recognition.seeds)} seeds"
    files = {name: partial(_write_rows, recognition, name) for name in TABLES}
    card = recognition.recogniser.card
    packages = ", ".join(f"{package} {version}" for package, version in card["packages"].items())
    return Report(
        title=recognition.name[:1].upper() + recognition.name[1:],
        answer=(
            f"{counts}; {recognition.groups} {recognition.group}s, {recognition.folds} folds, "
            f"{seeds}"
        ),
        quantities=list(answer_of(recognition)),
        sentences=list(sentences(recognition)),
        sections=(
            _scores_section(recognition),
            Section("confused", "Confusion matrix", (confusion_table(recognition),)),
            _model_section(recognition),
        ),
        charts=recognition_charts(recognition),
        warnings=recognition.doubts,
        files={**files, FOLDER: partial(_write_model, recognition)},
        summary=_summary(recognition),
        provenance=(
            f"{packages}; seeds {', '.join(map(str, recognition.seeds))}; data set SHA-256 "
            f"{card['data']['sha256']}."
        ),
    )


def _scores_section(recognition: Recognition) -> Section:
    """Return the table of scores, and how they are to be read."""
    group = recognition.group
    contact_time = ""
    if "true contact time" in recognition.scores:
        contact_time = ', "true contact time" that of the simulation'
    return Section(
        "table",
        "Scores",
        (
            score_table(recognition),
            Explanation(
                f"Scores on test signals, with no {group} in both training and test data; "
                "hyperparameters are chosen within the training folds. Balanced accuracy is the "
                "mean of the true positive rates of the classes. Optimism: balanced accuracy of "
                "the random split less that of the grouped one. Intervals count "
                f"{group}s, not signals, and include the variance between training sets; all are "
                "in scores.csv and optimism.csv. A baseline uses one measured quantity or, as the "
                f"majority class, none{contact_time}, and the probe the length, first and last "
                "sample of the signals."
            ),
        ),
    )


def _model_section(recognition: Recognition) -> Section:
    """Return how the model of the best classifier is used."""
    best = recognition.best
    return Section(
        "model",
        "The model",
        (
            Explanation(
                f"{best[:1].upper()}{best[1:]}, trained on all signals that were used, is in the "
                "folder model: an ONNX graph, and card.json, which describes it and its training "
                "data. Apply it with: vibroimpact recognise DATASET --model DIR"
            ),
        ),
        after_charts=True,
    )


def score_table(recognition: Recognition) -> Table:
    """Return the table of scores with the optimism, a row a classifier; the best is bold."""
    kinds = {compared.name: compared.kind for compared in recognition.compared}
    names = list(recognition.scores)
    rows = []
    for cells in score_cells(recognition):
        name, *scores = cells
        if kinds[name] != CLASSIFIER:
            name = f"{name} ({kinds[name]})"
        rows.append((name, *scores))
    return table_of(SCORE_HEADERS, rows, bold=[names.index(recognition.best)])


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


def score_cells(recognition: Recognition) -> list[tuple[str, ...]]:
    """Return the table of scores with the optimism, a row a classifier, as pages and
    terminals show it.
    """
    digits = _digits(recognition)
    return [
        (
            name,
            _percent(score.error.value, digits),
            _percents(score.error, digits),
            _percent(score.balanced_accuracy.value, digits),
            _percents(score.balanced_accuracy, digits),
            _percent(recognition.random[name].balanced_accuracy.value, digits),
            f"{100.0 * recognition.optimism[name].value:+.{digits}f}",
            f"{score.brier.value:.{digits + 2}f}",
        )
        for name, score in recognition.scores.items()
    ]


def confusion_table(recognition: Recognition) -> Table:
    """Return the table of what the best classifier takes for what."""
    counts = recognition.confusion[recognition.best]
    shares = counts / counts.sum(axis=1, keepdims=True)
    decimals = _digits(recognition)
    rows = [
        [name, *(_percent(share, decimals) for share in row)]
        for name, row in zip(recognition.class_names, shares, strict=True)
    ]
    headings = [(f"Classified as {name}", "%") for name in recognition.class_names]
    return table_of(["True class", *headings], rows)


def score_rows(recognition: Recognition) -> list[Row]:
    """Return a row for each classifier and split, as `scores.csv` has them."""
    kinds = {score.name: score.kind for score in recognition.compared}
    return [
        {"classifier": name, "kind": kinds[name], "split": split, **_scores(score)}
        for split, scores in ((GROUPED, recognition.scores), (RANDOM, recognition.random))
        for name, score in scores.items()
    ]


def optimism_rows(recognition: Recognition) -> list[Row]:
    """Return what a split at random promises beyond what groups kept apart hold, as
    `optimism.csv` has it.
    """
    return [
        {
            "classifier": name,
            "balanced_accuracy_grouped": recognition.scores[name].balanced_accuracy.value,
            "balanced_accuracy_random": recognition.random[name].balanced_accuracy.value,
            **_interval("optimism", optimism),
        }
        for name, optimism in recognition.optimism.items()
    ]


def confusion_rows(recognition: Recognition) -> list[Row]:
    """Return what is taken for what, mean over the seeds, as `confusion.csv` has it."""
    return [
        {
            "classifier": name,
            "class": truth,
            "taken_for": guess,
            "signals": counts[row, column],
            "part": counts[row, column] / counts[row].sum(),
        }
        for name, counts in recognition.confusion.items()
        for row, truth in enumerate(recognition.class_names)
        for column, guess in enumerate(recognition.class_names)
    ]


def robustness_rows(recognition: Recognition) -> list[Row]:
    """Return the balanced accuracy in noise, as `robustness.csv` has it."""
    return [
        {
            "signal_to_noise_dB": level.level,
            **_interval("trained_without", level.trained_without),
            **_interval("trained_with", level.trained_with),
        }
        for level in recognition.noise
    ]


def unseen_rows(recognition: Recognition) -> list[Row]:
    """Return the balanced accuracy in ranges that are left out in training, as
    `unseen.csv` has it.
    """
    return [
        {
            "key": region.key,
            "range": region.words,
            "signals": region.signals,
            **_interval("trained_on", region.seen),
            **_interval("left_out", region.unseen),
        }
        for region in recognition.unseen
    ]


def importance_rows(recognition: Recognition) -> list[Row]:
    """Return the importance of each feature, as `importance.csv` has it."""
    units = dict(
        zip(
            recognition.recogniser.card["features"],
            recognition.recogniser.card["units"],
            strict=True,
        )
    )
    return [
        {
            "feature": loss.feature,
            "unit": units[loss.feature],
            "loss": loss.loss,
            "loss_spread": loss.spread,
        }
        for loss in recognition.importance
    ]


def reliability_rows(recognition: Recognition) -> list[Row]:
    """Return the calibration curve, as `reliability.csv` has it."""
    return [
        {
            "class": level.class_name,
            "signals": level.signals,
            "probability": level.probability,
            "part": level.part,
            "part_low": level.low,
            "part_high": level.high,
        }
        for level in recognition.reliability
    ]


def fraction_rows(recognition: Recognition) -> list[Row]:
    """Return how well fractions are estimated, as `fraction.csv` has it."""
    return [
        {
            "class": stream.class_name,
            "fraction": stream.fraction,
            "impacts": stream.impacts,
            "counted": stream.counted,
            "estimate": stream.adjusted,
            "estimate_low": stream.low,
            "estimate_high": stream.high,
            "error_rms": stream.error,
            "covered": stream.covered,
        }
        for stream in recognition.streams
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


def _write_rows(recognition: Recognition, name: str, path: Path) -> None:
    """Write a table; one without rows has the first columns alone."""
    rows = TABLES[name](recognition)
    columns = list(rows[0]) if rows else _FIRST_COLUMNS[name]
    write_csv(rows, columns, path)


def _write_model(recognition: Recognition, path: Path) -> None:
    """Write the model into a folder of its own."""
    path.mkdir()
    save_recogniser(recognition.recogniser, path)


def _summary(recognition: Recognition) -> dict[str, Any]:
    """Return the content of `summary.json`."""
    grouped = [row for row in score_rows(recognition) if row["split"] == GROUPED]
    return {
        "name": recognition.name,
        "version": __version__,
        "recognition": {
            "group": recognition.group,
            "groups": recognition.groups,
            "folds": recognition.folds,
            "groups_for_5_percent": groups_for_error(
                recognition.scores[recognition.best].error, recognition.groups
            ),
            "seeds": list(recognition.seeds),
            "signals": dict(zip(recognition.class_names, recognition.counts, strict=True)),
            "best": recognition.best,
            "bayes_error": recognition.bayes_error,
            "bayes_error_sees": recognition.bayes_error_sees,
            "calibration_error": recognition.calibration_error,
        },
        "scores": grouped,
        "optimism": optimism_rows(recognition),
        "balanced_accuracy_by_seed": {
            name: score.balanced_accuracy.seeds.tolist()
            for name, score in recognition.scores.items()
        },
        "model": {
            key: recognition.recogniser.card[key]
            for key in ("classifier", "parameters", "packages", "data")
        },
        "doubts": list(recognition.doubts),
    }


def answer_of(recognition: Recognition) -> Iterator[Quantity]:
    """Yield scores of the best classifier, what bounds them, and whether the groups suffice."""
    best = recognition.scores[recognition.best]
    group = recognition.group
    yield _score_quantity("Balanced accuracy", best.balanced_accuracy, recognition.best)
    yield _score_quantity("Classification error", best.error, f"on {group}s not used in training")
    if recognition.bayes_error is not None:
        note = "on the error"
        if recognition.bayes_error < _LEAST_SHOWN:
            note = "below 0.05 %, which excludes nothing"
        yield Quantity("Lower bound", 100.0 * recognition.bayes_error, "%", note=note, figures=2)
    if are_too_few(best.error, recognition.groups):
        needed = groups_for_error(best.error, recognition.groups)
        note = f"too few: about {needed:,} are needed for ±5 %"
    else:
        note = "enough for an error within ±5 %"
    yield Quantity(f"{group.capitalize()}s", recognition.groups, note=note)
    if recognition.streams:
        most = max(stream.impacts for stream in recognition.streams)
        longest = (stream for stream in recognition.streams if stream.impacts == most)
        worst = max(longest, key=lambda stream: stream.error)
        yield Quantity(
            f"Error of the fraction of {worst.class_name}",
            100.0 * worst.error,
            "%",
            figures=2,
            note=f"root mean square, in {most:,} impacts, at the fraction {worst.fraction:g}",
        )


def _score_quantity(name: str, score: Score, note: str) -> Quantity:
    """Return a score in per cent with its interval."""
    interval = (100.0 * score.low, 100.0 * score.high)
    return Quantity(name, 100.0 * score.value, "%", note=note, interval=interval)


def sentences(recognition: Recognition) -> Iterator[str]:
    """Yield what the scores say, in sentences."""
    digits = _digits(recognition)
    at_random = recognition.random[recognition.best].balanced_accuracy.value
    yield (
        f"The best classifier of all features is {recognition.best}. Its scores are those on "
        f"{recognition.group}s not used in training; a random split would give a balanced "
        f"accuracy of {_percent(at_random, digits)} %."
    )
    simpler = simpler_and_as_good(recognition.compared, recognition.scores, recognition.best)
    if simpler is not None:
        accuracy = recognition.scores[simpler].balanced_accuracy
        yield (
            f"With these {recognition.group}s a simpler classifier can't be told to be worse: "
            f"{simpler}, balanced accuracy {_percent(accuracy.value, digits)} % "
            f"({_percents(accuracy, digits)} %)."
        )
    if recognition.bayes_error is not None:
        if recognition.bayes_error >= _LEAST_SHOWN:
            least = f"{_percent(recognition.bayes_error)} %"
        else:
            least = "less than 0.05 %, which excludes nothing"
        if recognition.bayes_error_sees is None:
            bound = f"The lower bound on the error that the data set states is {least}."
        else:
            bound = (
                "The lower bound on the error of a classifier that sees only "
                f"{recognition.bayes_error_sees}, measured up to 50 kHz and 80 dB "
                f"above the noise with a sensitivity known to 0.1 %, is {least}. A classifier "
                "that sees more can be better. For a "
                "band, a noise and a scatter of a sensor vibroimpact bound computes such bounds."
            )
        yield bound
        most = largest_error_of_none(recognition.groups, recognition.folds)
        if _LEAST_SHOWN <= recognition.bayes_error <= most:
            yield (
                f"With {recognition.groups} {recognition.group}s no classifier can be shown to be "
                "better than this bound: one without any error may "
                f"err in up to {_percent(most, digits)} % of further signals (confidence "
                f"{SURE:g} %). At least some "
                f"{groups_for_bound(recognition.bayes_error, recognition.folds):,} "
                f"{recognition.group}s are needed."
            )


def _digits(recognition: Recognition) -> int:
    """Return the number of decimals of scores in per cent."""
    best = recognition.scores[recognition.best]
    return 0 if coarse(best.error) else 1


def _scores(scores: Scores) -> Row:
    row: Row = {}
    for name in ("error", "balanced_accuracy", "brier", "log_loss"):
        row |= _interval(name, getattr(scores, name))
    return {
        **row,
        "balanced_accuracy_spread_over_seeds": float(np.std(scores.balanced_accuracy.seeds)),
    }


def _interval(name: str, score: Score) -> Row:
    return {name: score.value, f"{name}_low": score.low, f"{name}_high": score.high}


def _percent(value: float, digits: int = 1) -> str:
    return f"{100.0 * value:.{digits}f}"


def _percents(score: Score, digits: int) -> str:
    return f"{_percent(score.low, digits)} to {_percent(score.high, digits)}"
