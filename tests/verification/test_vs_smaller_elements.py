"""The largest force on thin plates with the default mesh against the same with elements of three
thicknesses: what is stated of the mesh.

Elements of a thin plate are many thicknesses large by default, and too stiff next to a force. The
same number of modes is kept, so that nothing but the mesh differs. All contacts end before the
highest mode has turned: what the modes leave out is in series with the law, with the error of the
mesh.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.cases.validity.plate_mesh import plate_mesh_error

AGAINST = Against(
    "same plate with elements of three thicknesses",
    "consistency",
    "impacts on vibrating bodies",
    "convergence with the size of plate elements; no external reference",
)

THICKNESS = 0.001
SUPPORTS = ["free", "simply-supported", "clamped"]
BALLS = [(0.001, 1.0), (0.002, 2.0)]
"""Radius [m] and speed [m/s]."""


@cache
def drop(
    supports: str, modes: int, radius: float, speed: float, size: float | None = None
) -> vi.Response:
    plate: dict[str, Any] = {
        "size": [0.06, 0.05, THICKNESS],
        "material": "steel",
        "model": "elastic",
        "supports": supports,
        "modes": modes,
    }
    if size:
        plate["mesh"] = {"element_size": size}
    case = {
        "sphere": {"radius": radius, "material": "steel"},
        "plate": plate,
        "drop": {"speed": speed, "position": [0.0065, 0.0035], "gravity": 0.0},
        "contact": {"law": "hertz"},
        "run": {"impacts": 1},
    }
    return vi.simulate(vi.case_of(case))


@pytest.mark.slow
@pytest.mark.parametrize(("radius", "speed"), BALLS)
@pytest.mark.parametrize("modes", [12, 40])
@pytest.mark.parametrize("supports", SUPPORTS)
def test_the_stated_error_of_the_mesh(
    agrees: Agrees, supports: str, modes: int, radius: float, speed: float
) -> None:
    """From 0.6 to 1.2 times the true one."""
    found, fine = (drop(supports, modes, radius, speed, size) for size in (None, 3.0 * THICKNESS))
    error = float(found.impacts["max_force_N"][0] / fine.impacts["max_force_N"][0]) - 1.0
    assert error > 0.003
    stated = plate_mesh_error(found.problem.facts, found.impacts) - plate_mesh_error(
        fine.problem.facts, fine.impacts
    )
    assert stated < 1.2 * error
    agrees(
        "steel balls on thin steel plates",
        "error of the largest force by the mesh, as stated",
        stated,
        error,
        relative=0.4,
    )
