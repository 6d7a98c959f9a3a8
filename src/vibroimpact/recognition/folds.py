"""Splits of signals into parts to train on and to test on: groups kept apart, or at random as a naive user would."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Indices


class Split(NamedTuple):
    """Indices of the signals that are trained on, and of those that are tested on."""

    train: Indices
    test: Indices


def split_signals(classes: Indices, groups: Indices | None, folds: int, seed: int) -> list[Split]:
    """Return the parts of a cross-validation, with the classes spread evenly over them.

    Parameters
    ----------
    classes : array of int
        Class of each signal.
    groups : array of int, optional
        Group of each signal; no group is in both parts of a split. None splits at random.
    folds : int
        Number of parts.
    seed : int
        Seed of the draw.

    Examples
    --------
    >>> groups = np.repeat(np.arange(6), 2)
    >>> one = split_signals(np.array([0, 1] * 6), groups, 3, 0)[0]
    >>> len(one.train), len(one.test), set(groups[one.train]) & set(groups[one.test])
    (8, 4, set())
    """
    from sklearn.model_selection import StratifiedGroupKFold, StratifiedKFold

    blank = np.zeros(len(classes))
    if groups is None:
        return [Split(*one) for one in StratifiedKFold(folds, shuffle=True, random_state=seed).split(blank, classes)]
    return [Split(*one) for one in StratifiedGroupKFold(folds, shuffle=True, random_state=seed).split(blank, classes, groups)]
