"""Calibration of probabilities: how often signals given a probability of a class are of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.recognition.scores import Bootstrap

_BINS = 10


@dataclass(frozen=True, eq=False)
class Reliable:
    """Signals given similar probabilities of a class.

    Parameters
    ----------
    class_name : str
        The class.
    signals : int
        Number of the signals.
    probability : float
        Their mean probability.
    part, low, high : float
        The part of them that is of the class, with its interval of 95 %.
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
    """Return the calibration curve of each class.

    Of two classes it is that of the second, whose curve is the first's turned about.

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
    points = []
    classes_drawn = list(enumerate(class_names))
    if len(classes_drawn) <= 2:
        classes_drawn = classes_drawn[1:]
    for number, name in classes_drawn:
        probability = held_out[:, number]
        bin_number = np.minimum((probability * _BINS).astype(int), _BINS - 1)
        for occupied in np.unique(bin_number):
            inside = bin_number == occupied
            is_class = (classes == number).astype(float)[np.newaxis, inside]
            share = bootstrap.within(inside).mean(is_class)
            points.append(
                Reliable(
                    class_name=name,
                    signals=int(inside.sum()),
                    probability=float(probability[inside].mean()),
                    part=share.value,
                    low=share.low,
                    high=share.high,
                )
            )
    return points
