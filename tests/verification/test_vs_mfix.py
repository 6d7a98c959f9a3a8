"""Against MFiX-DEM's verification case DEM01: a sphere that falls on a wall, linear spring and dashpot.

Garg et al. (2012), Powder Technology 220, 122-137, doi 10.1016/j.powtec.2011.09.019; positions from the closed
form of its three stages. Gravity acts in the contact, which ends at zero overlap. Tolerance 1e-6.
"""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi


@pytest.fixture(scope="module")
def response() -> vi.Response:
    case = {
        "sphere": {"radius": 0.1, "material": {"density": 2600, "youngs_modulus": 1e9, "poissons_ratio": 0.3}},
        "plate": {"material": "rigid"},
        "drop": {"height": 0.5, "gravity": 9.80665},
        "contact": {"law": "linear-spring-dashpot", "stiffness": 1e4, "restitution": 0.9},
        "run": {"impacts": 1},
    }
    return vi.simulate(vi.read_case(case))


def test_positions(response: vi.Response) -> None:
    heights = response.at([0.14083519, 0.30514291, 0.35062094])["position_m"]
    np.testing.assert_allclose(heights, [0.40274475, 0.04766252, 0.00593876], rtol=1e-6)


def test_events(response: vi.Response) -> None:
    row = {name: column[0] for name, column in response.impacts.items()}
    assert row["time_s"] == pytest.approx(0.285617, abs=5e-7)
    assert row["approach_speed_m_s"] == pytest.approx(2.800950, rel=1e-6)
    assert 0.1 - row["max_indentation_m"] == pytest.approx(0.001624, abs=5e-7)
    assert row["time_s"] + row["duration_s"] == pytest.approx(0.397435, abs=5e-7)
    assert row["separation_speed_m_s"] == pytest.approx(2.475443, rel=1e-6)
    assert row["rebound_height_m"] == pytest.approx(0.412432, abs=5e-7)
    assert response.energy["closure_relative"] <= 1e-9


def test_closed_form_to_the_tolerance() -> None:
    """Damped oscillator without gravity: the restitution asked is the one achieved."""
    for asked in (0.05, 0.3, 0.9, 1.0):
        case = {
            "sphere": {"radius": 0.1, "material": {"density": 2600, "youngs_modulus": 1e9, "poissons_ratio": 0.3}},
            "plate": {"material": "rigid"},
            "drop": {"speed": 2.0, "gravity": 0.0},
            "contact": {"law": "linear-spring-dashpot", "stiffness": 1e4, "restitution": asked},
            "run": {"impacts": 1},
        }
        assert vi.simulate(vi.read_case(case)).impacts["restitution_achieved"][0] == pytest.approx(asked, rel=1e-8)
