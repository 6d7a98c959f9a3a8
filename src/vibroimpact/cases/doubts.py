"""Warnings about a drop, and the relative errors of its results.

Warnings are of values that look like a slip of a unit, and of limits of the theory that are
exceeded. A limit that is not exceeded changes the results too, by less.
"""

from __future__ import annotations

import math
from collections.abc import Container, Mapping, Sequence

from vibroimpact.cases.limits.conditions import Conditions, DropSummary
from vibroimpact.cases.limits.limit import Limit, limits, numbers_of
from vibroimpact.cases.wrong_units.detect import slips
from vibroimpact.report.result_warning import ResultWarning, ranked
from vibroimpact.resolved_case import ResolvedCase


def doubts(case: ResolvedCase, summary: DropSummary, aside: Container[str] = ()) -> list[str]:
    """Return a sentence for each warning about a drop, those first that change most.

    There are slips of units and limits exceeded, each with its cause and a remedy. Of limits that
    are about the same thing there is the worst.

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
    warnings: list[str] = []
    if case:
        warnings += [ResultWarning(slip, math.inf) for slip in slips(case, aside)]
    grouped: dict[str, list[ResultWarning]] = {}
    for name, number in numbers_of(drop).items():
        limit = limits()[name]
        if float(number) > limit.threshold:
            warning = _warning(limit, drop, float(number))
            grouped.setdefault(limit.group or name, []).append(warning)
    warnings += map(_worst, grouped.values())
    return ranked(warnings)


def _worst(group: Sequence[ResultWarning]) -> ResultWarning:
    """Return the warning of a group that changes most; one whose effect is known is ahead."""
    return max(group, key=lambda warning: (not math.isnan(warning.effect), warning.effect))


def _warning(limit: Limit, drop: Conditions, number: float) -> ResultWarning:
    """Return the warning of a limit that is exceeded."""
    effect = max(limit.effects(drop, number).values(), default=math.nan)
    return ResultWarning(limit.sentence(drop, number), effect)


def errors_of(case: ResolvedCase, summary: DropSummary) -> Mapping[str, float]:
    """Return the estimated relative errors of results of the first impact, by their names.

    They are the sums of what the limits of the theory change, also of those that are not exceeded;
    of limits that are about the same thing the largest counts. What is not estimated is not in
    them.

    Parameters
    ----------
    case, summary
        As those of `doubts`.

    Examples
    --------
    >>> errors_of({}, DropSummary(modes={"plate": (0.03, 1e5)}, duration=1e-4))
    {'largest force': 0.03, 'contact time': 0.03}
    """
    drop = Conditions(case, summary)
    by_group: dict[str, dict[str, float]] = {}
    for name, number in numbers_of(drop).items():
        limit = limits()[name]
        largest = by_group.setdefault(limit.group or name, {})
        for result, change in limit.effects(drop, float(number)).items():
            largest[result] = max(largest.get(result, 0.0), abs(change))
    errors: dict[str, float] = {}
    for changes in by_group.values():
        for result, change in changes.items():
            errors[result] = errors.get(result, 0.0) + change
    return errors
