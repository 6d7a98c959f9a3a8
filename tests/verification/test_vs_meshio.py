"""Against meshio, which reads what is written here, with orders of the nodes of its own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from agreement import Against, Agrees
from vibroimpact.materials import Material
from vibroimpact.meshes.write_abaqus import write_abaqus
from vibroimpact.meshes.write_nastran import write_nastran
from vibroimpact.meshes.write_vtu import write_vtu
from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh

meshio = pytest.importorskip("meshio")

AGAINST = Against(
    "meshio, mesh files",
    "other program",
    "programs and files",
    "meshio, Schlömer, doi 10.5281/zenodo.1173115; it reads files written by this package, "
    "and writes files that this package reads",
)


STEEL = Material(density=7850.0, youngs_modulus=210e9, poissons_ratio=0.3, name="steel")
# meshio has the order of VTK, as the element kinds have
NAMES = {
    "tet4": "tetra",
    "tet10": "tetra10",
    "hex8": "hexahedron",
    "hex20": "hexahedron20",
    "hex27": "hexahedron27",
}
# where VTK's own cells have the nodes on faces and in the middle (vtkTriQuadraticHexahedron,
# vtkBiQuadraticQuad)
VTK_HEX27 = [
    [0, 0.5, 0.5],
    [1, 0.5, 0.5],
    [0.5, 0, 0.5],
    [0.5, 1, 0.5],
    [0.5, 0.5, 0],
    [0.5, 0.5, 1],
    [0.5, 0.5, 0.5],
]
VTK_QUAD9 = [[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0], [1, 0.5], [0.5, 1], [0, 0.5], [0.5, 0.5]]


def measures(kind: str, nodes: np.ndarray, connectivity: np.ndarray) -> np.ndarray:
    """Volume and its second moments; no element is inside out."""
    element = ELEMENT_KINDS[kind]
    points, weights = element.quadrature(8)
    values, slopes = element.basis(points)
    jacobian = np.linalg.det(np.einsum("qdn,enx->eqdx", slopes, nodes[connectivity]))
    assert jacobian.min() > 0
    place = np.einsum("qn,enx->eqx", values, nodes[connectivity])
    return np.array(
        [
            (jacobian * weights).sum(),
            *np.einsum("eq,eqx,eqy->xy", jacobian * weights, place, place).ravel(),
        ]
    )


def bent(kind: str) -> Mesh:
    reference = ELEMENT_KINDS[kind].reference
    nodes = (
        reference
        + 0.1 * reference[:, [1, 2, 0]] ** 2
        + 0.02 * np.random.default_rng(2).standard_normal(reference.shape)
    )
    return Mesh(
        nodes,
        (ElementBlock(kind, np.arange(len(nodes))[None, :]),),
        {"some": np.array([0, 2, 3])},
        {"all": np.array([0])},
    )


@pytest.mark.parametrize("kind", NAMES)
@pytest.mark.parametrize("suffix", ["bdf", "inp", "vtu"])
def test_elements(agrees: Agrees, kind: str, suffix: str, tmp_path: Path) -> None:
    mesh, file = bent(kind), tmp_path / f"mesh.{suffix}"
    written = kind if suffix == "vtu" or kind != "hex27" else "hex20"
    if suffix == "bdf":
        write_nastran(mesh, file, STEEL)
    elif suffix == "inp":
        write_abaqus(mesh, file, STEEL)
    else:
        write_vtu(mesh, file, {"height_m": mesh.nodes[:, 2], "place_m": mesh.nodes})
    read = meshio.read(file)
    (cells,) = read.cells
    assert cells.type == NAMES[written]
    expected = measures(
        written, mesh.nodes, mesh.blocks[0].connectivity[:, : len(ELEMENT_KINDS[written].reference)]
    )
    found = measures(written, read.points, cells.data)
    agrees(
        "five element types, Nastran, Abaqus and VTK files",
        "volume and second moments of volume",
        found,
        expected,
        relative=1e-11,
    )
    if suffix == "vtu":
        np.testing.assert_array_equal(read.point_data["height_m"], mesh.nodes[:, 2])
        np.testing.assert_array_equal(read.point_data["place_m"], mesh.nodes)
    if suffix == "inp":
        assert read.point_sets["some"].tolist() == [0, 2, 3]


@pytest.mark.parametrize("suffix", ["bdf", "vtu"])
def test_pyramids(suffix: str, tmp_path: Path) -> None:
    """Of five nodes; meshio does not read its own cells of 13."""
    mesh, file = bent("pyramid5"), tmp_path / f"mesh.{suffix}"
    (write_nastran if suffix == "bdf" else write_vtu)(mesh, file)
    (cells,) = meshio.read(file).cells
    assert cells.type == "pyramid"
    np.testing.assert_array_equal(cells.data, mesh.blocks[0].connectivity)


def test_bricks_of_27_nodes_stand_as_vtk_has_them() -> None:
    np.testing.assert_array_equal(ELEMENT_KINDS["hex27"].reference[20:], VTK_HEX27)


def test_plates(tmp_path: Path) -> None:
    reference = ELEMENT_KINDS["quad25"].reference
    nodes = np.concatenate([reference * [2.0, 3.0], np.zeros((25, 1))], axis=1)
    mesh = Mesh(nodes, (ElementBlock("quad25", np.arange(25)[None, :]),))
    write_nastran(mesh, tmp_path / "plate.bdf", STEEL, thickness=0.01)
    write_abaqus(mesh, tmp_path / "plate.inp", STEEL, thickness=0.01)
    write_vtu(mesh, tmp_path / "plate.vtu", {"place_m": nodes})
    for suffix, name in [("bdf", "quad8"), ("inp", "quad8"), ("vtu", "quad9")]:
        read = meshio.read(tmp_path / f"plate.{suffix}")
        found = np.concatenate([cells.data for cells in read.cells if cells.type == name])
        assert found.shape == (4, int(name[-1]))
        corners = {tuple(corner) for corner in read.points[found[:, 0], :2].tolist()}
        assert corners == {(0, 0), (1, 0), (0, 1.5), (1, 1.5)}
        for shell in read.points[found]:
            np.testing.assert_allclose(
                (shell[:, :2] - shell[0, :2]) / [1, 1.5], VTK_QUAD9[: len(shell)], atol=1e-12
            )


def test_a_mesh_of_meshio(agrees: Agrees, tmp_path: Path) -> None:
    """What meshio writes is read: two tetrahedra in each of its formats."""
    from vibroimpact.meshes.mesh_file import load_mesh

    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])
    tets = np.array([[0, 1, 2, 3], [1, 2, 3, 4]])
    for suffix, options in [
        ("bdf", {}),
        ("inp", {}),
        ("msh", {"file_format": "gmsh22", "binary": False}),
        ("msh", {"file_format": "gmsh", "binary": False}),
    ]:
        file = tmp_path / f"mesh.{suffix}"
        meshio.Mesh(points, [("tetra", tets)]).write(file, **options)
        read = load_mesh(file)
        found = measures("tet4", read.nodes, read.blocks[0].connectivity)[0]
        agrees(
            "two tetrahedra, files written by meshio",
            "volume",
            found,
            1 / 6 + 1 / 3,
            unit="m³",
            relative=1e-12,
        )
