"""Sensitivity: limited predictability of repeated impacts on a vibrating plate."""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.conditions import Conditions
from vibroimpact.cases.limit import Limit, two_digits
from vibroimpact.dynamics.change_by_impact import RELATIVE_CHANGE

_PREDICTED = 1e-3  # largest relative change of an impact that is not doubted
_LOST = 0.3  # relative change above which it is not told how large it is


def _number(drops: Conditions) -> Array:
    changes = np.asarray(drops.summary.changes, dtype=float)
    return float(np.nan_to_num(changes, nan=np.inf).max()) if changes.any() else math.nan


def _sentence(drop: Conditions, _: float) -> str:
    changes = np.asarray(drop.summary.changes, dtype=float)
    first, lost = np.flatnonzero(~(changes <= _PREDICTED))[0], np.flatnonzero(~(changes <= _LOST))
    grown = (
        []
        if lost.size and lost[0] == first
        else [f"to {100.0 * changes[first]:.2g} % of impact {first + 1}"]
    )
    grown += [f"to {100.0 * _LOST:g} % or more of impact {lost[0] + 1}"] if lost.size else []
    undamped = _undamped(drop)
    remedy = f"give {undamped} damping, or judge" if undamped else "judge"
    small = max(RELATIVE_CHANGE, drop.case["run"]["tolerance"]) if drop.case else RELATIVE_CHANGE
    return (
        f"the drop is sensitive from impact {first + 1} on: a relative change of {small:g} "
        f"in it grows {' and '.join(grown)}, "
        f"so that these impacts are not predictable; {remedy} them by their distribution "
        f"in a study over {_start(drop)}"
    )


def _start(drop: Conditions) -> str:
    """Return the key by which the case gives how the drop begins."""
    given = drop.case["drop"] if drop.case else {}
    return next(
        (f"drop.{key}" for key in ("height", "speed") if given.get(key) is not None),
        "drop.velocity.z" if given else "drop.height",
    )


def _shown(change: float) -> str:
    part = f"{two_digits(100.0 * change)} %" if change < 0.995 else "100 % or more"
    return (
        f"an impact that changes by {part} for a relative change of the drop by "
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
    return f"{' and '.join(bodies)} {'its' if len(bodies) == 1 else 'their'}" if bodies else ""


LIMITS = (
    Limit(
        name="sensitivity",
        title="sensitive drop",
        meaning=f"relative change of an impact for one of {RELATIVE_CHANGE:g}, or of the tolerance "
        "if that is larger, in the drop",
        threshold=_PREDICTED,
        number=_number,
        sentence=_sentence,
        shown=_shown,
        without_case=True,
    ),
)
