"""Against SciPy's Runge-Kutta of order 8, restarted at the deepest point: every law that has a
force, by its own formulas.

It is restarted too where a law without tension comes to its zero of force, beyond which it is
clipped.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.pair import ContactPair

AGAINST = Against(
    "SciPy's DOP853, restarted at maximum indentation",
    "own independent computation",
    "damping laws",
    "scipy.integrate.solve_ivp with the force of each law, tolerance 1e-11",
)


PAIR = ContactPair(
    effective_modulus=2.4e9,
    effective_radius=0.025,
    effective_mass=0.09,
    yield_strength=3e7,
    poissons_ratio=0.3,
)
LAWS = [law for law in vi.laws.contact_laws().values() if issubclass(law, CompliantLaw)]


def leg(
    law: CompliantLaw, start: list[float], speed: float, end: Callable[[float, np.ndarray], float]
) -> np.ndarray:
    """Return indentation and speed where `end` is zero."""

    def force(state: np.ndarray) -> float:
        return float(np.sum(law.forces(max(state[0], float(law.release_level)), state[1], speed)))

    def rates(_: float, state: np.ndarray) -> list[float]:
        return [
            state[1],
            -(max(force(state), 0.0) if law.tension == "cut" else force(state)) / 0.09,
        ]

    def no_push(_: float, state: np.ndarray) -> float:
        return force(state) if law.tension == "cut" and state[1] < 0.0 else 1.0

    end.terminal = no_push.terminal = True
    no_push.direction = -1
    options = {"method": "DOP853", "rtol": 1e-11, "atol": [1e-16, 1e-12], "max_step": 2e-5}
    run = solve_ivp(rates, (0.0, 1.0), start, events=[end, no_push], **options)
    if len(run.t_events[0]) == 0:
        run = solve_ivp(rates, (0.0, 1.0), run.y[:, -1], events=[end], **options)
    final: np.ndarray = run.y[:, -1]
    return final


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
@pytest.mark.parametrize("speed", [0.3, 6.0])
def test_restitution(agrees: Agrees, law: type[CompliantLaw], speed: float) -> None:
    one = law.example(PAIR)

    def turned(_: float, state: np.ndarray) -> float:
        return state[1]

    deepest, _ = leg(one, [0.0, speed], speed, turned)
    after = one.after_compression(deepest)

    def out(_: float, state: np.ndarray) -> float:
        return state[0] - float(after.release_level)

    _, final = leg(after, [deepest, -1e-12], speed, out)
    found = vi.laws.integrated_restitution(one, 0.09, speed)
    agrees(
        "all laws with a contact force, approach speeds 0.3 and 6 m/s",
        "coefficient of restitution",
        found,
        -final / speed,
        absolute=1e-8,
    )
