"""Against Walton and Braun's closed restitutions: constant, or sqrt(w0/(S v + w0)) (J.
Rheology 30, 949, 1986).
"""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.contact.laws.walton_braun import WaltonBraun

AGAINST = Against(
    "Walton and Braun, closed-form coefficient of restitution",
    "closed form",
    "elastic-plastic contact",
    "Walton and Braun 1986, J. Rheol. 30, 949, doi 10.1122/1.549893",
)


STIFFNESS, MASS = 2e6, 0.09
SPEEDS = np.array([0.01, 0.3, 5.0])


def test_constant_restitution(agrees: Agrees) -> None:
    law = WaltonBraun(stiffness=STIFFNESS, restitution=0.6)
    agrees(
        "constant coefficient of restitution",
        "coefficient of restitution",
        vi.laws.integrated_restitution(law, MASS, SPEEDS),
        0.6,
        relative=1e-10,
    )


def test_restitution_that_falls_with_the_speed(agrees: Agrees) -> None:
    law = WaltonBraun(stiffness=STIFFNESS, stiffening=800.0)
    frequency = np.sqrt(STIFFNESS / MASS)
    exact = np.sqrt(frequency / (800.0 * SPEEDS + frequency))
    agrees(
        "coefficient of restitution decreasing with the speed",
        "coefficient of restitution",
        vi.laws.integrated_restitution(law, MASS, SPEEDS),
        exact,
        relative=1e-10,
    )


def test_it_leaves_with_an_overlap_and_the_next_contact_begins_anew() -> None:
    law = WaltonBraun(stiffness=STIFFNESS, restitution=0.6)
    ball = vi.Body(mass=MASS, contact_offset=0.025)
    response = vi.simulate(
        vi.Problem(
            sphere=ball, plate=vi.rigid_plate(), laws=(law,), height=0.5, gravity=9.81, impacts=4
        )
    )
    np.testing.assert_allclose(response.impacts["restitution_achieved"], 0.6, rtol=2e-3)
    deepest = response.impacts["max_indentation_m"][0]
    release = response.impacts["time_s"][0] + response.impacts["duration_s"][0]
    assert 0.025 - response.at([release])["position_m"][0] == pytest.approx(
        deepest * (1 - 0.36), rel=1e-6
    )
    # a quarter period of each spring
    periods = 0.5 * np.pi * np.sqrt(MASS / STIFFNESS) * (1 + 0.6)
    assert response.impacts["duration_s"][0] == pytest.approx(periods, rel=2e-3)
    assert response.energy["closure_relative"] <= 1e-9
