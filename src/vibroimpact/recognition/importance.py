"""Importance of features: how much worse signals that were not trained on are recognised
once a feature is exchanged between them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.recognition.classifiers import Parameters
from vibroimpact.recognition.cross_validation import Chosen
from vibroimpact.recognition.folds import Split
from vibroimpact.recognition.jobs import Progress, run_jobs
from vibroimpact.recognition.scores import balanced_accuracy

_REPEATS = 3


@dataclass(frozen=True, eq=False)
class Importance:
    """Loss of balanced accuracy when a feature is permuted: its mean over the parts of
    the cross-validation, and its spread.
    """

    feature: str
    loss: float
    spread: float


def permutation_importance(
    chosen: Chosen, values: Floats, names: tuple[str, ...], workers: int, progress: Progress
) -> list[Importance]:
    """Return the importance of each feature on signals that were not trained on, the largest first.

    Features that say the same share their importance: each may seem to matter little while the
    other is there.
    """

    def one(split: Split, parameters: Parameters) -> Floats:
        fitted = chosen.refit(values, split.train, parameters)
        generator = np.random.default_rng(chosen.seed)
        tested, truth = values[split.test], chosen.classes[split.test]
        whole = balanced_accuracy(fitted.predict(tested), truth)
        losses = np.zeros(len(names))
        for place in range(len(names)):
            for _ in range(_REPEATS):
                exchanged = tested.copy()
                exchanged[:, place] = generator.permutation(tested[:, place])
                losses[place] += (
                    whole - balanced_accuracy(fitted.predict(exchanged), truth)
                ) / _REPEATS
        return losses

    jobs = [partial(one, *part) for part in chosen.parts]
    losses = np.array(run_jobs("importance of features", jobs, workers, progress))
    found = [
        Importance(name, float(part.mean()), float(part.std(ddof=1)))
        for name, part in zip(names, losses.T, strict=True)
    ]
    return sorted(found, key=lambda row: -row.loss)
