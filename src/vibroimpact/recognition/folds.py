"""Splits of signals into parts to train on and to test on: groups kept apart, or at random as a naive user would."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Indices

_INNER = 3
"""Parts of the cross-validation within a training part."""


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


def inner_splits(classes: Indices, groups: Indices | None, seed: int) -> list[Split]:
    """Return the parts of a cross-validation within a training part: three, or as many as a class has groups there.

    Where a class has one group only, signals are split at random: that chooses parameters less well, and tests nothing.

    Parameters
    ----------
    classes : array of int
        Class of each signal of the training part.
    groups : array of int, optional
        Their groups; None splits at random.
    seed : int
        Seed of the draw.

    Examples
    --------
    >>> len(inner_splits(np.array([0, 1] * 6), np.repeat(np.arange(2), 6), 0))
    2
    """
    if groups is not None:
        fewest = min(len(np.unique(groups[classes == one])) for one in np.unique(classes))
        if fewest > 1:
            return split_signals(classes, groups, min(_INNER, fewest), seed)
    return split_signals(classes, None, _INNER, seed)
