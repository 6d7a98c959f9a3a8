"""Approach speeds beyond those for which a parameter of the contact law is given as a
function of the speed.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Limit

_FAR = 1.05  # times a speed at an end


def _number(drops: Conditions) -> Array:
    if not drops.by_speed:
        return math.nan
    fastest = min(function.fastest for function in drops.by_speed.values())
    slowest = max(function.slowest for function in drops.by_speed.values())
    return np.fmax(
        drops.summary.speed / fastest, slowest / np.fmin(drops.summary.slowest, drops.summary.speed)
    )


def _sentence(drop: Conditions, number: float) -> str:
    slow = float(np.fmin(drop.summary.slowest, drop.summary.speed))
    fast = float(drop.summary.speed)
    name, function = max(
        drop.by_speed.items(), key=lambda item: max(fast / item[1].fastest, item[1].slowest / slow)
    )
    speeds = f"the first impact comes at {fast:.4g} m/s"
    if slow != fast:
        speeds += f", the slowest at {slow:.4g} m/s"
    return (
        f"contact.{name} is given for approach speeds from {function.slowest:.4g} to "
        f"{function.fastest:.4g} m/s, and {speeds}: "
        "beyond the ends the value at the nearest one holds; give it for more speeds"
    )


LIMITS = (
    Limit(
        name="speeds_given",
        title="speeds of a function",
        meaning="approach speed over the highest, or lowest over the approach speed, for which a "
        "parameter of the law is given",
        threshold=_FAR,
        number=_number,
        sentence=_sentence,
        shown=lambda number: f"{number:.3g} times",
    ),
)
