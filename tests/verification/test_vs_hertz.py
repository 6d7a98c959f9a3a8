"""Against Hertz's closed form of an undamped power-law impact without gravity. Tolerance 1e-8.

F = K delta^n: delta_max = ((n+1) m v^2 / 2K)^(1/(n+1)), T = 2/(n+1) B(1/(n+1), 1/2) delta_max/v;
for n = 1.5 the factor of delta_max/v is 2.9432751843 (Johnson 1985, section 11.4).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.special import beta

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.contact.laws.hertz import Hertz

AGAINST = Against(
    "Hertz impact, closed form",
    "closed form",
    "Hertz and elastic contact",
    "Johnson, Contact Mechanics, 1985, section 11.4",
)


def impact(stiffness: float, exponent: float, mass: float, speed: float) -> vi.Response:
    ball = vi.Body(mass=mass, contact_offset=0.1)
    law = Hertz(stiffness=stiffness, exponent=exponent)
    return vi.simulate(
        vi.Problem(
            sphere=ball, plate=vi.rigid_plate(), laws=(law,), speed=speed, gravity=0.0, impacts=1
        )
    )


def agrees_with_closed_form(
    agrees: Agrees, case: str, row: dict, stiffness: Any, exponent: float, mass: float, speed: Any
) -> None:
    """Compare impacts, one or an array of them, with the closed form."""
    depth = ((exponent + 1) * mass * speed**2 / (2 * stiffness)) ** (1 / (exponent + 1))
    duration = 2 / (exponent + 1) * beta(1 / (exponent + 1), 0.5) * depth / speed
    agrees(case, "maximum indentation", row["max_indentation_m"], depth, unit="m", relative=1e-8)
    agrees(case, "contact duration", row["duration_s"], duration, unit="s", relative=1e-8)
    agrees(
        case,
        "maximum contact force",
        row["max_force_N"],
        stiffness * depth**exponent,
        unit="N",
        relative=1e-8,
    )
    agrees(case, "coefficient of restitution", row["restitution_achieved"], 1.0, relative=1e-8)


@pytest.mark.parametrize("exponent", [1.0, 1.2, 1.5, 2.0, 2.2, 3.0])
@pytest.mark.parametrize("speed", [1e-3, 1.0, 300.0])
def test_closed_form(agrees: Agrees, exponent: float, speed: float) -> None:
    stiffness, mass = 3.7e8, 0.21
    row = impact(stiffness, exponent, mass, speed).impacts
    case = "six force exponents, approach speeds 1 mm/s to 300 m/s"
    agrees_with_closed_form(agrees, case, row, stiffness, exponent, mass, speed)


@pytest.mark.parametrize("exponent", [1.0, 1.2, 1.5, 2.0, 3.0])
def test_closed_form_of_a_table(agrees: Agrees, exponent: float) -> None:
    stiffness, mass, speed = np.geomspace(1e6, 1e12, 7), 0.21, np.geomspace(1e-2, 44.0, 7)
    law, ball = (
        Hertz(stiffness=stiffness, exponent=exponent),
        vi.Body(mass=mass, contact_offset=0.1),
    )
    problem = vi.Problem(
        sphere=ball,
        plate=vi.rigid_plate(),
        laws=(law,),
        speed=speed,
        gravity=0.0,
        impacts=1,
        tolerance=1e-8,
    )
    row = {name: column[:, 0] for name, column in vi.tabulate(problem).impacts.items()}
    case = "batch of drops, five force exponents"
    agrees_with_closed_form(agrees, case, row, stiffness, exponent, mass, speed)


def test_duration_factor_of_a_sphere(agrees: Agrees) -> None:
    row = impact(1e6, 1.5, 1.0, 1.0).impacts
    agrees(
        "force exponent 1.5",
        "contact duration, in units of maximum indentation over approach speed",
        row["duration_s"] / row["max_indentation_m"],
        2.9432751843,
        relative=1e-8,
    )


def test_the_papers_sphere_undamped(agrees: Agrees) -> None:
    row = impact(5.1154524848e8, 1.5, 0.09032078879, 8.826664149).impacts
    agrees(
        "the paper's sphere, closed form rounded to 5 or 6 digits",
        "maximum indentation",
        row["max_indentation_m"],
        7.8372e-4,
        unit="m",
        relative=1e-5,
    )
    agrees(
        "the paper's sphere, closed form rounded to 5 or 6 digits",
        "maximum contact force",
        row["max_force_N"],
        11223.5,
        unit="N",
        relative=1e-5,
    )
    agrees(
        "the paper's sphere, closed form rounded to 5 or 6 digits",
        "contact duration",
        row["duration_s"],
        261.335e-6,
        unit="s",
        relative=2e-6,
    )


def test_history_is_symmetric_in_time() -> None:
    response = impact(1e6, 1.5, 1.0, 1.0)
    duration = response.impacts["duration_s"][0]
    times = np.linspace(0.05, 0.45, 9) * duration
    early, late = response.at(times)["force_N"], response.at(duration - times)["force_N"]
    np.testing.assert_allclose(early, late, rtol=1e-5)
