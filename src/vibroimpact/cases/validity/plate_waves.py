r"""Waves through the thickness of the plate, which plate theory neglects."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Limit, of_force_and_duration, percent_less
from vibroimpact.dynamics.truncation import time_of_contact

PLATE_THEORY_INERTIA = "plate_theory_inertia_m_s2_N"
"""The fact of the elastic bodies with the inertia that plate theory neglects."""


def plate_theory_error(facts: Mapping[str, Any], impacts: Mapping[str, Any]) -> float:
    r"""Return the estimated share by which the first largest force is too large.

    It is so as plate elements have no thickness waves.

    A short force also excites waves through the thickness of a plate. To first order these reduce
    the displacement of the face by :math:`c \ddot F`, of which the inertia c is among the facts.
    The error of the largest force is that displacement over the tangent compliance of the contact,
    two thirds of indentation over force. A Hertzian force is about :math:`\sin^{3/2}(\pi t / T)`.

    Parameters
    ----------
    facts : mapping
        Facts of the elastic bodies; `plate_theory_inertia_m_s2_N` is c.
    impacts : mapping of str to array
        The impact table.

    Returns
    -------
    float
        Relative error; NaN without plate elements or without an impact.

    Examples
    --------
    >>> plate_theory_error({}, {"impact": [1]})
    nan
    """
    inertia = facts.get(PLATE_THEORY_INERTIA)
    if inertia is None or not len(impacts["impact"]):
        return math.nan
    force = float(impacts["max_force_N"][0])
    depth = float(impacts["max_indentation_m"][0])
    duration = time_of_contact(impacts)
    # at the peak the second derivative of the force is -3/2 (pi/T)^2 times it
    return float(inertia) * 1.5 * (math.pi / duration) ** 2 * force / (2.0 / 3.0 * depth)


def _sentence(drop: Conditions, error: float) -> str:
    duration = float(drop.summary.duration)
    return (
        f"the contact lasts {duration:.3g} s, and waves through the thickness of the "
        "plate, which plate elements do not "
        f"have, change the largest force by about {percent_less(error)}; take "
        'plate.element = "solid"'
    )


LIMITS = (
    Limit(
        name="plate_waves",
        title="waves through the thickness of the plate",
        meaning="part by which the first largest force is too large, as plate elements only bend",
        threshold=0.005,
        number=lambda drops: drops.summary.plate_theory,
        sentence=_sentence,
        effects=lambda _, error: of_force_and_duration(error),
        shown=percent_less,
        without_case=True,
    ),
)
