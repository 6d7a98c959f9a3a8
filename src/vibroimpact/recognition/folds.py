"""Splits of signals into parts to train on and to test on.

Groups are kept apart, or signals are split at random as a naive user would.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Indices

FOLDS = 5
"""Parts of the cross-validation of many groups."""
FEW = 10
"""Groups of a class below which each part leaves one out: that trains on as many as there are."""
_INNER = 3
"""Parts of the cross-validation within a training part."""
_UNEVEN = 0.02
"""Unevenness of the classes in training parts beyond which groups are dealt by class instead."""


class Split(NamedTuple):
    """Indices of the signals that are trained on, and of those that are tested on."""

    train: Indices
    test: Indices


def fewest_groups(classes: Indices, groups: Indices) -> int:
    """Return the number of groups of the class that is in the fewest.

    Examples
    --------
    >>> fewest_groups(np.array([0, 0, 1, 1, 1]), np.array([0, 0, 1, 2, 2]))
    1
    """
    return min(len(np.unique(groups[classes == number])) for number in np.unique(classes))


def default_folds(classes: Indices, groups: Indices) -> int:
    """Return the number of parts for some groups: five, or of few groups as many as a class has.

    One group of each class is then left out. To leave out a single group would train on more of the
    other classes, and so guess those more often.

    Examples
    --------
    >>> (
    ...     default_folds(np.array([0, 1] * 4), np.arange(8)),
    ...     default_folds(np.array([0, 1] * 40), np.arange(80)),
    ... )
    (4, 5)
    """
    fewest = fewest_groups(classes, groups)
    return max(2, fewest) if fewest < FEW else FOLDS


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
    >>> split = split_signals(np.array([0, 1] * 6), groups, 3, 0)[0]
    >>> len(split.train), len(split.test), set(groups[split.train]) & set(groups[split.test])
    (8, 4, set())
    """
    from sklearn.model_selection import StratifiedGroupKFold, StratifiedKFold

    no_features = np.zeros(len(classes))  # a split does not depend on them
    if groups is None:
        random_folds = StratifiedKFold(folds, shuffle=True, random_state=seed)
        return [Split(train, test) for train, test in random_folds.split(no_features, classes)]
    group_folds = StratifiedGroupKFold(folds, shuffle=True, random_state=seed)
    drawn = [Split(train, test) for train, test in group_folds.split(no_features, classes, groups)]
    if _unevenness(drawn, classes) <= _UNEVEN:
        return drawn
    # groups of unequal sizes may be drawn unevenly; to deal them is more even, and less random
    dealt = _dealt(classes, groups, folds, seed)
    if _unevenness(dealt, classes) < _unevenness(drawn, classes):
        return dealt
    return drawn


def _unevenness(splits: list[Split], classes: Indices) -> float:
    """Return the largest difference of the share of a class in a training part from that of all.

    It is 1 if a part lacks a class.
    """
    shares = np.bincount(classes) / len(classes)
    present = shares > 0.0
    unevenness = 0.0
    for split in splits:
        train_counts = np.bincount(classes[split.train], minlength=len(shares))
        test_counts = np.bincount(classes[split.test], minlength=len(shares))
        if not train_counts[present].all() or not test_counts[present].all():
            return 1.0
        train_shares = train_counts / train_counts.sum()
        unevenness = max(unevenness, float(np.abs(train_shares - shares).max()))
    return unevenness


def _dealt(classes: Indices, groups: Indices, folds: int, seed: int) -> list[Split]:
    """Return parts that are dealt whole groups class by class, the largest first.

    Surplus groups of all classes are thus in the same parts. A group of several classes is dealt
    with the first of them.
    """
    random = np.random.default_rng(seed)
    part = np.full(len(classes), -1)
    for class_number in np.unique(classes):
        not_dealt = (classes == class_number) & (part < 0)
        names, sizes = np.unique(groups[not_dealt], return_counts=True)
        # groups of equal size in random order
        shuffled = random.permutation(len(names))
        largest_first = shuffled[np.argsort(-sizes[shuffled], kind="stable")]
        for number, name in enumerate(names[largest_first]):
            part[groups == name] = number % folds
    return [
        Split(train=np.flatnonzero(part != number), test=np.flatnonzero(part == number))
        for number in range(folds)
    ]


def inner_splits(classes: Indices, groups: Indices | None, seed: int) -> list[Split]:
    """Return the parts of a cross-validation within a training part.

    They are three, or as many as a class has groups there. Where a class has one group only,
    signals are split at random: that chooses parameters less well, and tests nothing.

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
        fewest = fewest_groups(classes, groups)
        if fewest > 1:
            return split_signals(classes, groups, min(_INNER, fewest), seed)
    return split_signals(classes, None, _INNER, seed)
