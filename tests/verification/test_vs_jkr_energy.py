"""What adhesion takes, against the energy of a contact of Johnson, Kendall and Roberts,
integrated by SciPy.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

import vibroimpact as vi
from agreement import Against, Agrees
from support import plain_case
from vibroimpact.cases.validity.adhesion import WORK_OF_ADHESION, sticking_speed
from vibroimpact.contact.laws.jkr import JKR
from vibroimpact.contact.quasi_static import QuasiStatic

AGAINST = Against(
    "energy of a JKR contact, numerical quadrature (SciPy)",
    "own independent computation",
    "adhesion",
    "Johnson, Kendall and Roberts 1971, Proc. R. Soc. A 324, 301",
)


RADIUS, MODULUS = 2e-5, 3e10


def torn() -> float:
    """The work that it takes to draw a contact out, from zero indentation to where it
    breaks [J].
    """

    def force(a: float) -> float:
        return 4 * MODULUS * a**3 / (3 * RADIUS) - math.sqrt(
            8 * math.pi * WORK_OF_ADHESION * MODULUS * a**3
        )

    def slope(a: float) -> float:  # of the indentation a^2 / R - sqrt(2 pi w a / E)
        return 2 * a / RADIUS - 0.5 * math.sqrt(2 * math.pi * WORK_OF_ADHESION / (MODULUS * a))

    at_zero = (2 * math.pi * WORK_OF_ADHESION * RADIUS**2 / MODULUS) ** (1 / 3)
    at_break = brentq(slope, 1e-3 * at_zero, at_zero)
    return quad(lambda a: -force(a) * -slope(a), at_zero, at_break)[0]


def test_the_speed_below_which_a_sphere_sticks(agrees: Agrees) -> None:
    mass = 4 / 3 * math.pi * RADIUS**3 * 2500
    found = float(sticking_speed(RADIUS, MODULUS, mass))
    agrees(
        "sphere of 20 μm",
        "sticking speed",
        found,
        math.sqrt(2 * torn() / mass),
        unit="m/s",
        relative=1e-3,
    )


def test_the_restitution_that_is_lost(agrees: Agrees) -> None:
    """As the law with adhesion loses it, within 3 %."""
    material = {"density": 2500, "youngs_modulus": MODULUS * (1 - 0.25**2), "poissons_ratio": 0.25}
    law = {"law": "jkr", "work_of_adhesion": WORK_OF_ADHESION}
    bodies = {"sphere": {"radius": RADIUS, "material": material}, "plate": {"material": "rigid"}}
    case = plain_case(
        **bodies, drop={"speed": 0.1, "gravity": 0.0}, contact=law, run={"impacts": 1}
    )
    lost = 1 - float(vi.simulate(vi.case_of(case)).impacts["restitution_achieved"][0])
    mass = 4 / 3 * math.pi * RADIUS**3 * 2500
    speed = float(sticking_speed(RADIUS, MODULUS, mass))
    agrees(
        "sphere of 20 μm at 0.1 m/s, error estimate of a run",
        "decrease of the coefficient of restitution by adhesion",
        1 - np.sqrt(1 - (speed / 0.1) ** 2),
        lost,
        relative=0.03,
    )


def torn_in_series(compliance: float) -> float:
    """The work of force over approach, from the state at first touch, which adhesion
    stretches, to where the approach turns [J].
    """

    def force(a: float) -> float:
        return 4 * MODULUS * a**3 / (3 * RADIUS) - math.sqrt(
            8 * math.pi * WORK_OF_ADHESION * MODULUS * a**3
        )

    def approach(a: float) -> float:
        return (
            a**2 / RADIUS
            - math.sqrt(2 * math.pi * WORK_OF_ADHESION * a / MODULUS)
            + compliance * force(a)
        )

    at_zero = (2 * math.pi * WORK_OF_ADHESION * RADIUS**2 / MODULUS) ** (1 / 3)
    at_break = minimize_scalar(
        approach,
        bounds=(0.1 * at_zero, at_zero),
        method="bounded",
        options={"xatol": 1e-9 * at_zero},
    ).x
    at_touch = brentq(approach, at_break, 2 * at_zero)
    steps = np.linspace(at_break, at_touch, 20001)
    return -float(np.trapezoid([force(a) for a in steps], [approach(a) for a in steps]))


def test_the_energy_lost_with_a_compliance_in_series(agrees: Agrees) -> None:
    compliances = (5e-6, 5e-5, 2e-4)  # that of the contact at zero indentation is 2.5e-4 m/N
    law = JKR(effective_modulus=MODULUS, effective_radius=RADIUS, work_of_adhesion=WORK_OF_ADHESION)
    sphere, plate = (
        vi.Body(mass=4 / 3 * math.pi * RADIUS**3 * 2500, contact_offset=RADIUS),
        vi.Body(mass=np.inf, contact_offset=0.0),
    )
    lost = []
    for compliance in compliances:
        series = QuasiStatic(linear=compliance)
        alone = vi.Problem(
            sphere=sphere,
            plate=plate,
            laws=(law,),
            speed=0.1,
            gravity=0.0,
            impacts=1,
            quasi_static=series,
        )
        energy = vi.simulate(alone).energy
        assert energy["closure_relative"] < 1e-9
        lost.append(energy["contact_dissipated_J"])
    agrees(
        "JKR contact with a compliance in series",
        "energy dissipated in one impact",
        lost,
        [torn_in_series(one) for one in compliances],
        unit="J",
        relative=2e-4,
    )
