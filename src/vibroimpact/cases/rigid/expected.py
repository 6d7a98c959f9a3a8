"""Expected peak values of the first impact before a case is run.

They are those of the undamped contact of rigid bodies.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vibroimpact.cases.limits.conditions import DropSummary
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.cases.rigid.rigid_problem import contact_laws_of, in_liquid, touch_speed
from vibroimpact.compiled import interpreted
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.power_law import HERTZ_TIME
from vibroimpact.dynamics.motion.impact_conditions import impact_conditions_of
from vibroimpact.dynamics.restitution import achieved_restitution, law_achieving
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.cases.sections.schema import CaseTable
    from vibroimpact.materials import Material

# deflection of a square plate under a force at its centre over F a^2 / D: Timoshenko and
# Woinowsky-Krieger 1959, Tables 23 and 37
_SUPPORTED = 0.0116
_CLAMPED = 0.0056


def expected_of(case: CaseTable) -> DropSummary:
    """Return the expected peak values of the first impact without losses.

    They are NaN for a law that gives no force.
    """
    law = contact_laws_of(case)[0]
    speed = touch_speed(case)
    if not isinstance(law, CompliantLaw):
        return DropSummary(speed=speed)
    drop = np.ones(1)
    mass = contact_pair(case).effective_mass * drop
    with interpreted():
        conditions = impact_conditions_of(law, mass, case.drop.gravity * drop, speed * drop)
    depth = float(conditions.depth[0])
    static_force, _ = law.forces(conditions.depth, 0.0 * drop, conditions.approach_speed)
    return DropSummary(
        force=float(np.asarray(static_force)[0]),
        depth=depth,
        duration=HERTZ_TIME * depth / speed,
        speed=speed,
        deflection=_deflection(case, speed),
    )


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
    """Return the restitution that a law achieves at the first touch.

    With it is the parameter that achieves the one asked.

    Parameters
    ----------
    law : ContactLaw
        The law.
    mass, speed : float
        Effective mass [kg] and approach speed [m/s].
    """
    achieved = float(achieved_restitution(law, mass, speed))
    asked = math.nan
    if law.free_parameter == "restitution":
        asked = float(getattr(law, "restitution", math.nan))
    if not abs(achieved - asked) >= 5e-4:  # also where nothing is asked
        return ExpectedRestitution(asked, achieved)
    try:
        tuned_law = law_achieving(law, asked, mass, speed)
    except InputError as error:
        return ExpectedRestitution(asked, achieved, refusal=error.message)
    to_ask = float(getattr(tuned_law, "restitution", asked))
    return ExpectedRestitution(asked, achieved, to_ask)


def first_restitution(case: CaseTable) -> ExpectedRestitution:
    """Return the restitution that the law of a case achieves at the first touch.

    In a liquid the parameter is still that in air.
    """
    law_in_air = contact_laws_of(case)[0]
    law = in_liquid(case, law_in_air)
    expected = expected_restitution(
        law, float(contact_pair(case).effective_mass), touch_speed(case)
    )
    if law is law_in_air or math.isnan(expected.to_ask):
        return expected
    # the liquid leaves the same share of any restitution
    to_ask = expected.to_ask * float(vars(law_in_air)["restitution"]) / expected.asked
    if to_ask > 1.0:
        refusal = f"no restitution up to 1 in air would achieve {expected.asked:.5g}"
        return expected._replace(to_ask=math.nan, refusal=refusal)
    return expected._replace(to_ask=to_ask)


def plate_impedance(material: Material, thickness: float) -> float:
    """Return the impedance of an infinite thin plate to a force on a point, 8 sqrt(D rho h) [kg/s].

    It resists the force like a dashpot.
    """
    bending_stiffness = material.plane_strain_modulus * thickness**3 / 12.0  # D
    return 8.0 * math.sqrt(bending_stiffness * material.density * thickness)


def _deflection(case: CaseTable, speed: float) -> float:
    """Return the estimated deflection of an elastic plate at the contact point [m].

    NaN for a rigid plate.

    It is the smaller of two bounds. A light sphere rebounds before flexural waves return from the
    edges: the plate takes up twice the momentum of the sphere like an infinite plate, of impedance
    8 sqrt(D rho h). A heavy sphere is stopped by the plate as by a spring of the static stiffness.
    """
    size = case.plate.size
    material = case.plate.material
    if case.plate.model == "rigid" or size is None:
        return math.nan
    bending_stiffness = material.plane_strain_modulus * size[2] ** 3 / 12.0  # D
    mass = float(contact_pair(case).effective_mass)
    # the momentum of the rebound, 2 m v, moves an infinite plate by that over its impedance
    of_infinite_plate = 2.0 * mass * speed / plate_impedance(material, size[2])
    # a small plate is a spring that takes up the energy: m v^2 = w^2 / compliance
    factor = _CLAMPED if case.plate.supports == "clamped" else _SUPPORTED
    compliance = factor * min(size[:2]) ** 2 / bending_stiffness
    of_static_spring = speed * math.sqrt(mass * compliance)
    return min(of_infinite_plate, of_static_spring)
