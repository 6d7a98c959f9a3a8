"""The drag of air, against SciPy's integration of a fall with the drag coefficient of
every moment.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from agreement import Against, Agrees
from support import plain_case
from vibroimpact.cases.validity.air_drag import drag_coefficient, drag_loss
from vibroimpact.results.result import result_of

AGAINST = Against(
    "numerical integration of a fall through air (SciPy)",
    "own independent computation",
    "flight, bounces and shaken plates",
    "Newton's second law with the drag coefficients of Clift and Gauvin 1970 and of "
    "Schiller and Naumann 1935",
)


DENSITY, VISCOSITY, GRAVITY = 1.2, 1.81e-5, 9.80665


def coefficient(reynolds: float) -> float:
    """Schiller and Naumann (1935) to 1000, then 0.44: another formula than the program's,
    which is Clift and Gauvin's.
    """
    return 24.0 / reynolds * (1.0 + 0.15 * reynolds**0.687) if reynolds < 1000.0 else 0.44


def loss(radius: float, density: float, fall: float, drag=coefficient) -> float:
    """Which part of the speed is lost, from the fall itself: the square of the speed over
    the height.
    """

    def slope(_: float, square: np.ndarray) -> list[float]:
        speed = max(float(square[0]), 1e-30) ** 0.5
        reynolds = max(DENSITY * speed * 2 * radius / VISCOSITY, 1e-9)
        return [2 * (GRAVITY - 0.375 * DENSITY / density * drag(reynolds) / radius * speed**2)]

    end = solve_ivp(slope, (0.0, fall), [1e-12], method="LSODA", rtol=1e-9, atol=1e-14).y[0, -1]
    return 1.0 - float(end / (2 * GRAVITY * fall)) ** 0.5


DROPS = [
    (0.025, 1380, 3.975),
    (0.002, 1250, 3.998),
    (0.01, 1000, 10.0),
    (0.05, 2700, 50.0),
    (0.0005, 1380, 1.0),
    (1e-4, 2500, 1.0),
    (2e-5, 2500, 0.1),
]


@pytest.mark.parametrize(("radius", "density", "fall"), DROPS)
def test_the_speed_lost(agrees: Agrees, radius: float, density: float, fall: float) -> None:
    """Within 5 % of itself of an integration with the same coefficient, and 15 % of one
    with another published one.
    """
    found = float(drag_loss(radius, density, fall, GRAVITY))
    same = loss(radius, density, fall, lambda reynolds: float(drag_coefficient(reynolds)))
    agrees(
        "sphere radii 20 μm to 50 mm, error estimate of a run, same drag coefficient",
        "relative loss of approach speed by drag",
        found,
        same,
        relative=0.05,
    )
    agrees(
        "sphere radii 20 μm to 50 mm, error estimate of a run, drag "
        "coefficient of Schiller and Naumann",
        "relative loss of approach speed by drag",
        found,
        loss(radius, density, fall),
        relative=0.15,
    )


def test_the_papers_drop_and_a_pebble_are_doubted() -> None:
    """1.2 % of the speed in the paper's drop; 13.5 % of a pebble of 2 mm from 4 m, of a
    density of 1250 kg/m^3.
    """
    (paper,) = (
        doubt
        for doubt in result_of(vi.simulate(vi.load_case("paper:type1-theory"))).doubts
        if "air" in doubt
    )
    assert "1.2 % slower" in paper
    pebble = {"density": 1250, "youngs_modulus": 2e9, "poissons_ratio": 0.3}
    case = vi.case_of(
        plain_case(
            sphere={"radius": 0.002, "material": pebble}, drop={"height": 4.0}, run={"impacts": 1}
        )
    )
    (doubt,) = (doubt for doubt in result_of(vi.simulate(case)).doubts if "air" in doubt)
    part = loss(0.002, 1250, 3.998, lambda reynolds: float(drag_coefficient(reynolds)))
    assert abs(float(doubt.split("would be ")[1].split(" %")[0]) - 100 * part) < 0.3


def test_a_speed_is_no_fall() -> None:
    case = vi.case_of(plain_case(drop={"speed": 8.8}))
    assert not any("air" in doubt for doubt in result_of(vi.simulate(case)).doubts)
