"""Against Jackson, Green and Marghitu's fit to finite elements (Nonlinear Dynamics 60, 217, 2010).

Their restitution of an elastic-perfectly-plastic sphere beside Thornton's law with the hardness, 2.8 times the yield strength,
and beside the power-law-hardening law; and the latter's own limits, which are those of its source.
"""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from stated import says
from vibroimpact.contact.laws.jackson_green_marghitu import JacksonGreenMarghitu
from vibroimpact.contact.laws.storakers import Storakers
from vibroimpact.contact.laws.thornton import Thornton

AGAINST = Against(
    "Jackson, Green and Marghitu, formulas fitted to finite-element results",
    "published computation",
    "elastic-plastic contact",
    "Jackson, Green and Marghitu 2010, Nonlinear Dyn. 60, 217",
)
LIMIT = Against(
    "fully plastic contact of a power-law hardening sphere",
    "closed form",
    "elastic-plastic contact",
    "Storåkers, Biwa and Larsson 1997, Int. J. Solids Struct. 34, 3061",
)


PAGE = "docs/laws/storakers.md"
MODULUS, RADIUS, STRENGTH, MASS = 7e10, 0.01, 4e8, 0.01
FIT = JacksonGreenMarghitu(effective_modulus=MODULUS, effective_radius=RADIUS, yield_strength=STRENGTH, poissons_ratio=0.3)
PLASTIC = Storakers(effective_modulus=MODULUS, effective_radius=RADIUS, yield_strength=STRENGTH, hardening_exponent=1e5)


def test_the_fit_itself(agrees: Agrees) -> None:
    critical = FIT.critical_speed(MASS)
    # E* of the paper is this one; C, omega_c and P_c as it gives them
    c = 1.295 * np.exp(0.736 * 0.3)
    omega = (np.pi * c * STRENGTH / (2 * MODULUS)) ** 2 * RADIUS
    force = 4 / 3 * (RADIUS / MODULUS) ** 2 * (c / 2 * np.pi * STRENGTH) ** 3
    agrees("fitted formulas", "yield speed", critical, np.sqrt(4 * omega * force / (5 * MASS)), unit="m/s", relative=1e-12)
    ratio = np.array([0.5, 1.0, 1.0 + 1e-12, 10.0, 60.0 - 1e-9, 60.0 + 1e-9, 100.0])
    found = FIT.closed_form_restitution(MASS, ratio * critical)
    agrees("fitted formulas", "coefficient of restitution", found, [1, 1, 1, 0.828279, 0.590566, 0.590566, 0.531509], absolute=2e-6)
    assert FIT.closed_form_restitution(MASS, 1e9 * critical) == 0.0


def test_elastic_plastic_laws_beside_it(agrees: Agrees) -> None:
    speed = FIT.critical_speed(MASS) * np.array([30.0, 60.0, 100.0, 300.0])
    thornton = Thornton(effective_modulus=MODULUS, effective_radius=RADIUS, yield_pressure=2.8 * STRENGTH)
    fit = FIT.closed_form_restitution(MASS, speed)
    case = "30 to 300 times the yield speed"
    agrees(
        f"`thornton` with the hardness as yield pressure, {case}",
        "coefficient of restitution",
        vi.achieved_restitution(thornton, MASS, speed),
        fit,
        absolute=0.01,
    )
    plastic = vi.achieved_restitution(PLASTIC, MASS, speed)
    agrees(f"`storakers` without hardening, which yields late, {case}", "coefficient of restitution", plastic, fit, absolute=0.2)
    more = plastic - fit
    says(PAGE, "without hardening by {} to {} at 30 to 300 times the speed of first yield", more.min(), more.max())


def hardening(exponent: float) -> Storakers:
    """Return the law of a hardening exponent."""
    return Storakers(effective_modulus=MODULUS, effective_radius=RADIUS, yield_strength=STRENGTH, hardening_exponent=exponent)


def flow_stress(exponent: float) -> float:
    """Return the stress at a strain of one [Pa]."""
    return STRENGTH * (MODULUS / STRENGTH) ** (1 / exponent)


def test_nothing_is_lost_before_yield() -> None:
    yields = np.sqrt(0.8 * PLASTIC.stiffness * PLASTIC.yield_indentation**2.5 / MASS)
    first = Thornton(effective_modulus=MODULUS, effective_radius=RADIUS, yield_pressure=1.6 * STRENGTH)
    first_yields = np.sqrt(0.8 * first.stiffness * first.yield_indentation**2.5 / MASS)
    says(PAGE, "Without hardening nothing is lost up to {} times the speed of first yield", yields / first_yields)
    assert PLASTIC.closed_form_restitution(MASS, 1.01 * yields) < 1.0 == pytest.approx(PLASTIC.closed_form_restitution(MASS, 0.99 * yields))


@pytest.mark.parametrize("exponent", [1.1, 3.0, 1e5])
def test_the_slope_does_not_jump_at_yield(exponent: float) -> None:
    law = hardening(exponent)
    at_yield, small = law.yield_indentation, 1e-6
    below, at, above = (law.loading_force(at_yield * factor) for factor in (1 - small, 1.0, 1 + small))
    assert above - at == pytest.approx(at - below, rel=1e-4)


def test_thorntons_force_over_the_contact_radius(agrees: Agrees) -> None:
    """Without hardening; the indentation is another one, by the published relation of the fully plastic contact."""
    thornton = Thornton(effective_modulus=MODULUS, effective_radius=RADIUS, yield_pressure=3 * STRENGTH)
    indentation = thornton.yield_indentation * np.array([1.5, 10.0, 1000.0])
    found = PLASTIC.loading_force(indentation)
    expected = thornton.loading_force(PLASTIC.contact_radius(indentation) ** 2 / RADIUS)
    name = "`storakers` without hardening, against `thornton` at the same contact radius"
    agrees(name, "contact force", found, expected, unit="N", against=LIMIT, relative=1e-4)


def test_contact_radius_when_fully_plastic(agrees: Agrees) -> None:
    """c^2 of the source: 1.43 without hardening, 1 for m of about 3, 0.5 for m = 1."""
    published = {1e6: 1.43, 3.0: 1.0, 1.01: 0.5}
    found = [hardening(exponent).pile_up for exponent in published]
    agrees("`storakers`, three hardening exponents", "c^2", found, [*published.values()], against=LIMIT, absolute=0.01)


@pytest.mark.parametrize("exponent", [2.0, 5.0, 20.0, 1e5])
def test_hardening_law_when_fully_plastic(agrees: Agrees, exponent: float) -> None:
    law, flow = hardening(exponent), flow_stress(exponent)
    indentation = 1e10 * RADIUS  # far beyond its validity: the elastic part of the contact is gone
    case = "`storakers`, far above the yield speed"
    area = np.pi * law.contact_radius(indentation) ** 2
    agrees(case, "contact area", area, 2 * np.pi * law.pile_up * RADIUS * indentation, unit="m^2", against=LIMIT, relative=1e-3)
    pressure = 3 * flow * (law.contact_radius(indentation) / (6 * RADIUS)) ** (1 / exponent)
    agrees(case, "mean contact pressure", law.loading_force(indentation) / area, pressure, unit="Pa", against=LIMIT, relative=1e-3)
    power = 1 + 0.5 / exponent
    force = 3 * np.pi * flow * 6 ** (-1 / exponent) * (2 * law.pile_up) ** power * RADIUS ** (2 - power) * indentation**power
    agrees(case, "contact force", law.loading_force(indentation), force, unit="N", against=LIMIT, relative=1e-3)


@pytest.mark.parametrize("exponent", [2.0, 5.0, 20.0])
def test_hardening_law_far_above_yield(agrees: Agrees, exponent: float) -> None:
    law = hardening(exponent)
    speed = np.array([1e12, 1e13])
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


@pytest.mark.parametrize("exponent", [1.1, 3.0, 1e5])
def test_the_work_of_loading_is_the_integral_of_the_force(exponent: float) -> None:
    law = hardening(exponent)
    indentation = law.yield_indentation * np.array([1.0 + 1e-3, 2.0, 30.0, 1e4])
    small = 1e-5
    slope = (law.loading_work(indentation * (1 + small)) - law.loading_work(indentation * (1 - small))) / (2 * small * indentation)
    np.testing.assert_allclose(slope, law.loading_force(indentation), rtol=1e-8)
