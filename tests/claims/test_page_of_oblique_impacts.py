"""Numbers of the page on oblique impacts."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import vibroimpact as vi
from stated_numbers import says
from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core.tangential_history import SPRINGS

PAGE = "docs/oblique.md"
SPEED, COEFFICIENT = 3.85, 0.092
ANGLES = np.array([2.03, 3.93, 9.63, 20.08, 30.22, 39.30, 49.55, 59.84])
MEASURED = np.array([0.794, 0.745, 0.673, 0.596, 0.688, 0.772, 0.847, 0.902])
"""Kharaz, Gorham and Salman 2001: angles from the normal [deg] and tangential restitutions."""


def alumina_on_glass(friction: str) -> vi.Problem:
    """Return the impact of the page on a rigid plate under a friction law, along the normal."""
    case = {
        "sphere": {
            "radius": "2.5 mm",
            "material": {"density": 4000, "youngs_modulus": "380 GPa", "poissons_ratio": 0.23},
        },
        "plate": {
            "material": {"density": 2500, "youngs_modulus": "70 GPa", "poissons_ratio": 0.25}
        },
        "drop": {"speed": SPEED, "angle": 0.1, "gravity": 0},
        "contact": {
            "law": "lankarani-nikravesh",
            "restitution": 0.98,
            "friction": {"law": friction, "coefficient": COEFFICIENT},
        },
        "run": {"impacts": 1},
    }
    return vi.case_of(case).to_problem()


@cache
def tangential_restitution(friction: str) -> Floats:
    """Return the tangential restitution at the angles of the measurements."""
    problem = alumina_on_glass(friction)
    assert problem.oblique is not None
    along, down = SPEED * np.sin(np.radians(ANGLES)), SPEED * np.cos(np.radians(ANGLES))
    drops = replace(problem, speed=down, oblique=replace(problem.oblique, velocity=(along, 0.0)))
    return np.asarray(vi.tabulate(drops).impacts["tangential_restitution"][:, 0])


def test_measured_and_computed() -> None:
    laws = ("mdr", "mindlin", "mindlin-rescale", "mindlin-force", "coulomb")
    computed = np.stack([tangential_restitution(law) for law in laws])
    for angle, measured, row in zip(ANGLES, MEASURED, computed.T, strict=True):
        says(PAGE, "| {}° | {} | {} | {} | {} | {} | {} |", angle, measured, *row)
    error = np.abs(computed - MEASURED)
    says(
        PAGE,
        "| mean error of the first four | | {} | {} | {} | {} | {} |",
        *error[:, :4].mean(axis=1),
    )
    says(PAGE, "| of the last four | | {} | {} | {} | {} | {} |", *error[:, 4:].mean(axis=1))
    says(
        PAGE,
        "deviate from the measurements by up to {}",
        error[1:4, ANGLES < 30.0].max(),
    )


def test_ball_whose_spin_a_moment_stops() -> None:
    friction = {"law": "mindlin", "coefficient": 0.2, "rolling_coefficient": 0.02}
    case = {
        "sphere": {"radius": "10 mm", "material": "steel"},
        "plate": {"material": "steel"},
        "drop": {"velocity": [0.01, 0.0, -2.0]},
        "contact": {"law": "hertz", "friction": friction},
        "run": {"impacts": 1},
    }
    rigid = vi.case_of(case).to_problem()
    returns = [
        1e3 * float(vi.simulate(problem).impacts["separation_velocity_x_m_s"][0])
        for problem in (rigid, replace(rigid, local_element=(1e18, 1e6)))
    ]
    says(PAGE, "falls on steel at {} m/s with {} mm/s along the plate", 2.0, 10.0)
    says(
        PAGE,
        "coefficients {} and {}) returns with {} mm/s",
        friction["coefficient"],
        friction["rolling_coefficient"],
        returns[0],
    )
    says(
        PAGE,
        "returns with {} mm/s from a plate with a local stiffness of {} N/m as well",
        returns[1],
        1e18,
    )


def friction_left(ratio: float) -> float:
    """Return the friction of a contact that slides and twists over that of sliding alone,
    by quadrature of Hertz's pressure.
    """
    distance = (np.arange(2000) + 0.5) / 2000
    angle = 2.0 * np.pi * (np.arange(2000) + 0.5) / 2000
    along = 1.0 - ratio * distance[:, None] * np.sin(angle)
    across = ratio * distance[:, None] * np.cos(angle)
    weight = distance * np.sqrt(1.0 - distance**2)
    return float((weight * (along / np.hypot(along, across)).mean(axis=1)).sum() / weight.sum())


def test_friction_that_twisting_takes() -> None:
    lower = [100.0 * (1.0 - friction_left(ratio)) for ratio in (0.3, 1.0)]
    says(
        PAGE,
        "The friction is lower by {} % at q = {}, and by {} % at q = 1",
        lower[0],
        0.3,
        lower[1],
    )


def test_where_single_springs_part_from_mdr() -> None:
    """Each of the three is above it at every tenth of a degree from 0.5 to 27 degrees."""
    angles = np.radians(np.linspace(0.5, 27.0, 266))

    def curve(friction: str) -> Floats:
        problem = alumina_on_glass(friction)
        assert problem.oblique is not None
        drops = replace(
            problem,
            speed=SPEED * np.cos(angles),
            oblique=replace(problem.oblique, velocity=(SPEED * np.sin(angles), 0.0)),
        )
        return np.asarray(vi.tabulate(drops).impacts["tangential_restitution"][:, 0])

    mdr = curve("mdr")
    assert all((curve(law) > mdr).all() for law in ("mindlin", "mindlin-rescale", "mindlin-force"))
    says(PAGE, "the curves of single springs lie above it below {} degrees", np.degrees(angles[-1]))


def test_springs_in_two_directions() -> None:
    says(PAGE, "is computed with {} springs over the contact radius", SPRINGS)


def test_gravity_turns_the_slip() -> None:
    says(PAGE, "(about {} mrad in 0.1 ms at 1 m/s)", 1e3 * vi.Problem.gravity * 1e-4 / 1.0)


@pytest.mark.slow
def test_what_limits_the_motion_along_an_elastic_plate() -> None:
    """Drops whose friction is computed with a tolerance of 1e-9, and of 1e-13."""
    random = np.random.default_rng(5)
    of_velocity, of_energy = [], []
    for _ in range(8):
        plate = {
            "size": [0.2, 0.15, random.uniform(0.003, 0.01)],
            "material": "steel",
            "model": "elastic",
            "modes": 20,
            "damping": 0.01,
        }
        case = {
            "sphere": {"radius": random.uniform(0.005, 0.02), "material": "steel"},
            "plate": {**plate, "supports": "simply-supported"},
            "drop": {
                "speed": random.uniform(0.3, 3.0),
                "angle": f"{random.uniform(5, 70)} deg",
                "position": [random.uniform(-0.05, 0.05), 0.02],
            },
        }
        coefficient = random.uniform(0.1, 0.3)
        for law in ("mdr", "mindlin"):
            contact = {
                "law": "hunt-crossley",
                "restitution": 0.8,
                "friction": {"law": law, "coefficient": coefficient},
            }
            usual, exact = (
                vi.simulate(
                    vi.case_of(
                        {
                            "schema_version": 1,
                            **case,
                            "contact": contact,
                            "run": {"impacts": 1, "tolerance": one},
                        }
                    )
                ).impacts
                for one in (1e-9, 1e-13)
            )
            for axis in "xy":
                name = f"separation_velocity_{axis}_m_s"
                of_velocity.append(abs(usual[name][0] - exact[name][0]) / case["drop"]["speed"])
            of_energy.append(abs(usual["friction_lost_J"][0] / exact["friction_lost_J"][0] - 1.0))
    says(
        PAGE,
        "from {} to {} velocities along the plate after an impact change by less than {} of "
        "the approach speed",
        1e-9,
        1e-13,
        2e-4,
    )
    assert max(of_velocity) < 2e-4
    says(PAGE, "and the energy lost by friction by less than {} %", 1.0)
    assert 1e-6 < max(of_energy) < 0.01
