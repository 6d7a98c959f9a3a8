"""What few groups can't tell, and how many could.

It is said in warnings where figures would have false digits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import ceil, log, log10

import numpy as np

from vibroimpact.recognition.bound import SURE
from vibroimpact.recognition.classifiers import BASELINE, CLASSIFIER, Classifier
from vibroimpact.recognition.scores import Score, Scores, widening_by_few, widening_by_training

FINE = 0.05
"""Half the width of an interval from which on a score has no decimals.

The number of groups that it takes is then stated.
"""
_NORMAL_QUANTILE = 1.96
"""Half the width of an interval of 95 % in standard deviations."""


def coarse(error: Score) -> bool:
    """Return whether an error is known so badly that tenths of a per cent tell nothing.

    Examples
    --------
    >>> import numpy as np
    >>> (
    ...     coarse(Score(0.2, np.zeros(1), np.zeros(1), 20.0)),
    ...     coarse(Score(0.2, np.zeros(1), np.zeros(1), 2000.0)),
    ... )
    (True, False)
    """
    return error.high - error.low > 2.0 * FINE


def groups_for_error(error: Score, groups: int) -> int:
    """Return how many groups have an error with an interval of +-5 %, if they differ as these do.

    Parameters
    ----------
    error : Score
        The error that is known from `groups` groups.
    groups : int
        Their number.

    Examples
    --------
    >>> import numpy as np
    >>> groups_for_error(Score(0.5, np.zeros(1), np.zeros(1), 8.0), 8)
    270
    """
    if not error.trials:
        return groups
    trials = error.trials * widening_by_few(groups - 1) ** 2
    # of few trials none may err by luck: two more of each kind, after Agresti and Coull
    share = (error.value * error.trials + 2.0) / (error.trials + 4.0)
    return _rounded_up(_NORMAL_QUANTILE**2 * share * (1.0 - share) / FINE**2 * groups / trials)


def are_too_few(error: Score, groups: int) -> bool:
    """Return whether groups are too few for an error with an interval of +-5 %.

    Parameters
    ----------
    error : Score
        The error that is known from `groups` groups.
    groups : int
        Their number.

    Examples
    --------
    >>> import numpy as np
    >>> are_too_few(Score(0.5, np.zeros(1), np.zeros(1), 8.0), 8)
    True
    """
    return coarse(error) and groups_for_error(error, groups) > groups


def largest_error_of_none(groups: int, folds: int) -> float:
    """Return the largest error rate of a classifier that makes no error in some groups.

    The confidence is that of a possible leak.

    Examples
    --------
    >>> round(largest_error_of_none(8, 4), 2), round(largest_error_of_none(200, 5), 2)
    (0.67, 0.03)
    """
    trials = groups / (widening_by_training(folds) * widening_by_few(groups - 1) ** 2)
    return Score(0.0, np.zeros(0), np.zeros(0), trials).end(SURE / 100.0)


def groups_for_bound(bayes_error: float, folds: int) -> int:
    """Return how many groups without any error show that a classifier is better than a bound.

    Examples
    --------
    >>> groups_for_bound(0.231, 4)
    30
    """
    groups = log(1.0 - SURE / 100.0) / log(1.0 - bayes_error) * widening_by_training(folds)
    while largest_error_of_none(ceil(groups), folds) >= bayes_error:
        groups *= 1.05
    return _rounded_up(groups)


def few_groups_doubts(best: Scores, group: str, groups: int, classes: int) -> list[str]:
    """Return a warning if there are too few groups to tell the error of the best classifier.

    Parameters
    ----------
    best : Scores
        Its scores, groups kept apart.
    group : str
        What signals of a group share.
    groups, classes : int
        Number of groups and of classes.
    """
    error = best.error
    if not are_too_few(error, groups):
        return []
    doubt = (
        f"{groups} {group}s are too few: the error of the best classifier may be anything from "
        f"{100.0 * error.low:.0f} to {100.0 * error.high:.0f} %; for ±5 % about "
        f"{groups_for_error(error, groups):,} {group}s are needed, which more signals of the same "
        f"{group}s do not replace"
    )
    chance = 1.0 / classes
    if best.balanced_accuracy.low <= chance:
        doubt += (
            "; the classifier may be no better than guessing, whose balanced accuracy is "
            f"{100.0 * chance:.0f} %"
        )
    return [doubt]


def simpler_and_as_good(
    compared: Sequence[Classifier], scores: Mapping[str, Scores], best: str
) -> str | None:
    """Return the simplest classifier that is not shown to be worse than the best one.

    The 95 % interval of the difference of their balanced accuracies contains zero; it follows from
    the same draws of groups.

    Parameters
    ----------
    compared : sequence of Classifier
        The classifiers, the simplest first.
    scores : mapping of str to Scores
        Their scores, groups kept apart.
    best : str
        Name of the best one.

    Returns
    -------
    str or None
        Its name; None if there is none that is better than guessing.
    """
    best_accuracy = scores[best].balanced_accuracy
    for classifier in compared:
        if classifier.name == best:
            return None
        if classifier.name not in scores or classifier.kind not in (BASELINE, CLASSIFIER):
            continue
        accuracy = scores[classifier.name].balanced_accuracy
        # the draws of one that guesses are all alike
        is_informed = accuracy.low < accuracy.value
        difference = best_accuracy.draws - accuracy.draws
        if is_informed and np.nanquantile(difference, 0.025) <= 0.0:
            return classifier.name
    return None


def _rounded_up(groups: float) -> int:
    """Return a number rounded up: of two digits to one that ends in 5 or 0, else to two digits."""
    digits = int(log10(max(groups, 1.0)))
    step = 5 if digits < 2 else int(10 ** (digits - 1))
    return step * ceil(groups / step)
