"""The quantities of an impact that can be matched."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from vibroimpact.errors import InputError, choices
from vibroimpact.quoting import quoted


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

ALONG_PLATE = {
    "tangential_restitution": MatchableQuantity(
        "tangential_restitution", "", "tangential restitution"
    ),
    "separation_velocity_x": MatchableQuantity(
        "separation_velocity_x_m_s", "m/s", "velocity along the plate after the impact"
    ),
    "rebound_angle": MatchableQuantity("rebound_angle_deg", "deg", "rebound angle"),
    "spin_y_after": MatchableQuantity(
        "spin_y_after_rad_s", "rad/s", "angular velocity after the impact"
    ),
}
"""Those of an oblique impact that friction determines."""

DIRECTIONS = tuple(ALONG_PLATE)[:3]
"""Three measures of the motion of the centre along the plate after an impact."""

REBOUNDS = ("separation_speed", "rebound_height")
"""Two measures of the rebound; they differ slightly under a law that releases before the
overlap has vanished.
"""

REBOUND: Mapping[str, float] = {"separation_speed": 1.0}
"""The default weights."""


def check_weights(weights: Mapping[str, float]) -> None:
    """Check names and weights of the quantities to be matched.

    Raises
    ------
    InputError
        If a name is unknown, a weight is not positive, several say the same, or there is none at
        all.
    """
    known = {**MATCHABLE, **ALONG_PLATE}
    for name, weight in weights.items():
        if name not in known:
            raise InputError(
                f"{quoted(name)} can't be matched; there are {choices(known, name)}", "match"
            )
        if not 0.0 < weight < math.inf:
            raise InputError(
                f"{weight:g} is not allowed as a weight; it must be greater than 0 and finite",
                f"match.{name}",
            )
    for equivalent in (REBOUNDS, DIRECTIONS):
        names = [name for name in equivalent if name in weights]
        if len(names) > 1:
            raise InputError(f"{' and '.join(names)} are equivalent; give one of them", "match")
    if not weights:
        raise InputError(f"name at least one of {', '.join(known)}", "match")
