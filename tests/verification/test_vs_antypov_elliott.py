"""Against Antypov and Elliott's exact damping of a Hertz contact, and the two rules for its end.

F = K delta^1.5 + alpha sqrt(m K) delta^(1/4) v with alpha = -sqrt(5) ln e / sqrt(ln^2 e + pi^2) returns e if the
contact ends at zero indentation, and more if it ends at zero force: .902026 (.9), .808099 (.8), .550283 (.5).
(EPL 94, 50004, 2011.) The law is made here, by a user's means, so this also tests a law with a zero-force end.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.contact.law import parameter
from vibroimpact.contact.power_law import PowerLaw

MASS, STIFFNESS = 0.3, 1e7


@dataclass(frozen=True, kw_only=True)
class PullingTsuji(PowerLaw):
    name, equation, source = "pulling-tsuji", "", ""
    contact_end, tension, root = "zero-indentation", "kept", 4
    damping: float = parameter("damping", at_least=0)

    def forces(self, delta, delta_dot, approach_speed):
        return self.elastic_force(delta), self.damping * np.sqrt(np.sqrt(delta)) * delta_dot


@dataclass(frozen=True, kw_only=True)
class PushingTsuji(PullingTsuji):
    contact_end, tension = "zero-force", "cut"


def achieved(law: type[PullingTsuji], restitution: float) -> float:
    log = math.log(restitution)
    alpha = -math.sqrt(5) * log / math.sqrt(log**2 + math.pi**2)
    ball = vi.Body(mass=MASS, contact_offset=0.1)
    made = law(stiffness=STIFFNESS, damping=alpha * math.sqrt(MASS * STIFFNESS))
    response = vi.simulate(vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(made,), speed=2.0, gravity=0.0, impacts=1))
    assert response.energy["closure_relative"] <= 1e-9
    return float(response.impacts["restitution_achieved"][0])


@pytest.mark.parametrize("restitution", [0.9, 0.8, 0.5])
def test_zero_indentation_returns_what_was_asked(restitution: float) -> None:
    assert achieved(PullingTsuji, restitution) == pytest.approx(restitution, rel=1e-8)


@pytest.mark.parametrize(("restitution", "expected"), [(0.9, 0.902026), (0.8, 0.808099), (0.5, 0.550283)])
def test_zero_force_returns_more(restitution: float, expected: float) -> None:
    assert achieved(PushingTsuji, restitution) == pytest.approx(expected, abs=5e-7)


def test_zero_force_end_under_gravity_may_leave_the_sphere_in_its_indentation() -> None:
    ball = vi.Body(mass=MASS, contact_offset=0.1)
    outcomes = set()
    for height in (0.1001, 0.2, 1.0):
        law = PushingTsuji(stiffness=1e5, damping=150.0)
        response = vi.simulate(vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(law,), height=height, impacts=2, rest_speed=0.0))
        assert response.energy["closure_relative"] <= 1e-9
        history = response.history()
        assert all(np.all(np.isfinite(values)) for values in history.values())
        outcomes |= set(response.outcomes)
    assert outcomes == {vi.Outcome.IMPACTS, vi.Outcome.CAPTURED}
