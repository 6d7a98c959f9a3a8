"""What to expect of the first impact of a case before it is run: from the undamped contact between rigid bodies."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.cases.conditions import DropSummary
from vibroimpact.cases.rigid import contact_laws_of, contact_pair, touch_speed
from vibroimpact.contact.hertz_time import HERTZ_TIME
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.encounter import encounter_of

if TYPE_CHECKING:
    from vibroimpact.cases.case import Case

_SUPPORTED, _CLAMPED = 0.0116, 0.0056
"""Deflection of a square plate under a force at its centre over F a^2 / D: Timoshenko and Woinowsky-Krieger 1959, Tables 23 and 37."""


def expected_of(case: Case) -> DropSummary:
    """Return what to expect of the first impact of a case if nothing were lost; NaN of a law that gives no force."""
    law, speed = contact_laws_of(case)[0], touch_speed(case)
    if not isinstance(law, CompliantLaw):
        return DropSummary(speed=speed)
    one = np.ones(1)
    encounter = encounter_of(law, contact_pair(case).effective_mass * one, case.drop.gravity * one, speed * one)
    depth = float(encounter.depth[0])
    force = float(np.asarray(law.forces(encounter.depth, 0.0 * one, encounter.approach_speed)[0])[0])
    return DropSummary(force, depth, HERTZ_TIME * depth / speed, speed, _deflection(case, speed))


def _deflection(case: Case, speed: float) -> float:
    """Return about how far an elastic plate gives way [m]; NaN of another.

    The sphere rebounds before waves come back from the edges, so that the plate takes up twice its momentum as an infinite plate would,
    with 8 sqrt(D rho h) of force over speed; or, if it is heavy, the plate stops it like a spring. It can't be more than either.
    """
    size, material = case.plate.size, case.plate.material
    if case.plate.model == "rigid" or size is None:
        return math.nan
    bending = material.plane_strain_modulus * size[2] ** 3 / 12.0
    mass = float(contact_pair(case).effective_mass)
    as_infinite = 2.0 * mass * speed / (8.0 * math.sqrt(bending * material.density * size[2]))
    compliance = (_CLAMPED if case.plate.supports == "clamped" else _SUPPORTED) * min(size[:2]) ** 2 / bending
    return min(as_infinite, speed * math.sqrt(mass * compliance))
