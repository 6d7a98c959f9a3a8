"""What lies off the plate, and which one of a list is wrong, are said by the key as it is
typed, where a case is checked.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import tomli_w
from typer.testing import CliRunner

import vibroimpact as vi
from support import plain_case
from vibroimpact.cases.elastic.meshes import meshes_of
from vibroimpact.cli import app
from vibroimpact.structures.finite_elements.lattice import box_mesh

POINT = {"type": "point", "position": [0.0, 0.0]}
SIZE = [0.52, 0.42, 0.008]


def plate(supports: Any = "clamped", **more: Any) -> dict[str, Any]:
    return plain_case(
        plate={
            "size": SIZE,
            "material": "steel",
            "model": "elastic",
            "modes": 5,
            "supports": supports,
        },
        **more,
    )


def sensors(*several: dict[str, Any]) -> dict[str, Any]:
    return plate(sensors=list(several))


OFF: list[tuple[dict[str, Any], str]] = [
    (
        plate([POINT, {"type": "point", "position": [0.1, 0.5]}]),
        "plate.supports (the 2nd).position: (0.1, 0.5) m lies outside the plate",
    ),
    (
        plate({"type": "patch", "position": [0.3, 0], "radius": 0.02}),
        "plate.supports.position: (0.3, 0) m lies outside the plate",
    ),
    (
        plate({"type": "patch", "position": [0.24, 0], "radius": 0.019}),
        "plate.supports.radius: 0.019 m around (0.24, 0) m is too near the edge of the "
        "plate, which reaches to (0.26, 0.21) m "
        "from its centre; between it and the edge must be at least 0.15 radii",
    ),
    (
        plate({"type": "patch", "position": [0.25, 0], "size": [0.05, 0.05]}),
        "plate.supports.size: (0.05, 0.05) m around (0.25, 0) m reaches",
    ),
    (
        plate({"type": "patches", "spacing": [458.4, 360], "radius": 0.02}),
        "plate.supports.spacing: (458.4, 360) m is wider than the plate, (0.52, 0.42) m; "
        'were mm meant? Write ["458.4 mm", "360 mm"]',
    ),
    (
        plate({"type": "patches", "spacing": [0.4, 0.3], "radius": 20}),
        'were mm meant? Write "20 mm"',
    ),
    (
        plate(
            {
                "type": "bars",
                "spacing": [0.6, 0.3],
                "radius": 0.02,
                "length": 0.3,
                "material": "steel",
            }
        ),
        "plate.supports.spacing: (0.6, 0.3) m is wider than the plate",
    ),
    (
        plate({"type": "spring", "position": [0.2, 0], "stiffness": 1e6, "radius": 0.1}),
        "plate.supports.radius: 0.1 m around (0.2, 0) m",
    ),
    (
        plate({"type": "set", "name": "legs"}),
        'plate.supports: a plate that is meshed here has no set "legs"',
    ),
    (
        sensors({"name": "a1", "position": [100, 50]}),
        'sensors."a1".position: (100, 50) m lies outside the plate',
    ),
    (sensors({"name": "a1", "position": [100, 50]}), 'were mm meant? Write ["100 mm", "50 mm"]'),
    (
        sensors({"name": "a1", "position": "tip"}),
        'sensors."a1".position: only a plate with a mesh file has sets, such as "tip"',
    ),
    (
        plate(drop={"height": 1.0, "position": [100, 50]}),
        "drop.position: (100, 50) m lies outside the plate, which reaches "
        "to (0.26, 0.21) m; were mm",
    ),
    (
        plain_case(sphere__radius=25),
        'so it must be greater than the radius, 25 m; were mm meant? Write sphere.radius = "25 mm"',
    ),
]


@pytest.mark.parametrize(("case", "message"), OFF, ids=[message[:40] for _, message in OFF])
def test_what_lies_off_the_plate_is_refused_before_anything_is_computed(
    case: dict[str, Any], message: str
) -> None:
    with pytest.raises(vi.InputError) as raised:
        vi.case_of(case)
    assert message in str(raised.value)


@pytest.mark.parametrize(
    "supports",
    [
        {"type": "patch", "position": [0.24, 0.0], "radius": 0.0173},
        {"type": "patch", "position": [0.235, 0.0], "size": [0.05, 0.05]},
        {"type": "point", "position": [0.26, -0.21]},
        {"type": "spring", "position": [0.16, 0.0], "stiffness": 1e6, "radius": 0.1},
        {"type": "patches", "spacing": [0.473, 0.373], "radius": 0.02},
    ],
)
def test_what_is_let_through_can_be_held(supports: dict[str, Any]) -> None:
    """The rules here and those of the mesh are the same: at the edge of what is allowed a
    mesh is made and held.
    """
    meshes_of(vi.case_of(plate(supports)))


WHICH: list[tuple[dict[str, Any], str]] = [
    (
        sensors(
            {"name": "a", "position": [0, 0]}, {"name": "b", "position": [0, 0], "filter": "x"}
        ),
        'sensors."b".filter: "x" is not allowed',
    ),
    (
        sensors({"name": "a", "position": [0, 0]}, {"position": [0, 0]}),
        "sensors (the 2nd).name: this key is missing",
    ),
    (
        sensors({"name": "a", "position": [0, 0]}, {"name": "b", "position": [0, "x"]}),
        'sensors."b".position.y: "x" is not a length',
    ),
    (
        sensors({"name": "a", "position": [0, 0], "fce": 1}),
        'sensors."a".fce: unknown key "fce"; [[sensors]] takes name, position',
    ),
    (
        plate([POINT, {"type": "point", "position": [0.0, "x"]}]),
        'plate.supports (the 2nd).position.y: "x" is not a length',
    ),
    (
        plate([POINT, {"type": "pint"}]),
        'plate.supports (the 2nd): there is no support of type "pint"',
    ),
    (plain_case(plate__size=[1, 1, "x"]), 'plate.size.thickness: "x" is not a length'),
]


@pytest.mark.parametrize(("case", "message"), WHICH, ids=[message[:40] for _, message in WHICH])
def test_nobody_has_to_count_from_0(case: dict[str, Any], message: str) -> None:
    with pytest.raises(vi.InputError) as raised:
        vi.case_of(case)
    assert str(raised.value).startswith(message)
    assert len(str(raised.value).splitlines()) == 1


BROUGHT: list[tuple[dict[str, Any], str]] = [
    (plate([{"type": "set", "name": "LEGS"}]), 'plate.supports: the mesh has no set "LEGS"'),
    (
        plate([POINT, {"type": "patch", "position": [0.3, 0], "radius": 0.02}]),
        "plate.supports (the 2nd): the patch at (0.3, 0) m holds no nodes",
    ),
    (
        sensors({"name": "a1", "position": [0.3, 0]}),
        'sensors."a1".position: (0.3, 0) m is not on the body, which reaches from -0.26 to 0.26 m',
    ),
    (
        plate(drop={"height": 1.0, "position": [0.3, 0]}),
        "drop.position: (0.3, 0) m is not on the body",
    ),
]


@pytest.mark.parametrize(("case", "message"), BROUGHT, ids=[message[:40] for _, message in BROUGHT])
@pytest.mark.parametrize("command", ["check", "run", "modes"])
def test_a_mesh_that_is_brought_is_told_file_and_key(
    command: str, case: dict[str, Any], message: str, tmp_path: Path
) -> None:
    vi.meshes.write_abaqus(box_mesh((0.52, 0.42, 0.008), (4, 3, 1)), tmp_path / "plate.inp")
    case["plate"] = {**case["plate"], "size": None, "mesh": "plate.inp"}
    del case["plate"]["size"]
    if case["plate"]["supports"] == "clamped":
        case["plate"]["supports"] = [
            {"type": "point", "position": [x, y], "directions": "xyz"}
            for x, y in ((-0.2, -0.1), (0.2, 0.1), (0.2, -0.1))
        ]
    file = tmp_path / "case.toml"
    file.write_text(tomli_w.dumps(case))
    done = CliRunner().invoke(
        app, [command, str(file), *(["-o", str(tmp_path / "out")] if command != "check" else [])]
    )
    said = str(done.exception)
    assert done.exit_code != 0
    assert said.startswith(f"{file}: {message}")
