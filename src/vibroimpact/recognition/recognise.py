"""Recognition of what fell on a plate: trained, validated, and set beside its bound.

The validation keeps groups of signals apart, so that it can't fool itself.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version
from os import PathLike

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.arrays import Floats, Indices
from vibroimpact.errors import InputError
from vibroimpact.recognition.bound import bound_doubts
from vibroimpact.recognition.card import FORMAT
from vibroimpact.recognition.classifiers import (
    CLASSIFIER,
    PROBE,
    Classifier,
    all_classifiers,
    fit_tuned,
)
from vibroimpact.recognition.cross_validation import Chosen, Validated, cross_validate
from vibroimpact.recognition.dataset_signals import load_labelled_signals
from vibroimpact.recognition.extra import needs_extra
from vibroimpact.recognition.few_groups import few_groups_doubts
from vibroimpact.recognition.folds import default_folds
from vibroimpact.recognition.fraction import Streams, draw_rates, try_streams
from vibroimpact.recognition.importance import Importance, permutation_importance
from vibroimpact.recognition.input_faults import check_signals
from vibroimpact.recognition.jobs import Progress, silent
from vibroimpact.recognition.labelled_signals import LabelledSignals
from vibroimpact.recognition.onnx_runtime import silent_onnxruntime
from vibroimpact.recognition.recogniser import Recogniser, graph_of
from vibroimpact.recognition.recorder_leaks import recorder_leaks
from vibroimpact.recognition.reliability import Reliable, reliability
from vibroimpact.recognition.robustness import Noisy, score_in_noise
from vibroimpact.recognition.scores import Bootstrap, Score, Scores, score
from vibroimpact.recognition.signal_features import (
    FEATURES,
    baseline_doubts,
    features_of,
    tables_of,
)
from vibroimpact.recognition.unseen_bins import Unseen, score_unseen
from vibroimpact.report.reported import Reported

MOST_SIGNALS = 4000
"""Largest number of signals used, by default."""

SEEDS = 5
"""Number of seeds, by default."""


@dataclass(frozen=True, eq=False)
class Recognition(Reported, reported_in="vibroimpact.recognition.report"):
    """Cross-validated performance of classifiers on a data set.

    Parameters
    ----------
    name : str
        Title of the data set.
    group : str
        What signals of a group share; no group was both trained on and tested on.
    groups : int
        Number of groups.
    folds : int
        Number of parts of the cross-validation.
    seeds : tuple of int
        Seeds of the splits and classifiers.
    class_names : tuple of str
        Names of the classes.
    counts : tuple of int
        Number of signals of each class.
    compared : tuple of Classifier
        The classifiers, as they are compared.
    scores, random : mapping of str to Scores
        Their scores, with groups kept apart, and split at random.
    optimism : mapping of str to Score
        Balanced accuracy of the random split less that of groups kept apart.
    best : str
        The classifier of all features with the largest balanced accuracy, groups kept apart.
    confusion : mapping of str to array, shape (classes, classes)
        Number of signals of each true class (row) taken for each class (column), mean over the
        seeds.
    reliability, unseen, noise, importance, streams
        Of the best: calibration curve, ranges left out in training, noise, importance of features,
        and fraction in streams of impacts.
    calibration_error : float
        Mean difference of probability and part in the calibration curve, weighted by the signals.
    bayes_error : float, optional
        A lower bound on the error, where it is known.
    doubts : tuple of str
        What is doubtful, such as a leak.
    recogniser : Recogniser
        The best, trained on all signals, as it is saved.
    bayes_error_sees : str, optional
        The quantities alone that a classifier sees for which this bound was computed; None if the
        data set states the bound.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> found = vi.recognition.recognise("falls", folds=2, seeds=1)
    >>> sum(found.counts), found.confusion[found.best].shape
    (96, (2, 2))
    """

    name: str
    group: str
    groups: int
    folds: int
    seeds: tuple[int, ...]
    class_names: tuple[str, ...]
    counts: tuple[int, ...]
    compared: tuple[Classifier, ...]
    scores: Mapping[str, Scores]
    random: Mapping[str, Scores]
    optimism: Mapping[str, Score]
    best: str
    confusion: Mapping[str, Floats]
    reliability: Sequence[Reliable]
    unseen: Sequence[Unseen]
    noise: Sequence[Noisy]
    importance: Sequence[Importance]
    streams: Sequence[Streams]
    calibration_error: float
    bayes_error: float | None
    doubts: tuple[str, ...]
    recogniser: Recogniser
    bayes_error_sees: str | None = None


def recognise(
    dataset: str | PathLike[str] | LabelledSignals,
    *,
    group: str = "rock",
    folds: int | None = None,
    seeds: int = SEEDS,
    seed: int = 0,
    most: int = MOST_SIGNALS,
    workers: int = 2,
    progress: Progress = silent,
) -> Recognition:
    """Return scores of classifiers of a data set, trained and tested on separate groups of signals.

    Baselines (majority, peak alone, contact time alone), logistic regression, random forest,
    gradient boosting and a support vector machine are compared by nested cross-validation in which
    no group is both trained on and tested on; beside it stands the score of a split at random. The
    best is tried on ranges of the drawn keys that it was not trained on, in noise, and on streams
    of impacts.

    Parameters
    ----------
    dataset : path or LabelledSignals
        Folder of a data set, its file `dataset.nc`, or signals that were read.
    group : str, default "rock"
        What signals of a group share: "rock", "plate" or "fall".
    folds : int, optional
        Number of parts of the cross-validation; by default 5, or as many as a class has groups, if
        that is fewer than 10.
    seeds : int, default 5
        Number of seeds; every score is a mean over them.
    seed : int, default 0
        The first seed.
    most : int, default 4000
        Largest number of signals used; of more, whole groups are drawn at random.
    workers : int, default 2
        Number of processes.
    progress : callable, optional
        Called with what is done, how many parts of it are done, and how many there are.

    Returns
    -------
    Recognition
        Scores, tables and the trained model; `save` writes them as a folder.

    Raises
    ------
    InputError
        If the data set can't be read, or classifiers can't be trained on it and tested honestly;
        the extra `ml` is missing.
    ComputationError
        If the trained model can't be saved as ONNX without changing what it says.

    See Also
    --------
    vibroimpact.recognition.load_recogniser : loads a saved model, to apply it to other signals.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> found = vi.recognition.recognise("falls", folds=2, seeds=1)
    >>> score = found.scores[found.best].balanced_accuracy
    >>> bool(score.value > found.scores["majority"].balanced_accuracy.value)
    True
    """
    with needs_extra():
        import skl2onnx as skl2onnx
        import sklearn as sklearn
    # before hours of training, and before the worker processes, which inherit that it is silent
    silent_onnxruntime()
    check_settings(folds, seeds, most)
    if isinstance(dataset, LabelledSignals):
        signals = dataset.of_present_classes()
    else:
        read = load_labelled_signals(dataset, most=most, group=group, seed=seed)
        signals = read.of_present_classes()
    doubts = check_signals(signals, group, folds) + baseline_doubts(signals)
    assert signals.classes is not None  # checked
    classes = signals.classes
    groups = signals.groups[group]
    if folds is None:
        folds = default_folds(classes, groups)
    if signals.bayes_error_sees is None:  # of what this program computed there is no recorder
        doubts += recorder_leaks(signals, classes, groups, group, seed)
    progress("features", 0, 1)
    features = features_of(signals)
    progress("features", 1, 1)
    tables = tables_of(signals, features)
    used_seeds = tuple(range(seed, seed + seeds))
    compared = all_classifiers()
    validate = partial(
        cross_validate,
        compared,
        tables,
        classes,
        folds=folds,
        seeds=used_seeds,
        workers=workers,
        progress=progress,
    )
    grouped = validate(groups, what=f"cross-validation by {group}")
    at_random = validate(None, what="cross-validation at random")
    bootstrap = Bootstrap(groups, classes, seed, folds)
    scores = _scores(grouped, classes, bootstrap)
    random_scores = _scores(at_random, classes, bootstrap)
    best = _best_classifier(compared, scores)
    (probe,) = (classifier.name for classifier in compared if classifier.kind == PROBE)
    doubts += bound_doubts(scores, signals.bayes_error, probe, best.name, signals.bayes_error_sees)
    group_count = len(np.unique(groups))
    class_count = len(signals.class_names)
    doubts += few_groups_doubts(scores[best.name], group, group_count, class_count)
    chosen = Chosen(best, classes, groups, grouped[best.name], seed)
    held_out = chosen.validated.held_out.mean(axis=0)
    curve = reliability(held_out, classes, signals.class_names, bootstrap)
    return Recognition(
        name=signals.name,
        group=group,
        groups=group_count,
        folds=folds,
        seeds=used_seeds,
        class_names=signals.class_names,
        counts=tuple(int((classes == number).sum()) for number in range(class_count)),
        compared=tuple(classifier for classifier in compared if classifier.name in scores),
        scores=scores,
        random=random_scores,
        optimism={
            name: _difference(random_scores[name].balanced_accuracy, scores[name].balanced_accuracy)
            for name in scores
        },
        best=best.name,
        confusion={
            name: _confusion(validated, classes, class_count) for name, validated in grouped.items()
        },
        reliability=curve,
        unseen=score_unseen(chosen, features.values, signals, bootstrap, workers, progress),
        noise=score_in_noise(chosen, features.values, signals, bootstrap, workers, progress),
        importance=permutation_importance(
            chosen, features.values, features.names, workers, progress
        ),
        streams=try_streams(chosen.guessed, classes, signals.class_names, groups, seed),
        calibration_error=_calibration_error(curve),
        bayes_error=signals.bayes_error,
        doubts=tuple(doubts),
        recogniser=_trained(
            chosen, signals, features.names, features.units, tables[FEATURES], group
        ),
        bayes_error_sees=signals.bayes_error_sees,
    )


def check_settings(folds: int | None, seeds: int, most: int) -> None:
    """Raise InputError if the numbers of folds, seeds or signals are not allowed."""
    _check_least("folds", folds, 2)
    _check_least("seeds", seeds, 1)
    _check_least("most", most, 10)


def _check_least(name: str, number: int | None, least: int) -> None:
    if number is not None and number < least:
        raise InputError(f"{number} is not allowed; it must be {least} or more", name)


def _scores(
    validated: Mapping[str, Validated], classes: Indices, bootstrap: Bootstrap
) -> dict[str, Scores]:
    """Return the scores of classifiers by their cross-validations."""
    return {
        name: score(validation.held_out, classes, bootstrap)
        for name, validation in validated.items()
    }


def _best_classifier(compared: Sequence[Classifier], scores: Mapping[str, Scores]) -> Classifier:
    """Return the classifier of all features with the largest balanced accuracy."""
    of_all_features = [classifier for classifier in compared if classifier.kind == CLASSIFIER]
    return max(
        of_all_features, key=lambda classifier: scores[classifier.name].balanced_accuracy.value
    )


def _calibration_error(curve: Sequence[Reliable]) -> float:
    """Return the mean difference of probability and part, weighted by the signals."""
    differences = [abs(point.probability - point.part) for point in curve]
    return float(np.average(differences, weights=[point.signals for point in curve]))


def _difference(score: Score, subtracted: Score) -> Score:
    """Return the difference of two scores, whose draws are of the same groups."""
    return Score(
        score.value - subtracted.value,
        score.draws - subtracted.draws,
        score.seeds - subtracted.seeds,
    )


def _confusion(validated: Validated, classes: Indices, count: int) -> Floats:
    """Return how many signals of each class (row) are taken for each class, mean over the seeds."""
    confusion = np.zeros((count, count))
    for guessed in validated.held_out.argmax(axis=2):
        np.add.at(confusion, (classes, guessed), 1.0 / len(validated.held_out))
    return confusion


def _trained(
    chosen: Chosen,
    signals: LabelledSignals,
    names: tuple[str, ...],
    units: tuple[str, ...],
    values: Floats,
    group: str,
) -> Recogniser:
    """Return the chosen classifier trained on all signals, with its card."""
    classes = chosen.classes
    groups = chosen.groups
    seed = chosen.seed
    fitted, parameters = fit_tuned(chosen.classifier, values, classes, groups, seed)
    confusion = {}
    for number, name in enumerate(signals.class_names):
        generator = np.random.default_rng(seed)  # the same draws for all classes
        rates = draw_rates(chosen.guessed == number, classes == number, groups, generator)
        confusion[name] = {
            "true_rate": rates.true.round(6).tolist(),
            "false_rate": rates.false.round(6).tolist(),
        }
    card = {
        "format": FORMAT,
        "version": __version__,
        "packages": {name: version(name) for name in ("scikit-learn", "skl2onnx", "onnxruntime")},
        "classifier": chosen.classifier.name,
        "parameters": dict(parameters),
        "classes": list(signals.class_names),
        "features": list(names),
        "units": list(units),
        "sensors": {
            name: {
                "rate_Hz": sensor.rate,
                "unit": sensor.unit,
                "samples": sensor.values.shape[1],
            }
            for name, sensor in signals.sensors.items()
        },
        "group": group,
        "data": {
            "name": signals.name,
            "signals": len(signals),
            "groups": len(np.unique(groups)),
            "sha256": signals.check_sum,
        },
        "seed": seed,
        "confusion": confusion,
    }
    return Recogniser(card, graph_of(fitted, values, len(np.unique(classes))))
