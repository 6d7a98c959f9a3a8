"""Impacts in a liquid that are too slow for a rebound."""

from __future__ import annotations

import math

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import REBOUND, RESTITUTION, Limit
from vibroimpact.dynamics.fluids.liquid import CRITICAL_STOKES, Liquid, restitution_kept


def _number(drops: Conditions) -> Array:
    liquid = drops.case["contact"].get("liquid")
    if liquid is None:
        return math.nan
    return CRITICAL_STOKES / Liquid(**liquid).stokes_number(
        drops.summary.speed, drops.radius, drops.density
    )


def _sentence(drop: Conditions, number: float) -> str:
    stokes = CRITICAL_STOKES / number
    return (
        f"the first impact has a Stokes number of {stokes:.3g}: the correlation leaves "
        f"{float(restitution_kept(stokes)):.2g} of the "
        f"restitution, and below about {CRITICAL_STOKES:g} spheres were seen to stay on "
        "the wall; read it as no rebound"
    )


LIMITS = (
    Limit(
        name="no_rebound",
        title="no rebound in the liquid",
        meaning="critical Stokes number over that of the first impact",
        threshold=1.0,
        number=_number,
        sentence=_sentence,
        effects=lambda *_: {RESTITUTION: 1.0, REBOUND: 1.0},  # it stays on the plate
        shown=lambda number: f"{number:.3g}",
    ),
)
