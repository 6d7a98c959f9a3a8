"""Calibration of probabilities: how often signals that are given a probability of a class
are of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.recognition.scores import Bootstrap

_BINS = 10


@dataclass(frozen=True, eq=False)
class Reliable:
    """Signals given similar probabilities of a class: their number, the mean probability,
    and the part of the class with its interval.
    """

    class_name: str
    signals: int
    probability: float
    part: float
    low: float
    high: float


def reliability(
    held_out: Floats, classes: Indices, class_names: tuple[str, ...], bootstrap: Bootstrap
) -> list[Reliable]:
    """Return the calibration curve of each class, or of two classes that of the second, whose curve
    is the first's turned about.

    Parameters
    ----------
    held_out : array, shape (signals, classes)
        Probabilities of signals that were not trained on.
    classes : array of int
        The true classes.
    class_names : tuple of str
        Names of the classes.
    bootstrap : Bootstrap
        Draws of groups, for the intervals.
    """
    found = []
    names = list(enumerate(class_names))
    for number, name in names if len(names) > 2 else names[1:]:
        place = np.minimum((held_out[:, number] * _BINS).astype(int), _BINS - 1)
        for one in np.unique(place):
            inside = place == one
            part = bootstrap.within(inside).mean(
                (classes == number).astype(float)[np.newaxis, inside]
            )
            found.append(
                Reliable(
                    name,
                    int(inside.sum()),
                    float(held_out[inside, number].mean()),
                    part.value,
                    part.low,
                    part.high,
                )
            )
    return found
