"""What few groups can't tell, and how many could.

It is said in sentences where figures would have false digits.
"""

from __future__ import annotations

from math import ceil, log, log10

import numpy as np

from vibroimpact.recognition.bound import SURE
from vibroimpact.recognition.scores import Score, widening_by_few, widening_by_training

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


def _rounded_up(groups: float) -> int:
    """Return a number rounded up: of two digits to one that ends in 5 or 0, else to two digits."""
    digits = int(log10(max(groups, 1.0)))
    step = 5 if digits < 2 else int(10 ** (digits - 1))
    return step * ceil(groups / step)
