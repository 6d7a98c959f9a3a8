r"""Strength of the bodies: yielding, crushing or cracking under the contact pressure."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import (
    DURATION,
    FORCE,
    REBOUND,
    RESTITUTION,
    VIBRATION,
    Effects,
    Limit,
    two_digits,
)
from vibroimpact.contact.laws.thornton import Thornton
from vibroimpact.materials import RIGID, Material

# Johnson 1985, section 6.1: yield begins below the surface at a peak pressure of 1.6 times the
# yield strength
_YIELD = 1.6
_FULLY_PLASTIC = 2.8
"""Pressure of a contact that flows, over the yield strength."""

_LIKE_ELASTIC = 0.99
"""Part of the elastic force from which a contact that yields is as an elastic one."""

_STRUCTURAL_STEEL, _BALLS = "steel", "bearing-steel"
"""Materials of the library: that which a ball is said to be of, and that which it mostly is of."""

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


def plastic_impact(
    force: float, radius: float, modulus: float, yield_strength: float
) -> tuple[float, float]:
    r"""Return the largest force that plastic flow leaves of an elastic one, as a ratio, and the
    restitution of the contact.

    They are those of `Thornton`'s law with a pressure of 2.8 times the yield strength, for the
    energy that the elastic contact takes up.

    Parameters
    ----------
    force : float
        Largest force of the elastic contact [N].
    radius, modulus : float
        Effective radius [m] and modulus [Pa] of the pair.
    yield_strength : float
        Yield strength of the body that yields [Pa].

    References
    ----------
    Thornton, C. (1997). Coefficient of restitution for collinear collisions of elastic-perfectly
    plastic spheres. J. Appl. Mech. 64, 383-386. Tabor, D. (1951). The Hardness of Metals. Clarendon
    Press, Oxford: the pressure of 2.8 times the yield strength.

    Examples
    --------
    >>> ratio, restitution = plastic_impact(2519.0, 0.01, 57.7e9, 235e6)
    >>> round(ratio, 2), round(restitution, 2)
    (0.56, 0.51)
    """
    law = Thornton(
        effective_modulus=modulus,
        effective_radius=radius,
        yield_pressure=_FULLY_PLASTIC * yield_strength,
    )
    depth = (0.75 * force / (modulus * math.sqrt(radius))) ** (2.0 / 3.0)
    energy = 0.4 * force * depth
    yield_force, slope = law.plastic_coefficients
    plastic_energy = energy - 0.4 * float(yield_force) * float(law.yield_indentation)
    if plastic_energy <= 0.0:
        return 1.0, 1.0
    # beyond the first yield the force grows in proportion to the indentation
    plastic_force = math.sqrt(float(yield_force) ** 2 + 2.0 * float(slope) * plastic_energy)
    # the closed form takes the energy as that of a mass and a speed
    restitution = law.closed_form_restitution(np.array(2.0 * energy), np.array(1.0))
    return plastic_force / force, float(restitution)


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
    name, (stress, strength, verb) = _failure(body, drop)
    times = "just above" if ratio < 1.05 else f"{two_digits(ratio)} times"
    known = f"its {name.replace('_', ' ')} of {_stress(strength)}"
    if name == "tensile_strength":
        comparison = f"the tension at the rim of the contact, {_stress(stress)}, is {times} {known}"
    else:
        begins = "yield" if name == "yield_strength" else "be crushed"
        comparison = (
            f"Hertz's peak pressure of {_stress(pressure)} is {times} that at which it begins to "
            f"{begins}, {_YIELD} times {known}"
        )
    also = _fails_too(body, drop)
    meaning = _meaning(body, drop, name)
    remedy = ""
    if body == "sphere" and material.name == _STRUCTURAL_STEEL:
        remedy = f'; of a ball of a bearing, sphere.material is "{_BALLS}"'
    return f"{_named(body, material)} {verb}{also}: {meaning}; {comparison}{remedy}"


def _fails_too(body: str, drop: Conditions) -> str:
    """Return in words that the other body fails too, if it does."""
    (other,) = (name for name in _BODIES if name != body)
    if not _stress_ratio(other, drop) > 1.0:
        return ""
    return f", and so does {_named(other, drop.materials[other])}"


def _failure(body: str, drop: Conditions) -> tuple[str, tuple[Array, Array, str]]:
    """Return the strength of a body that is exceeded most, with stress, strength and verb."""
    failures = demands(drop.materials[body], float(drop.peak_pressure))
    return max(failures.items(), key=lambda failure: failure[1][0] / failure[1][1])


def _meaning(body: str, drop: Conditions, name: str) -> str:
    """Return what the failure by a strength means for the result, with the remedy."""
    if name != "yield_strength":
        return (
            f"{drop.law.name} leaves this out: take the force for an upper bound, and the "
            "restitution from a measurement"
        )
    ratio, restitution = _plastic_impact_of(body, drop)
    # in a liquid a law needs a restitution
    law = "" if drop.case["contact"].get("liquid") is not None else ', as by contact.law = "meyer"'
    if ratio > _LIKE_ELASTIC:
        return "the plastic flow stays below the surface, and changes little"
    return (
        f"with plastic flow{law}, the largest force would be about "
        f"{two_digits(100.0 * (1.0 - ratio))} % smaller, and the restitution of the contact about "
        f"{restitution:.1g}"
    )


def _plastic_impact_of(body: str, drop: Conditions) -> tuple[float, float]:
    """Return what plastic flow of a body would leave of the force, and the restitution."""
    return plastic_impact(
        float(drop.summary.force),
        float(drop.effective_radius),
        float(drop.modulus),
        float(drop.materials[body].yield_strength or math.inf),
    )


def _effects(body: str, drop: Conditions, ratio: float) -> Effects:
    """Return what yielding would change, where it is known: nothing below the strength."""
    if ratio <= 1.0:
        return {FORCE: 0.0}
    name, _ = _failure(body, drop)
    if name != "yield_strength":
        return {}
    force, restitution = _plastic_impact_of(body, drop)
    lost = 1.0 - restitution
    return {
        FORCE: 1.0 - force,
        DURATION: 1.0 - force,
        RESTITUTION: lost,
        REBOUND: 2.0 * lost,
        VIBRATION: 2.0 * (1.0 - force),  # energy goes with the square of the force
    }


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
    yields = "yields or cracks"
    materials = "its material"
    if len(bodies) > 1:
        yields = "yield or crack"
        materials = "their materials"
    return (
        f"whether {' and '.join(bodies)} {yields} under Hertz's peak pressure of "
        f"{_stress(float(drop.peak_pressure))} is not known; give yield_strength, "
        f"compressive_strength or tensile_strength in {materials}"
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
            effects=partial(_effects, body),
            group="strength",
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
        group="strength",
        shown=lambda ratio: f"peak pressure {ratio:.2g} E*",
    ),
)
