"""Buoyancy in air, which flights with its drag alone neglect, as they do the air that
moves along.
"""

from __future__ import annotations

import math

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Limit, of_slower_impact, percent_less
from vibroimpact.dynamics.fluids.air import Air
from vibroimpact.dynamics.fluids.liquid import Liquid


def _number(drops: Conditions) -> Array:
    table = drops.case["drop"].get("air")
    if table is None:
        return math.nan
    air = Air(**table)
    around = Liquid(density=air.density, viscosity=air.viscosity)
    return 1.0 - around.weight(drops.density) / around.inertia(drops.density)


def _sentence(drop: Conditions, lost: float) -> str:
    air = Air(**drop.case["drop"]["air"])
    remedy = (
        f"give contact.liquid = {{ density = {air.density:g}, viscosity = "
        f"{air.viscosity:g} }} in its place, which has all three, with a "
        "law that takes a restitution"
    )
    if drop.case["plate"].get("radius") is not None:  # a sphere in a liquid falls on a plate
        remedy = "take the speeds of impacts for too high"
    return (
        "buoyancy and the air that moves along would take "
        f"{percent_less(lost).removeprefix('-')} of the acceleration of so light a ball, "
        f"of a mean density of {drop.density:.3g} kg/m^3, and drop.air has drag alone; {remedy}"
    )


LIMITS = (
    Limit(
        name="air_buoyancy",
        title="buoyancy in air",
        meaning="part of the acceleration of a fall in air that buoyancy and the air that moves "
        "along would take",
        threshold=0.01,
        number=_number,
        sentence=_sentence,
        # the square of the speed goes with the acceleration
        effects=lambda _, lost: of_slower_impact(0.5 * lost),
        shown=percent_less,
    ),
)
