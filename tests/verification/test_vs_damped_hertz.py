"""Against the closed form for F = K delta^n (1 + D v/v0): D (1 + e) = ln[(1 + D)/(1 - e D)].
Tolerance 1e-8.

Independent of n, without gravity; also the restitutions that this gives for nine published D(e), of
which five are printed, and Adams' clipped law by an independent integration.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.contact.hysteretic import hysteretic_restitution

AGAINST = Against(
    "closed-form coefficient of restitution of hysteretic damping, D (1 + e) "
    "= ln[(1 + D)/(1 - e D)]",
    "closed form",
    "damping laws",
    "force F = K δ^n (1 + D v/v0) without gravity, any exponent n",
)


ASKED = (0.9, 0.8, 0.7, 0.5, 0.3, 0.1)
ACHIEVED = {
    "hunt-crossley": (0.90902, 0.83287, 0.76800, 0.66296, 0.58129, 0.51583),
    "lankarani-nikravesh": (0.91318, 0.84710, 0.79597, 0.72524, 0.68422, 0.66527),
    "flores": (0.89392, 0.78854, 0.68318, 0.47044, 0.25621, 0.06944),
    "gonthier": (0.87644, 0.76800, 0.66958, 0.48774, 0.30422, 0.10099),
    "hu-guo": (0.89990, 0.79920, 0.69730, 0.48774, 0.27066, 0.07407),
}
FACTORS = {  # D of the laws that the table leaves out
    "herbert-mcwhannell": lambda e: 6 * (1 - e) / ((2 * e - 1) ** 2 + 3),
    "lee-wang": lambda e: 0.75 * (1 - e),
    "zhiying-qishao": lambda e: 0.75 * (1 - e**2) * math.exp(2 * (1 - e)),
    "safaeifar": lambda e: 1.25 * (1 - e) / e,
}
EXACT = dict(zip(ASKED, (0.166482, 0.373146, 0.634828, 1.432751, 3.087082, 9.998159), strict=True))


def exact(factor: float) -> float:
    def excess(e: float) -> float:
        return factor * (1 + e) - math.log((1 + factor) / (1 - e * factor))

    return brentq(excess, 1e-9, min(1.0, 1 / factor) * (1 - 1e-15), xtol=1e-14)


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.5])
@pytest.mark.parametrize("name", ACHIEVED)
def test_the_printed_restitutions(agrees: Agrees, name: str, exponent: float) -> None:
    for asked, expected in zip(ASKED, ACHIEVED[name], strict=True):
        law = vi.laws.find_contact_law(name)(stiffness=1e7, restitution=asked, exponent=exponent)
        ball = vi.Body(mass=0.3, contact_offset=0.1)
        row = vi.simulate(
            vi.Problem(
                sphere=ball, plate=vi.rigid_plate(), laws=(law,), speed=2.0, gravity=0.0, impacts=1
            )
        ).impacts
        case = f"law {name}, six nominal coefficients of restitution, three force exponents"
        agrees(
            case,
            "coefficient of restitution",
            row["restitution_achieved"],
            exact(law.damping_factor),
            relative=1e-8,
        )
        agrees(
            case,
            "coefficient of restitution, printed value",
            row["restitution_achieved"],
            expected,
            absolute=5e-6,
        )
        assert row["restitution_asked"][0] == asked
        assert law.closed_form_restitution(0.3, 2.0) == pytest.approx(
            exact(law.damping_factor), rel=1e-12
        )


@pytest.mark.parametrize("name", FACTORS)
def test_the_laws_without_a_printed_restitution(agrees: Agrees, name: str) -> None:
    for asked in ASKED:
        law = vi.laws.find_contact_law(name)(stiffness=1e7, restitution=asked)
        assert law.damping_factor == pytest.approx(FACTORS[name](asked), rel=1e-14)
        found = vi.laws.integrated_restitution(law, 0.3, 2.0)
        agrees(
            f"law {name}, six nominal coefficients of restitution",
            "coefficient of restitution",
            found,
            exact(FACTORS[name](asked)),
            relative=1e-8,
        )


@pytest.mark.parametrize("wanted", EXACT)
def test_the_factor_that_achieves_a_restitution_exactly(agrees: Agrees, wanted: float) -> None:
    assert hysteretic_restitution(EXACT[wanted]) == pytest.approx(wanted, abs=1e-6)
    law = vi.laws.law_achieving(
        vi.laws.find_contact_law("flores")(stiffness=1e7, restitution=0.5),
        wanted,
        mass=0.3,
        speed=2.0,
    )
    agrees(
        "damping for six prescribed coefficients of restitution",
        "damping factor",
        law.damping_factor,
        EXACT[wanted],
        absolute=5e-6,
    )  # the digits printed


def test_the_closed_form_where_its_two_formulas_meet() -> None:
    factors = np.array([0.0, 1e-12, 1e-6, 0.0199999999, 0.02, 1.0, 20.0, 1e8])
    found = hysteretic_restitution(factors)
    assert found[0] == 1.0
    np.testing.assert_allclose(1.0 - found[1:3], 2 / 3 * factors[1:3], rtol=1e-4)
    assert abs(found[3] - found[4]) < 1e-10
    np.testing.assert_allclose(found[3:7], [exact(factor) for factor in factors[3:7]], rtol=1e-12)
    assert 0.0 < found[-1] <= 1e-8
