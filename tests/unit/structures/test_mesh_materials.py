"""Materials of the elements of mesh files: which are used, in which units, what is
refused, and what of a file is said to be left out.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

import vibroimpact as vi
from support import plain_case
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.elastic.meshes import meshes_of
from vibroimpact.errors import LONGEST_MESSAGE, InputError
from vibroimpact.materials import Material, find_material
from vibroimpact.meshes.element_materials import with_element_materials
from vibroimpact.meshes.left_out import remarks_of
from vibroimpact.modes.document import mesh_facts
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.stated_materials import StatedMaterial, StatedMaterials
from vibroimpact.structures.finite_elements.structure import solid_structure
from vibroimpact.structures.static_compliance import computed_compliance

STEEL = Material(7850.0, 210e9, 0.3, name="steel")
RUBBER = Material(1100.0, 10e6, 0.45, name="rubber")
SIZE = (0.2, 0.1, 0.01)
MASS_OF_STEEL, MASS_OF_BOTH = 1.57, 0.895  # kg, of 200 cm^3 of steel, and half of it of rubber


def bricks(axis: int = 0) -> Mesh:
    """A plate half of steel, half of rubber: beside one another, or one above the other."""
    mesh = box_mesh(SIZE, (4, 2, 2))
    centres = mesh.nodes[mesh.blocks[0].connectivity].mean(axis=1)
    return replace(
        mesh, materials=(STEEL, RUBBER), element_materials=(centres[:, axis] > 0).astype(int)
    )


def nastran(
    folder: Path,
    text: str,
    scale: float = 1.0,
    bulk: str = "",
    sections: str = "PSOLID,1,1\nPSOLID,2,2\n",
) -> Path:
    """The bricks as a deck: property 1 for x < 0, property 2 for x > 0, with MAT cards as
    a text.
    """
    mesh = bricks()
    rows = [
        f"GRID,{number},," + ",".join(f"{scale * value:.9g}" for value in at)
        for number, at in enumerate(mesh.nodes, 1)
    ]
    order = [*range(12), 16, 17, 18, 19, 12, 13, 14, 15]
    for number, nodes in enumerate(mesh.blocks[0].connectivity, 1):
        cells = [
            str(number),
            str(1 + mesh.element_materials[number - 1]),
            *map(str, nodes[order] + 1),
        ]
        rows += [
            "CHEXA," + ",".join(cells[:8]),
            "+," + ",".join(cells[8:16]),
            "+," + ",".join(cells[16:]),
        ]
    file = folder / "plate.bdf"
    file.write_text("BEGIN BULK\n" + text + sections + bulk + "\n".join(rows) + "\nENDDATA\n")
    return file


def abaqus(folder: Path, text: str, scale: float = 1.0, more: str = "") -> Path:
    """The bricks as a deck with the sets LEFT and RIGHT, and materials and sections as a text."""
    mesh = bricks()
    file = folder / "plate.inp"
    vi.meshes.write_abaqus(replace(mesh, nodes=scale * mesh.nodes, materials=()), file)
    left, right = (
        ",\n".join(map(str, np.flatnonzero(mesh.element_materials == of) + 1)) for of in (0, 1)
    )
    file.write_text(
        file.read_text()
        + f"*ELSET, ELSET=left\n{left}\n*ELSET, ELSET=RIGHT\n{right}\n"
        + text
        + more
    )
    return file


BDF_MM = "MAT1,1,2.1+5,,.3,7.85-9\nMAT1,2,10.,,.45,1.1-9\n"
INP_MM = (
    "*SOLID SECTION, ELSET=LEFT, MATERIAL=Steel\n*Solid Section, elset=right, material=RUBBER\n"
    "*MATERIAL, NAME=steel\n*ELASTIC\n210000., .3\n*DENSITY\n7.85e-9,\n"
    "*MATERIAL, NAME=Rubber\n*DENSITY\n1.1e-9\n*ELASTIC, TYPE=ISOTROPIC\n10., .45\n"
)


def case_of(file: Path, *, mesh: dict[str, Any] | None = None, **changes: Any) -> vi.Case:
    plate = {
        "material": "steel",
        "model": "elastic",
        "supports": "clamped",
        "modes": 4,
        "damping": 0.01,
    }
    brought = {"file": str(file), "unit": "mm"} | (mesh or {})
    supports = {"supports": "free"}
    return vi.case_of(
        plain_case(
            plate={**plate, **supports, "mesh": brought, **changes},
            drop={"speed": 1.0, "gravity": 0},
        )
    )


def doubts_of(file: Path, **changes: Any) -> str:
    return "\n".join(vi.compute_modes(case_of(file, **changes))["plate"].doubts)


@pytest.mark.parametrize("kind", ["bdf", "inp"])
def test_each_element_has_its_material(kind: str, tmp_path: Path) -> None:
    file = nastran(tmp_path, BDF_MM, 1e3) if kind == "bdf" else abaqus(tmp_path, INP_MM, 1e3)
    for _ in range(2):  # computed, and from the store
        found = vi.compute_modes(case_of(file))["plate"]
        assert found.model.properties.mass == pytest.approx(MASS_OF_BOTH, rel=1e-12)
        assert found.model.properties.centre[0] == pytest.approx(
            -0.05 * (0.785 - 0.11) / 0.895, rel=1e-9
        )
        assert [one.density for one in found.model.mesh.materials] == pytest.approx(
            [7850.0, 1100.0]
        )
        assert "8 of" in found.model.facts["materials"]
        # where both meet
        assert "the elements of the plate at the contact point are of 1100 kg/m3" in "\n".join(
            found.doubts
        )
    uniform = vi.compute_modes(
        case_of(
            file,
            mesh={
                "materials": {"PID1" if kind == "bdf" else "left": "steel"}
                | ({"PID2": "steel"} if kind == "bdf" else {"Right": "steel"})
            },
        )
    )["plate"]
    assert uniform.model.properties.mass == pytest.approx(
        0.2 * 0.1 * 0.01 * find_material("steel").density
    )
    assert uniform.model.frequencies[0] > 2.0 * found.model.frequencies[0]


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_modes_of_two_materials_are_those_of_the_whole_matrices(axis: int, tmp_path: Path) -> None:
    """Nodes that are symmetric in three planes, and materials that are so in two: no part
    of the motion may be lost.
    """
    mesh = bricks(axis)
    vi.meshes.write_abaqus(mesh, tmp_path / "plate.inp")
    found = vi.compute_modes(case_of(tmp_path / "plate.inp", mesh={"unit": "m"}, modes=12))[
        "plate"
    ].model.angular_frequencies
    structure = solid_structure(mesh, STEEL)
    squares = eigh(structure.stiffness.toarray(), structure.mass.toarray(), eigvals_only=True)
    np.testing.assert_allclose(found, np.sqrt(squares[6:18]), rtol=1e-6)


@pytest.mark.parametrize(
    ("unit", "scale", "steel", "rubber"),
    [
        ("m", 1.0, (7850.0, 210e9), (1100.0, 10e6)),
        ("mm", 1e3, (7.85e-9, 2.1e5), (1.1e-9, 10.0)),
        ("mm", 1e3, (7.85e-6, 210.0), (1.1e-6, 0.01)),
        ("mm", 1e3, (7.85e-3, 2.1e5), (1.1e-3, 10.0)),
        ("mm", 1e3, (7850.0, 210e9), (1100.0, 10e6)),
        ("cm", 1e2, (7.85, 2.1e12), (1.1, 1e8)),
        (
            "in",
            1 / 0.0254,
            (7.85e3 / 10686895.0, 210e9 / 6894.757),
            (1100 / 10686895.0, 10e6 / 6894.757),
        ),
        ("ft", 1 / 0.3048, (7850 / 515.3788, 210e9 / 47.88026), (1100 / 515.3788, 10e6 / 47.88026)),
        ("um", 1e6, (7850.0, 210e9), (1100.0, 10e6)),
    ],
)
def test_units(
    unit: str, scale: float, steel: tuple[float, float], rubber: tuple[float, float], tmp_path: Path
) -> None:
    said = tuple(
        StatedMaterial(name, *numbers, 0.3) for name, numbers in (("a", steel), ("b", rubber))
    )
    mesh = with_element_materials(
        replace(bricks(), materials=(), stated=StatedMaterials(said, bricks().element_materials)),
        1 / scale,
    )
    assert [one.density for one in mesh.materials] == pytest.approx([7850.0, 1100.0], rel=1e-5)
    assert [one.youngs_modulus for one in mesh.materials] == pytest.approx([210e9, 10e6], rel=1e-5)


def test_densities_of_weight(tmp_path: Path) -> None:
    """PARAM WTMASS makes a mass density of a weight density."""
    text = "PARAM,WTMASS,1.0193680-4\nMAT1,1,2.1+5,,.3,7.70085-5\nMAT1,2,10.,,.45,1.07910-5\n"
    found = meshes_of(case_of(nastran(tmp_path, text, 1e3)))["plate"]
    assert [one.density for one in found.materials] == pytest.approx([7850.0, 1100.0], rel=1e-4)


def test_constants_that_follow_from_others(tmp_path: Path) -> None:
    text = "MAT1,1,2.6+5,1.0+5,,7.85-9\nMAT1,2,,4.0,.25,1.1-9\n"
    found = meshes_of(case_of(nastran(tmp_path, text, 1e3)))["plate"].materials
    assert [(one.youngs_modulus, one.poissons_ratio) for one in found] == [
        pytest.approx((2.6e11, 0.3)),
        pytest.approx((10e6, 0.25)),
    ]


REFUSED = [
    (
        "MAT1,1,2.1+5,,.3,7.85-9\nMAT1,2,10.,,.45\n",
        "2 materials, of which MID2 has no density; give mesh.materials",
    ),
    ("MAT1,1,2.1+5,,.3,7.85-9\nMAT1,2\n", "MID2 has no density, Young's modulus, Poisson's ratio"),
    ("MAT1,1,2.1+5,,.3,7.85-9\n", "MID2 has no density, Young's modulus, Poisson's ratio"),
    ("MAT1,1,2.1+5,,.3,7.85-9\nMAT9,2,1.,2.,3.\n", "MID2 is anisotropic"),
    (
        "MAT1,1,2.1+5,,.3,7.85-9\nMAT1,2,10.,,.5,1.1-9\n",
        "the material MID2 of the file: Poisson's ratio 0.5 is not allowed",
    ),
    (
        "MAT1,1,2.1+5,,.3,7.85\nMAT1,2,10.,,.45,1.1\n",
        "in units that are not known: MID1 has the density 7.85 and the modulus 2.1e+05, "
        "with coordinates in mm",
    ),
    ("MAT1,1,2.1+5,,.3,7.85-9\nMAT1,2,ten,,.45,1.1-9\n", '"ten" is not an elastic constant'),
    ("MAT1,1,2.1+5,,.3,heavy\n", '"heavy" is not a density'),
]


@pytest.mark.parametrize(("text", "message"), REFUSED)
def test_what_can_not_be_used_is_refused(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=re.escape(message)) as raised:
        meshes_of(case_of(nastran(tmp_path, text, 1e3)))
    assert len(str(raised.value)) < LONGEST_MESSAGE
    # and the remedy that is named is accepted
    if "give mesh.materials" in str(raised.value):
        rubber = {"density": 1100, "youngs_modulus": "10 MPa", "poissons_ratio": 0.45}
        found = meshes_of(
            case_of(
                nastran(tmp_path, text, 1e3), mesh={"materials": {"MID1": "steel", "MID2": rubber}}
            )
        )["plate"]
        assert [one.name for one in found.materials] == ["steel", ""]


def test_elements_without_a_material_are_refused(tmp_path: Path) -> None:
    file = nastran(tmp_path, BDF_MM, 1e3, sections="PSOLID,1,1\nPSOLID,3,2\n")
    file.write_text(file.read_text().replace("CHEXA,1,1,", "CHEXA,1,3,"))
    with pytest.raises(
        InputError,
        match=r"the file gives 8 of its elements no material, and the others 2 materials; give "
        r"mesh\.materials",
    ):
        meshes_of(case_of(file))


ORTHOTROPIC = INP_MM.replace(
    "*ELASTIC, TYPE=ISOTROPIC\n10., .45\n", "*ELASTIC, TYPE=ORTHO\n1.,1.,1.,1.,1.,1.,1.,1.\n1.\n"
)
WARM = INP_MM.replace("10., .45\n", "10., .45, 20.\n8., .45, 100.\n")
HYPERELASTIC = INP_MM.replace(
    "*ELASTIC, TYPE=ISOTROPIC\n10., .45\n", "*HYPERELASTIC, NEO HOOKE\n1., 1.\n"
)
USER = INP_MM.replace("*ELASTIC, TYPE=ISOTROPIC\n10., .45\n", "*USER MATERIAL, CONSTANTS=1\n1.\n")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (ORTHOTROPIC, "Rubber is orthotropic"),
        (WARM, "Rubber is of elastic constants that depend on the temperature"),
        (HYPERELASTIC, "Rubber is hyperelastic"),
        (USER, "Rubber is a user material"),
        (
            INP_MM.replace("ELSET=LEFT", "ELSET=lefft"),
            'the file has no element set "lefft", of which the section is. Did you mean "LEFT"?',
        ),
    ],
)
def test_materials_of_abaqus_that_can_not_be_used(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        meshes_of(case_of(abaqus(tmp_path, text, 1e3)))


@pytest.mark.parametrize(
    ("named", "message"),
    [
        (
            {"steal": "steel"},
            'has no material or element set "steal"; it has left, RIGHT, steel, Rubber. Did '
            'you mean "steel"?',
        ),
        (
            {"left": "steel"},
            'the names leave out 8 elements of the material "Rubber" of the file; name it too',
        ),
        (
            {"left": "steel", "steel": "aluminium", "right": "steel"},
            '"steel" and "left" share 8 elements, each of which can have one material only',
        ),
        ({"left": "steel", "right": "rigid"}, 'mesh.materials.right: "rigid" does not deform'),
    ],
)
def test_wrong_names(named: dict[str, str], message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        meshes_of(case_of(abaqus(tmp_path, INP_MM, 1e3), mesh={"materials": named}))


def test_named_materials_are_part_of_the_case(tmp_path: Path) -> None:
    file = abaqus(tmp_path, "", 1e3)  # a deck without materials: sets are enough
    case = case_of(
        file,
        mesh={
            "materials": {"right": {"density": 1100, "youngs_modulus": 1e7, "poissons_ratio": 0.45}}
        },
    )
    assert resolved_case(case)["plate"]["mesh"]["materials"]["right"]["density"] == 1100.0
    again = vi.case_of(resolved_case(case))
    one, other = (vi.compute_modes(which)["plate"].model for which in (case, again))
    assert one.frequencies.tolist() == other.frequencies.tolist()
    density = find_material("steel").density
    assert one.properties.mass == pytest.approx(1e-4 * (density + 1100.0))
    assert (
        "8 of (1100 kg/m3, 0.01 GPa, 0.45), 8 of the material of the case" in one.facts["materials"]
    )


def test_one_material_that_contradicts_the_case_is_named(tmp_path: Path) -> None:
    only_rubber = "MAT1,1,10.,,.45,1.1-9\n"
    file = nastran(tmp_path, only_rubber, 1e3, sections="PSOLID,1,1\nPSOLID,2,1\n")
    found = doubts_of(file)
    assert (
        "gives its material MID1 a density of 1100 kg/m3 and a Young's modulus of 1e+07 Pa, "
        "and its elements are computed with" in found
    )
    [remark] = mesh_facts(case_of(file))["plate"]["remarks"]  # of `check`
    assert remark in found
    rubber = {"density": 1100, "youngs_modulus": 1e7, "poissons_ratio": 0.45}
    assert "gives its material" not in doubts_of(file, material=rubber)
    unknown = nastran(tmp_path, "MAT1,1,10.,,.45,1.1\n", 1e3, sections="PSOLID,1,1\nPSOLID,2,1\n")
    assert (
        "the density of 1.1 and the modulus of 10 of the material MID1 of the mesh file are "
        "those of no solid" in doubts_of(unknown)
    )
    anisotropic = nastran(tmp_path, "MAT9,1,10.\n", 1e3, sections="PSOLID,1,1\nPSOLID,2,1\n")
    assert (
        "the material of the mesh file, MID1, is anisotropic; its elements are computed "
        "with the isotropic" in doubts_of(anisotropic)
    )
    silent = nastran(tmp_path, "", 1e3, sections="PSOLID,1,1\nPSOLID,2,1\n")
    assert "material" not in doubts_of(silent)


def test_a_file_that_is_included_is_part_of_the_case(tmp_path: Path) -> None:
    """Modes that are kept are those of the materials that the files state now."""
    file = nastran(tmp_path, "INCLUDE 'materials.bdf'\n", 1e3)
    masses = []
    for density in ("1.1-9", "2.2-9"):
        (tmp_path / "materials.bdf").write_text(BDF_MM.replace("1.1-9", density))
        masses.append(vi.compute_modes(case_of(file))["plate"].model.properties.mass)
    assert masses == pytest.approx([0.895, 1.005], rel=1e-9)


def test_elements_of_a_fluid_are_left_out(tmp_path: Path) -> None:
    text = "MAT1,1,2.1+5,,.3,7.85-9\nMAT10,2,2.25+3,1.0-9\n"
    found = vi.compute_modes(case_of(nastran(tmp_path, text, 1e3)))["plate"]
    assert found.model.properties.mass == pytest.approx(1e-4 * find_material("steel").density)
    assert (
        "left out of the mesh file: elements of a fluid (8); the fluid is not part of the body"
        in "\n".join(found.doubts)
    )
    by_property = nastran(tmp_path, BDF_MM, 1e3, sections="PSOLID,1,1\nPSOLID,2,2,,,,,PFLUID\n")
    assert meshes_of(case_of(by_property))["plate"].number_of_elements == 8
    only = nastran(tmp_path, text, 1e3, sections="PSOLID,1,2\nPSOLID,2,2\n")
    with pytest.raises(
        InputError, match=r"the file has no solid element; .* left out: elements of a fluid"
    ):
        meshes_of(case_of(only))


NAMED = {
    "CONM2,100,1,,2.5\n": "CONM2 (1); masses are not part of the body",
    "CELAS2,100,1.+3,1,1\nCBUSH,101,3,1,2\n": "CELAS2 (1), CBUSH (1); springs and connectors are not part of the body",
    "CDAMP2,100,3.,1,1\n": "CDAMP2 (1); dampers are not part of the body, which rings for longer",
    "RSPLINE,100,1.,1,2,123,3\nMPC,1,1,1,1.,2,1,-1.\n": "RSPLINE (1), MPC (1); constraints of nodes are not applied",
    "CQUAD4,100,3,1,2,3,4\nCBAR,101,3,1,2\n": "CQUAD4 (1), CBAR (1); elements other than solids in three dimensions are "
    "not part",
    "SPC1,7,123,1,2\nSPC,8,1,1\n": "SPC (1), SPC1 (1); supports of the file are not used",
    "GRID,900,,1.,1.,1.,,123\n": "PS of GRID (1); supports of the file",
}


@pytest.mark.parametrize("bulk", NAMED)
def test_what_is_left_out_is_named_with_what_it_does(bulk: str, tmp_path: Path) -> None:
    assert NAMED[bulk] in doubts_of(nastran(tmp_path, BDF_MM, 1e3, bulk))


def test_what_an_abaqus_file_holds_besides_is_named(tmp_path: Path) -> None:
    more = (
        "*ELEMENT, TYPE=MASS, ELSET=lump\n900, 1\n*MASS, ELSET=lump\n2.5\n*ELEMENT, "
        "TYPE=SPRINGA, ELSET=springs\n901, 1, 2\n*SPRING, ELSET=springs\n\n1.\n"
        "*EQUATION\n1\n1,1,1.\n*BOUNDARY\n1,1,3\n*ELEMENT, "
        "TYPE=F3D8\n902,1,2,3,4,5,6,7,8\n*STEP\n*STATIC\n*END STEP\n"
    )
    found = doubts_of(abaqus(tmp_path, INP_MM, 1e3, more))
    for words in (
        "MASS (1), *MASS (1); masses",
        "SPRINGA (1), *SPRING (1); springs",
        "*EQUATION (1); constraints",
        "*BOUNDARY (1); supports",
    ):
        assert words in found
    assert "F3D8 (1); the fluid is not part" in found
    assert "STEP" not in found


def test_names_of_loads_and_results_do_nothing_to_the_body() -> None:
    assert (
        remarks_of(
            {
                "FORCE": 1,
                "PLOAD4": 2,
                "*STEP": 1,
                "*NODE PRINT": 1,
                "EIGRL": 1,
                "CORD2R": 1,
                "*CLOAD": 4,
            }
        )
        == ()
    )


def test_files_that_are_written_keep_the_materials(tmp_path: Path) -> None:
    mesh = bricks()
    mixed = replace(mesh, materials=(RUBBER,), element_materials=mesh.element_materials - 1)
    for wrote in (mesh, mixed):
        vi.meshes.write_nastran(wrote, tmp_path / "plate.bdf", STEEL)
        vi.meshes.write_abaqus(wrote, tmp_path / "plate.inp", STEEL)
        for name in ("plate.bdf", "plate.inp"):
            back = vi.meshes.load_mesh(tmp_path / name)
            densities = back.of_elements(STEEL, lambda one: one.density)
            assert densities == pytest.approx(wrote.of_elements(STEEL, lambda one: one.density))
            moduli = back.of_elements(STEEL, lambda one: one.youngs_modulus)
            assert moduli == pytest.approx(wrote.of_elements(STEEL, lambda one: one.youngs_modulus))


def test_the_static_compliance_has_the_material_at_the_place(tmp_path: Path) -> None:
    vi.meshes.write_abaqus(replace(bricks(), materials=()), tmp_path / "one.inp", STEEL)
    vi.meshes.write_abaqus(bricks(), tmp_path / "two.inp")
    edges = {"type": "set", "name": "ENDS"}
    ends = (
        "*NSET, NSET=ENDS\n"
        + ",\n".join(str(at + 1) for at in np.flatnonzero(np.abs(bricks().nodes[:, 0]) > 0.0999))
        + "\n"
    )
    found = {}
    for name in ("one.inp", "two.inp"):
        (tmp_path / name).write_text((tmp_path / name).read_text() + ends)
        body = {"density": 7850, "youngs_modulus": 210e9, "poissons_ratio": 0.3}
        named = {"materials": {"steel": body, "rubber": body}} if name == "two.inp" else {}
        case = case_of(tmp_path / name, supports=edges, material=body, mesh={"unit": "m", **named})
        found[name] = computed_compliance(vi.compute_modes(case)["plate"].body.recipe, (0.05, 0.0))
    assert found["one.inp"] == pytest.approx(found["two.inp"], rel=1e-9)


def test_a_contact_over_layers_of_two_materials_is_refused_but_as_modes_alone(
    tmp_path: Path,
) -> None:
    vi.meshes.write_abaqus(bricks(axis=2), tmp_path / "plate.inp")
    case = case_of(
        tmp_path / "plate.inp",
        mesh={"unit": "m"},
        material={"density": 1100, "youngs_modulus": 1e7, "poissons_ratio": 0.45},
    )
    assert vi.compute_modes(case)["plate"].model.properties.mass == pytest.approx(MASS_OF_BOTH)
    with pytest.raises(
        InputError,
        match=r'the body is of 2 materials .* give contact\.local_compliance = "superposed"',
    ):
        vi.simulate(case)
    superposed = {"law": "hertz", "local_compliance": "superposed"}
    assert (
        vi.simulate(
            vi.case_of({**resolved_case(case), "contact": superposed, "run": {"impacts": 1}})
        ).impacts["max_force_N"]
        > 0
    )
