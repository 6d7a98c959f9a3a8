"""Trained on and tested on: what is recognised of a size, height, plate, place or noise
that was never trained on.
"""

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

_BINS, _MOST_KEYS = 3, 8
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
    keys: dict[str, NDArray[Any]] = (
        {"plate": signals.groups["plate"]} if "plate" in signals.groups else {}
    )
    keys |= {key: one for key, one in signals.drawn.items() if not key.startswith(_OF_THE_CLASS)}
    found: list[tuple[str, str, Bools]] = []
    for key in [key for key, values in keys.items() if len(np.unique(values)) > 1][:_MOST_KEYS]:
        values = keys[key]
        names = np.unique(values)
        if values.dtype.kind not in "f" or len(names) <= _BINS:
            parts = np.array_split(names, min(len(names), _BINS))
            found += [(key, _names(part), np.isin(values, part)) for part in parts]
            continue
        edges = np.quantile(values, np.linspace(0.0, 1.0, _BINS + 1))
        place = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, _BINS - 1)
        found += [
            (key, f"{edges[one]:.3g} to {edges[one + 1]:.3g}", place == one)
            for one in range(_BINS)
            if (place == one).any()
        ]
    return found


def _names(part: NDArray[Any]) -> str:
    shown = [f"{one:.3g}" if isinstance(one, float) else str(one) for one in part.tolist()]
    return (
        shown[0]
        if len(shown) == 1
        else f"{shown[0]} to {shown[-1]}"
        if len(shown) > 3
        else ", ".join(shown)
    )


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
    """
    right = (chosen.guessed == chosen.classes).astype(float)[np.newaxis]
    bins = [one for one in bins_of(signals) if _usable(one[2], chosen)]

    def one(inside: Bools, split: Split, parameters: Parameters) -> Indices:
        test = split.test[inside[split.test]]
        if not len(test):
            return test
        return chosen.guess(
            chosen.refit(values, split.train[~inside[split.train]], parameters), values[test]
        )

    jobs = [partial(one, inside, *part) for _, _, inside in bins for part in chosen.parts]
    done = iter(run_jobs("ranges left out in training", jobs, workers, progress))
    found = []
    for key, words, inside in bins:
        guessed = np.full(len(chosen.classes), -1)
        for split, _ in chosen.parts:
            guessed[split.test[inside[split.test]]] = next(done)
        within = bootstrap.within(inside)
        unseen = (guessed == chosen.classes).astype(float)[np.newaxis]
        found.append(
            Unseen(
                key,
                words,
                int(inside.sum()),
                within.balanced(right[:, inside]),
                within.balanced(unseen[:, inside]),
            )
        )
    return found


def _usable(inside: Bools, chosen: Chosen) -> bool:
    """Return whether a range has all classes, and each training part without it has
    several groups of every class.
    """
    classes, names = chosen.classes, np.unique(chosen.classes)
    if len(np.unique(classes[inside])) < len(names):
        return False
    outside = [split.train[~inside[split.train]] for split, _ in chosen.parts]
    return all(
        len(np.unique(chosen.groups[part][classes[part] == one])) >= 2
        for part in outside
        for one in names
    )
