"""What of an impact can be matched."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from vibroimpact.errors import InputError, did_you_mean


class MatchableQuantity(NamedTuple):
    """What of an impact can be matched: its column of the impact table, SI unit, and words."""

    column: str
    unit: str
    words: str


MATCHABLE = {
    "separation_speed": MatchableQuantity("separation_speed_m_s", "m/s", "separation speed"),
    "max_force": MatchableQuantity("max_force_N", "N", "largest force"),
    "max_indentation": MatchableQuantity("max_indentation_m", "m", "largest indentation"),
    "duration": MatchableQuantity("duration_s", "s", "contact duration"),
    "rebound_height": MatchableQuantity("rebound_height_m", "m", "rebound height"),
}
"""What can be matched, by name."""

REBOUNDS = ("separation_speed", "rebound_height")
"""Two readings of one thing; they differ a little under a law that lets go before the bodies have stopped overlapping."""

REBOUND: Mapping[str, float] = {"separation_speed": 1.0}
"""What is matched by default."""


def check_weights(weights: Mapping[str, float]) -> None:
    """Raise unless these are outcomes that can be matched, with weights.

    Raises
    ------
    InputError
        If one is not known, or a weight is not positive.
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
