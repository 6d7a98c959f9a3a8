"""Elements, their meshes, and what is seen at places on their surface."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import skfem
from scipy.optimize import brentq

from solid_meshes import PYRAMIDS, pyramid_box
from support import one_in
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS, ElementKind
from vibroimpact.structures.finite_elements.geometry import (
    check_mesh,
    determinants,
    mass_properties,
)
from vibroimpact.structures.finite_elements.lattice import SOLID_KINDS, box_mesh
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh, solid_plate_mesh
from vibroimpact.structures.finite_elements.rectangle import Disc
from vibroimpact.structures.finite_elements.sphere_mesh import sphere_mesh
from vibroimpact.structures.finite_elements.structure import (
    Structure,
    plate_structure,
    solid_structure,
)
from vibroimpact.structures.finite_elements.surface import (
    Faces,
    lower_nodes,
    outer_faces,
    surface_motion,
)
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.supports.support import held_by

STEEL = Material(7850.0, 210e9, 0.3)
BOXES = ("tet4", "tet10", "wedge6", "wedge15", "hex8", "hex20", "hex27")
SOLIDS = (*BOXES, *PYRAMIDS)
PLATE = (0.52, 0.42, 0.008)


def box(size: tuple[float, float, float], counts: tuple[int, int, int], kind: str) -> Mesh:
    return (pyramid_box if kind in PYRAMIDS else box_mesh)(size, counts, kind)


def bent(kind: str) -> Mesh:
    """A box, its nodes moved smoothly, so that its elements are curved and none like another."""
    mesh = box((0.4, 0.3, 0.2), (2, 2, 2), kind)
    x, y, z = mesh.nodes.T
    moved = np.stack(
        [x + 0.3 * y * z + 0.2 * z**2, y - 0.2 * x * z + 0.3 * x**2, z + 0.4 * x * y], axis=1
    )
    return Mesh(moved, mesh.blocks)


def structure_of(kind: str) -> Structure:
    if kind == "quad25":
        return plate_structure(plate_mesh(PLATE[:2], 0.1, [Disc(0.1, 0.05, 0.03)]), STEEL, PLATE[2])
    return solid_structure(bent(kind), STEEL)


@pytest.mark.parametrize("kind", ELEMENT_KINDS)
def test_shape_functions(kind: str) -> None:
    """One at their own node and zero at the others, their sum one; gradients agree with
    differences.
    """
    element = ELEMENT_KINDS[kind]
    np.testing.assert_allclose(
        element.basis(element.reference)[0], np.eye(len(element.reference)), atol=1e-12
    )
    points = 0.1 + 0.15 * np.random.default_rng(0).random((6, element.dimension))
    values, gradients = element.basis(points)
    np.testing.assert_allclose(values.sum(axis=1), 1.0, rtol=1e-12)
    step = 1e-6
    for axis in range(element.dimension):
        shift = step * np.eye(element.dimension)[axis]
        difference = (element.basis(points + shift)[0] - element.basis(points - shift)[0]) / (
            2 * step
        )
        np.testing.assert_allclose(gradients[:, axis], difference, atol=1e-8)


def test_the_brick_of_27_nodes_is_that_of_scikit_fem() -> None:
    element, other = ELEMENT_KINDS["hex27"], skfem.ElementHex2()
    points = np.random.default_rng(0).uniform(-0.5, 1.5, (20, 3))
    values, gradients = element.basis(points)
    for node, place in enumerate(element.reference):
        value, gradient = other.lbasis(
            points.T, int(np.abs(np.asarray(other.doflocs) - place).max(axis=1).argmin())
        )
        np.testing.assert_allclose(values[:, node], value, atol=1e-12)
        np.testing.assert_allclose(gradients[:, :, node], gradient.T, atol=1e-12)


@pytest.mark.parametrize("kind", SOLIDS)
def test_nodes_of_edges_lie_between_their_corners(kind: str) -> None:
    """The order of Abaqus and VTK: its edges one after the other, as its manual numbers them."""
    edges = {
        6: [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
        8: [
            (0, 1),
            (1, 2),
            (2, 3),
            (3, 0),
            (4, 5),
            (5, 6),
            (6, 7),
            (7, 4),
            (0, 4),
            (1, 5),
            (2, 6),
            (3, 7),
        ],
        4: [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
        5: [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)],
    }
    element = ELEMENT_KINDS[kind]
    assert list(element.edges) == edges[element.corners]
    for node, (start, end) in zip(
        range(element.corners, len(element.reference)), edges[element.corners], strict=False
    ):
        np.testing.assert_allclose(
            element.reference[node], element.reference[[start, end]].mean(axis=0)
        )


@pytest.mark.parametrize("kind", ELEMENT_KINDS)
def test_quadrature_is_exact(kind: str) -> None:
    """Integrals of monomials over the unit cube and the unit simplex, as high as the mass
    of straight elements asks for.
    """
    element = ELEMENT_KINDS[kind]
    points, weights = element.quadrature()
    needed = {"tet4": 2, "tet10": 4}.get(kind, element.degree)
    assert (weights > 0).all()
    for powers in np.ndindex(*[needed + 1] * element.dimension):
        if element.is_pyramid:
            exact = (
                _integral_over_the_pyramid(powers)
                if sum(powers) <= needed
                else weights @ np.prod(points**powers, axis=1)
            )
        elif element.is_brick:
            exact = 1 / np.prod([power + 1 for power in powers])
        elif element.corners == 6 and sum(powers[:2]) <= needed:  # a triangle times an interval
            factorials = [
                np.prod(np.arange(1.0, power + 1)) for power in (*powers[:2], sum(powers[:2]) + 2)
            ]
            exact = factorials[0] * factorials[1] / factorials[2] / (powers[2] + 1)
        elif element.corners == 6:
            continue
        elif sum(powers) <= needed:
            factorials = [
                np.prod(np.arange(1.0, power + 1)) for power in (*powers, sum(powers) + 3)
            ]
            exact = factorials[0] * factorials[1] * factorials[2] / factorials[3]
        else:
            continue
        assert weights @ np.prod(points**powers, axis=1) == pytest.approx(exact, rel=1e-12)


def _integral_over_the_pyramid(powers: tuple[int, ...]) -> float:
    """The integral of x^a y^b z^c, slice by slice: a square of side 1 - z about (1/2, 1/2)."""
    along = np.polynomial.Polynomial([0.0, 1.0])
    across = [
        ((1.0 - 0.5 * along) ** (power + 1) - (0.5 * along) ** (power + 1)) / (power + 1)
        for power in powers[:2]
    ]
    whole = (across[0] * across[1] * along ** powers[2]).integ()
    return float(whole(1.0) - whole(0.0))


@pytest.mark.parametrize("kind", PYRAMIDS)
def test_faces_of_pyramids_are_those_of_tetrahedra_and_bricks(kind: str) -> None:
    """On a face only its nodes move it, as a triangle or a square of the same order is
    moved: meshes of several kinds have no gaps.
    """
    element = ELEMENT_KINDS[kind]
    others = {
        "pyramid5": ("tet4", "hex8"),
        "pyramid13": ("tet10", "hex20"),
        "pyramid14": ("tet10", "hex27"),
    }[kind]
    local = np.random.default_rng(0).random((20, 2)) * 0.5
    for face in element.faces:
        other = ELEMENT_KINDS[others[0] if len(face) == 3 else others[1]]
        same = next(one for one in other.faces if len(one) == len(face))
        none = np.zeros((0, 0), dtype=np.int64)
        values = element.basis(Faces(element, face, none).reference_points(local))[0]
        theirs = Faces(other, same, none).shape_functions(local)[0]
        seen = np.zeros(len(local))
        # each node of the face, by the corners between which it lies
        for between in BETWEEN[len(face)]:
            node = node_at(element, [face[corner] for corner in between])
            if node is not None:
                expected = theirs[:, node_at(other, [same[corner] for corner in between])]
                np.testing.assert_allclose(values[:, node], expected, atol=1e-12)
                seen += expected
        np.testing.assert_allclose(seen, 1.0, atol=1e-12)


BETWEEN = {
    3: [(0,), (1,), (2,), (0, 1), (1, 2), (2, 0)],
    4: [(0,), (1,), (2,), (3,), (0, 1), (1, 2), (2, 3), (3, 0), (0, 1, 2, 3)],
}


def node_at(element: ElementKind, corners: list[int]) -> int | None:
    """The node in the middle of corners, if the element has one there."""
    apart = np.abs(element.reference - element.reference[corners].mean(axis=0)).max(axis=1)
    return int(apart.argmin()) if apart.min() < 1e-12 else None


def test_slopes_on_a_face_of_a_pyramid_hold_up_to_its_apex() -> None:
    """There the gradient depends on the direction; on a face it is that of the triangle."""
    element, triangle = ELEMENT_KINDS["pyramid5"], np.array([[0.0, 1.0]])
    faces = Faces(element, (1, 2, 4), np.zeros((0, 0), dtype=np.int64))
    expected = np.zeros((2, 5))
    expected[:, 1] = -1.0
    expected[0, 2] = expected[1, 4] = 1.0
    np.testing.assert_allclose(faces.shape_functions(triangle)[1][0], expected, atol=1e-8)


@pytest.mark.parametrize("kind", PYRAMIDS)
def test_pyramids_between_others_keep_constant_strain(kind: str) -> None:
    """The patch test: of a bent mesh in a linear motion, the inner nodes are in equilibrium."""
    mesh = bent(kind)
    structure = solid_structure(mesh, STEEL)
    strain = np.random.default_rng(1).standard_normal((3, 3))
    forces = (structure.stiffness @ (mesh.nodes @ strain).ravel()).reshape(-1, 3)
    outside = np.zeros(len(mesh.nodes), dtype=bool)
    for faces in outer_faces(mesh):
        on_face = np.abs(faces.shape_functions(np.array([[0.31, 0.17]]))[0][0]) > 1e-9
        outside[faces.connectivity[:, on_face].ravel()] = True
    assert np.abs(forces[outside]).max() > 1e3 * np.abs(forces[~outside]).max()
    assert np.abs(forces[~outside]).max() < 1e-12 * np.abs(structure.stiffness).max()


@pytest.mark.parametrize("kind", ELEMENT_KINDS)
def test_rigid_motions_strain_nothing(kind: str) -> None:
    structure = structure_of(kind)
    motions = structure.rigid_motions()
    force = structure.stiffness @ motions
    assert np.abs(force).max() < 1e-11 * np.abs(structure.stiffness).max() * np.abs(motions).max()
    skew = structure.stiffness - structure.stiffness.T
    assert np.abs(skew).max() < 1e-12 * np.abs(structure.stiffness).max()


@pytest.mark.parametrize("kind", ELEMENT_KINDS)
def test_mass_of_rigid_motions_is_mass_and_inertia(kind: str) -> None:
    """The consistent mass matrix holds mass, centre and inertia, as integrated over the
    elements with more points.
    """
    structure = structure_of(kind)
    motions = structure.rigid_motions()
    expected = np.zeros((6, 6))
    expected[:3, :3], expected[3:, 3:] = (
        structure.properties.mass * np.eye(3),
        structure.properties.inertia,
    )
    found = motions.T @ (structure.mass @ motions)
    np.testing.assert_allclose(
        found, expected, atol=1e-4 * np.abs(expected[3:, 3:]).max(), rtol=1e-9
    )


@pytest.mark.parametrize("kind", SOLIDS)
def test_mass_and_inertia_of_a_box(kind: str) -> None:
    a, b, c = 0.4, 0.3, 0.2
    mesh = box((a, b, c), (2, 1, 3), kind)
    moved = Mesh(mesh.nodes + np.array([1.0, 2.0, 3.0]), mesh.blocks)
    found = mass_properties(moved, 7850.0)
    mass = 7850 * a * b * c
    assert found.mass == pytest.approx(mass, rel=1e-12)
    np.testing.assert_allclose(found.centre, [1, 2, 3], rtol=1e-12)
    np.testing.assert_allclose(
        found.inertia,
        mass / 12 * np.diag([b**2 + c**2, a**2 + c**2, a**2 + b**2]),
        atol=1e-10 * mass,
    )


def test_mass_and_inertia_of_a_plate() -> None:
    found = structure_of("quad25").properties
    a, b, c = PLATE
    mass = 7850 * a * b * c
    assert found.mass == pytest.approx(mass, rel=1e-12)
    np.testing.assert_allclose(
        found.inertia,
        mass / 12 * np.diag([b**2 + c**2, a**2 + c**2, a**2 + b**2]),
        rtol=1e-6,
        atol=1e-9,
    )


def frequency_of_a_block(kind: str, count: int) -> float:
    """The lowest mode in which a block, its four upright sides as Navier's plate has
    them, bends [Hz].
    """
    structure = solid_structure(
        box((1.0, 1.0, 0.5), (count, count, max(1, count // 2)), kind), STEEL
    )
    held = held_by(structure, [Edge(edge, "simply-supported") for edge in EDGES])
    modes = ElasticSystem(held.stiffness, held.mass, held.rigid, held.order).modes(6)
    heave = held.expansion @ modes.shapes
    moved = np.abs(heave.reshape(-1, 3, 6)[:, 2].sum(axis=0))
    return float(modes.angular_frequencies[moved.argmax()] / (2 * np.pi))


def exact_frequency_of_the_block() -> float:
    """Rayleigh and Lamb's antisymmetric waves in a layer of thickness 0.5 m, wave number
    sqrt(2) pi.
    """
    k, half = np.sqrt(2) * np.pi, 0.25
    shear, pressure = np.sqrt(210e9 / 2.6 / 7850), np.sqrt(210e9 * 0.7 / (1.3 * 0.4) / 7850)

    def condition(omega: float) -> float:
        p, q = (
            np.sqrt(complex((omega / pressure) ** 2 - k**2)),
            np.sqrt(complex((omega / shear) ** 2 - k**2)),
        )
        value = 4 * k**2 * q * np.sin(q * half) * np.cos(p * half) + (q**2 - k**2) ** 2 * np.sin(
            p * half
        ) / p * np.cos(q * half)
        return float(value.real)

    grid = np.linspace(0.05, 0.999, 400) * shear * k
    found = [
        brentq(condition, *ends)
        for ends in pairwise(grid)
        if condition(ends[0]) * condition(ends[1]) < 0
    ]
    return float(found[0] / (2 * np.pi))


@pytest.mark.parametrize(
    ("kind", "counts", "rate"),
    one_in(
        3,
        [
            ("hex20", (2, 4, 6), 4),
            ("hex27", (4, 6, 8), 4),
            ("tet10", (4, 6, 8), 4),
            ("tet4", (4, 8, 12), 2),
            ("hex8", (4, 8, 12), 2),
            ("pyramid5", (4, 6, 8), 2),
            ("pyramid13", (2, 4, 6), 4),
        ],
    ),
)
def test_rate_of_convergence(kind: str, counts: tuple[int, ...], rate: int) -> None:
    """Frequencies come from above, with twice the order of the element as power of its
    size; by regression, within 0.4.
    """
    exact = exact_frequency_of_the_block()
    errors = np.array([frequency_of_a_block(kind, count) for count in counts]) / exact - 1
    assert (errors > 0).all()
    assert -np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(rate, abs=0.4)


def face_area(mesh: Mesh) -> float:
    """The area of the faces that belong to one element alone."""
    total = 0.0
    along, weights = np.polynomial.legendre.leggauss(6)
    a, b = (part.ravel() for part in np.meshgrid((along + 1) / 2, (along + 1) / 2))
    weight = np.outer(weights, weights).ravel() / 4
    for faces in outer_faces(mesh):
        triangle = len(faces.corners) == 3
        local = np.stack([a, b * (1 - a) if triangle else b], axis=1)
        slopes = faces.shape_functions(local)[1]
        tangents = np.einsum("pdn,eni->depi", slopes, mesh.nodes[faces.connectivity])
        total += (
            np.linalg.norm(np.cross(*tangents), axis=2) * weight * (1 - a if triangle else 1)
        ).sum()
    return float(total)


@pytest.mark.parametrize("kind", BOXES)
def test_bricks_follow_discs_without_cracks(kind: str) -> None:
    """Volume, and area of all faces that have no neighbour: a crack would add to it.
    Discs well inside and apart.
    """
    random = np.random.default_rng(BOXES.index(kind))
    length, width, height = PLATE
    for _ in range(6):
        discs = [
            Disc(
                0.13 * (2 * side - 1) + random.uniform(-0.05, 0.05),
                random.uniform(-0.12, 0.12),
                0.02,
            )
            for side in range(2)
        ]
        lines = ([0.4 * length], [-0.45 * width])
        mesh = solid_plate_mesh(PLATE, random.uniform(0.06, 0.2), 1, kind, discs, lines)
        check_mesh(mesh)
        exact = 2 * (length * width + length * height + width * height)
        assert face_area(mesh) == pytest.approx(exact, rel=1e-9)
        assert mass_properties(mesh, 1.0).mass == pytest.approx(length * width * height, rel=1e-9)
        for disc in discs:
            rim_is_round(mesh, disc)
        corners = np.unique(mesh.blocks[0].connectivity[:, : ELEMENT_KINDS[kind].corners])
        for axis, at in ((0, lines[0][0]), (1, lines[1][0])):
            assert np.isclose(mesh.nodes[corners, axis], at, atol=1e-9).sum() >= 8


def rim_is_round(mesh: Mesh, disc: Disc) -> None:
    """Nodes of the lower side lie on the rim, at least at its four quarters, and none a
    hair beside it.
    """
    lower = mesh.nodes[lower_nodes(mesh)]
    apart = np.abs(np.hypot(lower[:, 0] - disc.x, lower[:, 1] - disc.y) - disc.radius)
    assert (apart < 1e-9).sum() >= 4
    assert not ((apart > 1e-9) & (apart < 1e-3 * disc.radius)).any()


def test_plate_elements_follow_discs_without_cracks() -> None:
    """Area, and length of all sides that have no neighbour, for many random discs, some
    near one another or near the edge.
    """
    random = np.random.default_rng(5)
    length, width = PLATE[:2]
    made = 0
    for _ in range(60):
        discs = [
            Disc(
                random.uniform(-0.5, 0.5) * length,
                random.uniform(-0.5, 0.5) * width,
                random.choice([0.002, 0.01, 0.03]),
            )
            for _ in range(random.integers(1, 4))
        ]
        try:
            mesh = plate_mesh((length, width), random.uniform(0.04, 0.2), discs)
        except InputError:
            continue
        made += 1
        cells, element = mesh.blocks[0].connectivity, mesh.blocks[0].element
        points, weights = element.quadrature()
        jacobian = determinants(mesh.nodes[cells], element.basis(points)[1])
        assert jacobian.min() > 0
        assert (jacobian * weights).sum() == pytest.approx(length * width, rel=1e-10)
        corners = cells[:, list(element.faces[0])]
        sides = np.sort(
            np.concatenate([corners[:, [index, (index + 1) % 4]] for index in range(4)]), axis=1
        )
        found, count = np.unique(sides, axis=0, return_counts=True)
        rim = found[count == 1]
        assert np.linalg.norm(
            np.diff(mesh.nodes[rim], axis=1)[:, 0], axis=1
        ).sum() == pytest.approx(2 * (length + width), rel=1e-10)
        for disc in discs:
            rim_is_round(mesh, disc)
    assert made > 25


@pytest.mark.parametrize("kind", SOLID_KINDS)
@pytest.mark.parametrize("grading", [1.0, 3.0])
def test_a_ball_has_no_cracks(kind: str, grading: float) -> None:
    mesh = sphere_mesh(0.025, 12, kind, grading)
    check_mesh(mesh)
    tolerance = (1.0 if grading == 1 else 8.0) * (
        1e-3 if kind in ("tet10", "hex20", "hex27") else 2e-2
    )
    assert face_area(mesh) == pytest.approx(4 * np.pi * 0.025**2, rel=tolerance)
    assert mass_properties(mesh, 1.0).mass == pytest.approx(
        4 / 3 * np.pi * 0.025**3, rel=3 * tolerance
    )


@pytest.mark.parametrize(
    ("kind", "degree"),
    [
        ("tet4", 1),
        ("hex8", 1),
        ("tet10", 2),
        ("hex20", 2),
        ("hex27", 2),
        ("pyramid5", 1),
        ("pyramid13", 2),
    ],
)
@pytest.mark.parametrize("side", ["upper", "lower"])
def test_places_on_flat_faces(kind: str, degree: int, side: str) -> None:
    """Linear fields, and by elements of second order quadratic ones, are seen as they
    are; on edges and corners too.
    """
    mesh = box((0.4, 0.3, 0.2), (3, 2, 1), kind)
    places = np.concatenate(
        [
            np.random.default_rng(1).uniform(-0.5, 0.5, (40, 2)),
            [[0.5, 0.5], [-0.5, 0.0], [1 / 6, 0.5], [0, 0]],
        ]
    )
    places *= [0.4, 0.3]
    motion, positions = surface_motion(mesh, places, side)
    np.testing.assert_allclose(positions[:, :2], places, atol=1e-12)
    np.testing.assert_allclose(positions[:, 2], 0.1 if side == "upper" else -0.1, atol=1e-12)
    np.testing.assert_allclose(
        (motion @ field(mesh.nodes, degree).ravel()).reshape(-1, 3),
        field(positions, degree),
        atol=1e-10,
    )


def field(at: np.ndarray, degree: int) -> np.ndarray:
    x, y, z = at.T
    linear = np.stack([1 + x - 2 * y + 3 * z, 2 - x + y, 3 * x + y - z], axis=1)
    return linear if degree == 1 else linear + np.stack([x * y, x**2 - y**2, y**2 + x * y], axis=1)


@pytest.mark.parametrize("kind", SOLIDS)
@pytest.mark.parametrize("side", ["upper", "lower"])
def test_places_on_curved_faces(kind: str, side: str) -> None:
    """On elements that are curved themselves a linear field is still exact, and the place
    lies where it should.
    """
    mesh = bent(kind)
    places = np.random.default_rng(2).uniform(-0.8, 0.8, (40, 2)) * [0.2, 0.15] + mesh.nodes[
        lower_nodes(mesh), :2
    ].mean(axis=0)
    motion, positions = surface_motion(mesh, places, side)
    np.testing.assert_allclose(positions[:, :2], places, atol=1e-9)
    np.testing.assert_allclose(
        (motion @ field(mesh.nodes, 1).ravel()).reshape(-1, 3), field(positions, 1), atol=1e-9
    )


@pytest.mark.parametrize("kind", ["hex20", "hex27"])
def test_places_on_a_ball(kind: str) -> None:
    """All over both halves, the poles too, up to 95 % of the radius; the height is that
    of the ball.
    """
    random = np.random.default_rng(3)
    radius, angle = 0.025 * 0.95 * np.sqrt(random.random(60)), 2 * np.pi * random.random(60)
    places = np.concatenate(
        [np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1), [[0.0, 0.0]]]
    )
    mesh = sphere_mesh(0.025, 8, kind)
    for side, sign in (("upper", 1), ("lower", -1)):
        motion, positions = surface_motion(mesh, places, side)
        height = np.sqrt(0.025**2 - (places**2).sum(axis=1))
        np.testing.assert_allclose(positions[:, 2], sign * height, rtol=0.02)
        np.testing.assert_allclose(
            (motion @ field(mesh.nodes, 1).ravel()).reshape(-1, 3), field(positions, 1), atol=1e-9
        )


def test_places_on_plate_elements() -> None:
    """A point at a height moves with the slopes: rigid motions are seen as they are, on
    both sides.
    """
    structure = structure_of("quad25")
    places = np.concatenate(
        [
            np.random.default_rng(4).uniform(-0.5, 0.5, (60, 2)) * PLATE[:2],
            [[0.1, 0.05], [0.13, 0.05], [0.26, 0.21]],
        ]
    )
    for side, height in (("upper", 0.004), ("lower", -0.004)):
        motion, positions = surface_motion(structure.mesh, places, side, structure.thickness)
        np.testing.assert_allclose(
            positions, np.column_stack([places, np.full(len(places), height)]), atol=1e-10
        )
        turned = np.random.default_rng(5).standard_normal(3)
        seen = (motion @ (structure.rigid_motions()[:, 3:] @ turned)).reshape(-1, 3)
        np.testing.assert_allclose(
            seen, np.cross(turned, positions - structure.properties.centre), atol=1e-10
        )


@pytest.mark.parametrize("kind", ["hex20"])
@pytest.mark.parametrize("place", [(0.3, 0.0), (0.0, -0.21001)])
def test_a_place_beside_the_body(kind: str, place: tuple[float, float]) -> None:
    mesh = plate_mesh(PLATE[:2], 0.2) if kind == "quad25" else solid_plate_mesh(PLATE, 0.2)
    with pytest.raises(
        InputError,
        match=r"is not on the body, which reaches from -0\.26 to 0\.26 m along x and from -0\.21 "
        r"to 0\.21 m along y",
    ):
        surface_motion(mesh, np.array([place]), "upper", PLATE[2])
