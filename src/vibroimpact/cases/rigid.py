"""Contact pair, laws and stop rule of a case, and its problem with rigid bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.bodies.body import Body
from vibroimpact.bodies.rigid import rigid_plate, rigid_sphere
from vibroimpact.cases.fields.section import derived
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.pair import ContactPair, effective_modulus
from vibroimpact.contact.registry import find_contact_law
from vibroimpact.dynamics.problem import Problem
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.cases.schema import CaseTable

_DEFAULT_IMPACTS = 5

PLATE_FALLS = (
    "the supports let the plate fall or tilt: under gravity it falls away from under the sphere; hold it vertically, leave it rigid, or "
    "hit it in free space, with drop.gravity = 0 and drop.speed"
)
"""Message for a plate that its supports do not hold, raised before its modes are computed (`"free"`) or after."""


@derived
def contact_pair(case: CaseTable) -> ContactPair:
    """Return the contact pair of a case: effective modulus, radius and mass, and the yield strength of the weaker body."""
    modulus, below = effective_modulus(case.sphere.material, case.plate.material), case.plate.radius
    mass, radius = rigid_sphere(case.sphere.radius, case.sphere.material).mass, case.sphere.radius
    if below is not None:
        radius = radius * below / (radius + below)
    if is_free_sphere(case):
        mass_below = rigid_sphere(below, case.plate.material).mass
        mass = mass * mass_below / (mass + mass_below)
    strength: Array | None = None
    ratio: Array = case.sphere.material.poissons_ratio
    for material in (case.sphere.material, case.plate.material):
        if material.yield_strength is None:
            continue
        weaker = np.less(material.yield_strength, np.inf if strength is None else strength)
        strength = np.where(weaker, material.yield_strength, np.inf if strength is None else strength)[()]
        ratio = np.where(weaker, material.poissons_ratio, ratio)[()]
    return ContactPair(modulus, radius, mass, strength, ratio)


def mass_of_sphere(case: CaseTable) -> float:
    """Return the mass of the falling sphere [kg]."""
    return float(rigid_sphere(case.sphere.radius, case.sphere.material).mass)


def is_free_sphere(case: CaseTable) -> bool:
    """Return whether a free sphere replaces the plate."""
    return case.plate.radius is not None and case.plate.supports == "free"


@derived
def contact_laws_of(case: CaseTable) -> tuple[ContactLaw, ...]:
    """Return the contact law of each impact, as many as the longest list of a parameter has values; the last holds for later impacts."""
    law, pair = find_contact_law(case.contact.law), contact_pair(case)
    lists = {key: value for key, value in case.contact.parameters.items() if isinstance(value, tuple)}
    number = max((len(value) for value in lists.values()), default=1)
    try:
        return tuple(
            law.for_pair(pair, **{**case.contact.parameters, **{key: value[min(impact, len(value) - 1)] for key, value in lists.items()}})
            for impact in range(number)
        )
    except InputError as error:
        raise InputError(error.message, f"contact.{error.key}".rstrip(".")) from None


def impact_limit(case: CaseTable) -> int | None:
    """Return the number of impacts after which a run stops; None if it continues to rest or to its duration."""
    if case.run.impacts is None:
        return _DEFAULT_IMPACTS if case.run.duration is None else None
    return None if case.run.impacts == "all" else case.run.impacts


def elastic_names(case: CaseTable) -> list[Literal["sphere", "plate"]]:
    """Return the names of the elastic bodies of a case."""
    names: tuple[Literal["sphere", "plate"], ...] = ("sphere", "plate")
    return [name for name in names if getattr(case, name).model == "elastic"]


def deforms(case: CaseTable) -> bool:
    """Return whether anything but the contact itself deforms, or the body below is free to move."""
    local = case.contact.local
    return bool(elastic_names(case)) or local.local_compliance == "identified" or local.finite_sphere or is_free_sphere(case)


def rigid_problem(case: CaseTable) -> Problem:
    """Return the problem of a case with rigid bodies; the numbers of the case may be arrays, one value per drop."""
    return Problem(
        sphere=rigid_sphere(case.sphere.radius, case.sphere.material),
        plate=_rigid_below(case),
        laws=contact_laws_of(case),
        height=case.drop.height,
        speed=case.drop.speed,
        gravity=case.drop.gravity,
        impacts=impact_limit(case),
        duration=case.run.duration,
        rest_speed=case.run.rest_speed,
        same_spot=case.drop.same_spot,
        tolerance=case.run.tolerance,
    )


def _rigid_below(case: CaseTable) -> Body:
    """Return the fixed rigid body below: a plate, or a sphere that replaces it."""
    if case.plate.radius is not None:
        return Body(mass=np.inf, contact_offset=case.plate.radius)
    return rigid_plate(case.plate.size[2] if case.plate.size else 0.0)


def touch_speed(case: CaseTable) -> float:
    """Return the approach speed of the first impact [m/s]."""
    if case.drop.speed is not None:
        return case.drop.speed
    return float((2.0 * case.drop.gravity * ((case.drop.height or 0.0) - case.sphere.radius)) ** 0.5)
