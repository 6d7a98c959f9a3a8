"""Against the closed form for F = K delta^n (1 + D v/v0): D (1 + e) = ln[(1 + D)/(1 - e D)]. Tolerance 1e-8.

Independent of n, without gravity; also the restitutions that this gives for Lankarani and Nikravesh's
D = 3/4 (1 - e^2), and Adams' clipped law by an independent integration.
"""

from __future__ import annotations

import math

import pytest
from scipy.optimize import brentq

import vibroimpact as vi
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh

ACHIEVED = {0.9: 0.91318, 0.8: 0.84710, 0.7: 0.79597, 0.5: 0.72524, 0.3: 0.68422, 0.1: 0.66527}


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.5])
@pytest.mark.parametrize("asked", ACHIEVED)
def test_restitution(asked: float, exponent: float) -> None:
    law = LankaraniNikravesh(stiffness=1e7, restitution=asked, exponent=exponent)
    ball = vi.Body(mass=0.3, contact_offset=0.1)
    row = vi.simulate(vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(law,), speed=2.0, gravity=0.0, impacts=1)).impacts
    damping = 0.75 * (1 - asked**2)
    exact = brentq(lambda e: damping * (1 + e) - math.log((1 + damping) / (1 - e * damping)), 0.5, 1.0, xtol=1e-14)
    assert row["restitution_achieved"][0] == pytest.approx(exact, rel=1e-8)
    assert row["restitution_achieved"][0] == pytest.approx(ACHIEVED[asked], abs=5e-6)
    assert row["restitution_asked"][0] == asked
