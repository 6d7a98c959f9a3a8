"""Supports: what they hold, what they leave, and what is refused."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.bed import bed_stiffness, patch_bed
from vibroimpact.structures.finite_elements.disc_quadrature import disc_rule
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.sphere_mesh import sphere_mesh
from vibroimpact.structures.finite_elements.structure import Structure, solid_structure
from vibroimpact.structures.finite_elements.surface import lower_nodes, surface_motion
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.recipe import PlateOfPlates, PlateOfSolids
from vibroimpact.structures.supports.bar import Bar, column_matrices
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.supports.node_set import NodeSet
from vibroimpact.structures.supports.patch import Patch, RectangularPatch
from vibroimpact.structures.supports.point import Point
from vibroimpact.structures.supports.spring import Spring
from vibroimpact.structures.supports.support import Support, held_by

STEEL = Material(7850.0, 210e9, 0.3)
WEIGHTLESS = Material(1e-6, 210e9, 0.3)
SIZE = (0.5, 0.4, 0.05)
PLATE, BRICKS = PlateOfPlates(SIZE, 0.14), PlateOfSolids(SIZE, 0.1)
SPOTS = [(-0.2, -0.15), (-0.2, 0.15), (0.15, -0.15), (0.15, 0.1)]


def made(
    shape: PlateOfPlates | PlateOfSolids, supports: tuple[Support, ...], material: Material = STEEL
) -> Structure:
    return shape.structure(shape.mesh(supports), material)


def frequencies(
    shape: PlateOfPlates | PlateOfSolids,
    supports: tuple[Support, ...],
    number: int,
    material: Material = STEEL,
) -> np.ndarray:
    held = held_by(made(shape, supports, material), supports)
    return ElasticSystem(held.stiffness, held.mass, held.rigid, held.order).modes(
        number
    ).angular_frequencies / (2 * np.pi)


def rigid_plate_on(blocks: list[tuple[tuple[float, float], np.ndarray]]) -> np.ndarray:
    """Frequencies of a rigid plate [Hz], held at its lower side by stiffnesses for three
    displacements and three rotations.
    """
    a, b, c = SIZE
    mass = 7850 * a * b * c
    stiffness = np.zeros((6, 6))
    for (x, y), block in blocks:
        # displacement by unit rotations: rotation cross position
        arm = np.array([[0, -c / 2, -y], [c / 2, 0, x], [y, -x, 0]])
        move = np.block([[np.eye(3), arm], [np.zeros((3, 3)), np.eye(3)]])
        stiffness += move.T @ block @ move
    inertia = mass / 12 * np.diag([b**2 + c**2, a**2 + c**2, a**2 + b**2])
    whole = np.block([[mass * np.eye(3), np.zeros((3, 3))], [np.zeros((3, 3)), inertia]])
    return np.sqrt(np.maximum(eigh(stiffness, whole, eigvals_only=True), 0)) / (2 * np.pi)


@pytest.mark.parametrize("shape", [PLATE, BRICKS])
@pytest.mark.parametrize("radius", [0.0, 0.03])
def test_a_rigid_plate_on_springs(shape: PlateOfPlates, radius: float) -> None:
    """Heave, pitch, roll and the sway of a stiff plate on soft springs; a pad resists
    turning with k r^2 / 4, and k r^2 / 2.
    """
    vertical, across = 1e4, 3e3
    turning = [vertical * radius**2 / 4] * 2 + [across * radius**2 / 2]
    block = np.diag([across, across, vertical, *turning])
    supports = tuple(Spring(x, y, vertical, across, radius) for x, y in SPOTS)
    np.testing.assert_allclose(
        frequencies(shape, supports, 6),
        rigid_plate_on([(spot, block) for spot in SPOTS]),
        rtol=2e-4,
    )


@pytest.mark.parametrize("shape", [PLATE, BRICKS])
def test_springs_without_horizontal_stiffness_leave_three_rigid_motions(
    shape: PlateOfPlates,
) -> None:
    supports = tuple(Spring(x, y, 1e4) for x, y in SPOTS)
    assert held_by(made(shape, supports), supports).rigid.shape[1] == 3
    block = np.diag([0, 0, 1e4, 0, 0, 0])
    np.testing.assert_allclose(
        frequencies(shape, supports, 3),
        rigid_plate_on([(spot, block) for spot in SPOTS])[3:],
        rtol=2e-4,
    )


@pytest.mark.parametrize(
    ("supports", "rigid"),
    [
        ((), 6),
        ((Point(0.1, 0.1, "xyz"),), 3),
        ((Point(0.1, 0.1, "xyz"), Point(-0.1, 0.1, "xyz")), 1),
        ((Point(0.1, 0.1, "xyz"), Point(-0.1, 0.1, "xyz"), Point(0.0, -0.1, "xyz")), 0),
        ((Point(0.1, 0.1), Point(-0.1, 0.1), Point(0.0, -0.1)), 3),
        ((Spring(0.1, 0.1, 1e5),), 5),
        ((Spring(0.1, 0.1, 1e5, 1e3),), 3),
        ((Spring(0.1, 0.1, 1e5, 0.0, 0.02),), 3),
        ((Spring(0.1, 0.1, 0.0),), 6),
        ((Patch(0.1, 0.1, 0.002),), 0),
        ((Bar(0.1, 0.1, 0.01, 0.3, STEEL),), 0),
        ((Edge("y-min", "simply-supported"),), 3),
        ((RectangularPatch(0.0, 0.1, 0.05, 0.02),), 0),
    ],
)
@pytest.mark.parametrize("shape", [PLATE, BRICKS])
def test_rigid_motions_that_are_left(
    shape: PlateOfPlates, supports: tuple[Support, ...], rigid: int
) -> None:
    structure = made(shape, supports)
    held = held_by(structure, supports)
    assert held.rigid.shape[1] == rigid
    if rigid:
        assert (
            np.abs(held.stiffness @ held.rigid).max()
            < 1e-10 * np.abs(held.stiffness).max() * np.abs(held.rigid).max()
        )


def top_stiffness(radius: float, length: float) -> np.ndarray:
    """Of the top of a clamped column, from its flexibility after Timoshenko, with
    Cowper's coefficient.
    """
    area, second, shear = np.pi * radius**2, np.pi * radius**4 / 4, 210e9 / 2.6
    factor = 6 * 1.3 / (7 + 6 * 0.3)
    sway = length**3 / (3 * 210e9 * second) + length / (factor * shear * area)
    tilt, both = length / (210e9 * second), length**2 / (2 * 210e9 * second)
    flexibility = np.diag(
        [sway, sway, length / (210e9 * area), tilt, tilt, length / (2 * shear * second)]
    )
    flexibility[0, 4] = flexibility[4, 0] = both
    flexibility[1, 3] = flexibility[3, 1] = -both
    return np.linalg.inv(flexibility)


@pytest.mark.parametrize("elements", [1, 3, 8])
def test_stiffness_of_a_column(elements: int) -> None:
    """E A / L, 3 E I / L^3 with shear, G J / L: exact, into however many beams it is cut."""
    stiffness, _ = column_matrices(0.03, 0.2, STEEL, elements)
    flexibility = np.linalg.inv(stiffness)[-6:, -6:]
    np.testing.assert_allclose(
        np.linalg.inv(flexibility), top_stiffness(0.03, 0.2), rtol=1e-8, atol=1e-3
    )


def test_frequencies_of_a_column() -> None:
    """Of its own: Euler's cantilever 1.8751^2 sqrt(E I / rho A L^4), and the stretched
    and the twisted rod c / 4 L.
    """
    radius, length = 0.005, 1.0
    stiffness, mass = column_matrices(radius, length, STEEL, 8)
    found = np.sqrt(eigh(stiffness, mass, eigvals_only=True)) / (2 * np.pi)
    bending = (
        np.array([1.8751041, 4.6940911, 7.8547574]) ** 2
        * np.sqrt(210e9 / 7850)
        * radius
        / 2
        / (2 * np.pi)
    )
    np.testing.assert_allclose(found[[0, 1]], bending[0], rtol=2e-4)
    np.testing.assert_allclose(found[[2, 3, 4, 5]], np.repeat(bending[1:], 2), rtol=3e-3)
    for speed in (np.sqrt(210e9 / 7850), np.sqrt(210e9 / 2.6 / 7850)):
        assert np.abs(found / (speed / 4) - 1).min() < 2e-3


def test_mass_of_a_column() -> None:
    """Of rigid motions: what is not at the fixed node is the mass that hangs on the others."""
    _, mass = column_matrices(0.03, 0.2, STEEL, 8)
    step, whole = 0.2 / 8, 7850 * np.pi * 0.03**2 * 0.2
    up = np.tile([0, 0, 1.0, 0, 0, 0], 8)
    assert up @ mass @ up == pytest.approx(whole * (1 - 2 / 3 * step / 0.2), rel=1e-12)


@pytest.mark.parametrize("shape", [pytest.param(PLATE, marks=pytest.mark.slow), BRICKS])
def test_a_rigid_plate_on_slender_bars(shape: PlateOfPlates) -> None:
    radius, length = 0.002, 0.3
    supports = tuple(Bar(x, y, radius, length, WEIGHTLESS) for x, y in SPOTS)
    exact = rigid_plate_on([(spot, top_stiffness(radius, length)) for spot in SPOTS])
    rigid = Material(7850.0, 10 * 210e9, 0.3)  # one of steel gives way around bars so slender
    np.testing.assert_allclose(frequencies(shape, supports, 3, rigid), exact[:3], rtol=1e-3)


@pytest.mark.slow
def test_bars_under_plate_elements_and_under_bricks() -> None:
    """Six modes of a plate of 8 mm on four bars within 0.3 %; bricks that are not refined
    at the rims are 1.5 % stiffer.
    """
    bars = tuple(Bar(x, y, 0.02, 0.2, STEEL) for x in (-0.18, 0.18) for y in (-0.14, 0.14))
    size = (0.5, 0.4, 0.008)
    flat, solid = (
        frequencies(shape, bars, 6)
        for shape in (PlateOfPlates(size, 0.06), PlateOfSolids(size, 0.02, splits=2))
    )
    np.testing.assert_allclose(solid, flat, rtol=3e-3)


def test_springs_hold_a_plate_at_its_corners() -> None:
    """Thin square plate on its four corners: lambda = 7.11, 15.77 twice and 19.60 (D. J.
    Gorman, J. Sound Vib. 79:561, 1981).
    """
    height = 0.004
    shape = PlateOfPlates((1.0, 1.0, height), 0.2)
    stiff = tuple(Spring(x, y, 1e9) for x in (-0.5, 0.5) for y in (-0.5, 0.5))
    rigidity = 210e9 * height**3 / (12 * 0.91)
    found = 2 * np.pi * frequencies(shape, stiff, 4) * np.sqrt(7850 * height / rigidity)
    np.testing.assert_allclose(found, [7.111, 15.77, 15.77, 19.60], rtol=2e-3)


def test_a_mesh_made_for_them_has_their_nodes() -> None:
    supports = (Patch(0.1, 0.1, 0.02), RectangularPatch(-0.1, 0.05, 0.06, 0.04), Point(0.03, -0.13))
    for shape in (PLATE, BRICKS):
        mesh = made(shape, supports).mesh
        lower = mesh.nodes[lower_nodes(mesh), :2]
        held = held_by(made(shape, supports), supports)
        still = np.asarray(np.abs(held.expansion).sum(axis=1))[:: mesh.dofs_per_node]
        assert np.isclose(np.hypot(*(lower - [0.1, 0.1]).T), 0.02, atol=1e-9).sum() >= 8
        assert np.isclose(np.hypot(*(lower - [0.03, -0.13]).T), 0.0, atol=1e-9).sum() == 1
        corner = [-0.13, 0.03]
        assert np.isclose(np.hypot(*(lower - corner).T), 0.0, atol=1e-9).sum() == 1
        if not mesh.is_flat:
            x, y, z = mesh.nodes[still == 0].T
            assert np.allclose(z, -SIZE[2] / 2)
            inside = (np.hypot(x - 0.1, y - 0.1) < 0.02 + 1e-9) | (
                (np.abs(x + 0.1) < 0.03 + 1e-9) & (np.abs(y - 0.05) < 0.02 + 1e-9)
            )
            assert (inside | np.isclose(x, 0.03)).all()


def test_a_patch_holds_the_lower_side_of_thin_plates() -> None:
    """There the plate neither moves nor turns: no node of the patch moves at the lower
    side, in any mode.
    """
    supports = (Patch(0.1, 0.1, 0.02),)
    held = held_by(made(replace(PLATE, theory="thin"), supports), supports)
    mesh = held.structure.mesh
    motion = held.expansion.toarray().reshape(len(mesh.nodes), 5, -1)
    inside = np.hypot(*(mesh.nodes[:, :2] - [0.1, 0.1]).T) < 0.02 + 1e-9
    assert np.abs(motion[inside, 2]).max() == 0
    np.testing.assert_allclose(
        motion[inside, :2] - SIZE[2] / 2 * motion[inside, 3:], 0.0, atol=1e-15
    )


def test_a_thick_plate_rests_on_a_bed() -> None:
    """What its lower face does on a patch costs the energy of springs spread over it: of
    a sink, a shift and a rocking of a disc.
    """
    radius = 0.02
    supports = (Patch(0.1, 0.1, radius),)
    held = held_by(made(PLATE, supports), supports)
    along, across = patch_bed(bed_stiffness(STEEL, SIZE[2]), SIZE[2] / radius)
    x, y, _ = held.structure.mesh.nodes.T - np.array([[0.1], [0.1], [0.0]])
    zero, one, area = np.zeros_like(x), np.ones_like(x), np.pi * radius**2
    motions = {
        "sink": ([zero, zero, one, zero, zero], across * area),
        "shift": ([one, zero, zero, zero, zero], along * area),
        "rock about the lower face": (
            [SIZE[2] / 2 * one, zero, -x, one, zero],
            across * area * radius**2 / 4,
        ),
        "turn": ([-y, x, zero, zero, zero], along * area * radius**2 / 2),
    }
    for name, (columns, stiffness) in motions.items():
        motion = np.stack(columns, axis=1).ravel()
        # the rim is a polynomial, not a circle
        assert motion @ (held.bed @ motion) == pytest.approx(stiffness, rel=2e-3), name
    assert held.expansion.shape[0] == held.expansion.shape[1]  # nothing is held still


def test_overlapping_patches_rest_on_one_bed() -> None:
    size = (0.1, 0.08)
    one = (RectangularPatch(0.0, 0.0, *size),)
    other = (RectangularPatch(-0.02, 0.0, 0.06, 0.08), RectangularPatch(0.02, 0.0, 0.06, 0.08))
    up = [
        np.tile([0.0, 0.0, 1.0, 0.0, 0.0], len(made(PLATE, supports).mesh.nodes))
        for supports in (one, other)
    ]
    beds = [held_by(made(PLATE, supports), supports).bed for supports in (one, other)]
    found = [float(motion @ (bed @ motion)) for motion, bed in zip(up, beds, strict=True)]
    area = [
        size[0] * size[1] * patch_bed(bed_stiffness(STEEL, SIZE[2]), SIZE[2] / radius)[1]
        for radius in (0.08 / 1.8, 0.06 * 0.08 / 0.14)
    ]
    np.testing.assert_allclose(found, area, rtol=1e-9)


@pytest.mark.parametrize(
    ("supports", "message"),
    [
        (
            (Patch(0.1, 0.1, 0.03), Patch(0.13, 0.1, 0.03)),
            r"the round support at \(0\.1, 0\.1\) m, radius 0\.03 m, is too near to another one",
        ),
        (
            (Patch(0.24, 0.1, 0.02),),
            r"radius 0\.02 m, does not lie wholly on the plate, which reaches from -0\.25 "
            r"to 0\.25 m along x",
        ),
        (
            (Patch(0.0, -0.19, 0.02),),
            r"does not lie wholly on the plate, which reaches from -0\.2 to 0\.2 m along y",
        ),
        ((Bar(0.0, 0.0, 0.3, 0.1, STEEL),), "does not lie wholly on the plate"),
        ((Point(0.4, 0.0),), r"\(0\.4, 0\) m is not on the body"),
        ((RectangularPatch(0.5, 0.0, 0.1, 0.1),), "does not lie wholly on the plate"),
        ((Spring(0.3, 0.0, 1e3),), "is not on the body"),
        ((NodeSet("feet"),), 'the mesh has no set "feet"; it has no named sets'),
    ],
)
def test_supports_that_hold_nothing(supports: tuple[Support, ...], message: str) -> None:
    with pytest.raises(InputError, match=message):
        held_by(made(BRICKS, supports), supports)


def test_a_mesh_that_does_not_know_them() -> None:
    structure = solid_structure(box_mesh((0.5, 0.4, 0.05), (4, 4, 1)), STEEL)
    with pytest.raises(
        InputError, match=r"the patch at \(0\.03, 0\.03\) m holds no nodes on the lower side"
    ):
        held_by(structure, [Patch(0.03, 0.03, 0.01)])
    with pytest.raises(InputError, match="holds only 1 of the nodes on the lower side"):
        held_by(structure, [Patch(0.0, 0.0, 0.02)])
    with pytest.raises(InputError, match="the bar at"):
        held_by(structure, [Bar(0.03, 0.03, 0.01, 0.1, STEEL)])
    with pytest.raises(
        InputError,
        match=r'the edge "x-min" has only 1 of the nodes of the mesh: that side of the body is '
        r"not flat",
    ):
        held_by(solid_structure(sphere_mesh(0.02, 4), STEEL), [Edge("x-min", "clamped")])


@pytest.mark.parametrize("patch_first", [True, False])
def test_two_bodies_can_not_hold_one_point(patch_first: bool) -> None:
    structure = solid_structure(box_mesh((0.5, 0.4, 0.05), (10, 8, 1)), STEEL)
    bar, other = (
        Bar(0.0, 0.0, 0.06, 0.1, STEEL),
        Patch(0.05, 0.0, 0.06) if patch_first else Bar(0.05, 0.0, 0.06, 0.1, STEEL),
    )
    with pytest.raises(
        InputError, match=r"two supports hold the same point, .* supports must lie apart"
    ):
        held_by(structure, [other, bar])


@pytest.mark.slow
def test_the_point_that_two_bodies_hold_is_named() -> None:
    """It lies in both: in the bar from -0.06 m to 0.06 m along x, and in the patch from
    0.03 m on.
    """
    bar, patch = Bar(0.0, 0.0, 0.06, 0.1, STEEL), RectangularPatch(0.09, 0.0, 0.12, 0.12)
    plate = PlateOfPlates((0.5, 0.4, 0.01), 0.02)
    structure = plate.structure(plate.mesh((bar, patch)), STEEL)
    with pytest.raises(InputError, match="two supports hold the same point") as raised:
        held_by(structure, [patch, bar])
    x, y = (float(number) for number in re.findall(r"-?[\d.]+(?=[,)])", str(raised.value))[:2])
    assert x >= 0.03 - 1e-9
    assert np.hypot(x, y) <= 0.06 + 1e-9


def test_patches_may_overlap_on_a_mesh_that_was_brought() -> None:
    """What is held still twice is held still."""
    structure = solid_structure(box_mesh((0.5, 0.4, 0.05), (10, 8, 1)), STEEL)
    one, other = Patch(0.0, 0.0, 0.06), Patch(0.05, 0.0, 0.06)
    both = held_by(structure, [one, other])
    assert both.stiffness.shape == held_by(structure, [other, one, other]).stiffness.shape
    assert both.stiffness.shape[0] < held_by(structure, [one]).stiffness.shape[0]


@pytest.mark.parametrize("condition", ["clamped", "simply-supported"])
@pytest.mark.parametrize("shape", [PLATE, BRICKS])
def test_edges_in_any_order(shape: PlateOfPlates, condition: str) -> None:
    """Edges share corners; the order in which they are named does not matter."""
    edges = [Edge(edge, condition) for edge in EDGES]
    first, second = (frequencies(shape, tuple(some), 4) for some in (edges, edges[::-1]))
    np.testing.assert_allclose(first, second, rtol=1e-9)


def test_a_patch_that_reaches_a_held_edge() -> None:
    """A rectangular patch beside a clamped edge, in either order."""
    supports = (Edge("x-min", "clamped"), RectangularPatch(-0.2, 0.0, 0.1, 0.1))
    for shape in (PLATE, BRICKS):
        np.testing.assert_allclose(
            frequencies(shape, supports, 4), frequencies(shape, supports[::-1], 4), rtol=1e-9
        )


def test_rule_of_a_disc() -> None:
    """Moments of a disc to the tenth degree."""
    points, weights = disc_rule(0.3)
    assert weights.sum() == pytest.approx(1.0, rel=1e-12)
    for power in range(1, 6):
        mean = weights @ (points**2).sum(axis=1) ** power
        assert mean == pytest.approx(0.3 ** (2 * power) / (power + 1), rel=1e-12)
    assert weights @ (points[:, 0] ** 3 * points[:, 1]) == pytest.approx(0.0, abs=1e-15)


def test_points_that_share_an_element_are_both_held() -> None:
    """Three points inside one brick: each stays where it is, in every mode."""
    structure = made(BRICKS, ())
    (x0, y0), side = structure.mesh.nodes[:, :2].min(axis=0), 0.01
    points = tuple(
        Point(x0 + a * side, y0 + b * side, "xyz") for a, b in ((1.0, 1.0), (2.0, 1.5), (1.5, 2.5))
    )
    held = held_by(structure, points)
    assert held.rigid.shape[1] == 0
    modes = ElasticSystem(held.stiffness, held.mass, held.rigid, held.order).modes(3)
    motion, _ = surface_motion(
        structure.mesh, np.array([[point.x, point.y] for point in points]), "lower"
    )
    moved = motion @ (held.expansion @ modes.shapes)
    assert np.abs(moved).max() < 1e-9 * np.abs(modes.shapes).max()
