"""Hertz's stiffness, which is that of an exponent of 1.5, in a law with another exponent."""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Limit

_SAME = 1e-9
"""Relative difference up to which a stiffness is that of the materials, not one that was given."""


def _number(drops: Conditions) -> Array:
    contact = drops.case["contact"]
    if "exponent" not in contact or "stiffness" not in contact:
        return math.nan
    is_hertz = np.abs(drops.hertz_ratio - 1.0) < _SAME
    return np.where(is_hertz, np.abs(drops.law_parameter("exponent") - 1.5), math.nan)[()]


def _sentence(drop: Conditions, number: float) -> str:
    exponent = float(drop.law_parameter("exponent"))
    return (
        "the stiffness that follows from the materials is Hertz's, for an exponent of "
        f"1.5; with the exponent {exponent:g} its number is "
        f"taken in N/m^{exponent:g}, which no theory gives: give contact.stiffness, or "
        "leave out contact.exponent"
    )


LIMITS = (
    Limit(
        name="stiffness_of_exponent",
        title="stiffness of another exponent",
        meaning="distance of the exponent from 1.5, where the stiffness is Hertz's",
        threshold=1e-9,
        number=_number,
        sentence=_sentence,
        shown=lambda number: f"{number:.3g}",
    ),
)
