"""The motion along the plate that a case describes: directions, spin, inclination and friction."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.fields.section import derived
from vibroimpact.cases.pair import contact_pair
from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.contact.registry import find_friction_law
from vibroimpact.dynamics.oblique.statement import Oblique
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.cases.schema import CaseTable


def oblique_keys(case: CaseTable) -> list[str]:
    """Return the keys of a case for which a drop is not along the plate's normal alone,
    friction included.
    """
    drop = case.drop
    along = drop.velocity is not None and any(np.any(part) for part in drop.velocity[:2])
    others: dict[str, Any] = {
        "drop.angle": drop.angle,
        "drop.spin": drop.spin,
        "plate.inclination": case.plate.inclination,
    }
    others["contact.friction"] = case.contact.friction
    return [
        *(["drop.velocity"] if along else []),
        *(key for key, value in others.items() if value is not None),
    ]


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
    """Return height, upward velocity there, speed at first touch, and gravity of a case
    along the normal, as a `Problem` takes them.
    """
    drop = case.drop
    gravity = (
        drop.gravity
        if case.plate.inclination is None
        else drop.gravity * np.cos(case.plate.inclination)
    )
    rising = 0.0 if drop.velocity is None else drop.velocity[2]
    if drop.height is not None:
        return {"height": drop.height, "velocity": rising, "gravity": gravity}
    if drop.velocity is not None:
        return {"speed": -rising, "gravity": gravity}
    return {
        "speed": drop.speed if drop.angle is None else drop.speed * np.cos(drop.angle),
        "gravity": gravity,
    }


def oblique_of(case: CaseTable) -> Oblique | None:
    """Return the motion along the plate of a case; None if the sphere falls along the
    normal without friction.
    """
    if not is_oblique(case):
        return None
    drop, inclination = case.drop, case.plate.inclination
    velocity: tuple[Array, Array] = (0.0, 0.0)
    if drop.velocity is not None:
        velocity = (drop.velocity[0], drop.velocity[1])
    elif drop.angle is not None:
        velocity = (drop.speed * np.sin(drop.angle), 0.0)
    return Oblique(
        velocity=velocity,
        spin=drop.spin or (0.0, 0.0, 0.0),
        position=drop.position,
        gravity=(0.0 if inclination is None else drop.gravity * np.sin(inclination), 0.0),
        friction=friction_law_of(case),
        size=None if case.plate.size is None else (case.plate.size[0], case.plate.size[1]),
    )
