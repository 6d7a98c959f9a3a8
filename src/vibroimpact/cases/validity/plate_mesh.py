r"""Elements of the plate that are too large for the field of the contact force."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Limit, of_force_and_duration, percent_more, two_digits

PLATE_MESH_COMPLIANCE = "plate_mesh_compliance_m_N"
"""The fact with the compliance that the elements of the plate lack at the contact point."""

_ALLOWED = 0.005  # relative error of the largest force
_SPARE = 2.0  # the error differs by so much with the place in an element


def plate_mesh_error(facts: Mapping[str, Any], impacts: Mapping[str, Any]) -> float:
    r"""Return the estimated share by which the first largest force is too large.

    It is so as the elements of the plate lack compliance.

    A compliance c that is added in series with the contact takes energy from it. While the ball is
    stopped the plate hardly yields but in the quasi-static response C of the modes left out, so
    that, for a given energy, a small c changes the largest force F of Hertz's contact with the
    indentation d by

    .. math:: \frac{\Delta F}{F} = -\frac{c}{2\,(\tfrac23 d / F + C)}

    Parameters
    ----------
    facts : mapping
        Facts of the elastic bodies; `plate_mesh_compliance_m_N` is c, and `series_compliance_m_N`
        is C.
    impacts : mapping of str to array
        The impact table.

    Returns
    -------
    float
        Relative error; NaN without plate elements or without an impact.

    Examples
    --------
    >>> plate_mesh_error({}, {"impact": [1]})
    nan
    """
    lacking = facts.get(PLATE_MESH_COMPLIANCE)
    if lacking is None or not len(impacts["impact"]):
        return math.nan
    force = float(impacts["max_force_N"][0])
    depth = float(impacts["max_indentation_m"][0])
    # the equation, with both sides of its fraction times the force
    series_compliance = float(facts.get("series_compliance_m_N", 0.0))
    return 0.5 * float(lacking) * force / (2.0 / 3.0 * depth + series_compliance * force)


def _sentence(drop: Conditions, error: float) -> str:
    # what elements lack grows a little less than with the square of their size, and faster where
    # they are small
    percentage = percent_more(error).removeprefix("+")
    size = float(drop.case["plate"]["mesh"]["element_size"])
    finer = size * math.sqrt(_ALLOWED / (_SPARE * error))
    return (
        "the elements of the plate are large for its thickness and do not follow its "
        "deflection next to the contact, which makes "
        f"the first largest force about {percentage} too large; give plate.mesh.element_size = "
        f'"{two_digits(1e3 * finer)} mm"'
    )


LIMITS = (
    Limit(
        name="plate_mesh",
        title="elements of the plate too large for the contact",
        meaning="part by which the first largest force is too large, as the elements of the plate "
        "lack compliance at the contact",
        threshold=_ALLOWED,
        number=lambda drops: drops.summary.plate_mesh,
        sentence=_sentence,
        effects=lambda _, error: of_force_and_duration(error),
        shown=percent_more,
    ),
)
