"""EXUDYN: a Python script with a point mass and a contact force as user function, exact
for most laws.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import NamedTuple

from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.contact.hysteretic import HystereticLaw
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.contact.laws.linear_spring_dashpot import LinearSpringDashpot
from vibroimpact.contact.registry import contact_laws
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import approach_speeds, first_contact, shared_notes
from vibroimpact.exporting.deck import number, render_deck
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, file_name
from vibroimpact.exporting.formula import Formula
from vibroimpact.exporting.program_friction import (
    COULOMB,
    coefficient_of,
    friction_in,
    friction_notes,
)
from vibroimpact.exporting.rigid_drop import as_rigid
from vibroimpact.files.plain_names import plain_words
from vibroimpact.ranges import Range

# without adams-poisson: its force jumps at maximum compression, where an integrator with adaptive
# steps gets stuck
_FORCES = {
    "adams-impact",
    "anagnostopoulos",
    "hertz",
    "jankowski",
    "kuwabara-kono",
    "linear-spring-dashpot",
    "tsuji",
}
"""Laws whose force the template has, beside that of all hysteretic laws."""

_CREEP = 1e-4
"""Slip below which friction is proportional to it, over the first approach speed."""


class _Parameter(NamedTuple):
    """A parameter of the contact law: its values, one for all impacts or one for each."""

    name: str
    values: list[float]
    meaning: str
    unit: str


def _force_model(law: ContactLaw) -> str:
    """Return what the template calls the contact force of a law."""
    if isinstance(law, LinearSpringDashpot) and law.damping is not None:
        return "constant dashpot"
    if isinstance(law, HuntCrossley) and law.dissipation is not None:
        return "constant dissipation"
    if isinstance(law, HystereticLaw):
        return "hysteretic"
    if law.name not in _FORCES:
        raise InputError(
            f"{law.name} can't be written for EXUDYN; {', '.join(laws_of_exudyn())} can. "
            'Take one of them, with the parameter that "vibroimpact calibrate" finds'
        )
    return law.name


def laws_of_exudyn() -> list[str]:
    """Return the names of the contact laws that can be written, sorted."""
    hysteretic = {name for name, law in contact_laws().items() if issubclass(law, HystereticLaw)}
    return sorted(_FORCES | hysteretic)


def _damping_factor(law: HystereticLaw) -> str:
    """Return the damping factor of a hysteretic law as a formula of Python.

    In it `e` is the restitution asked for, and other parameters are attributes of `p`.

    Raises
    ------
    InputError
        If the law has different formulas for different restitutions.
    """
    symbols = {item.name: Formula(f"p.{item.name}") for item in fields(law)}
    symbols["restitution"] = Formula("e")
    try:
        factor = law.changed(symbols).damping_factor
    except TypeError as error:
        raise InputError(
            f"{law.name} can't be written for EXUDYN, as its damping factor is no single formula"
        ) from error
    if isinstance(factor, Formula):
        return factor.text
    return number(factor)


def _parameters(drop: Drop) -> list[_Parameter]:
    parameters = []
    for item in fields(drop.laws[0]):
        values = [getattr(law, item.name) for law in drop.laws]
        if values[0] is None or item.metadata["memory"]:
            continue
        numbers = [float(value) for value in values]
        if len(set(values)) == 1:  # the same in every impact
            numbers = numbers[:1]
        unit = item.metadata["unit"] or "-"
        parameters.append(_Parameter(item.name, numbers, item.metadata["meaning"], unit))
    return parameters


def _fitted_value(drop: Drop) -> str:
    """Return the function of the approach speed that gives a parameter, clipped to its range,
    as a Python expression; "" if there is none.
    """
    if drop.function is None:
        return ""
    name, polynomial = drop.function
    value = " + ".join(
        f"{number(coefficient)} * approach**{power}"
        for power, coefficient in enumerate(polynomial.coefficients)
    )
    (parameter,) = (item for item in fields(drop.laws[0]) if item.name == name)
    allowed: Range = parameter.metadata["range"]
    lowest = float(allowed.clip(-math.inf))
    highest = float(allowed.clip(math.inf))
    if math.isfinite(lowest):
        value = f"max({value}, {number(lowest)})"
    if math.isfinite(highest):
        value = f"min({value}, {number(highest)})"
    return value


def _friction(drop: Drop) -> FrictionLaw | None:
    return friction_in(drop, "EXUDYN", COULOMB)


def _notes(drop: Drop) -> list[str]:
    return [*shared_notes(drop), *friction_notes(drop, "EXUDYN", _friction(drop))]


def _deck(drop: Drop) -> str:
    law = drop.laws[0]
    speeds = approach_speeds(drop)
    force_model = _force_model(law)
    duration, _ = first_contact(law, drop)
    friction_coefficient = coefficient_of(_friction(drop))
    oblique = drop.oblique or Oblique()
    damping_factor = ""
    if isinstance(law, HystereticLaw) and force_model == "hysteretic":
        damping_factor = _damping_factor(law)
    fitted_parameter = ""
    slowest_fitted = fastest_fitted = 0.0
    if drop.function is not None:
        fitted_parameter, function = drop.function
        slowest_fitted = function.slowest
        fastest_fitted = function.fastest
    return render_deck(
        "exudyn.py.j2",
        case_name=plain_words(drop.name),
        contact_law=law,
        notes=_notes(drop),
        radius=drop.radius,
        mass=drop.mass,
        inertia_ratio=drop.inertia_ratio,
        height=drop.height,
        downward_speed=drop.speed,
        velocity_along_plate=oblique.velocity,
        spin_about_plate_axes=oblique.spin[:2],
        spin_about_normal=oblique.spin[2],
        oblique=drop.oblique is not None,
        normal_gravity=drop.gravity,
        gravity_along_plate=oblique.gravity,
        # a fall is integrated to the known time of first touch, and each contact separately, with
        # steps of its scale
        impacts=len(speeds),
        contact_duration=duration,
        force_model=force_model,
        damping_factor=damping_factor,
        parameters=_parameters(drop),
        fitted_parameter=fitted_parameter,
        fitted_value=_fitted_value(drop),
        slowest_fitted=slowest_fitted,
        fastest_fitted=fastest_fitted,
        friction_coefficient=friction_coefficient,
        creep_speed=_CREEP * speeds[0],
    )


def _write(drop: Drop) -> Mapping[str, bytes]:
    return {file_name(drop, "-exudyn.py"): _deck(drop).encode()}


FORMAT = ExportFormat(
    name="exudyn",
    program="EXUDYN",
    files="a Python script (.py)",
    tested="run with EXUDYN 1.13.6, compared with vibroimpact's drops between rigid bodies, "
    "oblique ones too",
    write=_write,
    notes=_notes,
    prepare=as_rigid,
)
