"""Expected peak values of the first impact before a case is run, from the undamped
contact of rigid bodies.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vibroimpact.cases.conditions import DropSummary
from vibroimpact.cases.pair import contact_pair
from vibroimpact.cases.rigid_problem import contact_laws_of, in_liquid, touch_speed
from vibroimpact.compiled import interpreted
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.power_law import HERTZ_TIME
from vibroimpact.dynamics.impact_conditions import impact_conditions_of
from vibroimpact.dynamics.restitution import achieved_restitution, law_achieving
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.cases.case import Case

_SUPPORTED, _CLAMPED = 0.0116, 0.0056
"""Deflection of a square plate under a force at its centre over F a^2 / D: Timoshenko and
Woinowsky-Krieger 1959, Tables 23 and 37.
"""


def expected_of(case: Case) -> DropSummary:
    """Return the expected peak values of the first impact without losses; NaN for a law
    that gives no force.
    """
    law, speed = contact_laws_of(case)[0], touch_speed(case)
    if not isinstance(law, CompliantLaw):
        return DropSummary(speed=speed)
    one = np.ones(1)
    with interpreted():
        conditions = impact_conditions_of(
            law, contact_pair(case).effective_mass * one, case.drop.gravity * one, speed * one
        )
    depth = float(conditions.depth[0])
    force = float(
        np.asarray(law.forces(conditions.depth, 0.0 * one, conditions.approach_speed)[0])[0]
    )
    return DropSummary(force, depth, HERTZ_TIME * depth / speed, speed, _deflection(case, speed))


class ExpectedRestitution(NamedTuple):
    """The restitution of the first touch, of rigid bodies without gravity.

    Attributes
    ----------
    asked, achieved : float
        What is asked of the law, NaN where it takes no restitution, and what it achieves.
    to_ask : float
        The parameter with which it would achieve what is asked; NaN where it does so already, or
        none does.
    refusal : str
        Why none does.
    """

    asked: float
    achieved: float
    to_ask: float = math.nan
    refusal: str = ""


def expected_restitution(law: ContactLaw, mass: float, speed: float) -> ExpectedRestitution:
    """Return the restitution that a law achieves at the first touch, and the parameter that
    achieves the one asked.

    Parameters
    ----------
    law : ContactLaw
        The law.
    mass, speed : float
        Effective mass [kg] and approach speed [m/s].
    """
    achieved = float(achieved_restitution(law, mass, speed))
    asked = (
        float(getattr(law, "restitution", math.nan))
        if law.free_parameter == "restitution"
        else math.nan
    )
    if not abs(achieved - asked) >= 5e-4:
        return ExpectedRestitution(asked, achieved)
    try:
        return ExpectedRestitution(
            asked,
            achieved,
            float(getattr(law_achieving(law, asked, mass, speed), "restitution", asked)),
        )
    except InputError as error:
        return ExpectedRestitution(asked, achieved, refusal=error.message)


def first_restitution(case: Case) -> ExpectedRestitution:
    """Return the restitution that the law of a case achieves at the first touch; in a
    liquid the parameter is still that in air.
    """
    law = contact_laws_of(case)[0]
    wet = in_liquid(case, law)
    found = expected_restitution(wet, float(contact_pair(case).effective_mass), touch_speed(case))
    if wet is law or math.isnan(found.to_ask):
        return found
    to_ask = found.to_ask * float(vars(law)["restitution"]) / found.asked
    if to_ask > 1.0:
        return found._replace(
            to_ask=math.nan,
            refusal=f"no restitution up to 1 in air would achieve {found.asked:.5g}",
        )
    return found._replace(to_ask=to_ask)


def _deflection(case: Case, speed: float) -> float:
    """Return the estimated deflection of an elastic plate at the contact point [m]; NaN for a rigid
    plate.

    It is the smaller of two bounds. A light sphere rebounds before flexural waves return from the
    edges: the plate takes up twice the momentum of the sphere like an infinite plate, of impedance
    8 sqrt(D rho h). A heavy sphere is stopped by the plate as by a spring of the static stiffness.
    """
    size, material = case.plate.size, case.plate.material
    if case.plate.model == "rigid" or size is None:
        return math.nan
    bending = material.plane_strain_modulus * size[2] ** 3 / 12.0
    mass = float(contact_pair(case).effective_mass)
    as_infinite = 2.0 * mass * speed / (8.0 * math.sqrt(bending * material.density * size[2]))
    compliance = (
        (_CLAMPED if case.plate.supports == "clamped" else _SUPPORTED)
        * min(size[:2]) ** 2
        / bending
    )
    return min(as_infinite, speed * math.sqrt(mass * compliance))
