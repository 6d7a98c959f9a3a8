"""Modes, their number, statics, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csr_array

from vibroimpact.errors import ComputationError, InputError
from vibroimpact.materials import Material
from vibroimpact.structures import modes
from vibroimpact.structures.finite_elements import free_memory
from vibroimpact.structures.finite_elements.factor import Factors, factor_entries, nested_dissection
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh
from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh, solid_plate_mesh
from vibroimpact.structures.finite_elements.sphere_mesh import sphere_mesh
from vibroimpact.structures.finite_elements.structure import (
    Structure,
    node_adjacency,
    plate_structure,
    solid_structure,
)
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.supports.point import Point
from vibroimpact.structures.supports.spring import Spring
from vibroimpact.structures.supports.support import Support, held_by

STEEL = Material(7850.0, 210e9, 0.3)
SIZE = (0.5, 0.4, 0.02)
PLATE = plate_structure(plate_mesh(SIZE[:2], 0.14), STEEL, SIZE[2])
BRICKS = solid_structure(solid_plate_mesh(SIZE, 0.1), STEEL)
EDGE = (Edge("x-min", "clamped"),)
SPRINGS = tuple(Spring(x, y, 1e5) for x in (-0.2, 0.2) for y in (-0.15, 0.15))


def elastic(structure: Structure, supports: tuple[Support, ...] = ()) -> ElasticSystem:
    held = held_by(structure, supports)
    return ElasticSystem(held.stiffness, held.mass, held.rigid, held.order)


@pytest.mark.parametrize("structure", [PLATE, BRICKS])
@pytest.mark.parametrize(
    ("supports", "rigid"), [((), 6), (EDGE, 0), (SPRINGS, 3), ((Point(0.1, 0.1, "xyz"),), 3)]
)
def test_every_mode_is_found_once(
    structure: Structure, supports: tuple[Support, ...], rigid: int
) -> None:
    """As many as Sylvester's law of inertia counts; orthonormal, free of rigid motions,
    each solving its equation.
    """
    system = elastic(structure, supports)
    assert system.rigid.shape[1] == rigid
    found = system.modes(12)
    omega, shapes = found.angular_frequencies, found.shapes
    assert (np.diff(omega) >= 0).all()
    assert omega[0] > 1
    for number in range(1, 12):
        if omega[number] > 1.001 * omega[number - 1]:
            assert system.count_below(np.sqrt(omega[number] * omega[number - 1])) == number
    assert system.count_below(0.5 * omega[0]) == 0
    np.testing.assert_allclose(shapes.T @ (system.mass @ shapes), np.eye(12), atol=1e-7)
    np.testing.assert_allclose(system.rigid.T @ (system.mass @ shapes), 0.0, atol=1e-7)
    inertia = (system.mass @ shapes) * omega**2
    residual = np.linalg.norm(system.stiffness @ shapes - inertia, axis=0) / np.linalg.norm(
        inertia, axis=0
    )
    assert residual.max() < 1e-5


@pytest.mark.parametrize("supports", [(), tuple(Edge(edge, "simply-supported") for edge in EDGES)])
def test_double_modes_of_a_square_plate(supports: tuple[Support, ...]) -> None:
    """Both of a pair are found, however many modes are asked for."""
    system = elastic(plate_structure(plate_mesh((0.5, 0.5), 0.125), STEEL, 0.005), supports)
    every = system.modes(16).angular_frequencies
    assert (np.abs(np.diff(every) / every[1:]) < 1e-8).sum() >= 4
    for number in range(1, 10):
        np.testing.assert_allclose(
            system.modes(number).angular_frequencies, every[:number], rtol=1e-8
        )


@pytest.mark.parametrize("supports", [(), EDGE, SPRINGS])
def test_dense_and_sparse_agree(
    supports: tuple[Support, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    system = elastic(
        solid_structure(box_mesh((1.0, 0.5, 0.2), (4, 2, 1)), STEEL),
        () if supports == SPRINGS else supports,
    )
    assert system.stiffness.shape[0] < 400
    dense = system.modes(15)
    monkeypatch.setattr(modes, "_DENSE", 0)
    sparse = system.modes(15)
    np.testing.assert_allclose(sparse.angular_frequencies, dense.angular_frequencies, rtol=1e-7)
    overlap = np.abs(np.diag(dense.shapes.T @ (system.mass @ sparse.shapes)))
    np.testing.assert_allclose(overlap, 1.0, atol=1e-6)


def test_progress_ascends_to_one() -> None:
    seen: list[float] = []
    elastic(PLATE, EDGE).modes(10, seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


def two_bricks(shared: int) -> Mesh:
    """Two cubes that share one edge (2 corners), or one corner."""
    cube = box_mesh((1.0, 1.0, 1.0), (1, 1, 1), "hex8")
    shift = np.array([1.0, 1.0, 0.0 if shared == 2 else 1.0])
    other = cube.nodes + shift
    number = np.arange(8, 16)
    for index, at in enumerate(other):
        same = np.flatnonzero(np.linalg.norm(cube.nodes - at, axis=1) < 1e-9)
        if len(same):
            number[index] = same[0]
    used, connectivity = np.unique(
        np.concatenate([cube.blocks[0].connectivity, number[cube.blocks[0].connectivity]]),
        return_inverse=True,
    )
    return Mesh(
        np.concatenate([cube.nodes, other])[used],
        (ElementBlock("hex8", connectivity.reshape(-1, 8)),),
    )


@pytest.mark.parametrize("shared", [1, 2])
@pytest.mark.parametrize("supports", [(), EDGE])
def test_a_mechanism_is_refused(shared: int, supports: tuple[Support, ...]) -> None:
    structure = solid_structure(two_bricks(shared), STEEL)
    assert len(structure.mesh.nodes) == 16 - shared
    with pytest.raises(ComputationError, match="part of the body can move without resistance"):
        elastic(structure, supports)


def test_springs_that_are_next_to_none_are_named() -> None:
    springs = tuple(Spring(x, y, 1e-6, 1e-6) for x in (-0.2, 0.2) for y in (-0.1, 0.1))
    with pytest.raises(
        ComputationError,
        match="all of it can on springs that are next to none; look for such springs",
    ):
        elastic(PLATE, springs)


@pytest.mark.parametrize("number", [0, -1, 10**6])
def test_too_many_modes_or_none(number: int) -> None:
    with pytest.raises(InputError, match=f"{number} modes are not to be had from"):
        elastic(PLATE, EDGE).modes(number)


def test_as_many_modes_as_a_small_mesh_has() -> None:
    small = elastic(solid_structure(box_mesh((1.0, 1.0, 1.0), (1, 1, 1), "hex8"), STEEL))
    assert len(small.modes(18).angular_frequencies) == 18
    with pytest.raises(
        InputError, match="19 modes are not to be had from 24 degrees of freedom; ask for 1 to 18"
    ):
        small.modes(19)


def test_memory_that_is_not_known_to_be_free_is_not_said_to_be(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(free_memory, "_available", lambda: None)
    with pytest.raises(
        InputError,
        match=r"need about 1e\+09 GB of memory, and \d[\d.e+]* GB are built in, of which 80 % "
        r"may be used",
    ):
        free_memory.check_memory(1e18, "they need")


def test_too_little_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(free_memory, "free_memory", lambda: 1e6)
    structure = plate_structure(plate_mesh((0.5, 0.4), 0.05), STEEL, 0.01)
    with pytest.raises(
        InputError,
        match=r"the factors of 6765 degrees of freedom need about 0\.0\d+ GB of memory, and "
        r"0\.001 GB are free, .*; use larger elements",
    ):
        elastic(structure)


@pytest.mark.parametrize(
    "mesh",
    [
        plate_mesh((0.5, 0.4), 0.04),
        plate_mesh((2.0, 0.1), 0.04),
        solid_plate_mesh((0.5, 0.4, 0.01), 0.03),
        solid_plate_mesh((0.5, 0.4, 0.01), 0.05, 2, "tet10"),
        sphere_mesh(0.03, 8, "hex20"),
        sphere_mesh(0.03, 6, "tet4"),
        box_mesh((1.0, 1.0, 1.0), (5, 5, 5), "hex27"),
    ],
    ids=["plate", "strip", "bricks", "tetrahedra", "ball", "linear ball", "cube"],
)
def test_estimate_of_the_factors(mesh: Mesh) -> None:
    """What is estimated before, beside what there is after: never too little, and 30 % too much at
    most.

    Of the 25 numbers of a pair of nodes of a plate 12 are zero, as bending does not move its middle
    plane; the estimate counts them.
    """
    structure = plate_structure(mesh, STEEL, 0.01) if mesh.is_flat else solid_structure(mesh, STEEL)
    adjacency = node_adjacency(mesh)
    parts = nested_dissection(mesh.nodes, adjacency)
    assert np.array_equal(np.sort(np.concatenate(parts)), np.arange(len(mesh.nodes)))
    estimate = mesh.dofs_per_node**2 * factor_entries(parts, adjacency)
    whole = Factors(structure.stiffness + 1e9 * structure.mass, structure.order).entries
    assert 1.0 <= estimate / whole <= 1.3 * (25 / 13 if mesh.is_flat else 1)


def test_statics_are_the_sum_over_all_modes() -> None:
    """Of a free body too: flexibility is the sum of phi phi^T / omega^2."""
    for supports in ((), EDGE):
        system = elastic(
            solid_structure(box_mesh((1.0, 0.5, 0.2), (2, 1, 1), "hex8"), STEEL), supports
        )
        size = system.stiffness.shape[0]
        found = system.modes(size - system.rigid.shape[1])
        expected = (found.shapes / found.angular_frequencies**2) @ found.shapes.T
        static = system.static(np.eye(size))
        np.testing.assert_allclose(static, expected, atol=1e-9 * np.abs(expected).max())
        np.testing.assert_allclose(
            static[:, 2], system.static(np.eye(size)[2]), atol=1e-12 * np.abs(expected).max()
        )


@pytest.mark.parametrize("asked", [4, 12, 20])
def test_more_equal_modes_than_a_block_has(asked: int) -> None:
    """A diagonal system: 15 equal modes above two single ones."""
    values = np.concatenate([[1.0, 2.0], np.full(15, 3.0), np.geomspace(4.0, 1e6, 600)])
    found = ElasticSystem(csr_array(np.diag(values)), csr_array(np.eye(len(values)))).modes(asked)
    np.testing.assert_allclose(found.angular_frequencies**2, values[:asked], rtol=1e-9)
    np.testing.assert_allclose(found.shapes.T @ found.shapes, np.eye(asked), atol=1e-9)


def test_mass_at_a_few_degrees_of_freedom() -> None:
    """A system of which only a few degrees of freedom have mass has only as many modes."""
    size, heavy = 500, 30
    mass = np.zeros(size)
    mass[:heavy] = 1.0
    chain = csr_array(2.001 * np.eye(size) - np.eye(size, k=1) - np.eye(size, k=-1))
    condensed = np.linalg.inv(np.linalg.inv(chain.toarray())[:heavy, :heavy])
    found = ElasticSystem(chain, csr_array(np.diag(mass))).modes(10)
    np.testing.assert_allclose(
        found.angular_frequencies**2, np.linalg.eigvalsh(condensed)[:10], rtol=1e-9
    )
