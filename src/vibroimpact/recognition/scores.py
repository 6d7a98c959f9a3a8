"""Scores of held-out probabilities, with intervals by bootstrap over groups: signals of one rock are one piece of evidence, not many."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices

DRAWS = 1000
"""Number of bootstrap draws."""

_INTERVAL = (2.5, 97.5)
_LEAST = 1e-12  # of a probability whose logarithm is taken


@dataclass(frozen=True, eq=False)
class Score:
    """A score with its interval.

    Parameters
    ----------
    value : float
        Mean over the seeds.
    draws : array, shape (draws,)
        The same of groups drawn with replacement.
    seeds : array
        The score under each seed.
    """

    value: float
    draws: Floats
    seeds: Floats

    @property
    def low(self) -> float:
        """Lower end of the interval of 95 %."""
        return float(np.nanpercentile(self.draws, _INTERVAL[0]))

    @property
    def high(self) -> float:
        """Upper end of the interval of 95 %."""
        return float(np.nanpercentile(self.draws, _INTERVAL[1]))


class Bootstrap:
    """Groups drawn with replacement, the same for all scores, so that differences have intervals too.

    Parameters
    ----------
    groups : array of int
        Group of each signal.
    classes : array of int
        Class of each signal.
    seed : int
        Seed of the draws.
    """

    def __init__(self, groups: Indices, classes: Indices, seed: int = 0) -> None:
        names, self.place = np.unique(groups, return_inverse=True)
        self.classes = classes
        self.weights = np.random.default_rng(seed).multinomial(len(names), np.full(len(names), 1.0 / len(names)), DRAWS).astype(float)
        self.present = np.unique(classes)

    def mean(self, values: Floats) -> Score:
        """Return the mean of one value a signal, given for each seed: shape (seeds, signals)."""
        with np.errstate(invalid="ignore"):  # a draw may have none of the signals
            draws = (self._sums(values.mean(axis=0)) @ self.weights.T) / (self._sums(np.ones(values.shape[1])) @ self.weights.T)
        return Score(float(values.mean()), draws, values.mean(axis=1))

    def balanced(self, values: Floats) -> Score:
        """Return the mean over the classes of the mean of one value a signal in each class."""
        by_seed, by_draw = [], []
        for one in self.present:
            own = self.classes == one
            by_seed.append(values[:, own].mean(axis=1))
            with np.errstate(invalid="ignore"):  # a draw may have no group of a class
                by_draw.append((self._sums(values.mean(axis=0) * own) @ self.weights.T) / (self._sums(own.astype(float)) @ self.weights.T))
        seeds = np.mean(by_seed, axis=0)
        return Score(float(seeds.mean()), np.mean(by_draw, axis=0), seeds)

    def within(self, inside: Bools) -> Bootstrap:
        """Return the same draws for some of the signals."""
        found = copy(self)
        found.place, found.classes = self.place[inside], self.classes[inside]
        found.present = np.unique(found.classes)
        return found

    def _sums(self, values: Floats) -> Floats:
        return np.asarray(np.bincount(self.place, values, minlength=self.weights.shape[1]), dtype=float)


def balanced_accuracy(guessed: Indices, truth: Indices) -> float:
    """Return the mean over the classes of the part of their signals that is recognised.

    Examples
    --------
    >>> balanced_accuracy(np.array([0, 1, 1, 1]), np.array([0, 0, 0, 1])).__round__(3)
    0.667
    """
    return float(np.mean([(guessed[truth == one] == one).mean() for one in np.unique(truth)]))


@dataclass(frozen=True, eq=False)
class Scores:
    """All scores of one classifier under one split.

    Parameters
    ----------
    error : Score
        Part of the signals that are taken for another class.
    balanced_accuracy : Score
        Mean over the classes of the part of their signals that is recognised.
    brier, log_loss : Score
        Brier's score, half the squared distance of the probabilities from the truth, and the negative logarithm of the probability of the
        true class.
    """

    error: Score
    balanced_accuracy: Score
    brier: Score
    log_loss: Score


def score(held_out: Floats, classes: Indices, bootstrap: Bootstrap) -> Scores:
    """Return the scores of probabilities of signals that were not trained on.

    Parameters
    ----------
    held_out : array, shape (seeds, signals, classes)
        The probabilities.
    classes : array of int
        The true classes.
    bootstrap : Bootstrap
        Draws of groups.
    """
    right = (held_out.argmax(axis=2) == classes).astype(float)
    of_true = held_out[:, np.arange(len(classes)), classes]
    brier = 0.5 * (np.square(held_out).sum(axis=2) - 2.0 * of_true + 1.0)
    return Scores(
        bootstrap.mean(1.0 - right), bootstrap.balanced(right), bootstrap.mean(brier), bootstrap.mean(-np.log(np.maximum(of_true, _LEAST)))
    )
