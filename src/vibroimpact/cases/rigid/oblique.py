"""The motion along the plate that a case describes: directions, spin, inclination and friction."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.fields.section import derived
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.contact.friction.registry import find_friction_law
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.cases.sections.schema import CaseTable


def oblique_keys(case: CaseTable) -> list[str]:
    """Return the keys of a case for which a drop is not along the plate's normal alone.

    Friction is one of them.
    """
    drop = case.drop
    keys = []
    if drop.velocity is not None and any(np.any(component) for component in drop.velocity[:2]):
        keys.append("drop.velocity")
    values: dict[str, Any] = {
        "drop.angle": drop.angle,
        "drop.spin": drop.spin,
        "plate.inclination": case.plate.inclination,
        "contact.friction": case.contact.friction,
    }
    return [*keys, *(key for key, value in values.items() if value is not None)]


def is_oblique(case: CaseTable) -> bool:
    """Return whether a drop is not along the plate's normal alone, or its friction is asked for."""
    return bool(oblique_keys(case))


@derived
def friction_law_of(case: CaseTable) -> FrictionLaw | None:
    """Return the friction law of a case; None if it has none."""
    table = case.contact.friction
    if table is None:
        return None
    try:
        return find_friction_law(table.law).for_pair(contact_pair(case), **table.parameters)
    except InputError as error:
        raise InputError(error.message, f"contact.friction.{error.key}".rstrip(".")) from None


def normal_motion_of(case: CaseTable) -> dict[str, Any]:
    """Return the motion of a case along the normal, as a `Problem` takes it.

    It has height, upward velocity there, speed at first touch, and gravity.
    """
    drop = case.drop
    gravity = drop.gravity
    if case.plate.inclination is not None:
        gravity = gravity * np.cos(case.plate.inclination)
    upward_velocity = 0.0 if drop.velocity is None else drop.velocity[2]
    if drop.height is not None:
        return {"height": drop.height, "velocity": upward_velocity, "gravity": gravity}
    if drop.velocity is not None:
        return {"speed": -upward_velocity, "gravity": gravity}
    if drop.angle is not None:
        return {"speed": drop.speed * np.cos(drop.angle), "gravity": gravity}
    return {"speed": drop.speed, "gravity": gravity}


def oblique_of(case: CaseTable) -> Oblique | None:
    """Return the motion along the plate of a case.

    None if the sphere falls along the normal without friction.
    """
    if not is_oblique(case):
        return None
    drop = case.drop
    size = case.plate.size
    velocity: tuple[Array, Array] = (0.0, 0.0)
    if drop.velocity is not None:
        velocity = (drop.velocity[0], drop.velocity[1])
    elif drop.angle is not None:
        velocity = (drop.speed * np.sin(drop.angle), 0.0)
    gravity_along: Array = 0.0
    if case.plate.inclination is not None:
        gravity_along = drop.gravity * np.sin(case.plate.inclination)
    return Oblique(
        velocity=velocity,
        spin=drop.spin or (0.0, 0.0, 0.0),
        position=drop.position,
        gravity=(gravity_along, 0.0),
        friction=friction_law_of(case),
        size=None if size is None else (size[0], size[1]),
    )
