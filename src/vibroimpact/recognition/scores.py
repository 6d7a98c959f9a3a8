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
_LEAST_PROBABILITY = 1e-12  # whose logarithm is taken
_ROUNDING = 1e-12  # of a difference of shares


@dataclass(frozen=True, eq=False)
class Score:
    """A score with its interval of 95 %.

    The interval is for classifiers that are trained and tested on other such groups.

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
        """Return an end of an interval, at a probability `part`.

        If `part` is more than a half, it is the upper end of the interval of `2 part - 1`, else the
        lower end of that of `1 - 2 part`.
        """
        if self.trials is None:
            return float(np.nanquantile(self.draws, part))
        if np.isinf(self.trials):
            return self.value
        if self.trials < 1.0:
            return float(part > 0.5)  # less than one trial tells nothing
        # Clopper and Pearson: quantiles of beta distributions
        hits = self.value * self.trials
        misses = self.trials - hits
        if part > 0.5 and misses > 0.0:
            return float(beta.ppf(part, hits + 1.0, misses))
        if part > 0.5:
            return 1.0
        if hits > 0.0:
            return float(beta.ppf(part, hits, misses + 1.0))
        return 0.0


class Bootstrap:
    """Groups, which alone are independent, and draws of them.

    The draws are the same for all scores, so that differences of scores have intervals, too.

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
        names, self._group_number = np.unique(groups, return_inverse=True)
        self._classes = classes
        self._widening_by_training = widening_by_training(folds)
        # how often each group is drawn, (draws, groups)
        random = np.random.default_rng(seed)
        equal_probabilities = np.full(len(names), 1.0 / len(names))
        self._counts = random.multinomial(len(names), equal_probabilities, DRAWS).astype(float)

    def mean(self, values: Floats, *, share: bool = True) -> Score:
        """Return the mean of one value a signal.

        Parameters
        ----------
        values : array, shape (seeds, signals)
            The values under each seed.
        share : bool, default True
            Whether the values are 0 and 1, so that the mean is a share.
        """
        seed_mean = values.mean(axis=0)
        all_signals = np.ones(values.shape[1], dtype=bool)
        draws = self._drawn_means(seed_mean, all_signals)
        trials = None
        if share:
            trials = self._trials(seed_mean, [all_signals])
        return self._scored(float(values.mean()), draws, values.mean(axis=1), trials)

    def balanced(self, values: Floats) -> Score:
        """Return the mean over the classes of the mean of one value a signal in each class.

        Parameters
        ----------
        values : array, shape (seeds, signals)
            The values under each seed.
        """
        seed_mean = values.mean(axis=0)
        by_class = [self._classes == number for number in np.unique(self._classes)]
        seeds = np.mean([values[:, in_class].mean(axis=1) for in_class in by_class], axis=0)
        draws = np.mean([self._drawn_means(seed_mean, in_class) for in_class in by_class], axis=0)
        trials = self._trials(seed_mean, by_class)
        return self._scored(float(seeds.mean()), draws, seeds, trials)

    def within(self, inside: Bools) -> Bootstrap:
        """Return the same draws for some of the signals."""
        subset = copy(self)
        subset._group_number = self._group_number[inside]
        subset._classes = self._classes[inside]
        return subset

    def _drawn_means(self, values: Floats, counted: Bools) -> Floats:
        """Return the mean over the signals that are counted, of each draw of groups, (draws,)."""
        sums = self._group_sums(values * counted) @ self._counts.T
        numbers = self._group_sums(counted.astype(float)) @ self._counts.T
        with np.errstate(invalid="ignore"):  # a draw may have none of the signals
            return np.asarray(sums / numbers)

    def _scored(self, value: float, draws: Floats, seeds: Floats, trials: float | None) -> Score:
        """Return a score whose draws are widened as its interval is.

        Draws of few groups are too narrow, and know one training set.
        """
        groups = len(np.unique(self._group_number))
        if groups < 2:
            return Score(value, draws, seeds, trials)
        # draws with replacement have (groups - 1) / groups of the variance of the groups
        of_draws = np.sqrt(self._widening_by_training * groups / (groups - 1.0))
        widening = of_draws * widening_by_few(groups - 1)
        return Score(value, value + widening * (draws - value), seeds, trials)

    def _trials(self, values: Floats, parts: list[Bools]) -> float:
        """Return the number of independent trials with the variance of a mean.

        It is the mean over some parts, such as classes, of the mean in each.

        There are none where a part has one group, whose spread isn't known. There is no limit where
        each part is all right or all wrong, but not all parts alike: everything is taken for one
        class, and the mean is that for any groups.

        Parameters
        ----------
        values : array, shape (signals,)
            One value a signal, from 0 to 1.
        parts : list of array of bool
            Which signals are in each part.
        """
        means = []
        freedom = 0
        least_variance = 0.0  # relative to that of one trial
        deviations = np.zeros(self._counts.shape[1])  # what each group adds to the error
        has_signals = np.zeros(len(deviations), dtype=bool)
        for in_part in parts:
            sizes = self._group_sums(in_part.astype(float))
            groups = int((sizes > 0.0).sum())
            if groups < 2:
                return 0.0
            means.append(float(values[in_part].mean()))
            # linearised: the deviations of the sums of the groups from those of the mean
            part_deviations = (self._group_sums(values * in_part) - means[-1] * sizes) / (
                sizes.sum() * len(parts)
            )
            part_deviations[np.abs(part_deviations) < _ROUNDING] = 0.0
            deviations += np.sqrt(groups / (groups - 1.0)) * part_deviations
            has_signals |= sizes > 0.0
            freedom += groups - 1
            # the signals of a group tell no more than independent ones; and no more than the group
            # where the groups do not differ
            independent = groups
            if part_deviations.any():
                independent = sizes.sum()
            least_variance += 1.0 / (len(parts) ** 2 * independent)
        mean = float(np.mean(means))
        variance = float(deviations @ deviations)
        if not variance and 0.0 < mean < 1.0 and set(means) == {0.0, 1.0}:
            return np.inf
        # one trial has the variance of a share, mean (1 - mean)
        relative_variance = 0.0
        if variance:
            relative_variance = variance / (mean * (1.0 - mean))
        # of groups that have signals in several parts, as plates that all classes fall on, each
        # counts once
        freedom = min(freedom, int(has_signals.sum()) - 1)
        widening = self._widening_by_training * widening_by_few(freedom) ** 2
        return 1.0 / (max(least_variance, relative_variance) * widening)

    def _group_sums(self, values: Floats) -> Floats:
        """Return the sum of one value a signal over each group, (groups,)."""
        sums = np.bincount(self._group_number, values, minlength=self._counts.shape[1])
        return np.asarray(sums, dtype=float)


def widening_by_training(folds: int | None) -> float:
    """Return by how much the variance of a score is larger in a cross-validation.

    It is relative to that of one classifier tested on as many groups.

    Examples
    --------
    >>> widening_by_training(5), widening_by_training(None)
    (1.25, 1.0)
    """
    if folds is None:
        return 1.0
    # the term is the ratio of the test part to its training part
    return 1.0 + 1.0 / (folds - 1.0)


def widening_by_few(freedom: int) -> float:
    """Return by how much wider an interval is, after Student.

    Its variance is known with some degrees of freedom only.

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
    recalls = [(guessed[truth == number] == number).mean() for number in np.unique(truth)]
    return float(np.mean(recalls))


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
    true_probability = held_out[:, np.arange(len(classes)), classes]
    # 0.5 sum (p - y)^2, where y is 1 for the true class and 0 for the others
    brier = 0.5 * (np.square(held_out).sum(axis=2) - 2.0 * true_probability + 1.0)
    log_loss = -np.log(np.maximum(true_probability, _LEAST_PROBABILITY))
    return Scores(
        error=bootstrap.mean(1.0 - right),
        balanced_accuracy=bootstrap.balanced(right),
        brier=bootstrap.mean(brier, share=False),
        log_loss=bootstrap.mean(log_loss, share=False),
    )
