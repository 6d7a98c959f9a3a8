"""Size of the contact: Hertz's theory assumes small strains."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Limit


def _number(drops: Conditions) -> Array:
    by_depth = np.sqrt(drops.summary.depth / drops.effective_radius)
    if "elastic" not in (drops.model("sphere"), drops.model("plate")):
        return by_depth
    # the indentation includes the deflection of elastic bodies near the contact, which takes no
    # contact radius
    return np.fmin(by_depth, drops.contact_radius / drops.effective_radius)


def _sentence(drop: Conditions, part: float) -> str:
    if drop.case["plate"].get("radius") is None:
        whose = "the sphere's"
    else:
        whose = "the effective radius of both spheres"
    return (
        f"the contact radius reaches about {part:.2g} of {whose}, and strains about "
        f"{0.2 * part:.2g}: Hertz's theory, and its "
        "correction for a finite sphere, hold for small ones; take a lower speed or a "
        "stiffer material, or measure the force"
    )


LIMITS = (
    Limit(
        name="small_contact",
        title="large contact",
        meaning="contact radius over the radius of the sphere, or over the effective radius of two",
        threshold=0.3,
        number=_number,
        sentence=_sentence,
        shown=lambda part: f"{part:.2g} of the radius",
    ),
)
