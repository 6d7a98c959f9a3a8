"""Elastic bodies in cases: what is read, what is refused and how, and what `vibroimpact
modes` writes.
"""

from __future__ import annotations

import csv
import json
import subprocess
import sys
import tomllib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
import tomli_w

import vibroimpact as vi
from support import plain_case
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.cases.elastic.meshes import meshes_of
from vibroimpact.cases.fields.elastic_body import ElementKind
from vibroimpact.cases.fields.supports import EdgeName
from vibroimpact.cli import main
from vibroimpact.structures.finite_elements.lattice import SOLID_KINDS, box_mesh
from vibroimpact.structures.recipe import model_key
from vibroimpact.structures.supports.bar import Bar
from vibroimpact.structures.supports.edge import EDGES
from vibroimpact.structures.supports.patch import Patch

PLATE = {
    "size": ["520 mm", "420 mm", "8 mm"],
    "material": "steel-paper",
    "model": "elastic",
    "supports": "clamped",
    "modes": 4,
}
COARSE = {"element_size": "140 mm"}  # where no frequency is looked at
PATCHES = {"type": "patches", "spacing": ["458.4 mm", "360 mm"], "radius": "20 mm"}


def plate_case(**changes: Any) -> dict:
    """A case with an elastic plate; changes are keys of it."""
    plate = {key: value for key, value in {**PLATE, **changes}.items() if value is not None}
    return plain_case(plate=plate)


FAULTS: list[tuple[dict, str]] = [
    (plate_case(supports=None), "plate.supports: how is the elastic plate held?"),
    (
        plate_case(size=None),
        "plate.size: an elastic plate needs its length, width and thickness, or a mesh",
    ),
    (plate_case(material="rigid"), 'plate.material: "rigid" does not deform'),
    (
        plate_case(model="rigid"),
        'plate.modes: a rigid body does not take it; add model = "elastic"',
    ),
    (plate_case(supports="clampd"), 'plate.supports: "clampd" is not allowed'),
    (plate_case(supports="clampd"), 'Did you mean "clamped"?'),
    (
        plate_case(
            supports={
                "type": "bar",
                "position": [0, 0],
                "radius": 0.01,
                "length": 0.1,
                "material": {
                    "density": 7850,
                    "youngs_modulus": 2e11,
                    "poissons_ratio": 0.3,
                    "foo": 1,
                },
            }
        ),
        'plate.supports.material.foo: unknown key "foo"; it takes density, youngs_modulus, '
        "poissons_ratio,",
    ),
    (
        plate_case(supports={"type": "patchs"}),
        'plate.supports: there is no support of type "patchs"; there are patches, patch,',
    ),
    (
        plate_case(supports=[{"type": "patch", "position": [0, 0]}]),
        "plate.supports: give either radius or size; neither is given",
    ),
    (
        plate_case(supports=[PATCHES, {**PATCHES, "radus": 1}]),
        'plate.supports (the 2nd).radus: unknown key "radus"; it takes spacing, radius',
    ),
    (
        plate_case(supports={**PATCHES, "radius": "20 kg"}),
        'plate.supports.radius: "20 kg" is a mass',
    ),
    (
        plate_case(supports={"type": "edge", "edge": "x", "condition": "clamped"}),
        'plate.supports.edge: "x" is not allowed; it must be "x-min"',
    ),
    (
        plate_case(
            supports={
                "type": "bar",
                "position": [0, 0],
                "radius": 0.02,
                "length": 0.3,
                "material": "rigid",
            }
        ),
        'plate.supports.material: a bar is elastic, and "rigid" has no modulus',
    ),
    (
        plate_case(damping="adams"),
        'plate.damping: "adams" is not allowed; it must be a damping ratio',
    ),
    (plate_case(damping=-0.1), "plate.damping: -0.1 is not allowed; it must be at least 0"),
    (plate_case(damping={"rayleigh": [1.0]}), "plate.damping.rayleigh: it must be a pair, [a, b]"),
    (
        plate_case(damping={"frequencies": [10, 5], "ratios": [0.1, 0.1]}),
        "plate.damping.frequencies: the frequencies of the table must ascend",
    ),
    (
        plate_case(damping={"frequencies": [10], "ratios": [0.1, 0.1]}),
        "plate.damping: 1 frequency and 2 ratios do not make a table",
    ),
    (plate_case(damping="loss-factor"), "needs a loss_factor of the material, and it has none"),
    (plate_case(modes=0), "plate.modes: 0 is not allowed"),
    (plate_case(modes=2.5), "plate.modes: 2.5 is not allowed"),
    (
        plate_case(max_frequency="1 kHz"),
        "plate.modes: give either modes or max_frequency; both are given",
    ),
    (plate_case(modes=None, max_frequency="1 m"), 'plate.max_frequency: "1 m" is a length'),
    (
        plate_case(element="shell"),
        'plate.element: "shell" is not allowed; it must be "plate" or "solid"',
    ),
    (plate_case(mesh={"layers": 2}), 'plate.mesh.layers: element = "plate" does not take it'),
    (
        plate_case(element="solid", mesh={"theory": "thin"}),
        'plate.mesh.theory: element = "solid" does not take it',
    ),
    (
        plate_case(element="solid", mesh={"elements": 100, "element_size": 0.1}),
        "plate.mesh: give either element_size or elements",
    ),
    (plate_case(mesh={"elementsize": 0.1}), 'plate.mesh.elementsize: unknown key "elementsize"'),
    (
        plate_case(mesh="nowhere.bdf"),
        "nowhere.bdf: there is no such file; a mesh is a file of nodes and elements",
    ),
    (plate_case(mesh=3), "plate.mesh: 3 is neither the name of a file nor a table"),
    (
        plate_case(reduction="guyan"),
        'plate.reduction: "guyan" is not allowed; it must be "modal" or "craig-bampton"',
    ),
    (
        plain_case(sphere__modes=3),
        'sphere.modes: a rigid body does not take it; add model = "elastic"',
    ),
    (
        plain_case(sphere__model="elastic", sphere__mesh={"elements_across": 5}),
        "sphere.mesh.elements_across: 5 is not allowed",
    ),
    (
        plain_case(sphere__model="elastic", sphere__max_frequency="2 MHz"),
        "elements across the sphere, and 100 are the most; ask for fewer modes, or give "
        "mesh.elements_across",
    ),
    (
        plain_case(sensors=[{"name": "a", "position": [0, 0], "fce": "upper"}]),
        'sensors."a".fce: unknown key "fce"; [[sensors]] takes name,',
    ),
]


@pytest.mark.parametrize(("case", "message"), FAULTS, ids=[message[:50] for _, message in FAULTS])
def test_wrong_elastic_case(case: dict, message: str) -> None:
    with pytest.raises(vi.InputError) as raised:
        vi.case_of(case)
    assert message in str(raised.value)


FOUND_LATER: list[tuple[dict, str]] = [
    (
        {"supports": {**PATCHES, "radius": "40 mm"}},
        "plate.supports.radius: 0.04 m around (0.2292, 0.18) m reaches beyond the plate, "
        "which reaches to (0.26, 0.21) m from its centre",
    ),
    (
        {
            "supports": [
                {"type": "patch", "position": [x, 0.0], "radius": 0.05} for x in (0.0, 0.08)
            ]
        },
        "plate.supports: the round support at (0, 0) m, radius 0.05 m, is too near to another one",
    ),
    (
        {"supports": {"type": "point", "position": [1.0, 0.0]}},
        "plate.supports.position: (1, 0) m lies outside the plate",
    ),
    (
        {"supports": {"type": "spring", "position": [0.3, 0.0], "stiffness": 1e5}},
        "plate.supports.position: (0.3, 0) m lies outside the plate, "
        "which reaches to (0.26, 0.21) m",
    ),
    (
        {"supports": {"type": "set", "name": "LEGS"}},
        'plate.supports: a plate that is meshed here has no set "LEGS"',
    ),
    (
        {"modes": 20_000, "mesh": {"element_size": "200 mm"}},
        "plate: 20000 modes are not to be had from",
    ),
    ({"modes": None, "max_frequency": 1.0}, "plate.max_frequency: there is no mode below 1 Hz"),
]


@pytest.mark.parametrize(
    ("changes", "message"), FOUND_LATER, ids=[message[:50] for _, message in FOUND_LATER]
)
def test_body_that_cannot_be_made(changes: dict, message: str) -> None:
    with pytest.raises(vi.InputError) as raised:
        vi.compute_modes(vi.case_of(plate_case(**changes)))
    assert message in str(raised.value)


def test_too_large_for_the_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "vibroimpact.structures.finite_elements.free_memory.free_memory", lambda: 1e6
    )
    with pytest.raises(
        vi.InputError,
        match=r"the factors of .* degrees of freedom need about .* GB of memory, and 0.001 GB "
        r"are free",
    ):
        # a plate that no other test has left in memory
        vi.compute_modes(vi.case_of(plate_case(modes=5, size=["520.7 mm", "420 mm", "8 mm"])))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"element": "solid", "mesh": {"element_size": "1 um"}}, "would be more than 250000"),
        ({"element": "solid", "mesh": {"elements": 1_000_000_000}}, "would be more than 1000000"),
        ({"mesh": {"element_size": "1 mm"}}, "would be more than 62500 on this plate"),
    ],
)
def test_far_too_many_elements_are_refused_before_they_are_made(
    changes: dict, message: str
) -> None:
    with pytest.raises(vi.InputError, match=message):
        meshes_of(vi.case_of(plate_case(**changes)))


@pytest.mark.parametrize(
    ("changes", "doubt"),
    [
        (
            {"element": "solid", "mesh": {"kind": "hex8"}},
            "elements of first order, which are far too stiff in bending",
        ),
        ({"damping": 2}, "the damping of the plate is critical or more; a ratio of 0.01 is 1 %"),
        ({"size": [0.5, 0.4, 0.2]}, 'due to the theory of plates; take plate.element = "solid"'),
        ({"size": [520, 420, 8]}, 'write "520 mm", as a bare number is in metres'),
    ],
)
def test_what_is_probably_not_meant_is_doubted(changes: dict, doubt: str) -> None:
    found = vi.compute_modes(vi.case_of(plate_case(**changes)))["plate"]
    assert any(doubt in one for one in found.doubts)


@pytest.mark.slow
def test_a_graded_sphere_has_more_elements_or_is_doubted() -> None:
    sphere = {
        "radius": 0.025,
        "material": "rock-paper",
        "model": "elastic",
        "modes": 5,
        "mesh": {"grading": 4},
    }
    shape = elastic_bodies(vi.case_of(plain_case(sphere=sphere)))["sphere"].recipe.shape
    assert shape.elements_across == 16
    coarse = {**sphere, "mesh": {"grading": 4, "elements_across": 8}}
    doubts = vi.compute_modes(vi.case_of(plain_case(sphere=coarse)))["sphere"].doubts
    assert "its elements are too large" in doubts[0]


_DROP = """
import sys
from pathlib import Path
import vibroimpact as vi
from vibroimpact.cases.costs import describe_costs
from vibroimpact.files.result_folder import write_files, write_summary
from vibroimpact.results.folder import CHECKED_FILES, result_files
from vibroimpact.results.result import result_of
from vibroimpact.results.summary import summary_of
from vibroimpact.runs.paraview import write_paraview

case, folder = vi.load_case(sys.argv[1]), Path(sys.argv[2])
describe_costs(case)
response = vi.simulate(case)
result = result_of(response)
write_files(result_files(result), folder)
write_summary(summary_of(result), folder, CHECKED_FILES)
write_paraview(response, folder / "paraview")
print(*sys.modules)
"""


def modules_of_a_drop(case: str, folder: Path) -> set[str]:
    """The modules that a new process has loaded when it has computed a drop and written
    its data.
    """
    folder.mkdir()
    command = [sys.executable, "-c", _DROP, case, str(folder)]
    return set(
        subprocess.run(
            command, check=True, capture_output=True, text=True, timeout=120
        ).stdout.split()
    )


@pytest.mark.parametrize(
    ("mesh", "remedy"),
    [
        ({"elements": 30}, "give plate.mesh.elements = 102"),
        ({"elements": 60, "layers": 1}, "give plate.mesh.elements = 135"),
        ({"element_size": 0.1}, 'give plate.mesh.element_size = "66.7 mm"'),
    ],
)
def test_a_finer_mesh_is_asked_for_as_the_mesh_was(mesh: dict[str, Any], remedy: str) -> None:
    """An element size was proposed to a mesh of a number of elements, which refuses one."""
    (doubt,) = vi.compute_modes(vi.case_of(plate_case(element="solid", mesh=mesh)))["plate"].doubts
    assert remedy in doubt


def test_a_rigid_case_loads_nothing_that_vibrates(tmp_path: Path) -> None:
    loaded = modules_of_a_drop("paper:type1-theory", tmp_path / "drop")
    assert "vibroimpact.runs.paraview" in loaded
    assert "pint" not in loaded
    # numba loads SciPy's first module alone, to see its version
    assert not {
        name
        for name in loaded
        if name.startswith("scipy.") and not name.startswith(("scipy._", "scipy.version"))
    }
    assert not [name for name in loaded if name.startswith("vibroimpact.dynamics.vibrating")]


@pytest.mark.slow
def test_modes_that_are_stored_load_no_solvers(tmp_path: Path) -> None:
    sphere = {
        "radius": 0.01,
        "material": "steel",
        "model": "elastic",
        "modes": 5,
        "mesh": {"elements_across": 4},
    }
    sensor = {"name": "a1", "position": [0.1, 0.05]}
    plate = {**PLATE, "mesh": COARSE}
    case = plain_case(
        sphere=sphere, plate=plate, sensors=[sensor], drop={"speed": 1.0}, run={"impacts": 1}
    )
    (file := tmp_path / "case.toml").write_text(tomli_w.dumps(case), encoding="utf-8")
    solvers = {"scipy.linalg", "scipy.sparse.linalg", "scipy.sparse.csgraph", "scipy.spatial"}
    assert solvers <= modules_of_a_drop(str(file), tmp_path / "computed")
    loaded = modules_of_a_drop(str(file), tmp_path / "stored")
    assert "scipy.sparse" in loaded
    assert not {*solvers, "skfem", "pint"} & loaded


def test_the_words_of_a_case_are_those_of_the_structures() -> None:
    assert set(get_args(ElementKind)) == set(SOLID_KINDS)
    assert get_args(EdgeName) == EDGES


def test_rigid_bodies_have_no_modes() -> None:
    with pytest.raises(vi.InputError, match="no body of the case is elastic"):
        vi.compute_modes(vi.case_of(plain_case()))


@pytest.mark.parametrize(
    ("supports", "number", "kind"),
    [
        ("free", 0, None),
        ("clamped", 4, None),
        (PATCHES, 4, Patch),
        ({**PATCHES, "type": "bars", "length": 0.3, "material": "steel"}, 4, Bar),
        (
            [
                {"type": "edge", "edge": "x-min", "condition": "clamped"},
                {"type": "point", "position": [0.1, 0.1]},
            ],
            2,
            None,
        ),
    ],
)
def test_supports_and_back(supports: Any, number: int, kind: type | None) -> None:
    case = vi.case_of(plate_case(supports=supports))
    recipe = elastic_bodies(case)["plate"].recipe
    found = recipe.supports
    assert len(found) == number
    assert model_key(recipe) == model_key(replace(recipe))  # the modes have a place in the store
    assert kind is None or all(isinstance(support, kind) for support in found)
    again = vi.case_of(resolved_case(case))
    assert elastic_bodies(again)["plate"] == elastic_bodies(case)["plate"]
    assert resolved_case(case)["plate"]["mesh"]["element_size"] > 0  # what was chosen is said


@pytest.mark.parametrize(
    "damping",
    [
        0.02,
        "adams-default",
        {"rayleigh": [1.0, 1e-6]},
        {"loss_factor": 0.01},
        {"ratios": [0.1, 0.2]},
        {"frequencies": [1.0, 9.0], "ratios": [0.1, 0.2]},
    ],
)
def test_damping_and_back(damping: Any) -> None:
    case = vi.case_of(plate_case(damping=damping))
    assert (
        elastic_bodies(vi.case_of(resolved_case(case)))["plate"].damping
        == elastic_bodies(case)["plate"].damping
    )


def test_as_many_elements_as_asked() -> None:
    body = elastic_bodies(vi.case_of(plate_case(element="solid", mesh={"elements": 27304})))[
        "plate"
    ]
    mesh = body.recipe.shape.mesh(())
    assert abs(mesh.number_of_elements / 27304 - 1.0) < 1e-3
    lower, upper = np.unique(mesh.nodes[:, 2])[[0, -1]]
    assert (lower, upper) == (-0.004, 0.004)


def test_named_sets_and_coordinates(tmp_path: Path) -> None:
    """A plate that is brought, in millimetres, its support, contact and sensor named by
    sets, is the plate that is made here.
    """
    made = box_mesh((520.0, 420.0, 8.0), (13, 10, 1))
    low = np.flatnonzero(np.abs(made.nodes[:, 0] + 260.0) < 1e-6)
    top = np.flatnonzero((np.abs(made.nodes[:, :2]).max(axis=1) < 1e-6) & (made.nodes[:, 2] > 0))
    mesh = vi.Mesh(made.nodes, made.blocks, {"WALL": low, "TOP": top})
    for name, write in (
        ("plate.bdf", vi.meshes.write_nastran),
        ("plate.inp", vi.meshes.write_abaqus),
    ):
        write(mesh, tmp_path / name)
        brought = plate_case(
            supports={"type": "set", "name": "WALL"},
            mesh={"file": str(tmp_path / name), "unit": "mm", "contact": "TOP"},
            size=None,
        )
        brought["sensors"] = [
            {"name": "here", "position": "TOP"},
            {"name": "below", "position": [0.1, 0.05], "face": "lower"},
        ]
        there = vi.compute_modes(vi.case_of(brought))["plate"]
        case = plate_case(
            supports={"type": "edge", "edge": "x-min", "condition": "clamped"},
            element="solid",
            mesh={"element_size": 0.0421, "splits": 0, "layers": 1},
        )
        here = vi.compute_modes(vi.case_of(case))["plate"]
        assert here.model.mesh.number_of_elements == there.model.mesh.number_of_elements == 130
        np.testing.assert_allclose(there.basis.frequencies, here.basis.frequencies, rtol=1e-7)
        np.testing.assert_allclose(
            np.abs(there.basis.contact), np.abs(here.basis.contact), atol=1e-6
        )
        np.testing.assert_allclose(there.basis.points["here"][:, 2], there.basis.contact)
        assert there.doubts == ()


def test_a_mesh_in_millimetres_by_mistake_is_doubted(tmp_path: Path) -> None:
    vi.meshes.write_abaqus(box_mesh((520.0, 420.0, 8.0), (4, 3, 1)), tmp_path / "plate.inp")
    found = vi.compute_modes(
        vi.case_of(plate_case(mesh=str(tmp_path / "plate.inp"), element=None))
    )["plate"]
    (doubt,) = found.doubts
    assert "weighs 1.372e+10 kg, and what the case describes weighs 13.72 kg" in doubt
    assert 'if it is in millimetres, give mesh = { file = "...", unit = "mm" }' in doubt


def _brought(mesh: vi.Mesh, folder: Path, **changes: Any) -> vi.Case:
    vi.meshes.write_abaqus(mesh, folder / "plate.inp")
    return vi.case_of(plate_case(mesh=str(folder / "plate.inp"), **changes))


def test_inverted_elements_are_refused(tmp_path: Path) -> None:
    mesh = box_mesh((0.52, 0.42, 0.008), (4, 3, 1), "hex8")
    nodes = mesh.nodes.copy()
    inside = np.flatnonzero(np.abs(nodes[:, :2]).max(axis=1) < 0.2)[0]
    nodes[inside, 0] += 0.3
    with pytest.raises(
        vi.InputError, match=r"plate: \d of 12 \w+ elements are inverted or folded .*: number \d+"
    ):
        vi.compute_modes(_brought(vi.Mesh(nodes, mesh.blocks), tmp_path))


def test_a_contact_point_off_the_body_is_refused(tmp_path: Path) -> None:
    case = plate_case(mesh=str(tmp_path / "plate.inp"), size=None)
    case["drop"]["position"] = [0.3, 0.0]
    vi.meshes.write_abaqus(box_mesh((0.52, 0.42, 0.008), (4, 3, 1)), tmp_path / "plate.inp")
    with pytest.raises(
        vi.InputError,
        match=r"drop.position: \(0.3, 0\) m is not on the body, which reaches from -0.26 to 0.26 "
        r"m along x",
    ):
        vi.compute_modes(vi.case_of(case))


def test_a_plate_that_would_fall_is_doubted() -> None:
    for supports, held in (
        ("free", False),
        ("clamped", True),
        ({"type": "edge", "edge": "x-min", "condition": "simply-supported"}, False),
    ):
        found = vi.compute_modes(vi.case_of(plate_case(supports=supports, mesh=COARSE)))["plate"]
        assert found.model.is_held_vertically is held
        assert bool(found.doubts) is not held
    springs = [
        {"type": "spring", "position": [x, y], "stiffness": 1e5}
        for x, y in ((-0.2, -0.1), (0.2, -0.1), (0.0, 0.15))
    ]
    found = vi.compute_modes(vi.case_of(plate_case(supports=springs, mesh=COARSE)))["plate"]
    assert found.model.is_held_vertically
    assert len(found.model.rigid_coefficients) == 3


# the command
# ------------------------------------------------------------------------------------------


def command(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr("sys.argv", ["vibroimpact", *arguments])
    try:
        main()
    except SystemExit as left:
        return int(left.code or 0)
    return 0


def rows_of(path: Path) -> Sequence[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_modes_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import tomli_w

    monkeypatch.setattr("vibroimpact.charts.files._DPI", 40)
    monkeypatch.setattr("vibroimpact.modes.plate_shapes._POINTS", 1000)
    case = plate_case(damping="adams-default", modes=8, mesh=COARSE)
    case["sphere"] |= {"model": "elastic", "modes": 6, "mesh": {"elements_across": 4}}
    case["sensors"] = [{"name": "a1", "position": [0.1, 0.05]}]
    (tmp_path / "case.toml").write_text(tomli_w.dumps(case))
    monkeypatch.chdir(tmp_path)
    assert command(monkeypatch, "modes", "case.toml", "-o", "out") == 0
    printed = capsys.readouterr().out
    assert "Adams' default" in printed
    assert "rigid motions" in printed
    out = tmp_path / "out"
    rows = rows_of(out / "modes.csv")
    assert list(rows[0])[:4] == ["body", "mode", "frequency_Hz", "damping_ratio"]
    assert [(row["body"], row["mode"]) for row in rows[5:7]] == [("sphere", "6"), ("plate", "1")]
    assert len(rows) == 14
    assert len(rows_of(out / "points.csv")) == 8
    summary = json.loads((out / "summary.json").read_text())["modes"]["plate"]
    assert summary["mass_kg"] == pytest.approx(0.52 * 0.42 * 0.008 * 7850)
    assert summary["frequencies_Hz"] == [float(row["frequency_Hz"]) for row in rows[6:]]
    assert {file.name for file in out.iterdir()} == {
        *("case.toml", "modes.csv", "points.csv", "summary.json", "report.html"),
        *(f"{body}.{suffix}" for body in ("sphere", "plate") for suffix in ("bdf", "inp", "vtu")),
    }
    page = (out / "report.html").read_text()
    assert all(f'data-chart="{body}_modes"' in page for body in ("sphere", "plate"))
    # the case written is the case: nothing is computed again
    monkeypatch.setattr(
        "vibroimpact.structures.recipe.computed_model", lambda *given: pytest.fail("computed again")
    )
    assert command(monkeypatch, "modes", "out/case.toml", "-o", "again", "--figures") == 0
    assert {file.name for file in (tmp_path / "again" / "figures").iterdir()} == {
        "sphere_modes.png",
        "plate_modes.png",
    }
    assert (tmp_path / "again" / "modes.csv").read_bytes() == (out / "modes.csv").read_bytes()
    assert tomllib.loads((out / "case.toml").read_text())["plate"]["damping"] == "adams-default"
    capsys.readouterr()
    # a folder that is there is not overwritten, and check says what is known
    assert command(monkeypatch, "modes", "case.toml", "-o", "out") == 2
    assert "replace it with --force" in capsys.readouterr().err
    assert command(monkeypatch, "check", "case.toml") == 0
    assert "computed already" in capsys.readouterr().out
    assert command(monkeypatch, "report", "out") == 2
    assert "these are modes of elastic bodies" in capsys.readouterr().err


@pytest.mark.slow
def test_the_meshes_written_are_those_of_the_modes(tmp_path: Path) -> None:
    """A solid plate written for Nastran, and brought back, has the same frequencies."""
    case = vi.case_of(plate_case(element="solid", mesh={"element_size": 0.2}))
    modes = vi.compute_modes(case)
    modes.save(tmp_path / "out")
    for name in ("plate.bdf", "plate.inp"):
        brought = vi.case_of(plate_case(mesh=str(tmp_path / "out" / name)))
        again = vi.compute_modes(brought)["plate"]
        np.testing.assert_allclose(
            again.basis.frequencies, modes["plate"].basis.frequencies, rtol=1e-8
        )


def test_relative_mesh_files_lie_beside_the_case(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import tomli_w

    (tmp_path / "there").mkdir()
    vi.meshes.write_abaqus(
        box_mesh((0.52, 0.42, 0.008), (4, 3, 1)), tmp_path / "there" / "plate.inp"
    )
    (tmp_path / "there" / "case.toml").write_text(tomli_w.dumps(plate_case(mesh="plate.inp")))
    monkeypatch.chdir(tmp_path)
    assert vi.load_case("there/case.toml").plate.mesh.file == str(tmp_path / "there" / "plate.inp")
