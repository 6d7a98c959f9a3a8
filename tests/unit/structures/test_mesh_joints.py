"""Parts that the mesh file joins: a block cut in two and joined again, by each of the
ways of Nastran and Abaqus.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from scipy.linalg import eigh, null_space

import vibroimpact as vi
from solid_meshes import together
from support import plain_case
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.materials import Material
from vibroimpact.meshes.mesh_file import load_mesh
from vibroimpact.meshes.write_abaqus import write_abaqus
from vibroimpact.meshes.write_nastran import write_nastran
from vibroimpact.structures.finite_elements.geometry import check_mesh
from vibroimpact.structures.finite_elements.joints import solved_joints
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.parts import number_of_parts
from vibroimpact.structures.finite_elements.structure import solid_structure
from vibroimpact.structures.mirrored import elastic_system
from vibroimpact.structures.recipe import ImportedMesh, Recipe, computed_model
from vibroimpact.structures.support_force import computed_support_forces
from vibroimpact.structures.supports.edge import Edge
from vibroimpact.structures.supports.support import Support, held_by

STEEL = Material(7850.0, 210e9, 0.3)
SIZE = (0.2, 0.1, 0.05)
FACES = {
    "S1": (0, 1, 2, 3),
    "S2": (4, 5, 6, 7),
    "S3": (0, 1, 5, 4),
    "S4": (1, 2, 6, 5),
    "S5": (2, 3, 7, 6),
    "S6": (3, 0, 4, 7),
}
"""Corners of the faces of bricks, as the manual of Abaqus numbers them."""


def halves(
    first: tuple[int, int, int] = (2, 2, 1),
    second: tuple[int, int, int] = (2, 2, 1),
    kind: str = "hex20",
) -> Mesh:
    """Two blocks whose faces touch at x = 0, without a common node."""
    one, other = box_mesh(SIZE, first, kind), box_mesh(SIZE, second, kind)
    shift = np.array([0.1, 0.0, 0.0])
    return together(
        replace(one, nodes=one.nodes - shift), replace(other, nodes=other.nodes + shift)
    )


def pairs(mesh: Mesh) -> list[tuple[int, int]]:
    """The nodes of both halves at the same places, numbered from 1."""
    first, second = mesh.node_sets["nodes0"], mesh.node_sets["nodes1"]
    apart = np.linalg.norm(mesh.nodes[first][:, None] - mesh.nodes[second][None], axis=2)
    return [
        (int(first[row]) + 1, int(second[column]) + 1) for row, column in np.argwhere(apart < 1e-9)
    ]


def surface(mesh: Mesh, name: str, part: str, where: float = 0.0) -> str:
    rows = [f"*SURFACE, NAME={name}"]
    for element in mesh.element_sets[part].tolist():
        corners = mesh.nodes[mesh.blocks[0].connectivity[element]]
        rows += [
            f"{element + 1}, {label}"
            for label, face in FACES.items()
            if np.allclose(corners[list(face), 0], where)
        ]
    return "\n".join([*rows, ""])


def tie(mesh: Mesh, *, follower: str = "part0", leader: str = "part1", more: str = "") -> str:
    return (
        surface(mesh, "FOLLOWS", follower)
        + surface(mesh, "LEADS", leader)
        + f"*TIE, NAME=T{more}\nFOLLOWS, LEADS\n"
    )


ALL_AROUND = "*SURFACE,NAME=A\npart0,\n*SURFACE,NAME=B\npart1,\n*TIE,NAME=T\nA, B\n"
"""The tie of all outer faces of the elements of both halves."""


def read(mesh: Mesh, more: str, folder: Path, suffix: str) -> Mesh:
    file = folder / f"joined.{suffix}"
    if suffix == "bdf":
        write_nastran(mesh, file)
        file.write_text(
            file.read_text().replace("CEND", "CEND\nMPC = 7").replace("ENDDATA", f"{more}ENDDATA")
        )
    else:
        write_abaqus(mesh, file)
        file.write_text(file.read_text() + more)
    return load_mesh(file)


def frequencies(mesh: Mesh, supports: tuple[Support, ...] = (), rigid: int = 6) -> np.ndarray:
    """The lowest frequencies; the body has its mass and its rigid motions."""
    check_mesh(mesh)
    structure = solid_structure(mesh, STEEL)
    assert structure.properties.mass == pytest.approx(7850 * 0.4 * 0.1 * 0.05, rel=1e-9)
    held = held_by(structure, supports)
    assert held.rigid.shape[1] == rigid
    return elastic_system(held).modes(6).angular_frequencies


WHOLE = box_mesh((0.4, 0.1, 0.05), (4, 2, 1))
NASTRAN: dict[str, Callable[[list[tuple[int, int]]], str]] = {
    "RBE2": lambda at: "".join(
        f"RBE2,{900 + row},{one},123,{other}\n" for row, (one, other) in enumerate(at)
    ),
    "RBAR": lambda at: "".join(
        f"RBAR,{900 + row},{one},{other},123456,,,123\n" for row, (one, other) in enumerate(at)
    ),
    "RBE1": lambda at: "".join(
        f"RBE1,{900 + row},{one},123456,,,,,\n,UM,{other},123\n"
        for row, (one, other) in enumerate(at)
    ),
    "RBE3": lambda at: "".join(
        f"RBE3,{900 + row},,{one},123,1.,123,{other}\n" for row, (one, other) in enumerate(at)
    ),
    "MPC": lambda at: "".join(
        f"MPC,7,{one},{axis},1.,{other},{axis},-1.\n" for one, other in at for axis in (1, 2, 3)
    ),
}
ABAQUS: dict[str, Callable[[list[tuple[int, int]]], str]] = {
    "*EQUATION": lambda at: (
        "*EQUATION\n"
        + "".join(
            f"2\n{one},{axis},1.,{other},{axis},-1.\n" for one, other in at for axis in (1, 2, 3)
        )
    ),
    "*MPC": lambda at: "*MPC\n" + "".join(f"TIE, {one}, {other}\n" for one, other in at),
    "*EQUATION of sets": lambda at: (
        "".join(
            f"*NSET, NSET=S{side}\n" + "".join(f"{pair[side]}\n" for pair in at) for side in (0, 1)
        )
        + "*EQUATION\n"
        + "".join(f"2\nS0,{axis},1.\nS1,{axis},-1.\n" for axis in (1, 2, 3))
    ),
}


@pytest.mark.parametrize("name", [*NASTRAN, *ABAQUS])
def test_matching_halves_are_one_block_again(name: str, tmp_path: Path) -> None:
    mesh = halves()
    suffix, made = ("bdf", NASTRAN) if name in NASTRAN else ("inp", ABAQUS)
    joined = read(mesh, made[name](pairs(mesh)), tmp_path, suffix)
    assert list(joined.joined_by) == [name.split(" ")[0]]
    assert joined.remarks == ()
    assert number_of_parts(joined) == 1
    np.testing.assert_allclose(frequencies(joined), frequencies(WHOLE), rtol=1e-10)


@pytest.mark.parametrize("labels", [True, False])
def test_tied_surfaces_that_match(labels: bool, tmp_path: Path) -> None:
    """With faces by their labels, and with all outer faces of the elements; the nodes of
    the sides are too far then, and not tied.
    """
    mesh = halves()
    joined = read(mesh, tie(mesh) if labels else ALL_AROUND, tmp_path, "inp")
    assert joined.joined_by == {"*TIE": 1}
    assert [remark.split(" are further")[0] for remark in joined.remarks] == (
        [] if labels else ["of the 50 nodes that the mesh file ties by A to B, 37"]
    )
    np.testing.assert_allclose(frequencies(joined), frequencies(WHOLE), rtol=1e-10)


@pytest.mark.parametrize(("kind", "tolerance"), [("hex20", 0.004), ("hex8", 0.03), ("tet10", 0.01)])
def test_tied_surfaces_that_do_not_match(kind: str, tolerance: float, tmp_path: Path) -> None:
    """The finer follows; frequencies lie between those of two whole blocks, as coarse and
    as fine as the halves, within a tolerance.
    """
    mesh = halves((8, 5, 3), (4, 3, 2), kind)
    joined = read(mesh, ALL_AROUND if kind == "tet10" else tie(mesh), tmp_path, "inp")
    fine, coarse = (
        frequencies(box_mesh((0.4, 0.1, 0.05), counts, kind)) for counts in ((16, 5, 3), (8, 3, 2))
    )
    found = frequencies(joined)
    assert (found > fine * (1 - tolerance)).all()
    assert (found < coarse * (1 + tolerance)).all()


def test_a_coarse_surface_that_follows_a_fine_one_is_told(tmp_path: Path) -> None:
    mesh = halves((4, 2, 1), (8, 5, 3))
    (remark,) = read(mesh, tie(mesh), tmp_path, "inp").remarks
    assert "ties, FOLLOWS to LEADS, the first is the coarser" in remark
    assert "name the finer one first" in remark


def test_nodes_off_the_surface(tmp_path: Path) -> None:
    """Within the tolerance they are moved onto the faces, so that the body turns freely;
    beyond it they are not tied.
    """
    mesh = halves()
    mesh.nodes[mesh.node_sets["nodes0"], 0] -= 1e-4
    joined = read(
        mesh,
        surface(mesh, "FOLLOWS", "part0", -1e-4)
        + surface(mesh, "LEADS", "part1")
        + "*TIE,NAME=T\nFOLLOWS, LEADS\n",
        tmp_path,
        "inp",
    )
    (remark,) = joined.remarks
    assert (
        "are moved onto the faces of the second, by up to 0.0001 (in the unit of the file)"
        in remark
    )
    assert held_by(solid_structure(joined, STEEL)).rigid.shape[1] == 6
    apart = read(
        mesh,
        surface(mesh, "FOLLOWS", "part0", -1e-4)
        + surface(mesh, "LEADS", "part1")
        + "*TIE,NAME=T,POSITION TOLERANCE=1e-5\nFOLLOWS, LEADS\n",
        tmp_path,
        "inp",
    )
    assert apart.joints is None
    assert (
        "of the 13 nodes that the mesh file ties by FOLLOWS to LEADS, 13 are further than 1e-05"
        in apart.remarks[0]
    )
    assert number_of_parts(apart) == 2


def test_a_tolerance_of_zero_is_one_of_rounding(tmp_path: Path) -> None:
    """Nodes that lie on a face but for rounding are tied."""
    mesh = halves((8, 5, 3), (4, 3, 2))
    exact = read(mesh, tie(mesh, more=", POSITION TOLERANCE=0"), tmp_path, "inp")
    assert exact.remarks == ()
    np.testing.assert_allclose(
        frequencies(exact), frequencies(read(mesh, tie(mesh), tmp_path, "inp")), rtol=1e-9
    )


def constrained(mesh: Mesh, constraints: np.ndarray) -> np.ndarray:
    """Frequencies with constraints on displacements and six more unknowns, by the null
    space of all of them, dense.
    """
    structure = solid_structure(passing_as_joined(mesh), STEEL)
    size = structure.stiffness.shape[0]
    basis = null_space(constraints)[:size]
    basis = np.linalg.svd(basis, full_matrices=False)
    vectors = basis[0][:, basis[1] > 1e-9 * basis[1][0]]
    values = eigh(
        vectors.T @ (structure.stiffness @ vectors),
        vectors.T @ (structure.mass @ vectors),
        eigvals_only=True,
    )
    return np.sqrt(values[6:12])


@pytest.mark.parametrize("way", ["RBE2", "RBE3", "*KINEMATIC", "*DISTRIBUTING", "*RIGID BODY"])
def test_many_nodes_by_one_reference(way: str, tmp_path: Path) -> None:
    """Both faces follow one point beside them, rigidly or (the first) in the mean:
    against the null space of the constraints.
    """
    mesh, at = halves(), np.array([0.01, 0.02, 0.3])
    first, second = (np.array(side) for side in zip(*pairs(mesh), strict=True))
    mean = way in ("RBE3", "*DISTRIBUTING")
    rigid = second if mean else np.concatenate([first, second])
    reference = len(mesh.nodes) + 100
    if way.startswith("RBE"):
        more = f"GRID,{reference},,{at[0]},{at[1]},{at[2]}\n" + many(
            ["RBE2", "900", str(reference), "123456", *map(str, rigid)]
        )
        more += (
            many(["RBE3", "901", "", str(reference), "123456", "1.", "123", *map(str, first)])
            if mean
            else ""
        )
    else:
        more = (
            f"*NODE\n{reference}, {at[0]}, {at[1]}, {at[2]}\n"
            + surface(mesh, "A", "part0")
            + surface(mesh, "B", "part1")
        )
        coupling = f"*COUPLING, REF NODE={reference}, CONSTRAINT NAME="
        if way == "*RIGID BODY":
            more += (
                "*NSET, NSET=BOTH\n"
                + "".join(f"{node}\n" for node in rigid)
                + f"*RIGID BODY, NSET=BOTH, REF NODE={reference}\n"
            )
        else:
            more += (
                f"{coupling}one, SURFACE=A\n{way}\n"
                + f"{coupling}two, SURFACE=B\n*KINEMATIC\n1, 6\n"
            )
    joined = read(mesh, more, tmp_path, "bdf" if way.startswith("RBE") else "inp")
    assert joined.remarks == ()
    size = 3 * len(mesh.nodes)

    def moved(node: int) -> np.ndarray:  # the displacement of a node with the point: u + theta x r
        x, y, z = mesh.nodes[node - 1] - at
        return np.hstack([np.eye(3), [[0, z, -y], [-z, 0, x], [y, -x, 0]]])

    rows = np.zeros((3 * len(rigid), size + 6))
    for index, node in enumerate(rigid):
        rows[3 * index : 3 * index + 3, 3 * node - 3 : 3 * node] = np.eye(3)
        rows[3 * index : 3 * index + 3, size:] = -moved(node)
    if mean:  # least squares: the normal equations
        normal = np.zeros((6, size + 6))
        for node in first:
            normal[:, 3 * node - 3 : 3 * node] += moved(node).T
            normal[:, size:] -= moved(node).T @ moved(node)
        rows = np.concatenate([rows, normal])
    np.testing.assert_allclose(frequencies(joined), constrained(mesh, rows), rtol=1e-7)


def many(fields: list[str]) -> str:
    name, *rest = fields
    return "".join(
        ",".join([name if start == 0 else "", *rest[start : start + 8]]) + "\n"
        for start in range(0, len(rest), 8)
    )


@pytest.mark.parametrize("name", ["RBE1", "RBE2", "RBE3", "RBAR"])
@pytest.mark.parametrize("gap", [1e-17, 1e-10, 1.7e-7])
def test_rigid_links_of_nodes_at_one_place_but_for_rounding(
    name: str, gap: float, tmp_path: Path
) -> None:
    """They are no hinges in the direction of the rounding."""
    mesh = halves()
    nodes = mesh.nodes.copy()
    nodes[mesh.node_sets["nodes1"]] += [gap, 0.5 * gap, 0.0]
    joined = read(replace(mesh, nodes=nodes), NASTRAN[name](pairs(mesh)), tmp_path, "bdf")
    np.testing.assert_allclose(frequencies(joined), frequencies(WHOLE), rtol=1e-5)


@pytest.mark.parametrize(
    ("members", "follows"),
    [
        ([40], 1),
        ([40, 41], 2),
        ([39, 40, 41], 2),
        ([40, 41, 42], 3),
        ([1], 0),
        ([1, 2], 1),
        ([1, 2, 3], 3),
        ([3, 6, 20, 21], 3),
    ],
)
def test_means_of_nodes_that_show_less_than_a_rigid_motion(
    members: list[int], follows: int, tmp_path: Path
) -> None:
    """Turns about a node, or about the line on which the nodes lie, are free: a rigid arm
    on one node keeps its length only.
    """
    mesh = replace(halves(), node_sets={})
    joints = read(
        mesh,
        many(["RBE3", "901", "", "1", "123", "1.", "123", *map(str, members)]),
        tmp_path,
        "bdf",
    ).joints
    followers = [] if joints is None else joints.rows()
    assert len(followers) == follows
    motions = solid_structure(passing_as_joined(halves()), STEEL).rigid_motions()
    for follower, weights in followers:
        np.testing.assert_allclose(
            motions[follower],
            sum(value * motions[unknown] for unknown, value in weights.items()),
            atol=1e-12,
        )


def test_a_rigid_part_of_many_nodes_with_their_rotations(tmp_path: Path) -> None:
    """Rotations of nodes that nothing else joins follow, and cost nothing."""
    mesh = replace(box_mesh(SIZE, (12, 11, 10), "hex8"), node_sets={})
    point = len(mesh.nodes) + 100
    one, other = (
        read(
            mesh,
            f"GRID,{point},,0.,0.,1.\n"
            + many(["RBE2", "900", str(point), part, *map(str, range(1, 1501))]),
            tmp_path,
            "bdf",
        ).joints
        for part in ("123", "123456")
    )
    assert one is not None
    assert other is not None
    assert len(one.followers) == 3 * 1500 - 6
    np.testing.assert_array_equal(one.followers, other.followers)
    np.testing.assert_allclose((one.weights - other.weights).data, 0.0, atol=1e-12)


def test_components_of_couplings(tmp_path: Path) -> None:
    """A range may end beyond the last component; of *DISTRIBUTING, only rotations can be
    released.
    """
    mesh = replace(halves(), node_sets={})
    found = []
    for way, components in (
        ("KINEMATIC", "1, 6"),
        ("KINEMATIC", "1, 99999999999999"),
        ("DISTRIBUTING", "1, 6"),
        ("DISTRIBUTING", "4, 6"),
    ):
        text = (
            surface(mesh, "A", "part0")
            + f"*COUPLING, REF NODE=1, SURFACE=A\n*{way}\n{components}\n"
        )
        joints = read(mesh, text, tmp_path, "inp").joints
        assert joints is not None
        found.append(joints.weights.toarray())
    np.testing.assert_allclose(found[1], found[0])
    np.testing.assert_allclose(found[3], found[2])


def test_equations_with_other_coefficients(tmp_path: Path) -> None:
    """Several terms, one node in several equations, and one equation that follows from
    others: by the null space.
    """
    mesh = halves()
    (one, other), (two, twin), *rest = pairs(mesh)
    more = [
        [(one, 1, 1.0), (other, 1, -0.5), (twin, 1, -0.5)],
        [(two, 1, 2.0), (other, 1, -1.0), (one, 1, -1.0)],
    ]
    more += [
        [(first, axis, 1.0), (second, axis, -1.0)] for first, second in rest for axis in (1, 2, 3)
    ]
    more += [[(first, 2, 3.0), (second, 2, -3.0)] for first, second in rest[:2]]
    text = "*EQUATION\n" + "".join(
        f"{len(terms)}\n" + "".join(f"{node}, {axis}, {value},\n" for node, axis, value in terms)
        for terms in more
    )
    joined = read(mesh, text, tmp_path, "inp")
    rows = np.zeros((len(more), 3 * len(mesh.nodes)))
    for row, terms in enumerate(more):
        for node, axis, value in terms:
            rows[row, 3 * node - 4 + axis] += value
    found = elastic_system(held_by(solid_structure(joined, STEEL))).modes(6).angular_frequencies
    structure = solid_structure(passing_as_joined(mesh), STEEL)
    vectors = null_space(rows)
    values = eigh(
        vectors.T @ (structure.stiffness @ vectors),
        vectors.T @ (structure.mass @ vectors),
        eigvals_only=True,
    )
    np.testing.assert_allclose(found, np.sqrt(values[values > 1e-6 * values[-1]])[:6], rtol=1e-7)


def passing_as_joined(mesh: Mesh) -> Mesh:
    """A mesh whose parts pass as joined, though no joint moves anything."""
    from scipy.sparse import csr_array

    from vibroimpact.structures.finite_elements.joints import Joints

    first, second = mesh.node_sets["nodes0"][0], mesh.node_sets["nodes1"][0]
    row = np.zeros((1, 3 * len(mesh.nodes)))
    row[0, 3 * second] = 1.0
    return replace(mesh, joints=Joints(np.array([3 * first]), csr_array(row)))


def test_a_long_chain_of_equations() -> None:
    """Each displacement is twice the next: twenty equations leave one free, of which the
    others are multiples.
    """
    joints = solved_joints([{3 * node: 1.0, 3 * node + 3: -2.0} for node in range(20)], 63)
    assert joints is not None
    free = np.setdiff1d(np.arange(0, 63, 3), joints.followers)
    motion = np.zeros(63)
    motion[free] = 1.0
    motion[joints.followers] = joints.weights @ motion
    assert len(free) == 1
    np.testing.assert_allclose(motion[:60:3], 2.0 * motion[3::3])


@pytest.mark.parametrize("suffix", ["bdf", "inp"])
def test_joints_are_written_and_read_again(suffix: str, tmp_path: Path) -> None:
    mesh = halves((4, 3, 2), (2, 2, 1))
    joined = read(mesh, tie(mesh), tmp_path, "inp")
    (write_nastran if suffix == "bdf" else write_abaqus)(
        joined, tmp_path / f"again.{suffix}", STEEL
    )
    again = load_mesh(tmp_path / f"again.{suffix}")
    np.testing.assert_allclose(frequencies(again), frequencies(joined), rtol=1e-9)


def test_supports_on_joined_nodes(tmp_path: Path) -> None:
    """Held or on an edge, with the joint at the same nodes: as the block in one piece."""
    mesh = halves()
    joined = read(mesh, tie(mesh), tmp_path, "inp")
    edges = (Edge("y-min", "clamped"),)
    np.testing.assert_allclose(
        frequencies(joined, edges, 0), frequencies(WHOLE, edges, 0), rtol=1e-10
    )


def test_the_force_of_a_support_on_joined_nodes_is_refused(tmp_path: Path) -> None:
    """What holds such a node is the support and the joint together; the force of an edge
    away from the joint is known.
    """
    joined = read(halves(), tie(halves()), tmp_path, "inp")
    recipe = Recipe(
        ImportedMesh("joined", lambda: joined),
        STEEL.density,
        STEEL.youngs_modulus,
        STEEL.poissons_ratio,
    )
    across, away = (
        replace(recipe, supports=(Edge("y-min", "clamped"),)),
        replace(recipe, supports=(Edge("x-min", "clamped"),)),
    )
    with pytest.raises(
        InputError,
        match="it holds nodes that the mesh file joins to others; leave out its force sensor",
    ):
        computed_support_forces(across, (0.1, 0.02), "upper", [(0.1, -0.05)])
    forces = computed_support_forces(away, (0.1, 0.02), "upper", [(-0.2, 0.0)])
    np.testing.assert_allclose(forces.static[0], [0.0, 0.0, -1.0], atol=1e-6)
    both = replace(recipe, supports=(Edge("y-min", "clamped"), Edge("x-min", "clamped")))
    # no sensor on the other edge
    assert computed_support_forces(both, (0.1, 0.02), "upper", [(-0.2, 0.02)]).static.shape == (
        1,
        3,
    )
    with pytest.raises(InputError, match=r"the force of edge y-min clamped is not known"):
        computed_support_forces(both, (0.1, 0.02), "upper", [(-0.2, 0.02), (0.1, -0.05)])


def test_a_drop_on_joined_parts(tmp_path: Path) -> None:
    """As on the block in one piece: the force of the contact beside the joint, to rounding."""
    write_abaqus(WHOLE, tmp_path / "whole.inp")
    read(halves(), tie(halves()), tmp_path, "inp")
    peaks = []
    for name in ("whole.inp", "joined.inp"):
        plate = {
            "material": STEEL_TABLE,
            "model": "elastic",
            "supports": "free",
            "modes": 8,
            "mesh": {"file": str(tmp_path / name)},
        }
        drop = {"speed": 1.0, "gravity": 0, "position": [0.03, 0.01]}
        response = vi.simulate(vi.case_of(plain_case(plate=plate, drop=drop)))
        peaks.append(float(response.impacts["max_force_N"][0]))
    assert peaks[1] == pytest.approx(peaks[0], rel=1e-8)


def test_a_case_with_joined_parts(tmp_path: Path) -> None:
    """Both parts are the body, whatever the contact point; from the store too, with its joints."""
    mesh = halves()
    write_abaqus(mesh, tmp_path / "joined.inp")
    (tmp_path / "joined.inp").write_text((tmp_path / "joined.inp").read_text() + tie(mesh))
    plate = {
        "material": STEEL_TABLE,
        "model": "elastic",
        "supports": "free",
        "modes": 3,
        "mesh": {"file": str(tmp_path / "joined.inp")},
    }
    for position in ([0.15, 0], [-0.1, 0], [0.15, 0]):
        case = vi.case_of(
            plain_case(plate=plate, drop={"speed": 1.0, "gravity": 0, "position": position})
        )
        found = vi.compute_modes(case)["plate"]
        assert found.model.properties.mass == pytest.approx(7850 * 0.4 * 0.1 * 0.05, rel=1e-9)
        assert found.model.facts["joined by"] == "*TIE (1)"
        assert found.model.mesh.joints is not None
        assert not [
            words for words in found.model.facts.get("remarks on the file", "").split("\n") if words
        ]


STEEL_TABLE = {"density": 7850, "youngs_modulus": 210e9, "poissons_ratio": 0.3}


def test_joints_that_hold_the_body_are_told(tmp_path: Path) -> None:
    """Equal displacements across the line between two nodes resist that the body turns."""
    far = [
        int(np.argmin(np.linalg.norm(WHOLE.nodes - [x, -0.05, -0.025], axis=1))) + 1
        for x in (-0.2, 0.2)
    ]
    joined = read(WHOLE, f"*EQUATION\n2\n{far[0]}, 2, 1., {far[1]}, 2, -1.\n", tmp_path, "inp")
    recipe = Recipe(
        ImportedMesh("joined", lambda: joined),
        STEEL.density,
        STEEL.youngs_modulus,
        STEEL.poissons_ratio,
    )
    for supports in ((), (Edge("y-min", "clamped"),)):
        remarks = computed_model(replace(recipe, supports=supports)).facts["remarks on the file"]
        assert "the joints of the mesh file resist 1 of the 6 rigid motions of the body" in remarks


@pytest.mark.parametrize(("gap", "works"), [(1e-7, True), (1e-4, False)])
def test_equations_between_nodes_that_are_not_at_one_place(
    gap: float, works: bool, tmp_path: Path
) -> None:
    """Rounding of coordinates does no harm; beyond it, equal displacements do not turn
    with the body, and the remedy is told.
    """
    mesh = halves()
    nodes = mesh.nodes.copy()
    nodes[mesh.node_sets["nodes1"], 0] += gap
    joined = read(replace(mesh, nodes=nodes), ABAQUS["*EQUATION"](pairs(mesh)), tmp_path, "inp")
    if works:
        np.testing.assert_allclose(frequencies(joined), frequencies(WHOLE), rtol=1e-5)
    else:
        with pytest.raises(
            ComputationError,
            match=r"replace these by \*TIE, or by one RBE2 of all the nodes, which turn with the "
            r"body",
        ):
            elastic_system(held_by(solid_structure(joined, STEEL)))
        (one, other), *rest = pairs(mesh)
        followers = [other, *(node for pair in rest for node in pair)]
        turning = read(
            replace(mesh, nodes=nodes),
            many(["RBE2", "900", str(one), "123456", *map(str, followers)]),
            tmp_path,
            "bdf",
        )
        held = held_by(solid_structure(turning, STEEL))
        assert held.rigid.shape[1] == 6
        assert (elastic_system(held).modes(1).angular_frequencies > 1e3).all()


def test_a_hinge_is_refused(tmp_path: Path) -> None:
    """Two nodes leave the parts free to turn about the line through them."""
    mesh = halves()
    joined = read(mesh, ABAQUS["*EQUATION"](pairs(mesh)[:2]), tmp_path, "inp")
    with pytest.raises(ComputationError, match="part of the body can move without resistance"):
        frequencies(joined)


def assembly(more: str = "") -> str:
    """Two instances of one part, of which the second is turned by half a turn about an
    upright axis: their right ends meet at x = 0.
    """
    half = box_mesh(SIZE, (2, 2, 1))
    with TemporaryDirectory() as folder:
        write_abaqus(replace(half, node_sets={"corner": np.array([0])}), Path(folder, "half.inp"))
        body = Path(folder, "half.inp").read_text()
    right = faces_at(half, 0.1)
    assert len({label for _, label in right}) == 1
    numbers = ", ".join(str(number) for number, _ in right)
    sets = "".join(
        f"*ELSET, ELSET=_{name}, INTERNAL, INSTANCE={instance}\n{numbers}\n"
        for name, instance in (("A", "left"), ("B", "Right"))
    )
    surfaces = "".join(
        f"*SURFACE, TYPE=ELEMENT, NAME={name}\n_{name}, {right[0][1]}\n" for name in "AB"
    )
    return (
        f"*HEADING\n a test\n*PART, NAME=Half\n{body}*SURFACE, NAME=own\n1, S1\n*END "
        "PART\n*ASSEMBLY, NAME=all\n"
        "*INSTANCE, NAME=left, PART=half\n-0.1, 0, 0\n*END INSTANCE\n"
        "*INSTANCE, NAME=Right, PART=HALF\n0.2, 0.3, 0\n0.15, 0.15, 0, 0.15, 0.15, 1, "
        "180.\n*END INSTANCE\n"
        f"{sets}{surfaces}{more}*END ASSEMBLY\n"
    )


def faces_at(mesh: Mesh, where: float) -> list[tuple[int, str]]:
    """Elements, from 1, and the labels of their faces at an x."""
    return [
        (element + 1, label)
        for element, members in enumerate(mesh.blocks[0].connectivity)
        for label, face in FACES.items()
        if np.allclose(mesh.nodes[members[list(face)], 0], where)
    ]


def test_instances_of_an_assembly(tmp_path: Path) -> None:
    """Each has numbers and sets of its own, whose names are behind that of the instance;
    tied they are the block in one piece.
    """
    (tmp_path / "one.inp").write_text(assembly("*TIE, NAME=T, ADJUST=YES\nA, B\n"))
    joined = load_mesh(tmp_path / "one.inp")
    assert joined.joined_by == {"*TIE": 1}
    assert joined.remarks == ()
    assert [name for name in joined.node_sets if "corner" in name] == [
        "left.corner",
        "Right.corner",
    ]
    at = np.concatenate(
        [joined.nodes[joined.node_sets[name]] for name in ("left.corner", "Right.corner")]
    )
    np.testing.assert_allclose(at, [[-0.2, -0.05, -0.025], [0.2, 0.05, -0.025]], atol=1e-12)
    assert [len(joined.element_sets[name]) for name in ("left", "Right")] == [4, 4]
    np.testing.assert_allclose(frequencies(joined), frequencies(WHOLE), rtol=1e-10)


def test_reference_points_of_an_assembly(tmp_path: Path) -> None:
    """They have the numbers of nodes of the parts, and are others; an equation names
    nodes behind their instance.
    """
    nodes = "".join(
        f"2\nleft.{one}, {axis}, 1., Right.{other}, {axis}, -1.\n"
        for one, other in ends_that_meet()
        for axis in (1, 2, 3)
    )
    (tmp_path / "two.inp").write_text(assembly(f"*EQUATION\n{nodes}"))
    np.testing.assert_allclose(
        frequencies(load_mesh(tmp_path / "two.inp")), frequencies(WHOLE), rtol=1e-10
    )
    point = "*NODE\n1, 0, 0, 0.3\n*NSET, NSET=RP\n1,\n"
    coupled = "".join(
        f"*COUPLING, CONSTRAINT NAME=C{name}, REF NODE=RP, SURFACE={name}\n*KINEMATIC\n"
        for name in "AB"
    )
    (tmp_path / "three.inp").write_text(assembly(point + coupled))
    mesh = halves()
    number = len(mesh.nodes) + 1
    rigid = many(
        [
            "RBE2",
            "900",
            str(number),
            "123456",
            *(str(node) for pair in pairs(mesh) for node in pair),
        ]
    )
    same = read(mesh, f"GRID,{number},,0.,0.,.3\n{rigid}", tmp_path, "bdf")
    np.testing.assert_allclose(
        frequencies(load_mesh(tmp_path / "three.inp")), frequencies(same), rtol=1e-9
    )


@pytest.mark.parametrize("reference", ["RP", "1"])
def test_a_reference_point_of_an_assembly_of_one_instance(reference: str, tmp_path: Path) -> None:
    """It has the number of a node of the part, and is another, as in one of several instances."""
    half = replace(box_mesh(SIZE, (2, 2, 1)), node_sets={})
    write_abaqus(half, tmp_path / "half.inp")
    right = faces_at(half, 0.1)
    face = "".join(f"{element}, {label}\n" for element, label in right)
    body = f"{(tmp_path / 'half.inp').read_text()}*SURFACE, NAME=end\n{face}"
    coupling = f"*COUPLING, CONSTRAINT NAME=C, REF NODE={reference}, SURFACE=only.end\n*KINEMATIC\n"
    (tmp_path / "one.inp").write_text(
        f"*PART, NAME=P\n{body}*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=only, "
        "PART=P\n*END INSTANCE\n"
        f"*NODE\n1, 0, 0, 0.3\n*NSET, NSET=RP\n1,\n{coupling}*END ASSEMBLY\n"
    )
    number = len(half.nodes) + 1
    at_end = [str(node + 1) for node in np.flatnonzero(half.nodes[:, 0] > 0.1 - 1e-9)]
    rigid = f"GRID,{number},,0.,0.,.3\n" + many(["RBE2", "900", str(number), "123456", *at_end])
    found, same = load_mesh(tmp_path / "one.inp"), read(half, rigid, tmp_path, "bdf")
    assert found.joined_by == {"*KINEMATIC": 1}
    systems = [elastic_system(held_by(solid_structure(mesh, STEEL))) for mesh in (found, same)]
    one, other = (system.modes(3).angular_frequencies for system in systems)
    np.testing.assert_allclose(one, other, rtol=1e-9)


def test_a_coupling_in_a_part(tmp_path: Path) -> None:
    """Its nodes are those of each instance, by number and by set."""
    text = assembly().replace(
        "*END PART", "*KINEMATIC COUPLING, REF NODE=1\n2, 1, 3\ncorner, 1, 3\n*END PART"
    )
    (tmp_path / "two.inp").write_text(text)
    found = load_mesh(tmp_path / "two.inp")
    assert found.joined_by == {"*KINEMATIC COUPLING": 4}
    assert found.joints is not None
    assert len(found.joints.followers) == 2


def ends_that_meet() -> list[tuple[int, int]]:
    """Nodes of the right end of a half, from 1, and those that stand there once it is turned."""
    nodes = box_mesh(SIZE, (2, 2, 1)).nodes
    right = np.flatnonzero(nodes[:, 0] > 0.1 - 1e-9)
    turned = nodes[right] * [1.0, -1.0, 1.0]
    return [
        (int(node) + 1, int(right[np.linalg.norm(turned - nodes[node], axis=1).argmin()]) + 1)
        for node in right
    ]


@pytest.mark.parametrize(
    ("suffix", "more", "left"),
    [
        ("bdf", "RBE3,900,,1,123,1.,123456,2,3\n", "RBE3 (1); constraints"),
        ("bdf", "RBAR,900,1,2,123,,,123\n", "RBAR (1); constraints"),
        ("bdf", "MPC,1,1,1,1.\n", "MPC (1); constraints"),
        ("bdf", "MPC,1,1,1,1.,2,1,-1.\nMPC,2,1,1,1.,3,1,-1.\n", "MPC (2); constraints"),
        (
            "bdf",
            "GRID,900,,1.,1.,1.,7\nCORD2R,7,,0.,0.,0.,0.,1.,0.\n,0.,0.,1.\nRBE2,901,1,1,900\n",
            "RBE2 (1); constraints",
        ),
        ("inp", "*EQUATION\n2\nNONE,1,1.,2,1,-1.\n", "*EQUATION (1); constraints"),
        ("bdf", "MPC,1,1,1,1.,2,1,0.\n", "MPC (1); constraints"),
        ("inp", "*EQUATION\n2\n1,1,1.,2,1,0.\n", "*EQUATION (1); constraints"),
        (
            "inp",
            "*NSET,NSET=P,UNSORTED\n2,1\n*NSET,NSET=Q\n3,4\n*EQUATION\n2\nP,1,1.,Q,1,-1.\n",
            "*EQUATION (1); constraints",
        ),
        (
            "inp",
            "*NSET,NSET=P,UNSORTED\n2,1\n*NSET,NSET=Q\n3,4\n*MPC\nTIE,P,Q\n",
            "*MPC (1); constraints",
        ),
        ("inp", "*MPC\n,\n", "*MPC (1); constraints"),
        ("inp", "*TIE, NAME=T\n", "*TIE (1); constraints"),
        ("inp", "*COUPLING, REF NODE=1, SURFACE=A\n*MPC\nTIE,1,1\n", "*COUPLING (1); constraints"),
        (
            "inp",
            "*SURFACE,NAME=A\npart0,S1\n*COUPLING,REF NODE=1,SURFACE=A\n*KINEMATIC\n11,11\n",
            "*KINEMATIC (1); constraints",
        ),
        ("inp", "*KINEMATIC COUPLING,REF NODE=1\n2,3,2\n", "*KINEMATIC COUPLING (1); constraints"),
        ("inp", "*EQUATION, REMOVE\n1,1\n", "*EQUATION (1); constraints"),
        ("inp", "*MPC\nBEAM, 1, 2\n", "*MPC (1); constraints"),
        ("inp", "*TIE, NAME=T\nA, B\n", "*TIE (1); constraints"),
        (
            "inp",
            "*TIE, NAME=T, CYCLIC SYMMETRY\nA, B\n",
            "*TIE of cyclic symmetry (1); constraints",
        ),
        (
            "inp",
            "*TRANSFORM, NSET=one\n0,1,0,1,0,0\n*NSET, NSET=one\n1\n*EQUATION\n2\n1,1,1.,2,1,-1.\n",
            "*EQUATION (1); constraints",
        ),
    ],
)
def test_links_that_can_not_be_used_are_named(
    suffix: str, more: str, left: str, tmp_path: Path
) -> None:
    found = read(replace(halves(), node_sets={}), more, tmp_path, suffix)
    assert found.joints is None
    assert any(left in remark for remark in found.remarks), found.remarks


@pytest.mark.parametrize(
    ("suffix", "more", "message"),
    [
        ("bdf", "RBE2,900,9999,123,1\n", "the node 9999 that is joined here is not in the file"),
        (
            "bdf",
            "MPC,7,1,1,1.,9999,1,-1.\n",
            "the node 9999 that is joined here is not in the file",
        ),
        (
            "inp",
            "*EQUATION\n2\n1,1,1.,9999,1,-1.\n",
            "the node 9999 that is joined here is not in the file",
        ),
        ("inp", "*MPC\nTIE,1,9999\n", "the node 9999 that is joined here is not in the file"),
        ("bdf", "RBE2,900,1,127,2\n", '"127" names no components of motion'),
        ("bdf", "RBE2,900,1,123,2,THRU,99999999\n", "more than 1,000,000 nodes"),
        ("bdf", "RROD,900,1,1\n", "the two nodes whose distance is kept are at the same place"),
        (
            "inp",
            "*EQUATION\n3\n1,1,1.,2,1,-1.\n",
            "the equation has 2 of the 3 terms that it states",
        ),
        ("inp", "*EQUATION\nx\n1,1,1.\n", '"x" is not the number of terms'),
        (
            "inp",
            "*SURFACE,NAME=A\npart0\n*TIE,NAME=T,POSITION TOLERANCE=-1\nA, A\n",
            "the position tolerance is -1",
        ),
    ],
)
def test_links_that_are_wrong(suffix: str, more: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=message):
        read(halves(), more, tmp_path, suffix)


def test_the_case_control_says_which_constraints_apply(tmp_path: Path) -> None:
    mesh = halves()
    more = NASTRAN["MPC"](pairs(mesh)) + "MPC,8,1,1,1.,2,1,-1.\nMPCADD,9,7\n"
    write_nastran(mesh, tmp_path / "some.bdf")
    text = (tmp_path / "some.bdf").read_text().replace("ENDDATA", f"{more}ENDDATA")
    for asked, applied in (("MPC = 7", True), ("  MPC=9", True), ("TITLE = none", False)):
        (tmp_path / "some.bdf").write_text(text.replace("CEND", f"CEND\n{asked}"))
        assert (number_of_parts(load_mesh(tmp_path / "some.bdf")) == 1) is applied
