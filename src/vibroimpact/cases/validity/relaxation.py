r"""Relaxation: viscoelastic contact laws are of first order in the dissipation time."""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import FORCE, Limit, two_digits


def _number(drops: Conditions) -> Array:
    return np.divide(drops.law_parameter("dissipation_time"), drops.summary.duration)


def _second_order(ratio: float) -> float:
    """Return the part of the force that the term of second order in the dissipation time has."""
    return 0.5 * (math.pi * ratio) ** 2


def _sentence(drop: Conditions, ratio: float) -> str:
    time = float(drop.law_parameter("dissipation_time"))
    second = two_digits(100.0 * _second_order(ratio))
    return (
        f"the dissipation time, {time:.2g} s, is {two_digits(ratio)} of the contact's "
        f"{drop.summary.duration:.2g} s: "
        f"{drop.law.name} keeps the first order of it, and the second would be about "
        f"{second} % of the force; "
        "take a shorter time, or a law that is fitted to a restitution"
    )


LIMITS = (
    Limit(
        name="relaxation",
        title="viscoelastic time beside the contact",
        meaning="dissipation time of the law over the duration of the first impact, or of a "
        "Hertzian contact as deep if that is shorter",
        threshold=0.1,
        number=_number,
        sentence=_sentence,
        effects=lambda _, ratio: {FORCE: _second_order(ratio)},
        shown=lambda ratio: f"{two_digits(ratio)} of the contact",
    ),
)
