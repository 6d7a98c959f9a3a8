"""Against SciPy's Runge-Kutta of order 8, restarted at the deepest point: every law that has a force, by its own formulas.

The force is not smooth at touch and release, so SciPy itself is good to about 1e-7 here.
"""

from __future__ import annotations

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
    "scipy.integrate.solve_ivp with the force of each law, accurate to about 1e-7",
)


PAIR = ContactPair(effective_modulus=2.4e9, effective_radius=0.025, effective_mass=0.09, yield_strength=3e7, poissons_ratio=0.3)
LAWS = [law for law in vi.contact_laws().values() if issubclass(law, CompliantLaw)]


def leg(law: CompliantLaw, start: list[float], speed: float, ends: list) -> np.ndarray:
    def rates(_: float, state: np.ndarray) -> list[float]:
        static, dissipative = law.forces(max(state[0], float(law.release_level)), state[1], speed)
        force = float(static + dissipative)
        return [state[1], -(max(force, 0.0) if law.tension == "cut" else force) / 0.09]

    for end in ends:
        end.terminal = True
    return solve_ivp(rates, (0.0, 1.0), start, method="DOP853", rtol=1e-11, atol=[1e-16, 1e-12], events=ends, max_step=2e-5).y[:, -1]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
@pytest.mark.parametrize("speed", [0.3, 6.0])
def test_restitution(agrees: Agrees, law: type[CompliantLaw], speed: float) -> None:
    one = law.example(PAIR)

    def turned(_: float, state: np.ndarray) -> float:
        return state[1]

    deepest, _ = leg(one, [0.0, speed], speed, [turned])
    after = one.after_compression(deepest)

    def out(_: float, state: np.ndarray) -> float:
        return state[0] - float(after.release_level)

    _, final = leg(after, [deepest, -1e-12], speed, [out])
    found = vi.integrated_restitution(one, 0.09, speed)
    agrees(
        "all laws with a contact force, approach speeds 0.3 and 6 m/s", "coefficient of restitution", found, -final / speed, absolute=2e-6
    )
