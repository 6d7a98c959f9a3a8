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
    """Loss of balanced accuracy when a feature is permuted.

    Attributes
    ----------
    feature : str
        Name of the feature.
    loss, spread : float
        Mean and standard deviation of the loss over the parts of the cross-validation.
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

    jobs = [partial(_losses, chosen, values, *part) for part in chosen.parts]
    losses = np.array(run_jobs("importance of features", jobs, workers, progress))
    importances = [
        Importance(name, float(feature_losses.mean()), float(feature_losses.std(ddof=1)))
        for name, feature_losses in zip(names, losses.T, strict=True)
    ]
    return sorted(importances, key=lambda importance: -importance.loss)


def _losses(chosen: Chosen, values: Floats, split: Split, parameters: Parameters) -> Floats:
    """Return the loss by permuting each feature, in one part of the cross-validation."""
    fitted = chosen.refit(values, split.train, parameters)
    generator = np.random.default_rng(chosen.seed)
    tested = values[split.test]
    truth = chosen.classes[split.test]
    accuracy = balanced_accuracy(fitted.predict(tested), truth)
    losses = np.zeros(values.shape[1])
    for feature in range(values.shape[1]):
        for _ in range(_REPEATS):
            # permuted, a feature keeps its distribution and tells nothing of the class
            permuted = tested.copy()
            permuted[:, feature] = generator.permutation(tested[:, feature])
            loss = accuracy - balanced_accuracy(fitted.predict(permuted), truth)
            losses[feature] += loss / _REPEATS
    return losses
