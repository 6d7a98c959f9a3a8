"""Against MFiX-DEM's verification case DEM01: a sphere that falls on a wall, linear spring and
dashpot.

Garg et al. (2012), Powder Technology 220, 122-137, doi 10.1016/j.powtec.2011.09.019; positions from
the closed form of its three stages. Gravity acts in the contact, which ends at zero overlap.
Tolerance 1e-6.
"""

from __future__ import annotations

import pytest

import vibroimpact as vi
from agreement import Against, Agrees

AGAINST = Against(
    "MFiX-DEM, verification case DEM01",
    "closed form",
    "flight, bounces and shaken plates",
    "case of the MFiX manual after Garg et al. 2012, Powder Technol. 220, 122, doi "
    "10.1016/j.powtec.2011.09.019; "
    "closed form of its three stages",
)


@pytest.fixture(scope="module")
def response() -> vi.Response:
    case = {
        "sphere": {
            "radius": 0.1,
            "material": {"density": 2600, "youngs_modulus": 1e9, "poissons_ratio": 0.3},
        },
        "plate": {"material": "rigid"},
        "drop": {"height": 0.5, "gravity": 9.80665},
        "contact": {"law": "linear-spring-dashpot", "stiffness": 1e4, "restitution": 0.9},
        "run": {"impacts": 1},
    }
    return vi.simulate(vi.case_of(case))


def test_positions(agrees: Agrees, response: vi.Response) -> None:
    heights = response.at([0.14083519, 0.30514291, 0.35062094])["position_m"]
    agrees(
        "DEM01, falling and rebounding sphere",
        "height of the centre in flight and in contact",
        heights,
        [0.40274475, 0.04766252, 0.00593876],
        unit="m",
        relative=1e-6,
    )


def test_events(agrees: Agrees, response: vi.Response) -> None:
    row = {name: column[0] for name, column in response.impacts.items()}
    agrees(
        "DEM01, falling and rebounding sphere",
        "time of first contact",
        row["time_s"],
        0.285617,
        unit="s",
        absolute=5e-7,
    )
    agrees(
        "DEM01, falling and rebounding sphere",
        "approach speed",
        row["approach_speed_m_s"],
        2.800950,
        unit="m/s",
        relative=1e-6,
    )
    agrees(
        "DEM01, falling and rebounding sphere",
        "minimum height of the centre",
        0.1 - row["max_indentation_m"],
        0.001624,
        unit="m",
        absolute=5e-7,
    )
    agrees(
        "DEM01, falling and rebounding sphere",
        "time of separation",
        row["time_s"] + row["duration_s"],
        0.397435,
        unit="s",
        absolute=5e-7,
    )
    agrees(
        "DEM01, falling and rebounding sphere",
        "separation speed",
        row["separation_speed_m_s"],
        2.475443,
        unit="m/s",
        relative=1e-6,
    )
    agrees(
        "DEM01, falling and rebounding sphere",
        "maximum height of the centre after rebound",
        row["rebound_height_m"],
        0.412432,
        unit="m",
        absolute=5e-7,
    )
    assert response.energy["closure_relative"] <= 1e-9


def test_closed_form_to_the_tolerance(agrees: Agrees) -> None:
    """Damped oscillator without gravity: the restitution asked is the one achieved."""
    for asked in (0.05, 0.3, 0.9, 1.0):
        case = {
            "sphere": {
                "radius": 0.1,
                "material": {"density": 2600, "youngs_modulus": 1e9, "poissons_ratio": 0.3},
            },
            "plate": {"material": "rigid"},
            "drop": {"speed": 2.0, "gravity": 0.0},
            "contact": {"law": "linear-spring-dashpot", "stiffness": 1e4, "restitution": asked},
            "run": {"impacts": 1},
        }
        found = vi.simulate(vi.case_of(case)).impacts["restitution_achieved"]
        agrees(
            "linear spring-dashpot law without gravity",
            "coefficient of restitution",
            found,
            asked,
            relative=1e-8,
        )
