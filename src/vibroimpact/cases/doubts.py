"""What to doubt of a drop: where its assumptions are strained, said by numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from vibroimpact.cases.conditions import Conditions, Seen
from vibroimpact.cases.limit import limits, numbers_of


def doubts(case: Mapping[str, Any], seen: Seen) -> list[str]:
    """Return what to doubt of a drop of a case: the limits that it is beyond, each with a number, its cause and a remedy.

    Parameters
    ----------
    case : mapping
        A resolved case; empty of a problem made in Python, of which less can be told.
    seen : Seen
        What came of the drop, or is expected of it.

    Examples
    --------
    >>> doubts({}, Seen())
    []
    """
    drop = Conditions(case, seen)
    found = {name: float(number) for name, number in numbers_of(drop).items()}
    return [limits()[name].sentence(drop, number) for name, number in found.items() if number > limits()[name].threshold]
