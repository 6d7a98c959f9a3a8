"""Against the known numbers of sticking spheres (Johnson, Kendall and Roberts 1971; Thornton and
Ning 1998).

Pull-off force 3/2 pi w R, snap-in -8/9 of it, break at -3/4 (pi^2 w^2 R/E*^2)^(1/3), work to break
7.09 (w^5 R^4/E*^2)^(1/3), sticking speed sqrt(14.18/m) (w^5 R^4/E*^2)^(1/6), restitution sqrt(1 -
(v_s/v)^2).
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.contact.laws.jkr import JKR
from vibroimpact.contact.laws.krijt import Krijt

AGAINST = Against(
    "Johnson, Kendall and Roberts; Thornton and Ning, adhesive spheres",
    "closed form",
    "adhesion",
    "Johnson, Kendall and Roberts 1971, Proc. R. Soc. A 324, 301; Thornton and Ning 1998, "
    "Powder Technol. 99, 154",
)
SCIPY = Against(
    "SciPy's Radau, equation of motion in the contact radius",
    "own independent computation",
    "adhesion",
    "JKR contact with viscous dissipation, in the test",
)


MODULUS, RADIUS, ADHESION, MASS = 3e8, 2e-4, 0.3, 5e-8
LAW = JKR(effective_modulus=MODULUS, effective_radius=RADIUS, work_of_adhesion=ADHESION)
UNIT = (ADHESION**5 * RADIUS**4 / MODULUS**2) ** (1 / 3)
STICKING_SPEED = np.sqrt(14.1844 / MASS * UNIT)
PULL_OFF = 1.5 * np.pi * ADHESION * RADIUS


def force(delta: np.ndarray) -> np.ndarray:
    return LAW.forces(delta, np.zeros_like(delta), np.ones_like(delta))[0]


def test_force(agrees: Agrees) -> None:
    at_break = -0.75 * (np.pi**2 * ADHESION**2 * RADIUS / MODULUS**2) ** (1 / 3)
    agrees(
        "sphere of 0.2 mm",
        "indentation at detachment",
        LAW.release_level,
        at_break,
        unit="m",
        relative=1e-12,
    )
    agrees(
        "sphere of 0.2 mm",
        "force at first contact",
        force(np.zeros(1)),
        -8 / 9 * PULL_OFF,
        unit="N",
        relative=1e-12,
    )
    agrees(
        "sphere of 0.2 mm",
        "force at detachment",
        force(np.array([LAW.release_level])),
        -5 / 9 * PULL_OFF,
        unit="N",
        relative=1e-6,
    )
    lowest = force(np.linspace(LAW.release_level, 0.0, 20001)).min()
    agrees("sphere of 0.2 mm", "pull-off force", lowest, -PULL_OFF, unit="N", relative=1e-7)


def test_force_and_indentation_satisfy_the_published_pair() -> None:
    delta = np.concatenate(
        [
            LAW.release_level * np.array([1.0, 0.999999, 0.5, 1e-9]),
            [0.0],
            np.geomspace(1e-12, 1e-3, 40),
        ]
    )
    a = LAW.contact_radius(delta)
    np.testing.assert_allclose(
        a**2 / RADIUS - np.sqrt(2 * np.pi * ADHESION * a / MODULUS), delta, rtol=1e-9, atol=1e-16
    )
    expected = 4 * MODULUS * a**3 / (3 * RADIUS) - np.sqrt(8 * np.pi * ADHESION * MODULUS * a**3)
    np.testing.assert_allclose(force(delta), expected, rtol=1e-9, atol=1e-9 * PULL_OFF)


def test_work_to_break_and_restitution(agrees: Agrees) -> None:
    agrees(
        "sphere of 0.2 mm",
        "work of detachment",
        LAW.elastic_energy(LAW.release_level),
        7.0922 * UNIT,
        unit="J",
        relative=1e-5,
    )
    speeds = STICKING_SPEED * np.array([0.5, 0.99, 1.01, 1.5, 10.0])
    expected = np.sqrt(np.maximum(1 - (STICKING_SPEED / speeds) ** 2, 0.0))
    agrees(
        "approach speeds 0.5 to 10 times the sticking speed",
        "coefficient of restitution",
        LAW.closed_form_restitution(MASS, speeds),
        expected,
        absolute=2e-3,
    )
    np.testing.assert_allclose(
        vi.laws.integrated_restitution(LAW, MASS, speeds),
        LAW.closed_form_restitution(MASS, speeds),
        atol=1e-8,
    )


def test_a_slow_ball_sticks_and_the_status_says_so() -> None:
    ball = vi.Body(mass=MASS, contact_offset=RADIUS)
    plate = vi.rigid_plate()
    stuck = vi.simulate(
        vi.Problem(sphere=ball, plate=plate, laws=(LAW,), speed=0.9 * STICKING_SPEED, impacts=3)
    )
    assert stuck.outcomes == (vi.Outcome.STUCK,)
    assert "sticks" in stuck.status
    assert stuck.impacts["restitution_achieved"].tolist() == [0.0]
    assert stuck.energy["closure_relative"] <= 1e-9
    bounced = vi.simulate(
        vi.Problem(sphere=ball, plate=plate, laws=(LAW,), speed=1.5 * STICKING_SPEED, impacts=9)
    )
    assert bounced.outcomes == (vi.Outcome.STUCK,)
    assert len(bounced.impacts["impact"]) > 1
    history = bounced.history()
    assert history["indentation_m"].min() == pytest.approx(LAW.release_level, rel=1e-6)
    assert history["force_N"].min() == pytest.approx(-PULL_OFF, rel=1e-2)
    assert bounced.energy["closure_relative"] <= 1e-9


@pytest.mark.parametrize("time", [1e-8, 1e-7, 1e-6])
def test_viscous_loss_against_an_integration_in_the_contact_radius(
    agrees: Agrees, time: float
) -> None:
    law = Krijt(
        effective_modulus=MODULUS,
        effective_radius=RADIUS,
        work_of_adhesion=ADHESION,
        dissipation_time=time,
    )
    speed = 4.0 * STICKING_SPEED
    start = (2 * np.pi * ADHESION * RADIUS**2 / MODULUS) ** (1 / 3)
    end = start / 4 ** (2 / 3)

    def slope(a: float) -> float:
        return 2 * a / RADIUS - 0.5 * np.sqrt(2 * np.pi * ADHESION / (MODULUS * a))

    def rates(_: float, state: np.ndarray) -> list[float]:
        a, velocity = state
        pull = 4 * MODULUS * a**3 / (3 * RADIUS) - np.sqrt(8 * np.pi * ADHESION * MODULUS * a**3)
        return [velocity / slope(a), -(pull + 2 * MODULUS * time * a * velocity) / MASS]

    def broken(_: float, state: np.ndarray) -> float:
        return state[0] / end - 1.0 - 1e-4

    broken.terminal, broken.direction = True, -1
    run = solve_ivp(
        rates,
        (0.0, 1.0),
        [start, speed],
        method="Radau",
        rtol=1e-9,
        atol=[1e-16, 1e-12],
        events=broken,
    )
    # what is left between there and the break: nearly no way, so nearly no work
    found = vi.laws.integrated_restitution(law, MASS, speed)
    agrees(
        "viscous dissipation, three dissipation times",
        "coefficient of restitution",
        found,
        -run.y[1, -1] / speed,
        against=SCIPY,
        absolute=2e-6,
    )
