"""Against Gmsh: the files that it writes, and the geometries that it meshes."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from agreement import Against, Agrees
from vibroimpact.errors import InputError
from vibroimpact.meshes.geometry import mesh_geometry
from vibroimpact.meshes.mesh_file import load_mesh
from vibroimpact.structures.finite_elements.geometry import check_mesh, mass_properties
from vibroimpact.structures.finite_elements.mesh import Mesh

try:
    import gmsh
except (ImportError, OSError):  # not installed, or a system library that it needs is not
    pytest.skip("Gmsh can't be loaded", allow_module_level=True)

AGAINST = Against(
    "Gmsh, meshes and mesh files",
    "other program",
    "programs and files",
    "Geuzaine and Remacle 2009, Int. J. Numer. Methods Eng. 79, 1309; volumes "
    "of the shapes in closed form",
)


QUARTER_RING = np.pi * (0.3**2 - 0.1**2) / 4 * 0.2
SPHERE = 4 / 3 * np.pi * 0.3**3


def volume(mesh: Mesh) -> float:
    """The volume; no element is inside out."""
    total = 0.0
    for block in mesh.blocks:
        points, weights = block.element.quadrature()
        jacobian = np.linalg.det(
            np.einsum(
                "qdn,enx->eqdx", block.element.basis(points)[1], mesh.nodes[block.connectivity]
            )
        )
        assert jacobian.min() > 0
        total += float((jacobian * weights).sum())
    return total


@pytest.fixture
def model() -> Iterator[None]:
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    yield
    gmsh.finalize()


def make(shape: str, order: int, incomplete: bool = False) -> None:
    """Mesh a sphere or a box of tetrahedra, or a quarter of a ring of curved bricks, with
    named groups.
    """
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.12)
    gmsh.option.setNumber("Mesh.ElementOrder", order)
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", incomplete)
    occ = gmsh.model.occ
    if shape == "sphere":
        solid = occ.addSphere(0, 0, 0, 0.3)
    elif shape == "box":
        solid = occ.addBox(0, 0, 0, 0.2, 0.3, 0.4)
    else:
        face = occ.addRectangle(0.1, 0, 0, 0.2, 0.2)
        turned = occ.revolve(
            [(2, face)], 0, 0, 0, 0, 1, 0, np.pi / 2, numElements=[3], recombine=True
        )
        solid = next(tag for dimension, tag in turned if dimension == 3)
    occ.synchronize()
    if shape == "ring":
        for _, curve in gmsh.model.getBoundary([(2, face)], oriented=False):
            gmsh.model.mesh.setTransfiniteCurve(curve, 3)
        gmsh.model.mesh.setTransfiniteSurface(face)
        gmsh.model.mesh.setRecombine(2, face)
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    gmsh.model.addPhysicalGroup(3, [solid], name="body")
    gmsh.model.addPhysicalGroup(3, [solid], name="everything")
    gmsh.model.addPhysicalGroup(2, faces[:1], name="first_face")
    gmsh.model.mesh.generate(3)


EXACT = {"sphere": (SPHERE, 2e-3), "box": (0.024, 1e-6), "ring": (QUARTER_RING, 2e-3)}
# what Gmsh keeps of a number in the fields of Nastran: three digits of -1.23E-01 in small ones
DIGITS = {"0.bdf": 1e-3, "1.bdf": 1e-3, "2.bdf": 1e-6}
CASES = [
    ("sphere", 2, False, "tet10"),
    ("box", 1, False, "tet4"),
    ("box", 2, False, "tet10"),
    ("ring", 2, True, "hex20"),
    ("ring", 2, False, "hex27"),
]


@pytest.mark.parametrize(("shape", "order", "incomplete", "kind"), CASES)
def test_files_of_gmsh(
    agrees: Agrees, model: None, shape: str, order: int, incomplete: bool, kind: str, tmp_path: Path
) -> None:
    make(shape, order, incomplete)
    files = []
    for version in (2.2, 4.0, 4.1):
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        files.append(tmp_path / f"{version}.msh")
        gmsh.write(str(files[-1]))
    gmsh.option.setNumber("Mesh.SaveGroupsOfNodes", 1)
    files.append(tmp_path / "mesh.inp")
    gmsh.write(str(files[-1]))
    for fields in (0, 1, 2) if kind != "hex27" else ():
        gmsh.option.setNumber("Mesh.BdfFieldFormat", fields)
        files.append(tmp_path / f"{fields}.bdf")
        gmsh.write(str(files[-1]))
    exact, tolerance = EXACT[shape]
    meshes = [load_mesh(file) for file in files]
    for file, mesh in zip(files, meshes, strict=True):
        assert [block.kind for block in mesh.blocks] == [kind]
        agrees(
            f"{shape}, {kind}, {len(files)} mesh files",
            "volume",
            volume(mesh),
            exact,
            unit="m³",
            relative=tolerance,
        )
        kept = DIGITS.get(file.name, 1e-12)
        case = f"{shape}, {'.bdf with three digits' if kept == 1e-3 else file.suffix} against .msh"
        agrees(case, "volume", volume(mesh), volume(meshes[0]), unit="m³", relative=kept)
        assert len(mesh.nodes) == len(meshes[0].nodes)
        if file.suffix != ".bdf":
            assert set(mesh.element_sets) >= {"body", "everything"}
            assert len(mesh.element_sets["body"]) == mesh.number_of_elements
            assert len(mesh.node_sets["first_face"]) == len(meshes[0].node_sets["first_face"]) > 3


def test_a_binary_file(model: None, tmp_path: Path) -> None:
    make("box", 1)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.write(str(tmp_path / "mesh.msh"))
    with pytest.raises(InputError, match="this is a binary file; save the mesh as ASCII"):
        load_mesh(tmp_path / "mesh.msh")


def test_prisms(model: None, tmp_path: Path) -> None:
    occ = gmsh.model.occ
    occ.extrude([(2, occ.addRectangle(0, 0, 0, 1, 1))], 0, 0, 1, numElements=[1], recombine=True)
    occ.synchronize()
    gmsh.model.mesh.generate(3)
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
    for order, kind in ((1, "wedge6"), (2, "wedge15")):
        gmsh.model.mesh.setOrder(order)
        for suffix in ("msh", "inp", "bdf"):
            gmsh.write(str(tmp_path / f"mesh.{suffix}"))
            mesh = load_mesh(tmp_path / f"mesh.{suffix}")
            assert [block.kind for block in mesh.blocks] == [kind]
            check_mesh(mesh)
            found = mass_properties(mesh, 1.0)
            assert found.mass == pytest.approx(1.0, rel=1e-9)
            np.testing.assert_allclose(found.inertia, np.eye(3) / 6.0, atol=1e-9)


@pytest.mark.parametrize(
    ("order", "incomplete", "kind"),
    [(1, False, "pyramid5"), (2, True, "pyramid13"), (2, False, "pyramid14")],
)
def test_pyramids(order: int, incomplete: bool, kind: str, model: None, tmp_path: Path) -> None:
    """The six pyramids of a cube: their nodes in the order of Gmsh, and halfway on edges
    once they are ours.
    """
    tag = gmsh.model.addDiscreteEntity(3)
    corners = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
    gmsh.model.mesh.addNodes(
        3, tag, list(range(1, 10)), np.concatenate([corners.ravel(), [0.5] * 3])
    )
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (2, 6, 8, 4), (4, 8, 7, 3), (3, 7, 5, 1)]
    gmsh.model.mesh.addElementsByType(tag, 7, [], [node for face in faces for node in (*face, 9)])
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", incomplete)
    gmsh.model.mesh.setOrder(order)
    for version in (2.2, 4.1):
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.write(str(tmp_path / "mesh.msh"))
        mesh = load_mesh(tmp_path / "mesh.msh")
        (block,) = mesh.blocks
        assert block.kind == kind
        check_mesh(mesh)
        assert mass_properties(mesh, 1.0).mass == pytest.approx(1.0, rel=1e-12)
        reference = block.element.reference[:, 2]
        # the map of a straight pyramid is linear: heights over the base are those of the reference
        for members in block.connectivity:
            at = mesh.nodes[members]
            normal = np.cross(at[1] - at[0], at[3] - at[0])
            np.testing.assert_allclose((at - at[0]) @ normal, 0.5 * reference, atol=1e-12)


def write_geometry(file: Path, *boxes: float) -> None:
    """Write a sphere of 25 mm radius, in millimetres, and boxes beside it."""
    gmsh.model.occ.addSphere(0, 0, 0, 25)
    for x in boxes:
        gmsh.model.occ.addBox(x, 0, 0, 5, 5, 5)
    gmsh.model.occ.synchronize()
    gmsh.write(str(file))


def test_geometry_is_in_metres(
    agrees: Agrees, model: None, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    step, brep = tmp_path / "ball.step", tmp_path / "ball.brep"
    write_geometry(step)
    gmsh.write(str(brep))
    before = (
        gmsh.model.getCurrent(),
        gmsh.option.getNumber("Mesh.ElementOrder"),
        gmsh.model.getEntities(),
    )
    capfd.readouterr()
    for mesh in (load_mesh(step, size=0.01), load_mesh(brep, unit_in_metres=1e-3, size=0.01)):
        assert [block.kind for block in mesh.blocks] == ["tet10"]
        agrees(
            "sphere from a STEP or BREP file",
            "volume",
            volume(mesh),
            4 / 3 * np.pi * 0.025**3,
            unit="m³",
            relative=5e-4,
        )
        radius = np.linalg.norm(mesh.nodes[mesh.node_sets["face1"]], axis=1)
        agrees(
            "sphere from a STEP or BREP file",
            "distance of surface nodes from the centre",
            radius,
            0.025,
            unit="m",
            relative=1e-6,
        )  # of all orders
        corners = mesh.nodes[mesh.blocks[0].connectivity[:, :4]]
        assert np.linalg.norm(corners[:, :, None] - corners[:, None], axis=-1).max() < 2 * 0.01
    assert before == (
        gmsh.model.getCurrent(),
        gmsh.option.getNumber("Mesh.ElementOrder"),
        gmsh.model.getEntities(),
    )
    assert gmsh.isInitialized()
    assert capfd.readouterr() == ("", "")


def test_size_and_order(model: None, tmp_path: Path) -> None:
    write_geometry(tmp_path / "ball.stp")
    mesh = mesh_geometry(tmp_path / "ball.stp", size=0.02, order=1)
    assert [block.kind for block in mesh.blocks] == ["tet4"]
    with pytest.raises(
        InputError,
        match=r"elements of that size would be about .* million; at most 3 million are made: "
        r"choose a larger size",
    ):
        mesh_geometry(tmp_path / "ball.stp", size=1e-8)


def test_wrong_geometries(model: None, tmp_path: Path) -> None:
    write_geometry(tmp_path / "two.step", 100.0)
    with pytest.raises(InputError, match="it holds 2 solids; it must hold one"):
        load_mesh(tmp_path / "two.step")
    (tmp_path / "no.step").write_text("this is not STEP\n")
    with pytest.raises(InputError, match="the geometry can't be meshed"):
        load_mesh(tmp_path / "no.step")


@pytest.mark.parametrize(
    "reason", ["ImportError('no module')", "OSError('libGLU.so.1: cannot open shared object file')"]
)
def test_without_gmsh(reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "gmsh.py").write_text(f"raise {reason}\n")
    (tmp_path / "ball.step").write_text("ISO-10303-21;\n")
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    with pytest.raises(InputError) as raised:
        load_mesh(tmp_path / "ball.step")
    assert "needs Gmsh, which can't be loaded" in str(raised.value)
    assert reason.split("'")[1] in str(raised.value)
    remedy = (
        'pip install "vibroimpact[mesh]"'
        if reason.startswith("ImportError")
        else "install the library that it lacks"
    )
    assert remedy in str(raised.value)
