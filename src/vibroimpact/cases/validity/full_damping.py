"""Full-damping penetration of the Adams impact law, which the indentation may never reach."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Limit


def _number(drops: Conditions) -> Array:
    return np.divide(drops.law_parameter("full_damping_penetration"), drops.summary.depth)


def _sentence(drop: Conditions, ratio: float) -> str:
    fade = float(drop.law_parameter("full_damping_penetration"))
    return (
        f"the largest indentation, {drop.summary.depth:.3g} m, stays below the "
        f"full-damping penetration, {fade:.3g} m: the damping never "
        "acts in full, and less energy is lost; take a full_damping_penetration of "
        f"{0.1 * drop.summary.depth:.1g} m or so, or calibrate"
    )


LIMITS = (
    Limit(
        name="full_damping",
        title="damping never in full",
        meaning="full-damping penetration over the largest indentation",
        threshold=1.0,
        number=_number,
        sentence=_sentence,
        shown=lambda ratio: f"a penetration of {ratio:.3g} times the indentation",
    ),
)
