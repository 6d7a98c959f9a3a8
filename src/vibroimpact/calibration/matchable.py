"""The quantities of an impact that can be matched."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from vibroimpact.errors import InputError, did_you_mean


class MatchableQuantity(NamedTuple):
    """A quantity of an impact: its column in the impact table, SI unit, and name in words."""

    column: str
    unit: str
    phrase: str


MATCHABLE = {
    "separation_speed": MatchableQuantity("separation_speed_m_s", "m/s", "separation speed"),
    "max_force": MatchableQuantity("max_force_N", "N", "largest force"),
    "max_indentation": MatchableQuantity("max_indentation_m", "m", "largest indentation"),
    "duration": MatchableQuantity("duration_s", "s", "contact duration"),
    "rebound_height": MatchableQuantity("rebound_height_m", "m", "rebound height"),
}
"""The quantities that can be matched, by name."""

REBOUNDS = ("separation_speed", "rebound_height")
"""Two measures of the rebound; they differ slightly under a law that releases before the overlap has vanished."""

REBOUND: Mapping[str, float] = {"separation_speed": 1.0}
"""The default weights."""


def check_weights(weights: Mapping[str, float]) -> None:
    """Check names and weights of the quantities to be matched.

    Raises
    ------
    InputError
        If a name is unknown, a weight is not positive, both rebounds are given, or none at all.
    """
    for name, weight in weights.items():
        if name not in MATCHABLE:
            raise InputError(f'"{name}" can\'t be matched; there are {", ".join(MATCHABLE)}.{did_you_mean(name, MATCHABLE)}', "match")
        if not 0.0 < weight < math.inf:
            raise InputError(f"{weight:g} is not allowed as a weight; it must be greater than 0", f"match.{name}")
    if set(REBOUNDS) <= set(weights):
        raise InputError(f"{' and '.join(REBOUNDS)} say the same; give one of them", "match")
    if not weights:
        raise InputError(f"name at least one of {', '.join(MATCHABLE)}", "match")
