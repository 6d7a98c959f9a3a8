"""Recognition in noise: trained without the noise, and trained with it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.recognition.classifiers import Parameters
from vibroimpact.recognition.cross_validation import Chosen
from vibroimpact.recognition.folds import Split
from vibroimpact.recognition.jobs import Progress, run_jobs
from vibroimpact.recognition.labelled_signals import LabelledSignals
from vibroimpact.recognition.scores import Bootstrap, Score
from vibroimpact.recognition.signal_features import features_of, tables_of, with_noise

LEVELS = (20.0, 15.0, 10.0, 5.0, 0.0, -5.0, -10.0)
"""Ratios of signal to noise [dB]."""


@dataclass(frozen=True, eq=False)
class Noisy:
    """The balanced accuracy in noise.

    Parameters
    ----------
    level : float
        Ratio of the median signal's mean square to that of the noise [dB].
    trained_without, trained_with : Score
        Of classifiers trained on the signals as they are, and on signals with this noise.
    """

    level: float
    trained_without: Score
    trained_with: Score


def score_in_noise(
    chosen: Chosen,
    values: Floats,
    signals: LabelledSignals,
    bootstrap: Bootstrap,
    workers: int,
    progress: Progress,
) -> list[Noisy]:
    """Return the scores of a classifier in noise.

    The noise is added to the signals before their features are taken.

    Parameters
    ----------
    chosen : Chosen
        The classifier with its cross-validation.
    values : array, shape (signals, features)
        Features of the signals without noise.
    signals : LabelledSignals
        The signals.
    bootstrap : Bootstrap
        Draws of groups.
    workers, progress
        As `run_jobs` takes them.
    """
    levels = [partial(_features_in_noise, chosen, signals, level) for level in LEVELS]
    noisy_features = run_jobs("features in noise", levels, 1, progress)
    # without noise in training there is one classifier for all levels, with it one for each
    training = [(values, noisy_features)]
    training += [(features, [features]) for features in noisy_features]
    jobs = [
        partial(_guess_tests, chosen, train, tests, split, parameters)
        for train, tests in training
        for split, parameters in chosen.parts
    ]
    guesses = iter(run_jobs("recognition in noise", jobs, workers, progress))

    shape = (len(LEVELS), len(chosen.classes))
    right_without = np.zeros(shape)
    for split, _ in chosen.parts:
        for number, guessed in enumerate(next(guesses)):
            right_without[number, split.test] = guessed == chosen.classes[split.test]
    right_with = np.zeros(shape)
    for number in range(len(LEVELS)):
        for split, _ in chosen.parts:
            (guessed,) = next(guesses)
            right_with[number, split.test] = guessed == chosen.classes[split.test]

    noisy = []
    for number, level in enumerate(LEVELS):
        trained_without = bootstrap.balanced(right_without[number][np.newaxis])
        trained_with = bootstrap.balanced(right_with[number][np.newaxis])
        noisy.append(Noisy(level, trained_without, trained_with))
    return noisy


def _features_in_noise(chosen: Chosen, signals: LabelledSignals, level: float) -> Floats:
    """Return the table that a classifier reads, of signals in noise of a level [dB]."""
    noisy = with_noise(signals, level, chosen.seed)
    return tables_of(noisy, features_of(noisy))[chosen.classifier.table]


def _guess_tests(
    chosen: Chosen, train: Floats, tests: Sequence[Floats], split: Split, parameters: Parameters
) -> list[Indices]:
    """Return the classes that a classifier takes test signals for in each of several tables."""
    fitted = chosen.refit(train, split.train, parameters)
    return [chosen.guess(fitted, test[split.test]) for test in tests]
