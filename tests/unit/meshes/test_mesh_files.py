"""Mesh files: what is read, what is written, and what is refused with a clear message."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from support import one_in
from vibroimpact.errors import InputError
from vibroimpact.materials import RIGID, Material
from vibroimpact.meshes.geometry import mesh_geometry
from vibroimpact.meshes.mesh_file import load_mesh
from vibroimpact.meshes.nastran_cards import nastran_real
from vibroimpact.meshes.read_abaqus import read_abaqus
from vibroimpact.meshes.read_gmsh import read_gmsh
from vibroimpact.meshes.read_nastran import read_nastran
from vibroimpact.meshes.write_abaqus import write_abaqus
from vibroimpact.meshes.write_nastran import nastran_number, write_nastran
from vibroimpact.meshes.write_vtu import write_vtu
from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh

STEEL = Material(density=7850.0, youngs_modulus=210e9, poissons_ratio=0.3, name="steel")
MSH = (
    "$MeshFormat\n2.2 0 "
    "8\n$EndMeshFormat\n$Nodes\n{nodes}\n$EndNodes\n$Elements\n{elements}\n$EndElements\n"
)
SOLIDS = [
    "tet4",
    "tet10",
    "wedge6",
    "wedge15",
    "pyramid5",
    "pyramid13",
    "pyramid14",
    "hex8",
    "hex20",
    "hex27",
]
WRITTEN = {"hex27": ("hex20", 20), "pyramid14": ("pyramid13", 13)}
"""What kinds with nodes on faces become in a deck, and how many nodes these have."""


def measures(mesh: Mesh) -> np.ndarray:
    """Volume, its first and its second moments."""
    found = np.zeros(13)
    for block in mesh.blocks:
        points, weights = block.element.quadrature(8)
        values, slopes = block.element.basis(points)
        x = mesh.nodes[block.connectivity]
        jacobian = np.linalg.det(np.einsum("qdn,enx->eqdx", slopes, x))
        assert jacobian.min() > 0
        volume, place = jacobian * weights, np.einsum("qn,enx->eqx", values, x)
        second = np.einsum("eq,eqx,eqy->xy", volume, place, place)
        found += [volume.sum(), *np.einsum("eq,eqx->x", volume, place), *second.ravel()]
    return found


def curved(kind: str, seed: int = 0) -> Mesh:
    """Three separate, bent and jittered elements of a kind, with nodes in a wild order
    and some that nothing uses.
    """
    choose = np.random.default_rng(seed)
    reference = ELEMENT_KINDS[kind].reference
    bent = (
        reference + 0.1 * reference[:, [1, 2, 0]] ** 2 - 0.07 * reference[:, [2, 0, 1]] * reference
    )
    nodes = np.concatenate(
        [
            bent + 0.02 * choose.standard_normal(bent.shape) + [2.0 * index, -0.3, 0.1]
            for index in range(3)
        ]
    )
    connectivity = np.arange(len(nodes)).reshape(3, -1)
    order = choose.permutation(len(nodes) + 5)
    everything = np.concatenate([nodes, choose.standard_normal((5, 3))])
    place = np.argsort(order)
    sets = {"a set, of nodes": place[connectivity[1]], "one": place[:1]}
    return Mesh(
        everything[order],
        (ElementBlock(kind, place[connectivity]),),
        sets,
        {"left": np.array([0, 2])},
    )


def plate() -> Mesh:
    """Two by one plate elements."""
    x, y = np.meshgrid(np.linspace(0, 2, 9), np.linspace(0, 1, 5))
    nodes = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    first = np.array([9 * row + column for row in range(5) for column in range(5)])
    return Mesh(
        nodes,
        (ElementBlock("quad25", np.stack([first, first + 4])),),
        {"edge": np.array([0, 1, 2])},
        {"left": np.array([0])},
    )


def read_text(text: str | bytes, name: str, folder: Path) -> Mesh:
    file = folder / name
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return load_mesh(file)


def as_written(mesh: Mesh) -> Mesh:
    kinds = [
        WRITTEN.get(block.kind, (block.kind, block.connectivity.shape[1])) for block in mesh.blocks
    ]
    blocks = tuple(
        ElementBlock(kind, block.connectivity[:, :count])
        for (kind, count), block in zip(kinds, mesh.blocks, strict=True)
    )
    return Mesh(mesh.nodes, blocks, mesh.node_sets, mesh.element_sets)


def gmsh_text(mesh: Mesh, order: list[int]) -> str:
    """Version 2 in the order that Gmsh documents, with a group of volumes."""
    (block,) = mesh.blocks
    nodes = [
        f"{number} {x!r} {y!r} {z!r}" for number, (x, y, z) in enumerate(mesh.nodes.tolist(), 1)
    ]
    number = GMSH_TYPES[block.kind]
    elements = [
        f"{row} {number} 2 9 1 " + " ".join(map(str, members))
        for row, members in enumerate((block.connectivity[:, order] + 1).tolist(), 1)
    ]
    return MSH.format(
        nodes="\n".join([str(len(nodes)), *nodes]),
        elements="\n".join([str(len(elements)), *elements]),
    )


GMSH_TYPES = {
    "tet4": 4,
    "tet10": 11,
    "wedge6": 6,
    "wedge15": 18,
    "hex8": 5,
    "hex20": 17,
    "hex27": 12,
} | {
    "pyramid5": 7,
    "pyramid13": 19,
    "pyramid14": 14,
}
# the orders of the nodes as the manuals of the programs print them, in our numbers
GMSH_ORDER = {
    "tet4": list(range(4)),
    "tet10": [0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
    "wedge6": list(range(6)),
    "wedge15": [*range(6), 6, 8, 12, 7, 13, 14, 9, 11, 10],
    "pyramid5": list(range(5)),
    "pyramid13": [*range(5), 5, 8, 9, 6, 10, 7, 11, 12],
    "pyramid14": [*range(5), 5, 8, 9, 6, 10, 7, 11, 12, 13],
    "hex8": list(range(8)),
    "hex20": [*range(8), 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14],
    "hex27": [*range(8), 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14, 24, 22, 20, 21, 23, 25, 26],
}


@pytest.mark.parametrize("kind", SOLIDS)
@pytest.mark.parametrize("seed", range(3))
def test_round_trips_keep_volume_and_inertia(kind: str, seed: int, tmp_path: Path) -> None:
    mesh = curved(kind, seed)
    file = tmp_path / "mesh.inp"
    write_abaqus(mesh, file)
    back = read_abaqus(file)
    np.testing.assert_allclose(measures(back), measures(as_written(mesh)), rtol=1e-14, atol=1e-14)
    assert back.element_sets["left"].tolist() == [0, 2]
    assert len(back.nodes) == 3 * len(ELEMENT_KINDS[WRITTEN.get(kind, (kind,))[0]].reference)
    np.testing.assert_array_equal(
        np.unique(back.nodes[back.node_sets["one"]]), np.unique(mesh.nodes[mesh.node_sets["one"]])
    )

    file = tmp_path / "mesh.bdf"
    write_nastran(mesh, file, STEEL, title="A title")
    again = read_nastran(file)
    np.testing.assert_allclose(measures(again), measures(as_written(mesh)), rtol=1e-12, atol=1e-12)
    assert list(again.node_sets) == ["a set, of nodes", "one"]
    for name in again.node_sets:
        np.testing.assert_array_equal(again.node_sets[name], back.node_sets[name])
    assert again.skipped == {}

    read = read_text(gmsh_text(mesh, GMSH_ORDER[kind]), "mesh.msh", tmp_path)
    np.testing.assert_allclose(measures(read), measures(mesh), rtol=1e-14, atol=1e-14)
    assert read.element_sets["group9"].tolist() == [0, 1, 2]


@pytest.mark.parametrize("kind", SOLIDS)
def test_elements_may_be_numbered_either_way_round(kind: str, tmp_path: Path) -> None:
    """A mirrored element that is numbered as before has a negative volume everywhere; its
    nodes are those of a right element.
    """
    mesh = curved(kind)
    left = Mesh(mesh.nodes * [1.0, -1.0, 1.0], mesh.blocks)
    write_abaqus(left, tmp_path / "mesh.inp")
    back = read_abaqus(tmp_path / "mesh.inp")
    # of the volume, its moments along x, y, z, and xx to zz
    signs = np.array([1, 1, -1, 1, 1, -1, 1, -1, 1, -1, 1, -1, 1])
    np.testing.assert_allclose(
        measures(back), signs * measures(as_written(mesh)), rtol=1e-12, atol=1e-14
    )


def test_a_brick_of_27_nodes_in_the_order_of_abaqus(tmp_path: Path) -> None:
    mesh = curved("hex27")
    order = [*range(20), 26, 24, 25, 22, 21, 23, 20]
    rows = [
        "*NODE",
        *(
            f"{number}, {x!r}, {y!r}, {z!r}"
            for number, (x, y, z) in enumerate(mesh.nodes.tolist(), 1)
        ),
        "*ELEMENT, TYPE=C3D27",
    ]
    for number, members in enumerate((mesh.blocks[0].connectivity[:, order] + 1).tolist(), 1):
        rows += [
            f"{number}, " + ", ".join(map(str, members[:15])) + ",",
            ", ".join(map(str, members[15:])),
        ]
    read = read_text("\n".join(rows), "mesh.inp", tmp_path)
    assert read.blocks[0].kind == "hex27"
    np.testing.assert_allclose(measures(read), measures(mesh), rtol=1e-14, atol=1e-14)


def test_kinds_together(tmp_path: Path) -> None:
    tets, bricks = curved("tet10"), curved("hex20")
    shifted = ElementBlock("hex20", bricks.blocks[0].connectivity + len(tets.nodes))
    both = Mesh(
        np.concatenate([tets.nodes, bricks.nodes]),
        (tets.blocks[0], shifted),
        {},
        {"mix": np.array([1, 4])},
    )
    write_abaqus(both, tmp_path / "mesh.inp")
    write_nastran(both, tmp_path / "mesh.bdf")
    for back in (load_mesh(tmp_path / "mesh.inp"), load_mesh(tmp_path / "mesh.bdf")):
        assert [block.kind for block in back.blocks] == ["tet10", "hex20"]
        np.testing.assert_allclose(measures(back), measures(tets) + measures(bricks), rtol=1e-12)
    assert load_mesh(tmp_path / "mesh.inp").element_sets["mix"].tolist() == [1, 4]


def test_unit(tmp_path: Path) -> None:
    mesh = curved("tet10")
    write_abaqus(mesh, tmp_path / "mesh.INP")
    in_millimetres = load_mesh(tmp_path / "mesh.INP", unit_in_metres=1e-3)
    assert measures(in_millimetres)[0] == pytest.approx(1e-9 * measures(mesh)[0], rel=1e-12)


FREE = "GRID,1\nGRID,2,,1.\nGRID,3,,,1.\nGRID,4,,,,1.\n"
TETRA = FREE + "CTETRA,1,1,1,2,3,4\n"


@pytest.mark.parametrize(
    "text",
    [
        TETRA,
        "sol 103\ncend\nbegin bulk\n" + TETRA.lower() + "enddata\nthis is not read",
        "GRID           1\nGRID           2              1.\nGRID         "
        "  3                      1.\n"
        "GRID           4                             1.0\nCTETRA         1       1       1 "
        "      2       3       4\n",
        "GRID\t1\nGRID\t2\t\t1.\nGRID\t3\t\t\t1.\nGRID\t4\t\t\t\t1.\nCTETRA\t1\t1\t1\t2\t3\t4\n",
        "GRID*                  1\n*\nGRID*                "
        "  2                              1.\n*A\n"
        "GRID*,3,,0.,1.D+0\n*,0.\nGRID*                  4                              0.  "
        "            0.*B\n*B           10.-1\n"
        "CTETRA*                1               1               1               2\n*        "
        "              3               4\n",
        FREE + "CTETRA,1,1,1,2,3,4,,,+E1\n+E1,,,,\n",
        FREE
        + "CTETRA  1       1       1       2       3       4                       +E1     \n+E1\n",
        FREE + "CTETRA,1,,1,2,3,4 $ a comment, with commas\n$ CPENTA,1\n\n",
        "\ufeff" + TETRA.replace("\n", "\r\n"),
        TETRA + "$ caf\xe9 \xb0\n",
    ],
)
def test_nastran_fields(text: str, tmp_path: Path) -> None:
    mesh = read_text(text, "mesh.bdf", tmp_path)
    np.testing.assert_array_equal(
        mesh.nodes[mesh.blocks[0].connectivity[0]], [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    )
    assert mesh.element_sets["PID1"].tolist() == [0]


REPEATED = "GRID,1\nGRID,2,,1.\n=,*(1),=,-0.,*(1.)\nGRID,4,,,,1.\nCTETRA,1,1,1,2,3,4\n"


def test_cards_that_repeat_the_one_before_them(tmp_path: Path) -> None:
    mesh = read_text(REPEATED, "mesh.bdf", tmp_path)
    np.testing.assert_array_equal(
        mesh.nodes[mesh.blocks[0].connectivity[0]], [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    )
    rows = "GRID,1\n=,*(1),=,*1.,==\n=(2)\nGRID,11,,0.,1.\n=,*1,=,*(1.),==\n=2\nGRID,21,,,,1.\n=,*(1),=,*(1.),==\n=2\n"
    mesh = read_text(
        rows + "CTETRA,1,1,1,2,11,21\n=,*(1),=,*(1),*(1),*(1),*(1)\n=(1)\n", "mesh.bdf", tmp_path
    )
    assert mesh.nodes[mesh.blocks[0].connectivity].tolist() == [
        [[x, 0, 0], [x + 1, 0, 0], [x, 1, 0], [x, 0, 1]] for x in (0.0, 1.0, 2.0)
    ]


def test_grid_points_in_local_systems(tmp_path: Path) -> None:
    """Rectangular, cylindrical and spherical, one in another, by points and by nodes, in
    any order, and by default.
    """
    tetra = "CTETRA,1,1,1,2,3,4\n"
    square = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    # the origin at (3, 4, 5), z along the global x, and the plane of x and z that of the global x
    # and y
    turned = "CORD2R,5,,3.,4.,5.,9.,4.,5.\n,3.,9.,5.\n"
    expected = np.array([3, 4, 5]) + square[:, [2, 0, 1]]
    rows = "GRID,1,5\nGRID,2,5,1.\nGRID,3,5,,1.\nGRID,4,5,,,1.\n"
    tried = [rows + turned, turned + "GRDSET,,5\n" + rows.replace(",5", ",")]
    polar = turned + "CORD2C,6,5,,,,,,1.\n,1.\n"
    tried.append(polar + "GRID,1,6\nGRID,2,6,1.\nGRID,3,6,1.,90.\nGRID,4,6,,70.,1.\n")
    round_ = turned + "CORD2S,7,5,,,,,,1.\n,1.\n"
    tried.append(round_ + "GRID,1,7\nGRID,2,7,1.,90.\nGRID,3,7,1.,90.,90.\nGRID,4,7,1.,,33.\n")
    # by three nodes, of which one stands in a cylinder: at (3, 4, 5), (9, 4, 5) and (3, 9, 5)
    tried.append(
        "CORD1R,8,101,102,103\nGRID,101,,3.,4.,5.\nGRID,102,,9.,4.,5.\nCORD2C,9,,,,,,,1.\n,1.\nGRID,103,9,9.486832980505138,71.56505117707799,5.\n"
        + rows.replace(",5", ",8")
    )
    # on axes that a cylinder gives: its points by radius and angle
    tried.append(
        "CORD2C,9,,,,,,,1.\n,1.\nCORD2R,5,9,5.,53.13010235415598,5.,9.848857801796104,23.962488974578176,5.\n,9.486832980505138,71.56505117707799,5.\n"
        + rows
    )
    for text in tried:
        mesh = read_text(text + tetra, "mesh.bdf", tmp_path)
        np.testing.assert_allclose(mesh.nodes[mesh.blocks[0].connectivity[0]], expected, atol=1e-12)


def test_latin_text_is_read(tmp_path: Path) -> None:
    assert (
        read_text(
            (TETRA + "$ caf\xe9\n").encode("latin-1"), "mesh.bdf", tmp_path
        ).number_of_elements
        == 1
    )


def test_nastran_sets(tmp_path: Path) -> None:
    case = (
        "SET 1 = 1,2,THRU,\n 3\nSET 2 = 4 THRU 1000000000000\nSET 3 = ALL\nSET 4 = 0.1, "
        "0.2\nSET 5 = 99\n$ node set 2: the top\n"
    )
    mesh = read_text(
        case
        + "BEGIN BULK\n"
        + TETRA
        + "SPC1,7,123,1,THRU,2\nSPC1,7,3,4\nSPC,8,1,3,0.\nPSOLID,1,1\nENDDATA\n",
        "mesh.bdf",
        tmp_path,
    )
    assert {name: members.tolist() for name, members in mesh.node_sets.items()} == {
        "SET1": [0, 1, 2],
        "the top": [3],
        "SPC7": [0, 1, 3],
    }
    assert mesh.skipped == {"SET": 2, "SPC": 1, "set without solid elements or their nodes": 1}


def test_nastran_numbers() -> None:
    for text, value in [
        ("1.5-3", 1.5e-3),
        ("-.5+2", -50.0),
        ("1.D+3", 1e3),
        ("2.d-1", 0.2),
        ("1.E2", 100.0),
        ("7", 7.0),
    ]:
        assert nastran_real(text, None) == pytest.approx(value, rel=1e-15)
    choose = np.random.default_rng(1)
    values = np.concatenate(
        [
            choose.standard_normal(3000) * 10.0 ** choose.integers(-30, 14, 3000),
            [0.0, -0.0, 1.0, 1e-300, -1e15],
        ]
    )
    for value in values.tolist():
        text = nastran_number(value)
        assert len(text) <= 16
        assert "." in text
        assert nastran_real(text, None) == pytest.approx(
            value, rel=1e-10 if abs(value) < 1e-9 else 1e-11, abs=0
        )


def test_includes(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "nodes.bdf").write_text(
        "INCLUDE 'more.bdf'\n" + FREE.replace("GRID,1\n", "")
    )
    (tmp_path / "parts" / "more.bdf").write_text("GRID,1\n")
    mesh = read_text("include 'parts\\nodes.bdf'\nCTETRA,1,1,1,2,3,4\n", "mesh.bdf", tmp_path)
    assert len(mesh.nodes) == 4
    (tmp_path / "nodes.inc").write_text("1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n")
    (tmp_path / "tets.inc").write_text("*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n")
    deck = "*NODE, NSET=most, INPUT=nodes.inc\n4, 0., 0., 1.\n*INCLUDE, INPUT=tets.inc\n"
    assert read_text(deck, "mesh.inp", tmp_path).node_sets["most"].tolist() == [0, 1, 2, 3]


NODES = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n900000000000000000,5,5,5\n"
DECK = NODES + "*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n"


def test_abaqus_assembly(tmp_path: Path) -> None:
    text = f"""*Heading
 anything, *at all
** a comment
*Part, name=P
{NODES}*Element, type=C3D4H, elset=Skin
 7, 1,
 2, 3, 4
*ELEMENT, TYPE=S3
 8, 1, 2,
 3
*Nset, nset=Base, generate
 1, 1000000000000, 2
*nset, nset="all of, it"
 base, 2, 4,
*Elset, elset=both
 skin, 8
*End Part
*Assembly, name=A
*Node
 1, 9., 9., 9.
*Instance, name=P-1, part=P
*End Instance
*Node
 2, 9., 9., 9.
*Nset, nset=RP
 1
*Nset, nset=top, instance=P-1
 P-1.4, P-1.BASE
*End Assembly
*Material, name=steel
*Density
 7850.,
"""
    mesh = read_text(text, "mesh.inp", tmp_path)
    assert {name: members.tolist() for name, members in mesh.node_sets.items()} == {
        "Base": [0, 2],
        "all of, it": [0, 1, 2, 3],
        "top": [0, 2, 3],
    }
    assert {name: members.tolist() for name, members in mesh.element_sets.items()} == {
        "Skin": [0],
        "both": [0],
    }
    assert mesh.skipped == {"S3": 1, "*NODE": 2, "*NSET": 1}
    assert len(mesh.nodes) == 4


def test_coordinates_at_the_end_may_be_left_out(tmp_path: Path) -> None:
    deck = DECK.replace("1,0,0,0", "1,0.").replace("2,1,0,0", "2,1.").replace("3,0,1,0", "3,0.,1.")
    mesh = read_text(deck, "mesh.inp", tmp_path)
    np.testing.assert_array_equal(mesh.nodes, [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])


def test_a_set_that_doubles_itself_stays_small(tmp_path: Path) -> None:
    rows = [DECK + "*NSET, NSET=s0\n1, 2"] + [
        f"*NSET, NSET=s{number + 1}\ns{number}, s{number}" for number in range(200)
    ]
    mesh = read_text("\n".join(rows), "mesh.inp", tmp_path)
    assert mesh.node_sets["s200"].tolist() == [0, 1]


@pytest.mark.parametrize("write", one_in(3, ["inp", "bdf", "msh"]))
def test_large_files_are_read(write: str, tmp_path: Path) -> None:
    n = 30
    numbers = np.arange((n + 1) ** 3).reshape(n + 1, n + 1, n + 1)
    nodes = np.stack(np.meshgrid(*3 * [np.linspace(0, 1, n + 1)], indexing="ij"), axis=-1).reshape(
        -1, 3
    )
    corners = ELEMENT_KINDS["hex8"].reference.astype(int)
    bricks = np.stack(
        [numbers[x : n + x, y : n + y, z : n + z].ravel() for x, y, z in corners], axis=1
    )
    mesh = Mesh(nodes, (ElementBlock("hex8", bricks),))
    file = tmp_path / f"mesh.{write}"
    if write == "msh":
        file.write_text(gmsh_text(mesh, GMSH_ORDER["hex8"]))
    else:
        (write_nastran if write == "bdf" else write_abaqus)(mesh, file)
    assert load_mesh(file).number_of_elements == n**3


def test_written_plates(tmp_path: Path) -> None:
    write_nastran(plate(), tmp_path / "plate.bdf", STEEL, thickness=0.01)
    rows = (tmp_path / "plate.bdf").read_text().splitlines()
    assert sum(row.startswith("CQUAD8") for row in rows) == 8
    assert sum(row.startswith("GRID*") for row in rows) == 45 - 8
    assert [row for row in rows if row.startswith("PSHELL*")] == [
        "PSHELL*                2               1             .01               1"
    ]
    assert not any(row.startswith("PSOLID") for row in rows)
    write_abaqus(plate(), tmp_path / "plate.inp", STEEL, thickness=0.01)
    text = (tmp_path / "plate.inp").read_text()
    assert "*ELEMENT, TYPE=S8R\n1, 1, 3, " in text
    assert "*SHELL SECTION, ELSET=SHELLS, MATERIAL=steel\n0.01\n" in text
    assert "*ELSET, ELSET=left\n1, 2, 3, 4\n" in text
    assert "*DENSITY\n7850.0\n*ELASTIC\n210000000000.0, 0.3\n" in text


TET = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n"
TWO_PARTS = (
    f"*PART,NAME=B\n{TET}*END PART\n*INSTANCE,NAME=I,PART=B\n*END INSTANCE\n"
    + "*INSTANCE,NAME=J,PART=B\n0,0,1\n*END INSTANCE\n"
)
FAULTS: list[tuple[str, str | bytes, str]] = [
    ("mesh.bdf", "", ": the file is empty"),
    ("mesh.bdf", b"GRID,1\0", ": this is not a text file"),
    (
        "mesh.bdf",
        FREE,
        ": the file has no solid element; a mesh is of tetrahedra, pyramids, wedges or bricks",
    ),
    ("mesh.bdf", FREE + "CQUAD4,1,1,1,2,3,4\n", "bricks; left out: CQUAD4 (1)"),
    (
        "mesh.bdf",
        FREE + "CTETRA,1,1,1,2,3,5\n",
        ":5: element 1 has the node 5, which the file does not give",
    ),
    ("mesh.bdf", "CTETRA,1,1,1,2,3,5\n", ":1: element 1 has the node 1, which"),
    ("mesh.bdf", FREE + "CTETRA,1,1,1,2,3\n", ":5: CTETRA 1 has 3 nodes; it must have 4 or 10"),
    (
        "mesh.bdf",
        FREE + "CTETRA,1,1,1,2,,4,1,2\n",
        ":5: CTETRA 1 has 5 nodes; it must have 4 or 10, and only nodes on edges may be left",
    ),
    ("mesh.bdf", FREE + "CTETRA,1,1,1,2,,4\n", ":5: CTETRA 1 has 3 nodes"),
    (
        "mesh.bdf",
        FREE + "CWEDGE,1,1,1,2,3,4,1\n",
        '5: "CWEDGE" is a solid element that is not read; the elements must be CTETRA, '
        "CPYRAM, CPENTA or CHEXA",
    ),
    ("mesh.bdf", FREE + "CPYRAM,1,1,1,2,3,4\n", ":5: CPYRAM 1 has 4 nodes; it must have 5 or 13"),
    (
        "mesh.bdf",
        TETRA + "GRID,1,,2.\n",
        ":6: node 1 was given other coordinates in line 1; a node may be given again at the "
        "same place only",
    ),
    (
        "mesh.bdf",
        TETRA + "CTETRA,1,1,4,1,2,3\n",
        ":6: element 1 was given in line 5 already; an element may be given once",
    ),
    (
        "mesh.bdf",
        "GRID,1,3\n",
        ":1: the coordinate system 3 is not in the file; its CORD1R, CORD1C",
    ),
    ("mesh.bdf", "GRDSET,,3\nGRID,1\n", ":2: the coordinate system 3 is not in the file"),
    (
        "mesh.bdf",
        "GRID,1,3\nCORD2R,3,,0.,0.,0.,0.,0.,1.\n,0.,0.,5.\n",
        ":2: the three points of the coordinate system 3 lie on one line",
    ),
    (
        "mesh.bdf",
        "GRID,1,3\nCORD2R,3,4,,,,,,1.\n,1.\nCORD2R,4,3,,,,,,1.\n,1.\n",
        "refers to itself",
    ),
    (
        "mesh.bdf",
        "GRID,1,3\nCORD1R,3,7,8,9\n",
        ":2: the GRID 7 that defines the coordinate system is not in the file",
    ),
    ("mesh.bdf", "GRID,1,-1\n", ':1: "-1" is not the number of a coordinate system'),
    ("mesh.bdf", "=,*(1)\n", ":1: a card is repeated without one before it"),
    ("mesh.bdf", "GRID,1\n=(3)\n", ':2: "=(3)" repeats steps, and the line before has none'),
    ("mesh.bdf", "GRID,1\n=x,2\n", ':2: "=x" is no repetition; it must be "=", or "=(n)"'),
    ("mesh.bdf", "DEFORM,1,a\n=,=,*(1)\n", ':2: "a" is not a number that can be stepped'),
    (
        "mesh.bdf",
        "CHEXA,1,1,1,2,3,4,5,6\n,7,8\n=,*(1),=\n",
        ":3: a CHEXA of several lines is repeated",
    ),
    ("mesh.bdf", "GRID,1,,nan\n", ":1: node 1 has the coordinate nan; it must be finite"),
    ("mesh.bdf", "GRID,1,,1.+999\n", ":1: node 1 has the coordinate inf"),
    ("mesh.bdf", "GRID,1,,x\n", ':1: "x" is not a coordinate; it must be a number such as'),
    ("mesh.bdf", "GRID,one\n", ':1: "one" is not the number of a node; it must be a whole number'),
    (
        "mesh.bdf",
        "GRID*,1,,0.,0.\n",
        ":1: GRID* 1 has two coordinates; the third must stand in a second line",
    ),
    (
        "mesh.bdf",
        "GRID,1,,,,,,,,+A\n+B,1\n",
        ':2: "B" does not go on with the card before it, which asks for "A"',
    ),
    ("mesh.bdf", "+A,1\n", ":1: a line goes on without a card before it"),
    ("mesh.bdf", "BEGIN SUPER=1\n", ':1: "BEGIN SUPER" is not read'),
    (
        "mesh.bdf",
        "BEGIN BULK\n" + TETRA,
        ": there is a BEGIN BULK but no ENDDATA; the file is cut short, or that line was left out",
    ),
    ("mesh.bdf", "SPC1,1,123,x\n", ":1: the nodes of SPC1 can't be read"),
    ("mesh.bdf", "INCLUDE 'no.bdf'\n", ":1: the file to include can't be read"),
    (
        "mesh.bdf",
        "INCLUDE 'mesh.bdf'\n",
        ':1: "mesh.bdf" is included a second time; a file may be included once',
    ),
    (
        "mesh.bdf",
        TETRA + "INCLUDE 'more\n.bdf'\n",
        ":6: the file to include is not given; its name must be on the line of INCLUDE, in quotes",
    ),
    (
        "mesh.inp",
        DECK + "*INCLUDE\n",
        ":9: the file to include is not given; *INCLUDE must have INPUT=file on its first line",
    ),
    (
        "mesh.inp",
        DECK + "*ELEMENT, TYPE=C3D4,\nINPUT=more.inp\n",
        ":9: the file to include is not given; *ELEMENT must have",
    ),
    ("mesh.inp", "1,0,0,0\n", ":1: there are data before the first keyword"),
    ("mesh.inp", "*NODE\n1 0 0\n", ":2: a node must have a number and up to three coordinates"),
    (
        "mesh.inp",
        "*NODE, SYSTEM=C\n1,0,0,0\n",
        ":1: the nodes are in cylindrical or spherical coordinates",
    ),
    ("mesh.inp", "*NODE\n1,0,0,inf\n", ":2: node 1 has the coordinate inf"),
    (
        "mesh.inp",
        DECK + "*ELEMENT,TYPE=C3D7\n2,1,2,3,4,1\n",
        ':9: "C3D7" is an element that is not read; solid elements must be C3D4',
    ),
    (
        "mesh.inp",
        DECK + "*ELEMENT,TYPE=C3D15V\n2,1\n",
        ":10: element 2 has 1 nodes; C3D15V must have 15",
    ),
    ("mesh.inp", DECK + "*ELEMENT\n", ":9: *ELEMENT has no TYPE"),
    (
        "mesh.inp",
        NODES + "*ELEMENT,TYPE=C3D4\n1,1,2,3\n",
        ":8: element 1 has 3 nodes; C3D4 must have 4",
    ),
    (
        "mesh.inp",
        NODES + "*ELEMENT,TYPE=C3D4\n1,1,2,3,\n",
        ":8: element 1 has 3 nodes and its lines end there; C3D4 must have 4",
    ),
    (
        "mesh.inp",
        NODES + "*ELEMENT,TYPE=C3D4\n1,1,2,3,4,4\n",
        ":8: element 1 has 5 nodes; C3D4 must have 4",
    ),
    (
        "mesh.inp",
        DECK + "*NSET,NSET=a\nbse\n*NSET,NSET=b\n1",
        ':10: "bse" is neither a number nor a *NSET before this line',
    ),
    (
        "mesh.inp",
        DECK + "*NSET,NSET=base\n1\n*NSET,NSET=b\nbse",
        'one of them. Did you mean "BASE"?',
    ),
    ("mesh.inp", DECK + "*NSET,NSET=a,GENERATE\n5,1\n", ":10: GENERATE needs first and last"),
    ("mesh.inp", DECK + "*NSET\n1\n", ":9: *NSET has no name"),
    ("mesh.inp", DECK + "*NGEN\n1,2\n", ":9: *NGEN makes nodes or elements by a rule"),
    ("mesh.inp", DECK + "*SYSTEM\n1,0,0\n", ":9: *SYSTEM moves the nodes"),
    (
        "mesh.inp",
        "*PART,NAME=A\n*END PART\n*PART,NAME=B\n*END PART\n",
        ":3: the parts of the file are in no assembly",
    ),
    (
        "mesh.inp",
        "*PART,NAME=A\n*END PART\n*PART,NAME=A\n",
        ':3: a part of the name "A" was given before',
    ),
    ("mesh.inp", "*PART,NAME=A\n*PART,NAME=B\n", ":1: *PART has no *END PART before the next one"),
    (
        "mesh.inp",
        TWO_PARTS.replace("PART=B", "PART=C"),
        ':10: the instance is of the part "C", which is not in the file',
    ),
    (
        "mesh.inp",
        TWO_PARTS.replace("NAME=J", "NAME=I"),
        ':12: the instance has no name of its own, but "I"',
    ),
    (
        "mesh.inp",
        TWO_PARTS.replace("\n0,0,1\n", "\n0,0,1\n0,0,0,0,0,1\n"),
        ":14: the turn of the instance has 6 numbers",
    ),
    (
        "mesh.inp",
        TWO_PARTS.replace("\n0,0,1\n", "\n0,0,1\n0,0,0,0,0,0,9\n"),
        ":14: the two points of the axis of the turn are the same",
    ),
    (
        "mesh.inp",
        TWO_PARTS.replace("\n0,0,1\n", "\n0,0,1e999\n"),
        ":13: the place of the instance is not finite",
    ),
    (
        "mesh.inp",
        TWO_PARTS.replace("2,1,0,0", "2000000000000,1,0,0"),
        ":4: the number 2000000000000 is too large for a part",
    ),
    (
        "mesh.inp",
        TWO_PARTS + "*ASSEMBLY\n*NSET,NSET=x,INSTANCE=K\n1\n*END ASSEMBLY\n",
        ':16: there is no instance "K" before',
    ),
    (
        "mesh.inp",
        TWO_PARTS.replace("1,1,2,3,4", "1,1,2,3,9"),
        ":8: element 1 has the node 9, which the file does not give",
    ),
    ("mesh.inp", TWO_PARTS.replace("2,1,0,0", "2,1,0,1e20"), ":4: node 2 has the coordinate 1e+20"),
    (
        "mesh.inp",
        TWO_PARTS.replace("2,1,0,0", "2,1,0,0\n2,1,0,1"),
        ":5: node 2 was given other coordinates in line 4",
    ),
    (
        "mesh.inp",
        TWO_PARTS.replace("1,1,2,3,4", "1,1,2,3"),
        ":8: element 1 has 3 nodes; C3D4 must have 4",
    ),
    (
        "mesh.msh",
        "$NOD\n0\n$ENDNOD\n",
        ':1: "$NOD" has no "$EndNOD"; the file is cut short, or its format is none of 2, '
        "4.0 and 4.1",
    ),
    (
        "mesh.inp",
        "*PART,NAME=A\n" + DECK,
        ":1: *PART has no *END PART; the file is cut short, or that line was left out",
    ),
    (
        "mesh.inp",
        "*INSTANCE,NAME=A,PART=P\n0,0,1\n*END INSTANCE\n",
        ':1: the instance is of the part "P", which is not in the file',
    ),
    ("mesh.inp", "*NODE,INPUT=no.inp\n", ":1: the file to include can't be read"),
    ("mesh.msh", "hello\n", ':1: "hello" stands outside a section'),
    (
        "mesh.msh",
        b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\n",
        ": this is a binary file; save the mesh as ASCII (in Gmsh the option Mesh.B",
    ),
    (
        "mesh.msh",
        "$MeshFormat\n1 0 8\n$EndMeshFormat\n$Nodes\n$EndNodes\n$Elements\n$EndElements\n",
        ':2: the version "1" is not read; it must be',
    ),
    ("mesh.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", ": the file has no $Nodes"),
    (
        "mesh.msh",
        "$MeshFormat\n2.2 0 8\n",
        ':1: "$MeshFormat" has no "$EndMeshFormat"; the file is cut short',
    ),
    (
        "mesh.stl",
        "",
        '".stl" is not read; a mesh must be .bdf, .dat, .nas, .fem, .inp, .msh, .step, .stp '
        "or .brep",
    ),
    ("mesh", "", '"" is not read; a mesh must be .bdf'),
]
FOUR = "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1"
GMSH_FAULTS = [
    (
        FOUR,
        "1\n1 13 2 1 1 1 2 3 4 1 2",
        ":13: the element is a prism of 18 nodes, which is not read; prisms must "
        "have 6 or 15 nodes",
    ),
    (FOUR, "1\n1 7 2 1 1 1 2 3 4", ":13: the element has 4 nodes; its type 7 must have 5"),
    (
        FOUR,
        "1\n1 29 2 1 1 1 2 3 4 1",
        ":13: the element is of type 29, which is not read; all must be of first or second order",
    ),
    (FOUR, "1\n1 4 2 1 1 1 2 3", ":13: the element has 3 nodes; its type 4 must have 4"),
    (FOUR, "1\n1 4 2 1 1 1 2 3 9", ":13: element 1 has the node 9, which the file does not give"),
    (
        FOUR,
        "1000000000000000\n1 4 2 1 1 1 2 3 4",
        ":11: $Elements states 1000000000000000 lines where 1 is left",
    ),
    (
        "1000000000000000\n1 0 0 0",
        "0",
        ":4: $Nodes states 1000000000000000 lines where 1 is left; the file is truncated",
    ),
    ("99999999999999999999\n1 0 0 0", "0", ':5: "99999999999999999999" is not the number of nodes'),
    ("1\n1 0 0", "0", ":6: the line has 3 of the 4 entries that it must have"),
    ("0\n1 0 0 0", "0", ":6: $Nodes has more lines than it states"),
    ("", "0", ":4: $Nodes ends too soon"),
    (FOUR, "1\n1 2 2 1 1 1 2 3", ": the file has no solid element"),
]
FAULTS += [
    ("mesh.msh", MSH.format(nodes=nodes, elements=elements), message)
    for nodes, elements, message in GMSH_FAULTS
]


@pytest.mark.parametrize(
    ("name", "text", "message"),
    FAULTS,
    ids=[f"{name[5:]}-{message[:40]}" for name, _, message in FAULTS],
)
def test_wrong_files(name: str, text: str | bytes, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as raised:
        read_text(text, name, tmp_path)
    assert str(raised.value).startswith(f"{tmp_path / name}:")
    assert message in str(raised.value)
    assert "\n" not in str(raised.value)


def test_wrong_paths(tmp_path: Path) -> None:
    (tmp_path / "folder.bdf").mkdir()
    for name, message in [
        ("no.bdf", "there is no such file"),
        ("folder.bdf", "this is a directory"),
        ("no.step", "there is no such file"),
    ]:
        with pytest.raises(InputError, match=message):
            load_mesh(tmp_path / name)
    with pytest.raises(
        InputError, match="unit_in_metres: 0 m is not allowed; it must be greater than 0 and finite"
    ):
        load_mesh("mesh.bdf", unit_in_metres=0)
    with pytest.raises(InputError, match="the file is a mesh already"):
        load_mesh("mesh.bdf", size=1)
    with pytest.raises(InputError, match="size: -1 m is not allowed; it must be greater than 0"):
        load_mesh("mesh.step", size=-1)
    with pytest.raises(InputError, match="order: 3 is not allowed; it must be 1 or 2"):
        mesh_geometry("mesh.step", order=3)
    with pytest.raises(InputError, match="a STEP file states its own unit; leave this out"):
        load_mesh("mesh.stp", unit_in_metres=1e-3)


def test_what_can_not_be_written(tmp_path: Path) -> None:
    mesh = curved("tet4")
    with pytest.raises(InputError, match="is rigid or has no density"):
        write_nastran(mesh, tmp_path / "mesh.bdf", RIGID)
    with pytest.raises(InputError, match="is rigid or has no density"):
        write_abaqus(mesh, tmp_path / "mesh.inp", RIGID)
    with pytest.raises(InputError, match="the mesh has no elements"):
        write_abaqus(Mesh(np.zeros((0, 3)), ()), tmp_path / "mesh.inp")
    with pytest.raises(InputError, match="thickness: 0 m is not allowed"):
        write_nastran(plate(), tmp_path / "mesh.bdf", thickness=0)
    with pytest.raises(InputError, match="the file can't be written"):
        write_vtu(mesh, tmp_path / "no" / "mesh.vtu", {})
    with pytest.raises(
        InputError, match=r"u: the values have the shape \(2,\); it must be \(17,\) or \(17, 3\)"
    ):
        write_vtu(mesh, tmp_path / "mesh.vtu", {"u": [1, 2]})
    with pytest.raises(InputError, match="u: the values are not real numbers"):
        write_vtu(mesh, tmp_path / "mesh.vtu", {"u": np.ones(17) * 1j})
    assert not list(tmp_path.iterdir())


def test_names_and_titles_can_not_break_a_file(tmp_path: Path) -> None:
    mesh = curved("tet4")
    name = 'a\n*NODE\n"1", $2'
    wild = Mesh(
        mesh.nodes, mesh.blocks, {name: mesh.blocks[0].connectivity[0]}, {name: np.array([0])}
    )
    write_nastran(wild, tmp_path / "mesh.bdf", title="one\nBEGIN BULK\ntwo")
    write_abaqus(wild, tmp_path / "mesh.inp")
    write_vtu(wild, tmp_path / "mesh.vtu", {'<&"\n': np.zeros(17)})
    assert list(load_mesh(tmp_path / "mesh.bdf").node_sets) == ['a *NODE "1", 2']
    assert list(load_mesh(tmp_path / "mesh.inp").node_sets) == ["a *NODE '1', $2"]


def test_readers_take_texts_as_paths(tmp_path: Path) -> None:
    (tmp_path / "mesh.txt").write_text(MSH.format(nodes=FOUR, elements="1\n1 4 2 1 1 1 2 3 4"))
    assert read_gmsh(str(tmp_path / "mesh.txt")).number_of_elements == 1


def test_a_node_given_again_in_an_included_file_names_that_file(tmp_path: Path) -> None:
    (tmp_path / "more.bdf").write_text("GRID,1,,2.\n")
    (tmp_path / "mesh.bdf").write_text("INCLUDE 'more.bdf'\n" + TETRA)
    with pytest.raises(InputError) as raised:
        load_mesh(tmp_path / "mesh.bdf")
    assert (
        f"mesh.bdf:2: node 1 was given other coordinates in line 1 of {tmp_path / 'more.bdf'}"
        in str(raised.value)
    )
