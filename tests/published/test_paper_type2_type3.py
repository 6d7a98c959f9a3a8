"""The paper's Types 2 and 3 with a local element identified from Type 2 alone: what it prints, and
what follows.

"Study on the Vibroimpact Response of the Particle Elastic Impact on the Metal Plate", Shock and
Vibration. Its Type 2 can't be had from any documented setting; a spring and a dashpot in series
with Adams' IMPACT that give Type 2's largest force and rebound predict Type 3. Its printed numbers
(P), and those of another program for the same identified model (I: k = 1.20e6 N/m, c = 586 N s/m,
patches of 20 mm):

    force  rebound  plate's centre of mass: displacement, velocity, acceleration   strain   kinetic energy
    P   3680.223 N   0.18278 m   1e-4 m     0.1 m/s     200 m/s2    0.13225 J   0.29412 J
    I   3465 N       0.200 m     9.1e-5 m   0.090 m/s   244 m/s2    0.116 J     -

The printed kinetic energy is two and a half times what the model gives, and does not go with the
strain energy printed beside it.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees

AGAINST = Against(
    "the paper, Type 3 (elastic sphere on an elastic plate), with the local element of Type 2",
    "published computation",
    "impacts on vibrating bodies",
    "Study on the Vibroimpact Response of the Particle Elastic Impact on the Metal Plate, "
    "Shock and Vibration",
)
FITTED = Against(
    "the paper, Type 2 (elastic sphere on a rigid plate), to which the local element is fitted",
    "fitted to published numbers",
    "impacts on vibrating bodies",
    "Study on the Vibroimpact Response of the Particle Elastic Impact on the Metal Plate, "
    "Shock and Vibration; the acceleration follows from the force",
)
OTHER = Against(
    "modal integration with the same local element",
    "own independent computation",
    "impacts on vibrating bodies",
    "separate program with the identified model: k = 1.20e6 N/m, c = 586 N s/m, support "
    "patches of 20 mm radius",
)


FORCE, REBOUND, SPEED = 3582.036, 0.26228, 8.826664149
PRINTED = {
    "max_force_N": 3680.223,
    "rebound_height_m": 0.18278,
    "plate_displacement_m": 1e-4,
    "plate_velocity_m_s": 0.1,
    "plate_acceleration_m_s2": 200.0,
    "plate_strain_J": 0.13225,
}
QUANTITIES = {
    "max_force_N": ("maximum contact force", "N"),
    "rebound_height_m": ("rebound height", "m"),
    "plate_displacement_m": ("maximum plate displacement", "m"),
    "plate_velocity_m_s": ("maximum plate velocity", "m/s"),
    "plate_acceleration_m_s2": ("maximum plate acceleration", "m/s²"),
    "plate_strain_J": ("maximum plate strain energy", "J"),
}
IDENTIFIED = {
    "max_force_N": 3465.0,
    "rebound_height_m": 0.200,
    "plate_displacement_m": 9.1e-5,
    "plate_velocity_m_s": 0.090,
    "plate_acceleration_m_s2": 244.0,
    "plate_strain_J": 0.116,
}


def shipped(name: str, **plate: Any) -> vi.Problem:
    """A shipped case with one impact and no sensors; `plate` changes keys of its plate."""
    case = tomllib.loads(
        (files("vibroimpact") / "cases" / "library" / "paper" / f"{name}.toml").read_text()
    )
    case.pop("sensors", None)
    case["plate"].update(plate)
    return vi.case_of({**case, "run": {"impacts": 1}}).to_problem()


@cache
def identified(
    radius: str = "20 mm", modes: int = 40, element_size: float = 0.12
) -> dict[str, float]:
    """What is predicted of Type 3: the largest magnitude of everything."""
    supports = {"type": "patches", "spacing": ["458.4 mm", "360 mm"], "radius": radius}
    response = vi.simulate(
        shipped(
            "type3-identified", modes=modes, supports=supports, mesh={"element_size": element_size}
        )
    )
    history = response.history()
    found = {
        name: float(np.abs(values).max())
        for name, values in history.items()
        if name.startswith("plate")
    }
    return found | {
        name: float(response.impacts[name][0]) for name in ("max_force_N", "rebound_height_m")
    }


def test_identified_meets_type_2(agrees: Agrees) -> None:
    """Force and rebound to 1e-8; stiffness and damping as another program found them,
    which let the sphere leave at zero indentation.
    """
    problem = shipped("type2-identified")
    assert problem.local_element is not None
    assert problem.local_element == pytest.approx((1.20e6, 586.0), rel=0.04)
    impacts = vi.simulate(problem).impacts
    force, height, acceleration = (
        impacts[name] for name in ("max_force_N", "rebound_height_m", "max_acceleration_m_s2")
    )
    case = "Type 2, local element identified from it"
    agrees(case, "maximum contact force", force, FORCE, unit="N", against=FITTED, relative=1e-8)
    agrees(case, "rebound height", height, REBOUND, unit="m", against=FITTED, relative=1e-8)
    agrees(
        case,
        "maximum acceleration",
        acceleration,
        39656.0,
        unit="m/s²",
        against=FITTED,
        relative=5e-4,
    )


def test_type_3_is_predicted(agrees: Agrees) -> None:
    """Within 3 % of another program with the same model; force and rebound within 12 % of
    what is printed, the plate within 25 %.
    """
    found = identified()
    for name, value in IDENTIFIED.items():
        quantity, unit = QUANTITIES[name]
        agrees(
            "Type 3, same local element",
            quantity,
            found[name],
            value,
            unit=unit,
            against=OTHER,
            relative=0.03,
        )
    for name, value in PRINTED.items():
        quantity, unit = QUANTITIES[name]
        within = 0.12 if name in ("max_force_N", "rebound_height_m") else 0.25
        agrees(
            "Type 3, predicted with the local element of Type 2",
            quantity,
            found[name],
            value,
            unit=unit,
            relative=within,
        )
    assert found["plate_potential_J"] < 0.015  # as printed
    assert found["plate_kinetic_J"] < 0.5 * 0.29412


@pytest.mark.slow
def test_the_radius_of_the_patches_matters_little(population: Callable[..., int]) -> None:
    """Which the paper does not print. From 10 to 26 mm, the largest that the plate has
    room for: force and rebound 1 %, the plate 16 %.
    """
    radii = ("10 mm", "26 mm", "15 mm", "20 mm", "25 mm")  # the extremes first
    tables = [identified(radius, 200, 0.04) for radius in radii[: population(5, share=3)]]
    for name, spread in {
        "max_force_N": 0.004,
        "rebound_height_m": 0.01,
        "plate_strain_J": 0.02,
        "plate_displacement_m": 0.18,
    }.items():
        values = [table[name] for table in tables]
        assert max(values) / min(values) < 1.0 + spread, name


def test_superposed_is_what_a_multibody_program_gives() -> None:
    """Far from what the paper prints for Type 2, as it is far from finite elements; and
    only as damped as its default damping makes it.
    """
    case = tomllib.loads(
        (files("vibroimpact") / "cases" / "library" / "paper" / "type2-superposed.toml").read_text()
    )
    case["sphere"]["modes"] = 20
    response = vi.simulate(vi.case_of({**case, "run": {"impacts": 1}}))
    assert response.energy["sphere_damping_J"] > 0.01 * response.energy["input_J"]  # critical
    assert response.impacts["max_force_N"][0] > 2.0 * FORCE
    height = 0.025 + response.impacts["separation_speed_m_s"][0] ** 2 / (2.0 * 9.8)
    assert height > 2.0 * REBOUND
    assert math.isclose(response.impacts["approach_speed_m_s"][0], SPEED, rel_tol=1e-9)
