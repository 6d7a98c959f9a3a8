"""Where nothing is compiled, the same source gives the same numbers."""

from __future__ import annotations

import itertools
import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import vibroimpact
import vibroimpact as vi
from random_systems import modes_at
from vibrating import drop_on
from vibroimpact.compiled import SWITCH, why_not_compiled
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.contact.laws.jkr import JKR
from vibroimpact.contact.laws.thornton import Thornton
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.structures.modal_model import ModalBasis

LAWS = {
    "hysteretic": HuntCrossley(stiffness=1e9, restitution=0.7),
    "recoiling": AdamsImpact(stiffness=1e9, damping_max=2e3, full_damping_penetration=1e-5),
    "yielding": Thornton(effective_modulus=7e10, effective_radius=0.01, yield_pressure=1e9),
    "sticking": JKR(effective_modulus=1e8, effective_radius=0.01, work_of_adhesion=0.5),
}


def numbers() -> dict[str, dict[str, list[float]]]:
    """The first impacts of each law on a plate with two modes and a compliance in series;
    and oblique drops on a rigid plate, and on it.
    """
    plate = ModalBasis(
        np.array([300.0, 2e3]), np.array([0.01, 0.02]), np.array([1.0, 0.5]), np.zeros((2, 3))
    )
    found = {}
    for name, law in LAWS.items():
        problem = drop_on(law, plate, speed=1.0, impacts=1, quasi_static=QuasiStatic(linear=1e-10))
        found[name] = {
            column: values.tolist() for column, values in vi.simulate(problem).impacts.items()
        }
    moduli = {
        "effective_modulus": 1.8e10,
        "effective_shear_modulus": 1.4e10,
        "effective_radius": 0.025,
    }
    for name, rolling in itertools.product(("mdr", "mindlin", "mindlin-rescale"), (0.0, 0.02)):
        friction = vi.friction.find_friction_law(name)(
            coefficient=0.2, rolling_coefficient=rolling, **moduli
        )
        oblique = vi.Oblique(velocity=(0.6, 0.1), spin=(0.0, -20.0, 5.0), friction=friction)
        problem = drop_on(LAWS["hysteretic"], speed=2.0, impacts=1, oblique=oblique)
        found[f"{name}, {rolling}"] = {
            column: values.tolist() for column, values in vi.simulate(problem).impacts.items()
        }
        if name != "mindlin-rescale":
            moving = replace(plate, along=np.array([[0.3, -0.1], [0.1, 0.2]]))
            on_plate = drop_on(
                LAWS["hysteretic"], moving, speed=2.0, impacts=1, oblique=oblique, tolerance=1e-6
            )
            found[f"{name}, {rolling}, on a plate"] = {
                column: values.tolist() for column, values in vi.simulate(on_plate).impacts.items()
            }
    return found | {"a system": system_numbers()}


def system_numbers() -> dict[str, list[float]]:
    """Impacts of two balls that meet a plate at nearly the same time, and one another."""
    shapes = {"low": np.array([1.0, 0.5]), "side": np.array([0.6, -0.7])}
    plate = vi.MovingBody(mass=np.inf, modes=modes_at(np.array([300.0, 2e3]), 0.01, **shapes))
    ball = vi.MovingBody(mass=0.05, velocity=(0.0, 0.0, -1.0))
    contacts = {
        "low": vi.PointContact(above="first", below="plate", law=LAWS["yielding"], gap=1e-5),
        "side": vi.PointContact(above="second", below="plate", law=LAWS["recoiling"], gap=2e-5),
        "top": vi.PointContact(above="third", below="first", law=LAWS["hysteretic"], gap=5e-5),
    }
    bodies = {"plate": plate, "first": ball, "second": ball, "third": ball}
    response = vi.simulate_system(vi.System(bodies=bodies, contacts=contacts), duration=1e-3)
    impacts = {name: values for name, values in response.impacts.items() if name != "contact"}
    return {name: values.tolist() for name, values in impacts.items()}


def test_plain_python_gives_the_same() -> None:
    if why_not_compiled():
        pytest.skip("nothing is compiled")
    source = Path(vibroimpact.__file__).parents[1]  # that of this process, whatever is installed
    folders = (source, Path(__file__).parent, Path(__file__).parents[2])
    environment = {**os.environ, SWITCH: "0", "PYTHONPATH": os.pathsep.join(map(str, folders))}
    script = "import json; from test_plain_python import numbers; print(json.dumps(numbers()))"
    told = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True
    )
    plain = json.loads(told.stdout)
    for name, columns in numbers().items():
        for column, values in columns.items():
            if column == "sensitivity":  # by finite differences
                continue
            # a top is flat: rounding shifts it further
            within = 1e-9 if column.startswith("time_of_max") else 1e-12
            np.testing.assert_allclose(
                plain[name][column], values, rtol=within, atol=1e-15, err_msg=f"{name}: {column}"
            )
