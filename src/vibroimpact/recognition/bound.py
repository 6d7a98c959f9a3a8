"""Classifiers beside a bound on their error.

One that is better has seen more than the bound counts, or what it may not, a leak.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.recognition.scores import Score, Scores

SURE = 99.0
"""Confidence with which an error must lie below the bound [%]."""


def below_bound(error: Score, bayes_error: float) -> bool:
    """Return whether an error rate lies below the Bayes error by more than chance.

    Parameters
    ----------
    error : Score
        Error rate with its interval, which counts groups.
    bayes_error : float
        The bound: the lowest error of a classifier that sees only what the bound counts.

    Examples
    --------
    >>> none = Score(0.0, np.zeros(1000), np.zeros(5), 100.0)
    >>> below_bound(none, 0.2), below_bound(none, 0.02)
    (True, False)
    """
    return error.end(SURE / 100.0) < bayes_error


def bound_doubts(
    scores: Mapping[str, Scores],
    bayes_error: float | None,
    probe: str,
    best: str,
    sees: str | None = None,
) -> list[str]:
    """Return a sentence for each possible leak.

    It is what is better than the bound, or a probe that is better than all features.

    Parameters
    ----------
    scores : mapping of str to Scores
        Scores under the grouped split.
    bayes_error : float, optional
        The bound, where it is known.
    probe : str
        Name of the classifier of what should tell little.
    best : str
        Name of the best classifier of all features.
    sees : str, optional
        The quantities for which the bound was computed; None if the data set states the bound.
    """
    sentences = []
    if bayes_error is not None:
        if sees is None:
            bound = "that the data set states"
            explanation = (
                "if the bound counts all that an impact tells, it has used information that "
                "does not come from the impact, or this is chance"
            )
        else:
            bound = f"of classifiers that see only {sees}"
            explanation = (
                "it has used something else, such as the position of the impact or the "
                "shape of the pulse, or information that does not "
                "come from the impact, or this is chance"
            )
        for name, score in scores.items():
            if below_bound(score.error, bayes_error):
                sentences.append(
                    f"possible leak: {name} errs in {score.error.value:.1%}, below the Bayes error "
                    f"of {bayes_error:.1%} {bound}; {explanation}"
                )
    probe_accuracy = scores[probe].balanced_accuracy
    best_accuracy = scores[best].balanced_accuracy
    # the draws are of the same groups, so that their differences are those of the scores
    difference = probe_accuracy.draws - best_accuracy.draws
    if np.nanpercentile(difference, 100.0 - SURE) > 0.0:
        sentences.append(
            f"leak: {probe} alone classify better (balanced accuracy "
            f"{probe_accuracy.value:.3f}) than all "
            f"features ({best_accuracy.value:.3f}); check how the signals were cut"
        )
    return sentences
