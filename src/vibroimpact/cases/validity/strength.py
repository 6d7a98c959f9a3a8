r"""Strength of the bodies: yielding, crushing or cracking under the contact pressure."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Limit, two_digits
from vibroimpact.materials import RIGID, Material

# Johnson 1985, section 6.1: yield begins below the surface at a peak pressure of 1.6 times the
# yield strength
_YIELD = 1.6
_BODIES = ("sphere", "plate")


def demands(material: Material, peak_pressure: Array) -> dict[str, tuple[Array, Array, str]]:
    r"""Return the stress in a body under a Hertz contact for each known strength, by its name.

    With it are the strength, and the verb of its failure.

    The largest shear stress below the surface equals that of a uniaxial test at :math:`p_0 / 1.6`;
    the tension at the rim of the contact is :math:`(1 - 2 \nu) p_0 / 3`.

    Parameters
    ----------
    material : Material
        Material of the body.
    peak_pressure : float or array
        Hertz's peak pressure p0 [Pa].

    References
    ----------
    Johnson, K. L. (1985). Contact Mechanics. Cambridge University Press, section 3.4 (rim) and eq.
    (6.9).
    """
    uniaxial_stress = peak_pressure / _YIELD
    rim_tension = (1.0 - 2.0 * material.poissons_ratio) / 3.0 * peak_pressure
    failures = {
        "yield_strength": (uniaxial_stress, material.yield_strength, "yields"),
        "compressive_strength": (uniaxial_stress, material.compressive_strength, "is crushed"),
        "tensile_strength": (rim_tension, material.tensile_strength, "cracks"),
    }
    return {
        name: (stress, strength, verb)
        for name, (stress, strength, verb) in failures.items()
        if strength is not None
    }


def _stress_ratio(body: str, drops: Conditions) -> Array:
    """Return the largest ratio of stress to strength of a body.

    NaN if no strength is known or the law models yielding.
    """
    if drops.yields:
        return math.nan
    failures = demands(drops.materials[body], drops.peak_pressure)
    if not failures:
        return math.nan
    ratios = [stress / strength for stress, strength, _ in failures.values()]
    return np.maximum.reduce(np.broadcast_arrays(*ratios))


def _strength_sentence(body: str, drop: Conditions, ratio: float) -> str:
    material = drop.materials[body]
    pressure = float(drop.peak_pressure)
    name, (stress, strength, verb) = max(
        demands(material, pressure).items(), key=lambda failure: failure[1][0] / failure[1][1]
    )
    known = f"its {name.replace('_', ' ')} of {_stress(strength)}"
    if name == "tensile_strength":
        comparison = (
            f": the tension at the rim of the contact is {_stress(stress)}, {two_digits(ratio)} "
            f"times {known}"
        )
    else:
        begins = "yield" if name == "yield_strength" else "be crushed"
        times = "just above" if ratio < 1.05 else f"{two_digits(ratio)} times"
        comparison = f", {times} that at which it begins to {begins} ({_YIELD} times {known})"
    remedy = "take the force for an upper bound, and the restitution from a measurement"
    # in a liquid a law needs a restitution
    if name == "yield_strength" and drop.case["contact"].get("liquid") is None:
        remedy = "take a law that yields, such as meyer"
    return (
        f"{_named(body, material)} {verb} under Hertz's peak pressure of "
        f"{_stress(pressure)}{comparison}; {drop.law.name} leaves this out: {remedy}"
    )


def _stress(value: float) -> str:
    """Return a stress in MPa or GPa."""
    if value >= 0.9995e9:
        return f"{value / 1e9:.3g} GPa"
    return f"{value / 1e6:.3g} MPa"


def _named(body: str, material: Material) -> str:
    return f"the {body} ({material.name})" if material.name else f"the {body}"


def _bodies_without_strength(drops: Conditions) -> list[str]:
    """Return the names of the bodies that deform and have no known strength."""
    return [
        body
        for body in _BODIES
        if drops.materials[body] is not RIGID and not demands(drops.materials[body], 1.0)
    ]


def _pressure_ratio(drops: Conditions) -> Array:
    """Return the peak pressure over the effective modulus; NaN if a strength of each body
    is known or the law models yielding.
    """
    if _bodies_without_strength(drops) and not drops.yields:
        return drops.peak_pressure / drops.modulus
    return math.nan


def _unknown_sentence(drop: Conditions, _: float) -> str:
    bodies = [_named(body, drop.materials[body]) for body in _bodies_without_strength(drop)]
    return (
        f"whether {' and '.join(bodies)} "
        f"{'yield or crack' if len(bodies) > 1 else 'yields or cracks'} "
        "under Hertz's peak pressure of "
        f"{_stress(float(drop.peak_pressure))} is not known: no strength is given; give "
        "yield_strength, compressive_strength or "
        f"tensile_strength in {'their materials' if len(bodies) > 1 else 'its material'}"
    )


LIMITS = (
    *(
        Limit(
            name=f"{body}_strength",
            title=f"strength of the {body}",
            meaning=f"largest stress in the {body} over its strength, under Hertz's pressure",
            threshold=1.0,
            number=partial(_stress_ratio, body),
            sentence=partial(_strength_sentence, body),
            shown=lambda ratio: f"{ratio:.3g} times the strength",
        )
        for body in _BODIES
    ),
    Limit(
        name="strength_not_known",
        title="strength not known",
        meaning="Hertz's peak pressure over the effective modulus, where no strength of a body is "
        "known",
        threshold=0.0,
        number=_pressure_ratio,
        sentence=_unknown_sentence,
        shown=lambda ratio: f"a peak pressure of {ratio:.2g} of the effective modulus",
    ),
)
