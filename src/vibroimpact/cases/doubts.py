"""Doubts about a drop.

They are values that look like a slip of a unit, and limits of the theory that are exceeded.
"""

from __future__ import annotations

from collections.abc import Container

from vibroimpact.cases.limits.conditions import Conditions, DropSummary
from vibroimpact.cases.limits.limit import limits, numbers_of
from vibroimpact.cases.wrong_units.detect import slips
from vibroimpact.resolved_case import ResolvedCase


def doubts(case: ResolvedCase, summary: DropSummary, aside: Container[str] = ()) -> list[str]:
    """Return a sentence for each doubt about a drop.

    There are slips of units and limits exceeded, each with its cause and a remedy.

    Parameters
    ----------
    case : ResolvedCase
        A resolved case; empty for a problem made in Python, for which only limits that do not need
        the case are checked.
    summary : DropSummary
        Computed or expected peak values of the drop.
    aside : container of str
        Dotted keys whose slips are reported elsewhere.

    Examples
    --------
    >>> doubts({}, DropSummary())
    []
    """
    drop = Conditions(case, summary)
    sentences = list(slips(case, aside)) if case else []
    for name, number in numbers_of(drop).items():
        limit = limits()[name]
        if float(number) > limit.threshold:
            sentences.append(limit.sentence(drop, float(number)))
    return sentences
