"""Recognition in noise: trained without the noise, and trained with it."""

from __future__ import annotations

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
    """Return the scores of a classifier in noise, which is added to the signals before
    their features are taken.
    """

    def features_in(level: float) -> Floats:
        noisy = with_noise(signals, level, chosen.seed)
        return tables_of(noisy, features_of(noisy))[chosen.classifier.table]

    def one(
        train: Floats, tests: tuple[Floats, ...], split: Split, parameters: Parameters
    ) -> list[Indices]:
        fitted = chosen.refit(train, split.train, parameters)
        return [chosen.guess(fitted, test[split.test]) for test in tests]

    tables = run_jobs(
        "features in noise", [partial(features_in, level) for level in LEVELS], 1, progress
    )
    trained_on = [(values, tuple(tables)), *((table, (table,)) for table in tables)]
    jobs = [partial(one, *both, *part) for both in trained_on for part in chosen.parts]
    done = iter(run_jobs("recognition in noise", jobs, workers, progress))
    right = np.zeros((2, len(LEVELS), len(chosen.classes)))
    for number in range(len(trained_on)):
        for split, _ in chosen.parts:
            for place, guessed in enumerate(next(done)):
                where = (0, place) if number == 0 else (1, number - 1)
                right[(*where, split.test)] = guessed == chosen.classes[split.test]
    without, trained = ([bootstrap.balanced(row[np.newaxis]) for row in rows] for rows in right)
    return [Noisy(*row) for row in zip(LEVELS, without, trained, strict=True)]
