"""Recognition of a range of a drawn key, such as a size or a height, that was never trained on."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.recognition.classifiers import Parameters
from vibroimpact.recognition.cross_validation import Chosen
from vibroimpact.recognition.folds import Split
from vibroimpact.recognition.jobs import Progress, run_jobs
from vibroimpact.recognition.labelled_signals import LabelledSignals
from vibroimpact.recognition.scores import Bootstrap, Score

_BINS = 3
_MOST_KEYS = 8
_OF_THE_CLASS = ("sphere.material", "contact.")
"""Keys by which classes are made: a range of them left out would leave a class out."""


@dataclass(frozen=True, eq=False)
class Unseen:
    """The score of signals in a range of a key, with and without training on that range.

    Parameters
    ----------
    key : str
        The drawn key, or "plate".
    words : str
        The range, or the value.
    signals : int
        Number of its signals.
    seen, unseen : Score
        Balanced accuracy on them of classifiers trained on all ranges, and on the other ranges
        alone; in both cases on other groups.
    """

    key: str
    words: str
    signals: int
    seen: Score
    unseen: Score


def bins_of(signals: LabelledSignals) -> list[tuple[str, str, Bools]]:
    """Return the ranges of the drawn keys: key, range in words, and which signals lie in it.

    Numbers have three ranges of equally many signals, and few values or names one for each.
    """
    columns: dict[str, NDArray[Any]] = {}
    if "plate" in signals.groups:
        columns["plate"] = signals.groups["plate"]
    for key, column in signals.drawn.items():
        if not key.startswith(_OF_THE_CLASS):
            columns[key] = column
    varying = [key for key, values in columns.items() if len(np.unique(values)) > 1]
    bins: list[tuple[str, str, Bools]] = []
    for key in varying[:_MOST_KEYS]:
        values = columns[key]
        levels = np.unique(values)
        if values.dtype.kind not in "f" or len(levels) <= _BINS:
            for bin_levels in np.array_split(levels, min(len(levels), _BINS)):
                bins.append((key, _levels_text(bin_levels), np.isin(values, bin_levels)))
            continue
        edges = np.quantile(values, np.linspace(0.0, 1.0, _BINS + 1))
        # the largest value is in the last bin
        bin_number = np.searchsorted(edges, values, side="right") - 1
        bin_number = np.clip(bin_number, 0, _BINS - 1)
        for number in range(_BINS):
            inside = bin_number == number
            if inside.any():
                bins.append((key, f"{edges[number]:.3g} to {edges[number + 1]:.3g}", inside))
    return bins


def _level_text(level: Any) -> str:
    return f"{level:.3g}" if isinstance(level, float) else str(level)


def _levels_text(levels: NDArray[Any]) -> str:
    """Return the values or names of a range in words."""
    texts = [_level_text(level) for level in levels.tolist()]
    if len(texts) > 3:
        return f"{texts[0]} to {texts[-1]}"
    return ", ".join(texts)


def score_unseen(
    chosen: Chosen,
    values: Floats,
    signals: LabelledSignals,
    bootstrap: Bootstrap,
    workers: int,
    progress: Progress,
) -> list[Unseen]:
    """Leave out each range of each drawn key in training, and test on it; groups stay apart.

    A range without signals of every class is left out, as is one without which a class could not be
    trained.

    Parameters
    ----------
    chosen : Chosen
        The classifier with its cross-validation.
    values : array, shape (signals, features)
        Features of the signals.
    signals : LabelledSignals
        The signals.
    bootstrap : Bootstrap
        Draws of groups.
    workers, progress
        As `run_jobs` takes them.
    """
    bins = []
    for key, phrase, inside in bins_of(signals):
        if _usable(inside, chosen):
            bins.append((key, phrase, inside))
    jobs = [
        partial(_guess_left_out, chosen, values, inside, split, parameters)
        for _, _, inside in bins
        for split, parameters in chosen.parts
    ]
    guesses = iter(run_jobs("ranges left out in training", jobs, workers, progress))
    right_seen = (chosen.guessed == chosen.classes).astype(float)[np.newaxis]
    scores = []
    for key, phrase, inside in bins:
        guessed = np.full(len(chosen.classes), -1)
        for split, _ in chosen.parts:
            guessed[split.test[inside[split.test]]] = next(guesses)
        right_unseen = (guessed == chosen.classes).astype(float)[np.newaxis]
        within = bootstrap.within(inside)
        scores.append(
            Unseen(
                key,
                phrase,
                signals=int(inside.sum()),
                seen=within.balanced(right_seen[:, inside]),
                unseen=within.balanced(right_unseen[:, inside]),
            )
        )
    return scores


def _guess_left_out(
    chosen: Chosen, values: Floats, inside: Bools, split: Split, parameters: Parameters
) -> Indices:
    """Return the classes of tested signals in a range, predicted without training on it."""
    test = split.test[inside[split.test]]
    if not len(test):
        return test
    fitted = chosen.refit(values, split.train[~inside[split.train]], parameters)
    return chosen.guess(fitted, values[test])


def _usable(inside: Bools, chosen: Chosen) -> bool:
    """Return whether classifiers can be trained without a range, and tested on it.

    The range must have all classes, and each training part without it several groups of every
    class.
    """
    classes = chosen.classes
    class_numbers = np.unique(classes)
    if len(np.unique(classes[inside])) < len(class_numbers):
        return False
    for split, _ in chosen.parts:
        train = split.train[~inside[split.train]]
        for number in class_numbers:
            if len(np.unique(chosen.groups[train][classes[train] == number])) < 2:
                return False
    return True
