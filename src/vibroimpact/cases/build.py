"""From a case to the problem it states, and back to a resolved case."""

from __future__ import annotations

from dataclasses import asdict, fields
from typing import TYPE_CHECKING, Any

from vibroimpact.bodies.plate import rigid_plate
from vibroimpact.bodies.sphere import rigid_sphere
from vibroimpact.contact.law import CompliantLaw, ContactLaw, find_contact_law, loses_nothing
from vibroimpact.contact.pair import ContactPair, effective_modulus
from vibroimpact.dynamics.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.materials import RIGID, Material

if TYPE_CHECKING:
    from vibroimpact.cases.schema import Case

_DEFAULT_IMPACTS = 5


def contact_pair(case: Case) -> ContactPair:
    """Return the facts of the touching pair of a case: effective modulus, radius and mass."""
    modulus = effective_modulus(case.sphere.material, case.plate.material)
    mass = rigid_sphere(case.sphere.radius, case.sphere.material).mass
    yielding = [material for material in (case.sphere.material, case.plate.material) if material.yield_strength]
    weaker = min(yielding, key=lambda material: material.yield_strength or 0.0, default=None)
    return ContactPair(
        effective_modulus=modulus,
        effective_radius=case.sphere.radius,
        effective_mass=mass,
        yield_strength=weaker.yield_strength if weaker else None,
        poissons_ratio=(weaker or case.sphere.material).poissons_ratio,
    )


def contact_laws_of(case: Case) -> tuple[ContactLaw, ...]:
    """Return the law of each impact: as many as the longest list of a parameter."""
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


def impacts_of(case: Case) -> int | None:
    """Return after how many impacts a case stops; None if it goes on to rest."""
    if case.run.impacts is None:
        return _DEFAULT_IMPACTS if case.run.duration is None else None
    return None if case.run.impacts == "all" else case.run.impacts


def problem_of(case: Case) -> Problem:
    """Return the problem that a case states.

    Raises
    ------
    InputError
        If the contact law can't be made for these bodies, or the sphere would bounce for ever.
    """
    law = contact_laws_of(case)[-1]
    if impacts_of(case) is None and case.run.duration is None:
        remedy = "give a number or a duration"
        if loses_nothing(law):
            raise InputError(f'"all" needs a law that loses energy, and this {law.name} never comes to rest; {remedy}', "run.impacts")
        if isinstance(law, CompliantLaw) and law.lasting and case.drop.same_spot and loses_nothing(law.after_compression(1.0)):
            words = f"and {law.name} loses none on a dent that it has made"
            raise InputError(f'"all" needs a law that loses energy, {words}; {remedy}, or drop.same_spot = false', "run.impacts")
    return Problem(
        sphere=rigid_sphere(case.sphere.radius, case.sphere.material),
        plate=rigid_plate(case.plate.size[2] if case.plate.size else 0.0),
        laws=contact_laws_of(case),
        height=case.drop.height,
        speed=case.drop.speed,
        gravity=case.drop.gravity,
        impacts=impacts_of(case),
        duration=case.run.duration,
        rest_speed=case.run.rest_speed,
        same_spot=case.drop.same_spot,
        tolerance=case.run.tolerance,
        source=resolved(case),
    )


def first_speed(problem: Problem) -> float:
    """Return the speed of the first touch [m/s] of a problem of one drop."""
    if problem.speed is not None:
        return float(problem.speed)
    fall = float(problem.height or 0.0) - float(problem.sphere.contact_offset)
    return float((2.0 * float(problem.gravity) * fall) ** 0.5)


def resolved(case: Case) -> dict[str, Any]:
    """Return a case in full, in SI: what is written as `case.toml`, and reads back as the same case."""
    laws = contact_laws_of(case)
    contact: dict[str, Any] = {"law": case.contact.law}
    for item in fields(laws[0]):
        values = [getattr(law, item.name) for law in laws]
        if item.name in case.contact.parameters or values[0] is not None:
            contact[item.name] = values if len(values) > 1 and len(set(values)) > 1 else values[0]
    size = {"size": list(case.plate.size)} if case.plate.size else {}
    number = impacts_of(case)
    return {
        "schema_version": case.schema_version,
        "name": case.name,
        "sphere": {**case.sphere.model_dump(exclude={"material"}), "material": _table(case.sphere.material)},
        "plate": {**size, "model": case.plate.model, "material": _table(case.plate.material)},
        "drop": {**case.drop.model_dump(exclude_none=True), "position": list(case.drop.position)},
        "contact": contact,
        "run": {**case.run.model_dump(exclude_none=True, exclude={"impacts"}), "impacts": "all" if number is None else number},
    }


def _table(material: Material) -> dict[str, Any] | str:
    if material is RIGID:
        return RIGID.name
    keep = ("density", "youngs_modulus", "poissons_ratio", "yield_strength", "loss_factor", "name")
    return {key: value for key, value in asdict(material).items() if key in keep and value not in (None, "")}
