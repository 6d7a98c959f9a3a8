"""Against Jackson, Green and Marghitu's fit to finite elements (Nonlinear Dynamics 60, 217, 2010).

Their restitution of an elastic-perfectly-plastic sphere beside Thornton's law with the hardness,
2.8 times the yield strength, and the power-law-hardening law in its perfectly plastic limit; and
the latter's own limits.
"""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.contact.laws.jackson_green_marghitu import JacksonGreenMarghitu
from vibroimpact.contact.laws.storakers import Storakers
from vibroimpact.contact.laws.thornton import Thornton

AGAINST = Against(
    "Jackson, Green and Marghitu, formula fitted to finite-element results, beside other laws",
    "published computation",
    "elastic-plastic contact",
    "Jackson, Green and Marghitu 2010, Nonlinear Dyn. 60, 217",
)
FORMULA = Against(
    "Jackson, Green and Marghitu, their formulas",
    "closed form",
    "elastic-plastic contact",
    "Jackson, Green and Marghitu 2010, Nonlinear Dyn. 60, 217: the law is this formula",
)
LIMIT = Against(
    "limiting cases of a power-law hardening sphere",
    "closed form",
    "elastic-plastic contact",
    "Storåkers, Biwa and Larsson 1997, Int. J. Solids Struct. 34, 3061; Thornton 1997, J. "
    "Appl. Mech. 64, 383",
)


MODULUS, RADIUS, STRENGTH, MASS = 7e10, 0.01, 4e8, 0.01
FIT = JacksonGreenMarghitu(
    effective_modulus=MODULUS, effective_radius=RADIUS, yield_strength=STRENGTH, poissons_ratio=0.3
)
PLASTIC = Storakers(
    effective_modulus=MODULUS,
    effective_radius=RADIUS,
    yield_strength=STRENGTH,
    hardening_exponent=1e5,
)


def test_the_fit_itself(agrees: Agrees) -> None:
    critical = FIT.critical_speed(MASS)
    # E* of the paper is this one; C, omega_c and P_c as it gives them
    c = 1.295 * np.exp(0.736 * 0.3)
    omega = (np.pi * c * STRENGTH / (2 * MODULUS)) ** 2 * RADIUS
    force = 4 / 3 * (RADIUS / MODULUS) ** 2 * (c / 2 * np.pi * STRENGTH) ** 3
    speed = np.sqrt(4 * omega * force / (5 * MASS))
    agrees(
        "fitted formulas",
        "yield speed",
        critical,
        speed,
        unit="m/s",
        against=FORMULA,
        relative=1e-12,
    )
    ratio = np.array([0.5, 1.0, 1.0 + 1e-12, 10.0, 60.0 - 1e-9, 60.0 + 1e-9, 100.0])
    found = FIT.closed_form_restitution(MASS, ratio * critical)
    expected = [1, 1, 1, 0.828279, 0.590566, 0.590566, 0.531509]
    agrees(
        "fitted formulas",
        "coefficient of restitution",
        found,
        expected,
        against=FORMULA,
        absolute=2e-6,
    )
    assert FIT.closed_form_restitution(MASS, 1e9 * critical) == 0.0


def test_elastic_plastic_laws_beside_it(agrees: Agrees) -> None:
    speed = FIT.critical_speed(MASS) * np.array([30.0, 60.0, 100.0, 300.0])
    thornton = Thornton(
        effective_modulus=MODULUS, effective_radius=RADIUS, yield_pressure=2.8 * STRENGTH
    )
    fit = FIT.closed_form_restitution(MASS, speed)
    case = "30 to 300 times the yield speed"
    agrees(
        f"`thornton` with the hardness as yield pressure, {case}",
        "coefficient of restitution",
        vi.laws.achieved_restitution(thornton, MASS, speed),
        fit,
        absolute=0.01,
    )
    agrees(
        f"`storakers` without hardening, {case}",
        "coefficient of restitution",
        vi.laws.achieved_restitution(PLASTIC, MASS, speed),
        fit,
        absolute=0.04,
    )


def test_hardening_law_without_hardening_is_thorntons(agrees: Agrees) -> None:
    thornton = Thornton(
        effective_modulus=MODULUS, effective_radius=RADIUS, yield_pressure=3 * STRENGTH
    )
    speed = np.array([0.1, 1.0, 10.0])
    found, expected = (law.closed_form_restitution(MASS, speed) for law in (PLASTIC, thornton))
    agrees(
        "`storakers` without hardening, against `thornton`",
        "coefficient of restitution",
        found,
        expected,
        against=LIMIT,
        absolute=1e-4,
    )


@pytest.mark.parametrize("exponent", [2.0, 5.0, 20.0])
def test_hardening_law_far_above_yield(agrees: Agrees, exponent: float) -> None:
    law = Storakers(
        effective_modulus=MODULUS,
        effective_radius=RADIUS,
        yield_strength=STRENGTH,
        hardening_exponent=exponent,
    )
    speed = np.array([1e7, 1e8])
    found = law.closed_form_restitution(MASS, speed)
    power, expected = np.log10(found[1] / found[0]), -(1 - 1 / exponent) / (4 + 1 / exponent)
    agrees(
        "`storakers`, far above the yield speed",
        "exponent of the speed in the coefficient of restitution",
        power,
        expected,
        against=LIMIT,
        relative=1e-3,
    )
    # of the contact: the mean pressure is the published one, less the small elastic part
    radius = 0.2 * RADIUS
    pressure = law.loading_force(radius**2 / RADIUS) / (np.pi * radius**2)
    flow_stress = STRENGTH * (MODULUS / STRENGTH) ** (1 / exponent)
    expected = 3 * flow_stress * (0.2 / 6) ** (1 / exponent)
    agrees(
        "`storakers`, far above the yield speed",
        "mean contact pressure",
        pressure,
        expected,
        unit="Pa",
        against=LIMIT,
        relative=0.1,
    )
