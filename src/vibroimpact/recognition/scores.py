"""Scores of held-out probabilities, with intervals that count groups: signals of one rock are one
piece of evidence, not many.

Shares have the interval of Korn and Graubard (1998), Survey Methodology 24:193: that of Clopper and
Pearson for as many independent trials as have the variance that the groups show, fewer by Student's
t for few groups. Other scores, and differences, have draws of groups.

Both are widened by the term of Nadeau and Bengio (2003), Machine Learning 52:239, doi
10.1023/A:1024068626366, for training sets: the variance is multiplied by 1 + t, t being the ratio
of what is tested on to what is trained on in each part of the cross-validation.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import numpy as np
from scipy.stats import beta, norm, t

from vibroimpact.arrays import Bools, Floats, Indices

DRAWS = 1000
"""Number of bootstrap draws."""

_INTERVAL = 0.95
_LEAST = 1e-12  # of a probability whose logarithm is taken
_SAME = 1e-12  # rounding of a difference of shares


@dataclass(frozen=True, eq=False)
class Score:
    """A score with its interval of 95 %, for classifiers trained on other such groups, and tested
    on other such groups.

    Parameters
    ----------
    value : float
        Mean over the seeds.
    draws : array, shape (draws,)
        The same of groups drawn with replacement, about the value as wide as intervals are.
    seeds : array
        The score under each seed.
    trials : float, optional
        Of a share: the number of independent trials that tell as much. None for what is no share;
        its interval is that of the draws.

    Examples
    --------
    >>> none = Score(0.0, np.zeros(1000), np.zeros(5), 8.0)
    >>> none.low, round(none.high, 3), round(none.end(0.99), 3)
    (0.0, 0.369, 0.438)
    """

    value: float
    draws: Floats
    seeds: Floats
    trials: float | None = None

    @property
    def low(self) -> float:
        """Lower end of the interval of 95 %."""
        return self.end(0.5 - 0.5 * _INTERVAL)

    @property
    def high(self) -> float:
        """Upper end of the interval of 95 %."""
        return self.end(0.5 + 0.5 * _INTERVAL)

    def end(self, part: float) -> float:
        """Return an end of the interval: the upper of `2 part - 1` if `part` is more than
        a half, else the lower of `1 - 2 part`.
        """
        if self.trials is None:
            return float(np.nanquantile(self.draws, part))
        if np.isinf(self.trials):
            return self.value
        if self.trials < 1.0:
            return float(part > 0.5)  # less than one trial tells nothing
        hits = self.value * self.trials
        misses = self.trials - hits
        if part > 0.5:
            return float(beta.ppf(part, hits + 1.0, misses)) if misses > 0.0 else 1.0
        return float(beta.ppf(part, hits, misses + 1.0)) if hits > 0.0 else 0.0


class Bootstrap:
    """The groups as what is independent: their number and spread, and draws of them, the same for
    all scores, for intervals of differences.

    Parameters
    ----------
    groups : array of int
        Group of each signal.
    classes : array of int
        Class of each signal.
    seed : int
        Seed of the draws.
    folds : int, optional
        Number of parts of the cross-validation that the scores are of; None for one classifier that
        is only tested.
    """

    def __init__(
        self, groups: Indices, classes: Indices, seed: int = 0, folds: int | None = None
    ) -> None:
        names, self.place = np.unique(groups, return_inverse=True)
        self.classes = classes
        self.of_training = widening_by_training(folds)
        self.weights = (
            np.random.default_rng(seed)
            .multinomial(len(names), np.full(len(names), 1.0 / len(names)), DRAWS)
            .astype(float)
        )
        self.present = np.unique(classes)

    def mean(self, values: Floats, *, share: bool = True) -> Score:
        """Return the mean of one value a signal, given for each seed: shape (seeds,
        signals); it is a share if the values are 0 and 1.
        """
        with np.errstate(invalid="ignore"):  # a draw may have none of the signals
            draws = (self._sums(values.mean(axis=0)) @ self.weights.T) / (
                self._sums(np.ones(values.shape[1])) @ self.weights.T
            )
        held = self._trials(values.mean(axis=0), [np.ones(values.shape[1], dtype=bool)])
        return self._scored(
            float(values.mean()), draws, values.mean(axis=1), held if share else None
        )

    def balanced(self, values: Floats) -> Score:
        """Return the mean over the classes of the mean of one value a signal in each class."""
        by_seed, by_draw = [], []
        for one in self.present:
            own = self.classes == one
            by_seed.append(values[:, own].mean(axis=1))
            with np.errstate(invalid="ignore"):  # a draw may have no group of a class
                by_draw.append(
                    (self._sums(values.mean(axis=0) * own) @ self.weights.T)
                    / (self._sums(own.astype(float)) @ self.weights.T)
                )
        seeds = np.mean(by_seed, axis=0)
        held = self._trials(values.mean(axis=0), [self.classes == one for one in self.present])
        return self._scored(float(seeds.mean()), np.mean(by_draw, axis=0), seeds, held)

    def within(self, inside: Bools) -> Bootstrap:
        """Return the same draws for some of the signals."""
        found = copy(self)
        found.place, found.classes = self.place[inside], self.classes[inside]
        found.present = np.unique(found.classes)
        return found

    def _scored(self, value: float, draws: Floats, seeds: Floats, trials: float | None) -> Score:
        """Return a score whose draws are widened as its interval is: draws of few groups
        are too narrow, and know one training set.
        """
        groups = len(np.unique(self.place))
        if groups < 2:
            return Score(value, draws, seeds, trials)
        wider = np.sqrt(self.of_training * groups / (groups - 1.0)) * widening_by_few(groups - 1)
        return Score(value, value + wider * (draws - value), seeds, trials)

    def _trials(self, values: Floats, parts: list[Bools]) -> float:
        """Return the number of independent trials with the variance of the mean over some parts of
        the mean in each.

        It is none where a part has one group, whose spread isn't known. It has no limit where each
        part is all right or all wrong, but not all parts alike: everything is taken for one class,
        and the mean is that for any groups.
        """
        means, freedom, least = [], 0, 0.0
        apart = np.zeros(self.weights.shape[1])
        there = np.zeros(len(apart), dtype=bool)
        for own in parts:
            sizes = self._sums(own.astype(float))
            groups = int((sizes > 0.0).sum())
            if groups < 2:
                return 0.0
            means.append(float(values[own].mean()))
            own_apart = (self._sums(values * own) - means[-1] * sizes) / (sizes.sum() * len(parts))
            own_apart[np.abs(own_apart) < _SAME] = 0.0
            apart += np.sqrt(groups / (groups - 1.0)) * own_apart
            there |= sizes > 0.0
            freedom += groups - 1
            # the signals of a group tell no more than independent ones; and no more than the group
            # where the groups do not differ
            least += 1.0 / (len(parts) ** 2 * (sizes.sum() if own_apart.any() else groups))
        mean = float(np.mean(means))
        variance = float(apart @ apart)
        if not variance and 0.0 < mean < 1.0 and set(means) == {0.0, 1.0}:
            return np.inf
        # of groups that have signals in several parts, as plates that all classes fall on, each
        # counts once
        wider = self.of_training * widening_by_few(min(freedom, int(there.sum()) - 1)) ** 2
        return 1.0 / (max(least, variance / (mean * (1.0 - mean)) if variance else 0.0) * wider)

    def _sums(self, values: Floats) -> Floats:
        return np.asarray(
            np.bincount(self.place, values, minlength=self.weights.shape[1]), dtype=float
        )


def widening_by_training(folds: int | None) -> float:
    """Return the variance of a score of a cross-validation over that of one classifier tested on as
    many groups.

    Examples
    --------
    >>> widening_by_training(5), widening_by_training(None)
    (1.25, 1.0)
    """
    return 1.0 if folds is None else 1.0 + 1.0 / (folds - 1.0)


def widening_by_few(freedom: int) -> float:
    """Return by how much wider an interval is whose variance is known with some degrees of freedom
    only, after Student.

    Examples
    --------
    >>> round(widening_by_few(6), 3)  # 2.447 / 1.960
    1.248
    """
    upper = 0.5 + 0.5 * _INTERVAL
    return float(t.ppf(upper, freedom) / norm.ppf(upper))


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
        Brier's score, half the squared distance of the probabilities from the truth, and the
        negative logarithm of the probability of the true class.
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
        bootstrap.mean(1.0 - right),
        bootstrap.balanced(right),
        bootstrap.mean(brier, share=False),
        bootstrap.mean(-np.log(np.maximum(of_true, _LEAST)), share=False),
    )
