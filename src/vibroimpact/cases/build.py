"""From a case to the problem it states, and back to a resolved case."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from vibroimpact.bodies.plate import rigid_plate
from vibroimpact.bodies.sphere import rigid_sphere
from vibroimpact.cases.calibrate_section import calibrate_table
from vibroimpact.cases.material_field import material_table
from vibroimpact.contact.law import CompliantLaw, ContactLaw, find_contact_law, loses_nothing
from vibroimpact.contact.pair import Array, ContactPair, effective_modulus
from vibroimpact.dynamics.problem import Problem
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.cases.schema import Case, PlateSection, SphereSection

_DEFAULT_IMPACTS = 5


def contact_pair(case: Case) -> ContactPair:
    """Return the facts of the touching pair of a case: effective modulus, radius and mass."""
    modulus = effective_modulus(case.sphere.material, case.plate.material)
    mass = rigid_sphere(case.sphere.radius, case.sphere.material).mass
    strength: Array | None = None
    ratio: Array = case.sphere.material.poissons_ratio
    for material in (case.sphere.material, case.plate.material):
        if material.yield_strength is None:
            continue
        weaker = np.less(material.yield_strength, np.inf if strength is None else strength)
        strength = np.where(weaker, material.yield_strength, np.inf if strength is None else strength)[()]
        ratio = np.where(weaker, material.poissons_ratio, ratio)[()]
    return ContactPair(modulus, case.sphere.radius, mass, strength, ratio)


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


def check_case(case: Case) -> None:
    """Raise unless a case can be stated as a problem, without computing anything.

    Raises
    ------
    InputError
        If the contact law can't be made for these bodies, the sphere would bounce for ever, an elastic body can't be made, or what must
        lie on the plate does not.
    """
    law = contact_laws_of(case)[-1]
    if impacts_of(case) is None and case.run.duration is None:
        remedy = "give a number or a duration"
        if loses_nothing(law):
            raise InputError(f'"all" needs a law that loses energy, and this {law.name} never comes to rest; {remedy}', "run.impacts")
        if isinstance(law, CompliantLaw) and law.lasting and case.drop.same_spot and loses_nothing(law.after_compression(1.0)):
            words = f"and {law.name} loses none on a dent that it has made"
            raise InputError(f'"all" needs a law that loses energy, {words}; {remedy}, or drop.same_spot = false', "run.impacts")
    if case.sensors and case.plate.model == "rigid":
        raise InputError(
            'the plate is rigid, so that its points do not move; give it model = "elastic", or leave out the sensors', "sensors"
        )
    local = case.contact.local
    if local.local_compliance == "identified" and case.sphere.model == "elastic":
        raise InputError('the local element of "identified" stands for the deformation of the sphere; leave it "rigid"', "sphere.model")
    if local.finite_sphere and case.sphere.model == "elastic":
        words = 'an elastic sphere deforms in its modes, and "consistent" corrects the rest already; leave this out'
        raise InputError(words, "contact.finite_sphere")
    if local.finite_sphere and not isinstance(law, CompliantLaw):
        raise InputError(f"{law.name} gives no force that a finite sphere would change; leave this out", "contact.finite_sphere")
    if elastic_names(case):
        from vibroimpact.cases.build_elastic import elastic_bodies  # which loads sparse matrices
        from vibroimpact.cases.places import check_places

        check_places(case)
        elastic_bodies(case)


def elastic_names(case: Case) -> list[Literal["sphere", "plate"]]:
    """Return which bodies of a case are elastic."""
    names: tuple[Literal["sphere", "plate"], ...] = ("sphere", "plate")
    return [name for name in names if getattr(case, name).model == "elastic"]


def deforms(case: Case) -> bool:
    """Does anything of a case but the contact itself deform?"""
    local = case.contact.local
    return bool(elastic_names(case)) or local.local_compliance == "identified" or local.finite_sphere


def problem_of(case: Case, progress: Callable[[float], None] | None = None, tell: Callable[[str], None] | None = None) -> Problem:
    """Return the problem that a case states.

    Parameters
    ----------
    case : Case
        The case.
    progress : callable, optional
        Called with a number from 0 to 1 while modes of elastic bodies are computed.
    tell : callable, optional
        Called with a sentence if something is wrong with the store of modes.

    Raises
    ------
    InputError
        What `check_case` raises; and if elastic bodies do not fit the treatment of local compliance, or no local element fits
        what was measured.
    """
    check_case(case)
    problem = replace(rigid_problem(case), source=resolved(case))
    if not deforms(case):
        return problem
    from vibroimpact.cases.coupling import coupled  # which loads finite elements

    return coupled(case, problem, progress, tell)


def rigid_problem(case: Case) -> Problem:
    """Return the problem of a case as if its bodies were rigid; the numbers of the case may be arrays, one value a drop."""
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
    )


def first_speed(case: Case) -> float:
    """Return the speed of the first touch [m/s] of a case."""
    if case.drop.speed is not None:
        return case.drop.speed
    return float((2.0 * case.drop.gravity * ((case.drop.height or 0.0) - case.sphere.radius)) ** 0.5)


def resolved(case: Case) -> dict[str, Any]:
    """Return a case in full, in SI: what is written as `case.toml`, and reads back as the same case."""
    laws = contact_laws_of(case)
    contact: dict[str, Any] = {"law": case.contact.law}
    for item in fields(laws[0]):
        values = [getattr(law, item.name) for law in laws]
        if item.name in case.contact.parameters or values[0] is not None:
            contact[item.name] = values if len(values) > 1 and len(set(values)) > 1 else values[0]
    number = impacts_of(case)
    return {
        "schema_version": case.schema_version,
        "name": case.name,
        "sphere": _body(case, "sphere"),
        "plate": _body(case, "plate"),
        "drop": {**case.drop.model_dump(exclude_none=True), "position": list(case.drop.position)},
        "contact": {**contact, **case.contact.local.model_dump(exclude_none=True)},
        "run": {**case.run.model_dump(exclude_none=True, exclude={"impacts"}), "impacts": "all" if number is None else number},
        **({"sensors": [sensor.model_dump(exclude_none=True, mode="json") for sensor in case.sensors]} if case.sensors else {}),
        **({"calibrate": calibrate_table(case.calibrate)} if case.calibrate else {}),
        **({"sweep": case.sweep.model_dump(exclude_none=True, mode="json")} if case.sweep else {}),
    }


def _body(case: Case, name: Literal["sphere", "plate"]) -> dict[str, Any]:
    """Return a body in full, without what its model does not have."""
    section: SphereSection | PlateSection = getattr(case, name)
    found = section.model_dump(exclude_none=True, exclude={"material", "supports", "damping", "mesh"})
    if section.model == "rigid":
        found = {key: found[key] for key in ("radius", "size", "model") if key in found}
    else:
        from vibroimpact.cases.build_elastic import elastic_table  # which loads sparse matrices

        found |= elastic_table(case, name)
    if "size" in found:
        found["size"] = list(found["size"])
    return {**found, "material": material_table(section.material)}
