"""Flights through air and liquids that are too fast for the drag coefficient that is taken."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Limit
from vibroimpact.dynamics.core.fall import HIGHEST_REYNOLDS
from vibroimpact.dynamics.fluids.air import SPEED_OF_SOUND


def _reynolds(drops: Conditions) -> Array:
    medium = _medium(drops)
    if medium is None or "viscosity" not in medium:
        return math.nan
    return medium["density"] * _speed(drops) * 2.0 * drops.radius / medium["viscosity"]


def _speed(drops: Conditions) -> Array:
    """Return the speed at first touch, also along the plate [m/s]."""
    drop = drops.case["drop"]
    normal = drops.summary.speed
    along = 0.0
    if drop.get("velocity") is not None:
        along = np.hypot(drop["velocity"][0], drop["velocity"][1])
    elif drop.get("angle") is not None:
        along = drop["speed"] * np.sin(drop["angle"])
    elif drop.get("height") is not None:  # it falls straight down on a plate that may be inclined
        along = normal * np.tan(drops.case["plate"].get("inclination") or 0.0)
    return np.hypot(normal, along)


def _medium(drops: Conditions) -> Mapping[str, Array] | None:
    """Return the table of the air or the liquid in which the sphere falls, None in a vacuum."""
    medium: Mapping[str, Array] | None = drops.case["drop"].get("air") or drops.case["contact"].get(
        "liquid"
    )
    return medium


def _drag_sentence(drop: Conditions, number: float) -> str:
    if drop.case["drop"].get("air") is not None:
        remedy = "give a measured one as drop.air.drag_coefficient, in place of drop.air.viscosity"
    else:
        remedy = "take the speeds after flights for uncertain"
    return (
        f"the Reynolds number of the flight reaches {HIGHEST_REYNOLDS * number:.2g}: from "
        f"about {HIGHEST_REYNOLDS:g} on the drag "
        "coefficient of a smooth sphere falls to a fraction of the 0.5 that is taken, of "
        f"a rough one earlier; {remedy}"
    )


def _mach(drops: Conditions) -> Array:
    if drops.case["drop"].get("air") is None:
        return math.nan
    return _speed(drops) / SPEED_OF_SOUND


def _sound_sentence(drop: Conditions, number: float) -> str:
    start = ""
    given = drop.case["drop"]
    if given.get("height") is not None:
        key = "drop.speed"
        if given.get("velocity") is not None:
            key = "drop.velocity without drop.height"
        start = f"begin with the speed at first touch, {key}, and "
    return (
        f"the sphere flies at {number:.2g} of the speed of sound in air at 20 C, and the "
        "compression of the air increases the drag, which "
        f"is that of slow flight here; {start}take the rebounds for uncertain"
    )


LIMITS = (
    Limit(
        name="drag_coefficient",
        title="drag at high speed",
        meaning=f"Reynolds number at first touch over {HIGHEST_REYNOLDS:g}, up to which the drag "
        "coefficient holds",
        threshold=1.0,
        number=lambda drops: _reynolds(drops) / HIGHEST_REYNOLDS,
        sentence=_drag_sentence,
        shown=lambda number: f"Re {HIGHEST_REYNOLDS * number:.2g}",
    ),
    Limit(
        name="mach",
        title="compression of air",
        meaning="speed at first touch over the speed of sound in air at 20 C",
        threshold=0.3,
        number=_mach,
        sentence=_sound_sentence,
        shown=lambda number: f"Mach {number:.2g}",
    ),
)
