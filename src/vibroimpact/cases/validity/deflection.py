r"""Deflection of the plate: linear bending neglects the membrane stretching of large
deflections.
"""

from __future__ import annotations

import math

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Limit, percent_more

_STIFFENING = {True: (0.200, 0.443), False: (0.272, 1.430)}
"""Coefficients A of clamped plates (True) and others (False): for edges that are free to move in
the plane, and immovable edges.

Timoshenko and Woinowsky-Krieger 1959, Theory of Plates and Shells, section 100, eq. (232) and Table
82 (after Volmir), circular plates under a force at the centre: w/h + A (w/h)^3 is proportional to
the force.
"""


def _number(drops: Conditions) -> Array:
    if drops.size is not None and drops.model("plate") == "elastic":
        return drops.summary.deflection / drops.size[2]
    return math.nan


def stiffening(ratio: float, *, clamped: bool) -> tuple[float, float]:
    """Return the relative increase of the stiffness of a plate by its deflection, for edges free in
    the plane and immovable edges.

    Parameters
    ----------
    ratio : float
        Deflection over thickness.
    clamped : bool
        Whether the edges are clamped; otherwise they are free to rotate.
    """
    sliding, held = _STIFFENING[clamped]
    return sliding * ratio**2, held * ratio**2


def _sentence(drop: Conditions, ratio: float) -> str:
    sliding, held = stiffening(ratio, clamped=drop.case["plate"].get("supports") == "clamped")
    return (
        f"the plate deflects by {ratio:.2g} of its thickness: it also stretches, which is "
        "not computed, and is stiffer by about "
        f"{percent_more(sliding).removeprefix('+')} if its edges may slide in its plane, "
        f"{percent_more(held).removeprefix('+')} if they "
        "are held; take a lower speed, a thicker plate, or a program for large deflections"
    )


LIMITS = (
    Limit(
        name="plate_deflection",
        title="plate deflection over thickness",
        meaning="largest deflection of the plate at the contact point over its thickness",
        threshold=0.2,
        number=_number,
        sentence=_sentence,
        shown=lambda ratio: f"{ratio:.2g} thicknesses",
    ),
)
