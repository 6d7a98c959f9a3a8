"""Sensitivity: limited predictability of repeated impacts on a vibrating plate."""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import LATER_IMPACTS, Limit, two_digits
from vibroimpact.dynamics.change_by_impact import RELATIVE_CHANGE

_PREDICTED = 1e-3  # largest relative change of an impact that is not doubted
_LOST = 0.3  # relative change above which it is not told how large it is


def _number(drops: Conditions) -> Array:
    changes = np.asarray(drops.summary.changes, dtype=float)
    if not changes.any():
        return math.nan
    return float(np.nan_to_num(changes, nan=np.inf).max())


def _sentence(drop: Conditions, _: float) -> str:
    changes = np.asarray(drop.summary.changes, dtype=float)
    first = np.flatnonzero(~(changes <= _PREDICTED))[0]
    lost = np.flatnonzero(~(changes <= _LOST))
    growth = []
    if not lost.size or lost[0] != first:
        growth.append(f"to {100.0 * changes[first]:.2g} % of impact {first + 1}")
    if lost.size:
        growth.append(f"to {100.0 * _LOST:g} % or more of impact {lost[0] + 1}")
    remedy = "judge"
    if undamped := _undamped(drop):
        remedy = f"give {undamped} damping, or judge"
    perturbation = RELATIVE_CHANGE
    if drop.case:
        perturbation = max(RELATIVE_CHANGE, drop.case["run"]["tolerance"])
    return (
        f"the drop is sensitive from impact {first + 1} on: a relative change of "
        f"{perturbation:g} in it grows {' and '.join(growth)}, "
        f"so that these impacts are not predictable; {remedy} them by their distribution "
        f"in a study over {_start(drop)}"
    )


def _start(drop: Conditions) -> str:
    """Return the key by which the case gives how the drop begins."""
    if not drop.case:
        return "drop.height"
    table = drop.case["drop"]
    for key in ("height", "speed"):
        if table.get(key) is not None:
            return f"drop.{key}"
    return "drop.velocity.z"


def _shown(change: float) -> str:
    percentage = "100 % or more"
    if change < 0.995:
        percentage = f"{two_digits(100.0 * change)} %"
    return (
        f"an impact that changes by {percentage} for a relative change of the drop by "
        f"{RELATIVE_CHANGE:g}, or by the tolerance if that is larger"
    )


def _undamped(drop: Conditions) -> str:
    """Return the undamped elastic bodies in words; "" if all are damped."""
    if not drop.case:  # the bodies are not known
        return "what vibrates its"
    bodies = [
        f"the {body}"
        for body in ("plate", "sphere")
        if drop.model(body) == "elastic" and not drop.case[body].get("damping")
    ]
    if not bodies:
        return ""
    pronoun = "its" if len(bodies) == 1 else "their"
    return f"{' and '.join(bodies)} {pronoun}"


LIMITS = (
    Limit(
        name="sensitivity",
        title="sensitive drop",
        meaning=f"relative change of an impact for one of {RELATIVE_CHANGE:g}, or of the tolerance "
        "if that is larger, in the drop",
        threshold=_PREDICTED,
        number=_number,
        sentence=_sentence,
        effects=lambda _, change: {LATER_IMPACTS: change},
        shown=_shown,
        without_case=True,
    ),
)
