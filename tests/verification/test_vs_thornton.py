"""Against Thornton's closed restitution of an elastic-perfectly-plastic sphere (J. Appl. Mech. 64,
383, 1997).

e at v/v_y = 2, 5, 10, 50, 100, 1000 and the asymptote 1.18499 (v_y/v)^(1/4), by the closed form and
by integration; the dent that stays, and what the next impact on it does.
"""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.contact.laws.thornton import Thornton

AGAINST = Against(
    "Thornton, elastic-perfectly plastic sphere",
    "closed form",
    "elastic-plastic contact",
    "Thornton 1997, J. Appl. Mech. 64, 383",
)


LAW = Thornton(effective_modulus=2.4e9, effective_radius=0.025, yield_pressure=5e7)
MASS = 0.09
# printed, 4 digits
YIELD_SPEED = 3.194 * np.sqrt(
    LAW.yield_pressure**5 * LAW.effective_radius**3 / (LAW.effective_modulus**4 * MASS)
)
EXACT_YIELD_SPEED = np.sqrt(0.8 * LAW.stiffness * LAW.yield_indentation**2.5 / MASS)
EXPECTED = {2: 0.930626, 5: 0.773337, 10: 0.658558, 50: 0.444606, 100: 0.374299, 1000: 0.210701}


def test_yield_speed(agrees: Agrees) -> None:
    agrees(
        "onset of yield", "yield speed", EXACT_YIELD_SPEED, YIELD_SPEED, unit="m/s", relative=1e-4
    )


@pytest.mark.parametrize("ratio", EXPECTED)
def test_restitution(agrees: Agrees, ratio: float) -> None:
    speed = ratio * EXACT_YIELD_SPEED
    case = "2 to 1000 times the yield speed"
    agrees(
        f"{case}, closed form",
        "coefficient of restitution",
        LAW.closed_form_restitution(MASS, speed),
        EXPECTED[ratio],
        absolute=1e-6,
    )
    agrees(
        f"{case}, integrated",
        "coefficient of restitution",
        vi.laws.integrated_restitution(LAW, MASS, speed),
        EXPECTED[ratio],
        absolute=1e-6,
    )
    r = 1.0 / ratio
    printed = (
        np.sqrt(6 * np.sqrt(3) / 5 * (1 - r * r / 6))
        * (r / (r + 2 * np.sqrt(6 / 5 - r * r / 5))) ** 0.25
    )
    agrees(
        f"{case}, printed formula",
        "coefficient of restitution",
        LAW.closed_form_restitution(MASS, speed),
        printed,
        relative=1e-12,
    )


def test_asymptote_and_elastic_range(agrees: Agrees) -> None:
    found = LAW.closed_form_restitution(MASS, 1e8 * EXACT_YIELD_SPEED)
    agrees(
        "asymptote, 1e8 times the yield speed",
        "coefficient of restitution",
        found,
        1.18499 * 1e-2,
        relative=1e-4,
    )
    assert LAW.closed_form_restitution(MASS, 0.999 * EXACT_YIELD_SPEED) == 1.0


def drop(*, same_spot: bool, **more: object) -> vi.Response:
    ball = vi.Body(mass=MASS, contact_offset=0.025)
    return vi.simulate(
        vi.Problem(
            sphere=ball,
            plate=vi.rigid_plate(),
            laws=(LAW,),
            height=1.0,
            gravity=9.81,
            impacts=4,
            same_spot=same_spot,
            **more,
        )
    )


def test_the_dent_lasts_and_the_next_impact_on_it_is_elastic() -> None:
    response = drop(same_spot=True)
    impacts, energy = response.impacts, response.energy
    assert impacts["restitution_achieved"][0] < 0.7
    np.testing.assert_allclose(impacts["restitution_achieved"][1:], 1.0, rtol=1e-9)
    dent = impacts["max_indentation_m"][0] - LAW.elastic_recovery(impacts["max_indentation_m"][0])
    history = response.history()
    touch = np.searchsorted(history["time_s"], impacts["time_s"][1])
    assert history["position_m"][touch] - 0.025 == pytest.approx(-dent, rel=1e-9)
    assert history["indentation_m"][touch - 1] == 0.0
    # gravity adds a little, so the second impact is as deep as the first but for that
    assert impacts["plastic_work_J"][0] == pytest.approx(impacts["energy_lost_J"][0], rel=1e-12)
    np.testing.assert_allclose(impacts["plastic_work_J"][1:], 0.0, atol=1e-9 * energy["input_J"])
    assert energy["plastic_work_J"] == pytest.approx(impacts["plastic_work_J"].sum(), rel=1e-12)
    assert energy["contact_dissipated_J"] == pytest.approx(0.0, abs=1e-12)
    assert energy["closure_relative"] <= 1e-9


def test_fresh_surfaces_yield_each_time() -> None:
    response = drop(same_spot=False)
    achieved = response.impacts["restitution_achieved"]
    assert np.all(np.diff(achieved) > 0.0)
    np.testing.assert_allclose(
        achieved,
        LAW.closed_form_restitution(MASS, response.impacts["approach_speed_m_s"]),
        rtol=1e-3,
    )
    assert response.energy["closure_relative"] <= 1e-9


def test_a_dent_from_before_is_gone_on_with_and_a_batch_remembers_its_own() -> None:
    ball = vi.Body(mass=MASS, contact_offset=0.025)
    heights = np.array([0.3, 2.0, 1.0])
    dented = Thornton(
        effective_modulus=2.4e9,
        effective_radius=0.025,
        yield_pressure=5e7,
        loaded_to=np.array([0.0, 1e-4, 6e-4]),
    )
    batch = vi.simulate(
        vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(dented,), height=heights, impacts=3)
    )
    for index, height in enumerate(heights):
        alone = vi.simulate(
            vi.Problem(
                sphere=ball,
                plate=vi.rigid_plate(),
                laws=(dented.take(index),),
                height=height,
                impacts=3,
            )
        )
        for name in ("time_s", "restitution_achieved", "max_indentation_m", "plastic_work_J"):
            np.testing.assert_allclose(
                batch.impacts[name][index], alone.impacts[name], rtol=1e-9, atol=1e-12
            )
    assert np.all(batch.energy["closure_relative"] <= 1e-9)
    assert batch.impacts["restitution_achieved"][2, 0] == pytest.approx(
        dented.take(2).closed_form_restitution(MASS, batch.impacts["approach_speed_m_s"][2, 0]),
        rel=1e-3,
    )
