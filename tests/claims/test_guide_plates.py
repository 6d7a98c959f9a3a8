"""Numbers of the guide on the thickness of the plate."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from stated_numbers import says
from support import example, names_of_page
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import numbers_of
from vibroimpact.cases.validity.modes_left_out import _TRUNCATED

PAGE = "docs/guides/plate-thickness.md"
PICTURES = example("pictures_of_guides")


def row(response: vi.Response) -> tuple[float, float, float]:
    """Restitution, largest force [N] and duration [us] of the first impact."""
    found = PICTURES.first_impact(response)
    return found["restitution_achieved"], found["max_force_N"], 1e6 * found["duration_s"]


def limits_of(response: vi.Response) -> dict[str, float]:
    result = vi.result_of(response)
    return {
        name: float(number)
        for name, number in numbers_of(Conditions(result.case, result._drop_summary)).items()
    }


def test_rigid_plate() -> None:
    back, force, duration = row(PICTURES.on_rigid_plate())
    says(PAGE, "| rigid | {} | | {} | {} |", back, force, duration)
    assert not vi.result_of(PICTURES.on_rigid_plate()).doubts
    says(
        PAGE,
        "the pressure is at most {} of that of first yield of the nylon",
        limits_of(PICTURES.on_rigid_plate())["sphere_strength"],
    )


@pytest.mark.slow  # modes of five plates
def test_thicknesses() -> None:
    found = {}
    for thickness in PICTURES.THICKNESSES:
        response = PICTURES.on_plate(thickness)
        assert not vi.result_of(response).doubts
        back, force, duration = row(response)
        found[thickness] = (back, PICTURES.zener(thickness), force, duration)
    says(PAGE, "| 4 | {} | {} | {} | {} |", *found[4.0])
    says(PAGE, "| 6 | {} | {} | {} | {} |", *found[6.0])
    says(PAGE, "| 8 | {} | {} | {} | {} |", *found[8.0])
    says(PAGE, "| 12 | {} | {} | {} | {} |", *found[12.0])
    says(PAGE, "| 20 | {} | {} | {} | {} |", *found[20.0])
    says(PAGE, "from {} at 4 mm to {} at 20 mm", found[4.0][0], found[20.0][0])
    says(PAGE, "the force rises from {} to {2} N", found[4.0][2], found[20.0][2])
    thin = vi.result_of(PICTURES.on_plate(4.0))
    says(
        PAGE,
        "on the plate of 4 mm the {} modes end at {} kHz and do not reach 3/T = {} kHz",
        len(thin.frequencies("plate")),
        1e-3 * thin.frequencies("plate")[-1],
        3e-3 / float(thin.impacts["duration_s"][0]),
    )
    says(
        PAGE,
        "may change the force by {} %; above {} % it gives a warning",
        100 * thin.truncation["plate"],
        100 * _TRUNCATED,
    )


def test_fit_of_zeners_equation() -> None:
    """The restitution of an elastic contact on a dashpot, by SciPy, beside the formula of
    the page.
    """
    inelasticity = np.array(
        [0.006, 0.01, 0.03, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 1.0, 1.5, 2.0, 2.5, 3.0]
    )
    error = np.array([abs(exact(one) - np.exp(-1.72 * one)) for one in inelasticity])
    says(
        PAGE,
        "accurate to {} up to λ = 0.1 and to {} beyond",
        error[inelasticity <= 0.1].max(),
        error.max(),
    )
    says(PAGE, "reduces the restitution by {} % if λ is 0.006", 100.0 * (1.0 - exact(0.006)))


def exact(inelasticity: float) -> float:
    def slopes(_: float, state: np.ndarray) -> list[float]:
        root = np.sqrt(max(state[0], 0.0))
        return [state[1], -root * max(state[0], 0.0) - 1.5 * inelasticity * root * state[1]]

    def apart(time: float, state: np.ndarray) -> float:
        return float(state[0]) if time > 0.1 else 1.0

    apart.terminal = True  # type: ignore[attr-defined]
    return -float(
        solve_ivp(slopes, (0.0, 50.0), [0.0, 1.0], rtol=1e-9, atol=1e-12, events=apart).y[1, -1]
    )


@pytest.mark.slow
def test_program_of_the_page() -> None:
    names = names_of_page(PAGE)
    rock = names["zener"](
        0.008, names["mass"], names["stiffness"], speed=8.83, material=vi.find_material("steel")
    )
    says(PAGE, "zener(0.008, mass, stiffness, 8.83, steel) # {}", rock)
    assert rock == pytest.approx(0.75, abs=0.02)  # a quarter of the speed
    drop = vi.case_of(PICTURES.THICKNESS).to_problem()
    mass, stiffness = float(drop.sphere.mass), float(drop.laws[0].stiffness)
    thickness = np.arange(20, 60)
    speed = PICTURES.first_impact(PICTURES.on_rigid_plate())["approach_speed_m_s"]
    left = [
        names["zener"](1e-3 * one, mass, stiffness, speed=speed, material=vi.find_material("steel"))
        for one in thickness
    ]
    says(
        PAGE,
        "this requires a plate of {} mm",
        float(np.interp(np.exp(-1.72 * 0.006), left, thickness)),
    )


def test_granite_dents_and_cracks() -> None:
    granite = {
        "sphere": {"radius": "25 mm", "material": "granite"},
        "plate": {"material": "steel"},
        "drop": {"height": "1 m"},
        "contact": {"law": "tsuji", "restitution": 0.8},
        "run": {"impacts": 1},
    }
    found = limits_of(vi.simulate(vi.case_of(granite)))
    says(
        PAGE,
        "from 1 m on a rigid plate the pressure is {} times that of first yield of the steel",
        found["plate_strength"],
    )
    says(
        PAGE,
        "the tension beside the contact {} times the tensile strength of granite",
        found["sphere_strength"],
    )
