"""Results of runs of every kind that is shown: bodies, supports, laws and ends."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import vibroimpact as vi
from support import plain_case
from vibrating import drop_on, random_modes
from vibroimpact.cases.build import resolved_case
from vibroimpact.results.result import Result, result_of
from vibroimpact.structures.finite_elements.lattice import box_mesh

HOSTILE = "<script>alert(1)</script>\"'&<b>"
"""What must be shown as it is."""

SIZE = [0.3, 0.2, 0.01]


def elastic(supports: Any = "clamped", **changes: object) -> dict:
    """A case of an elastic plate that is held in a way."""
    plate = {
        "model": "elastic",
        "material": "steel",
        "size": SIZE,
        "modes": 6,
        "damping": 0.02,
        "mesh": {"element_size": 0.05},
    }
    drop = {"height": 0.1, "position": [0.02, 0.01]}
    return plain_case(
        **{"plate": {**plate, "supports": supports}, "drop": drop, "run": {"impacts": 2}, **changes}
    )


def sensor(name: str, place: tuple[float, float] = (0.1, 0.05), **more: object) -> dict:
    return {"name": name, "position": list(place), "rate": 20e3, **more}


CASES: dict[str, Callable[[], dict]] = {
    "a sphere on a half space": plain_case,
    "a plate of a size": lambda: plain_case(plate__size=SIZE, drop__position=[0.05, -0.02]),
    "a plate that is rigid": lambda: plain_case(plate__material="rigid"),
    "a sphere below": lambda: plain_case(plate={"material": "steel", "radius": 0.04}),
    "a sphere below that is free": lambda: plain_case(
        plate={"material": "steel", "radius": 0.01, "supports": "free"},
        drop={"speed": 1.0, "gravity": 0.0},
        run={"impacts": 1},
    ),
    "an instantaneous law": lambda: plain_case(contact={"law": "newton", "restitution": 0.5}),
    "an instantaneous law without gravity": lambda: plain_case(
        contact={"law": "newton", "restitution": 0.5},
        drop={"speed": 1.0, "gravity": 0.0},
        run={"impacts": 1},
    ),
    "no impact": lambda: plain_case(run={"duration": 0.1}),
    "rest": lambda: plain_case(
        contact={"law": "hunt-crossley", "restitution": 0.3},
        drop={"height": 0.05},
        run={"impacts": "all"},
    ),
    "a capture": lambda: plain_case(
        sphere={"radius": "1 um", "material": "glass"},
        plate={"material": "glass"},
        drop={"speed": 0.01, "gravity": 0.0},
        contact={"law": "jkr", "work_of_adhesion": 1.0},
        run={"impacts": 1},
    ),
    "a dent": lambda: plain_case(
        contact={"law": "walton-braun", "stiffness": 1e7, "restitution": 0.6}
    ),
    "an elastic sphere": lambda: plain_case(
        sphere={
            "radius": 0.025,
            "material": "steel",
            "model": "elastic",
            "modes": 3,
            "mesh": {"elements_across": 4},
        },
        run={"impacts": 1},
    ),
    "an elastic plate without impact": lambda: elastic(
        run={"duration": 0.02}, sensors=[sensor("a1")]
    ),
    "a free plate": lambda: elastic(
        "free", drop={"speed": 1.0, "gravity": 0.0, "position": [0.02, 0.01]}, run={"impacts": 1}
    ),
    "sensors": lambda: elastic(
        sensors=[sensor("a1"), sensor("a2"), sensor("v", (-0.1, 0.0), quantity="velocity")]
    ),
    "hostile names": lambda: elastic(
        name=HOSTILE,
        sphere__material={
            "name": HOSTILE,
            "density": 2600,
            "youngs_modulus": 50e9,
            "poissons_ratio": 0.25,
        },
        plate__material={
            "name": f"{HOSTILE}2",
            "density": 7850,
            "youngs_modulus": 210e9,
            "poissons_ratio": 0.3,
        },
        sensors=[sensor(HOSTILE), sensor("$\\frac{$", (0.0, 0.05)), sensor("a" * 200)],
    ),
}

_BAR = {
    "type": "bar",
    "position": [0.1, 0.05],
    "radius": 0.008,
    "length": 0.05,
    "material": "steel",
}
_CORNERS = {"spacing": [0.24, 0.14], "radius": 0.02}
_SPRING = {"type": "spring", "stiffness": 1e5, "horizontal_stiffness": 1e5}

SUPPORTS: dict[str, Any] = {
    "free": "free",
    "clamped": "clamped",
    "simply supported": "simply-supported",
    "two edges": [
        {"type": "edge", "edge": "x-min", "condition": "clamped"},
        {"type": "edge", "edge": "y-max", "condition": "simply-supported"},
    ],
    "patches": {"type": "patches", **_CORNERS},
    "patches of both kinds": [
        {"type": "patch", "position": [-0.1, 0.0], "size": [0.04, 0.15]},
        {"type": "patch", "position": [0.1, 0.0], "radius": 0.03},
    ],
    "bars": {"type": "bars", **_CORNERS, "length": 0.05, "material": "steel"},
    "a bar and points": [
        _BAR,
        {"type": "point", "position": [-0.1, -0.07], "directions": "xyz"},
        {"type": "point", "position": [0.1, -0.07]},
    ],
    "springs": [
        {**_SPRING, "position": [-0.1, -0.07], "radius": 0.01},
        {**_SPRING, "position": [0.1, -0.07]},
    ],
}
"""Supports of every kind, but for the sets of a mesh that was brought."""

MADE: dict[str, Callable[[], vi.Problem]] = {
    "made in Python": lambda: vi.Problem(
        sphere=vi.Body(mass=0.1, contact_offset=0.02),
        plate=vi.rigid_plate(),
        laws=(vi.laws.find_contact_law("hertz")(stiffness=1e8),),
        height=0.5,
        impacts=2,
    ),
    "modes made in Python": lambda: drop_on(
        vi.laws.find_contact_law("hertz")(stiffness=5e8),
        random_modes(3, 10, 150.0, 15e3, 1.2, 0.02),
        impacts=2,
    ),
}

BROUGHT = "a mesh that was brought"
RUNS = [*CASES, *MADE, BROUGHT]


@cache
def run_of(name: str) -> Result:
    """Return the result of a run of `RUNS`."""
    if name == BROUGHT:
        with TemporaryDirectory() as folder:
            return _result(_brought(Path(folder)))
    return result_of(vi.simulate(MADE[name]())) if name in MADE else _result(CASES[name]())


def _result(case: dict) -> Result:
    return result_of(vi.simulate(vi.case_of(case)))


def held(name: str) -> Result:
    """Return a result whose case has the supports of a name; what was computed is that of
    a clamped plate.
    """
    return replace(run_of("sensors"), case=resolved_case(vi.case_of(elastic(SUPPORTS[name]))))


def _brought(folder: Path) -> dict:
    mesh = box_mesh((0.3, 0.2, 0.02), (6, 4, 1), "hex20")
    left = (mesh.nodes[:, 0] < mesh.nodes[:, 0].min() + 1e-9).nonzero()[0]
    vi.meshes.write_abaqus(vi.Mesh(mesh.nodes, mesh.blocks, {"root": left}), folder / "plate.inp")
    plate = {
        "material": "steel",
        "model": "elastic",
        "modes": 6,
        "damping": 0.02,
        "mesh": str(folder / "plate.inp"),
    }
    return elastic(
        plate={**plate, "supports": {"type": "set", "name": "root"}},
        drop={"height": 0.1, "position": [0.1, 0.05]},
    )
