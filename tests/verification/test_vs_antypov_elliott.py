"""Against Antypov and Elliott's exact damping of a Hertz contact, and the two rules for its end.

F = K delta^1.5 + alpha sqrt(m K) delta^(1/4) v with alpha = -sqrt(5) ln e / sqrt(ln^2 e + pi^2)
returns e if the contact ends at zero indentation, and more if it ends at zero force: .902026 (.9),
.808099 (.8), .550283 (.5). (EPL 94, 50004, 2011.) The shipped law has the first end; the second is
made here, by a user's means.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.contact.laws.tsuji import Tsuji

AGAINST = Against(
    "Antypov and Elliott, analytical solution of the damped Hertz contact",
    "closed form",
    "damping laws",
    "Antypov and Elliott 2011, EPL 94, 50004, doi 10.1209/0295-5075/94/50004",
)


MASS, STIFFNESS = 0.3, 1e7


@dataclass(frozen=True, kw_only=True)
class PushingTsuji(Tsuji):
    """The same law as programs that let nothing pull use it: made here, by a user's means."""

    name = "pushing-tsuji"
    contact_end, tension = "zero-force", "cut"


def achieved(law: type[Tsuji], restitution: float) -> float:
    ball = vi.Body(mass=MASS, contact_offset=0.1)
    made = law(stiffness=STIFFNESS, restitution=restitution, effective_mass=MASS)
    response = vi.simulate(
        vi.Problem(
            sphere=ball, plate=vi.rigid_plate(), laws=(made,), speed=2.0, gravity=0.0, impacts=1
        )
    )
    assert response.energy["closure_relative"] <= 1e-9
    return float(response.impacts["restitution_achieved"][0])


def test_alpha(agrees: Agrees) -> None:
    _, dissipative = Tsuji(stiffness=4.0, restitution=0.5, effective_mass=9.0).forces(
        16.0, 1.0, 1.0
    )
    agrees(
        "coefficient of restitution 0.5",
        "damping parameter alpha",
        dissipative / (math.sqrt(4.0 * 9.0) * 2.0),
        0.481769,
        absolute=5e-7,
    )


@pytest.mark.parametrize("restitution", [0.9, 0.8, 0.5])
def test_zero_indentation_returns_what_was_asked(agrees: Agrees, restitution: float) -> None:
    agrees(
        "contact ends at zero indentation",
        "coefficient of restitution",
        achieved(Tsuji, restitution),
        restitution,
        relative=1e-8,
    )


@pytest.mark.parametrize(
    ("restitution", "expected"), [(0.9, 0.902026), (0.8, 0.808099), (0.5, 0.550283)]
)
def test_zero_force_returns_more(agrees: Agrees, restitution: float, expected: float) -> None:
    agrees(
        "contact ends at zero force",
        "coefficient of restitution",
        achieved(PushingTsuji, restitution),
        expected,
        absolute=5e-7,
    )


def test_zero_force_end_under_gravity_may_leave_the_sphere_in_its_indentation() -> None:
    ball = vi.Body(mass=MASS, contact_offset=0.1)
    outcomes = set()
    for height in (0.1001, 0.2, 1.0):
        law = PushingTsuji(stiffness=1e5, restitution=0.267, effective_mass=MASS)
        response = vi.simulate(
            vi.Problem(
                sphere=ball,
                plate=vi.rigid_plate(),
                laws=(law,),
                height=height,
                impacts=2,
                rest_speed=0.0,
            )
        )
        assert response.energy["closure_relative"] <= 1e-9
        history = response.history()
        assert all(np.all(np.isfinite(values)) for values in history.values())
        outcomes |= set(response.outcomes)
    assert outcomes == {vi.Outcome.IMPACTS, vi.Outcome.CAPTURED}
