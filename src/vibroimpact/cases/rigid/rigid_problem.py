"""Contact laws of a case, and its problem with rigid bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.bodies.body import Body
from vibroimpact.bodies.rigid_bodies import rigid_plate
from vibroimpact.cases.fields.section import derived
from vibroimpact.cases.rigid.oblique import normal_motion_of, oblique_of
from vibroimpact.cases.rigid.pair import ball_of, contact_pair, is_free_sphere, sphere_density
from vibroimpact.cases.rigid.plate_motion import motion_of
from vibroimpact.cases.rigid.run_ends import stated_ends
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.registry import find_contact_law
from vibroimpact.contact.speed_function import BySpeed, SpeedFunction, SpeedTable, held
from vibroimpact.dynamics.fluids.fluid import Fluid
from vibroimpact.dynamics.motion.flight_in_fluid import speed_of_fall
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.cases.sections.schema import CaseTable
    from vibroimpact.dynamics.fluids.air import Air
    from vibroimpact.dynamics.fluids.liquid import Liquid

PLATE_FALLS = (
    "the supports let the plate fall or tilt: under gravity it falls away from under the "
    "sphere; hold it vertically, leave it rigid, or "
    "hit it in free space, with drop.gravity = 0 and drop.speed or drop.velocity"
)
"""Message for a plate that its supports do not hold.

It is raised before its modes are computed (`"free"`) or after.
"""


def mass_of_sphere(case: CaseTable) -> float:
    """Return the mass of the falling sphere [kg]."""
    return float(ball_of(case.sphere).mass)


@derived
def contact_laws_of(case: CaseTable) -> tuple[ContactLaw, ...]:
    """Return the contact law of each impact.

    There are as many as the longest list of a parameter has values; the last holds for later
    impacts.

    A function of the approach speed has its value at the first touch, in a vacuum.
    """
    law = find_contact_law(case.contact.law)
    pair = contact_pair(case)
    parameters: dict[str, Any] = dict(case.contact.parameters)
    for key, function in by_speed_of(case).items():
        parameters[key] = held(function, _touch_speed_in_vacuum(case))
    lists = {key: value for key, value in parameters.items() if isinstance(value, tuple)}
    impacts = max((len(values) for values in lists.values()), default=1)
    laws = []
    try:
        for impact in range(impacts):
            for key, values in lists.items():
                # the last value of a shorter list holds
                parameters[key] = values[min(impact, len(values) - 1)]
            laws.append(law.for_pair(pair, **parameters))
    except InputError as error:
        raise InputError(error.message, f"contact.{error.key}".rstrip(".")) from None
    return tuple(laws)


def fluid_of(case: CaseTable) -> Fluid | None:
    """Return what the sphere of a case flies through; None for a vacuum."""
    return _liquid_of(case) or _air_of(case)


def _liquid_of(case: CaseTable) -> Liquid | None:
    if case.contact.local.liquid is None:
        return None
    return case.contact.local.liquid.liquid()


def _air_of(case: CaseTable) -> Air | None:
    if case.drop.air is None:
        return None
    return case.drop.air.air()


def by_speed_of(case: CaseTable) -> dict[str, BySpeed]:
    """Return the parameters of a case's contact law that are functions of the approach speed."""
    return {
        key: value
        for key, value in case.contact.parameters.items()
        if isinstance(value, (SpeedFunction, SpeedTable))
    }


def in_liquid(case: CaseTable, law: ContactLaw) -> ContactLaw:
    """Return a contact law of a case at the speed of the first touch.

    It has the restitution that a liquid, if there is one, leaves it.
    """
    functions = by_speed_of(case)
    if functions:
        law = law.changed(
            {key: held(function, touch_speed(case)) for key, function in functions.items()}
        )
    table = case.contact.local.liquid
    if table is None:
        return law
    return table.liquid().around(
        law, touch_speed(case), case.sphere.radius, sphere_density(case.sphere)
    )


def elastic_names(case: CaseTable) -> list[Literal["sphere", "plate"]]:
    """Return the names of the elastic bodies of a case."""
    names: tuple[Literal["sphere", "plate"], ...] = ("sphere", "plate")
    return [name for name in names if getattr(case, name).model == "elastic"]


def deforms(case: CaseTable) -> bool:
    """Return whether anything but the contact itself deforms, or the body below is free to move."""
    local = case.contact.local
    return (
        bool(elastic_names(case))
        or local.local_compliance == "identified"
        or local.finite_sphere
        or is_free_sphere(case)
    )


def rigid_problem(case: CaseTable) -> Problem:
    """Return the problem of a case with rigid bodies.

    The numbers of the case may be arrays, one value per drop.
    """
    return Problem(
        sphere=ball_of(case.sphere),
        plate=_rigid_below(case),
        laws=contact_laws_of(case),
        by_speed=by_speed_of(case),
        **normal_motion_of(case),
        oblique=oblique_of(case),
        motion=motion_of(case),
        air=_air_of(case),
        liquid=_liquid_of(case),
        sensors=tuple(sensor.sensor() for sensor in case.sensors),
        **stated_ends(case),
        rest_speed=case.run.rest_speed,
        same_spot=case.drop.same_spot,
        tolerance=case.run.tolerance,
    )


def _rigid_below(case: CaseTable) -> Body:
    """Return the fixed rigid body below: a plate, or a sphere that replaces it."""
    if case.plate.radius is not None:
        return Body(mass=np.inf, contact_offset=case.plate.radius)
    thickness = case.plate.size[2] if case.plate.size else 0.0
    return rigid_plate(thickness)


@derived
def touch_speed(case: CaseTable) -> float:
    """Return the approach speed of the first impact [m/s]."""
    motion = normal_motion_of(case)
    if "speed" in motion:
        return float(motion["speed"])
    if fluid_of(case) is not None:
        return speed_of_fall(rigid_problem(case))
    return float(_touch_speed_in_vacuum(case))


def _touch_speed_in_vacuum(case: CaseTable) -> Array:
    """Return the approach speed of the first impact without air [m/s].

    The numbers of the case may be arrays.
    """
    motion = normal_motion_of(case)
    if "speed" in motion:
        return motion["speed"]
    fall = motion["height"] - case.sphere.radius
    return (motion["velocity"] ** 2 + 2.0 * motion["gravity"] * fall) ** 0.5
