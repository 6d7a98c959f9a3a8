"""What to doubt of a drop: numbers that look like a slip of a unit, and where its assumptions are strained."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Any

from vibroimpact.cases.conditions import Conditions, DropSummary
from vibroimpact.cases.limit import limits, numbers_of
from vibroimpact.cases.slips.find import slips


def doubts(case: Mapping[str, Any], summary: DropSummary, aside: Container[str] = ()) -> list[str]:
    """Return what to doubt of a drop of a case: slips of units, and limits that it is beyond, each with a cause and a remedy.

    Parameters
    ----------
    case : mapping
        A resolved case; empty of a problem made in Python, of which less can be told.
    summary : DropSummary
        What came of the drop, or is expected of it.
    aside : container of str
        Dotted keys whose slips are told elsewhere.

    Examples
    --------
    >>> doubts({}, DropSummary())
    []
    """
    drop = Conditions(case, summary)
    found = {name: float(number) for name, number in numbers_of(drop).items()}
    beyond = [limits()[name].sentence(drop, number) for name, number in found.items() if number > limits()[name].threshold]
    return [*(slips(case, aside) if case else ()), *beyond]
