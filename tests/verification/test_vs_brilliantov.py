"""Against the equation of viscoelastic spheres (Kuwabara and Kono 1987; Brilliantov and others
1996), integrated by SciPy.

x'' + b sqrt(x) x' + x^1.5 = 0 from x = 0, x' = 1 to zero force, b = .1, .3, 1. And the Pade
approximant of Mueller and Poeschel (Phys. Rev. E 84, 021302, 2011), good to about 1e-3 over all
speeds.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from agreement import Against, Agrees
from vibroimpact.contact.laws.kuwabara_kono import KuwabaraKono
from vibroimpact.dynamics.restitution import integrated_restitution

AGAINST = Against(
    "SciPy's DOP853, dimensionless equation of viscoelastic spheres",
    "own independent computation",
    "damping laws",
    "equation of Kuwabara and Kono 1987, Jpn. J. Appl. Phys. 26, 1230, and Brilliantov et "
    "al. 1996, Phys. Rev. E 53, 5382; tolerance 1e-12",
)
PADE = Against(
    "Müller and Pöschel, Padé approximant of the coefficient of restitution",
    "closed form",
    "damping laws",
    "Müller and Pöschel 2011, Phys. Rev. E 84, 021302, doi 10.1103/PhysRevE.84.021302; "
    "accurate to about 1e-3",
)


def integrated(b: float) -> float:
    """Return the speed at which the force is zero again, after an approach at 1."""

    def rates(_: float, state: np.ndarray) -> list[float]:
        depth = max(state[0], 0.0)
        return [state[1], -np.sqrt(depth) * (b * state[1] + depth)]

    def no_force(_: float, state: np.ndarray) -> float:
        return b * state[1] + state[0]

    no_force.terminal, no_force.direction = True, -1
    run = solve_ivp(
        rates, (0.0, 10.0), [0.0, 1.0], method="DOP853", rtol=1e-12, atol=1e-14, events=no_force
    )
    return -float(run.y[1, -1])


@pytest.mark.parametrize("b", [0.1, 0.3, 1.0])
def test_dimensionless_equation(agrees: Agrees, b: float) -> None:
    law = KuwabaraKono(stiffness=1.0, dissipation_time=b / 1.5)
    agrees(
        "three dimensionless damping parameters",
        "coefficient of restitution",
        integrated_restitution(law, 1.0, 1.0),
        integrated(b),
        absolute=1e-8,
    )


def test_pade_over_the_speed(agrees: Agrees) -> None:
    stiffness, mass, time = 5e8, 0.09, 2e-6
    speed = np.geomspace(1e-3, 1e2, 16)
    star = np.sqrt(1.5 * time * (stiffness / mass) ** 0.4) * speed**0.1
    top = np.polynomial.polynomial.polyval(star, [1, 1.07232, 0.574198, 0.141552])
    bottom = np.polynomial.polynomial.polyval(
        star, [1, 1.07232, 1.72765, 1.37842, 1.19449, 0.467273, 0.235585]
    )
    found = integrated_restitution(
        KuwabaraKono(stiffness=stiffness, dissipation_time=time), mass, speed
    )
    agrees(
        "approach speeds 1 mm/s to 100 m/s",
        "coefficient of restitution",
        found,
        top / bottom,
        against=PADE,
        absolute=2e-3,
    )
    assert np.all(np.diff(found) < 0.0)
