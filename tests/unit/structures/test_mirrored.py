"""Structures with mirror planes: which they have, and their modes part by part."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from scipy.sparse.linalg import eigsh

from vibroimpact.errors import InputError
from vibroimpact.materials import find_material
from vibroimpact.structures import modes as of_modes
from vibroimpact.structures.finite_elements.factor import Factors
from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh, solid_plate_mesh
from vibroimpact.structures.finite_elements.sphere_mesh import sphere_mesh
from vibroimpact.structures.finite_elements.structure import plate_structure, solid_structure
from vibroimpact.structures.mirror import mirror_planes, symmetry_bases
from vibroimpact.structures.mirrored import MirroredSystem, elastic_system
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.recipe import (
    Recipe,
    Reduction,
    SphereOfSolids,
    computed_model,
    mesh_features,
)
from vibroimpact.structures.supports.constraints import HeldStructure
from vibroimpact.structures.supports.edge import Edge
from vibroimpact.structures.supports.patch import Patch
from vibroimpact.structures.supports.spring import Spring
from vibroimpact.structures.supports.support import Support, held_by

STEEL = find_material("steel-paper")
SIZE = (0.52, 0.42, 0.008)
CORNERS = tuple(Patch(x, y, 0.02) for x in (-0.2292, 0.2292) for y in (-0.18, 0.18))
SIDES = (Edge("x-min", "clamped"), Edge("x-max", "clamped"))


@cache
def plate(*supports: Support, theory: str = "thick") -> HeldStructure:
    mesh = plate_mesh(SIZE[:2], 0.14, *mesh_features(supports))
    return held_by(plate_structure(mesh, STEEL, SIZE[2], theory), supports)


@cache
def sphere(across: int = 6, grading: float = 1.0, kind: str = "hex20") -> HeldStructure:
    return held_by(solid_structure(sphere_mesh(0.025, across, kind, grading), STEEL))


@cache
def bricks(*supports: Support) -> HeldStructure:
    return held_by(
        solid_structure(solid_plate_mesh(SIZE, 0.08, 1, "hex20", *mesh_features(supports)), STEEL),
        supports,
    )


@pytest.mark.parametrize(
    ("held", "axes"),
    [
        # whose lower face is held: that couples bending and stretching
        (lambda: plate(*CORNERS), [0, 1]),
        (lambda: plate(), [0, 1, 2]),
        (lambda: plate(theory="thin"), [0, 1, 2]),
        (lambda: plate(*CORNERS[:2]), [1]),
        (lambda: plate(CORNERS[0], Patch(0.2292, 0.17, 0.02)), []),
        # on a mesh that is symmetric but for it
        (lambda: plate(*CORNERS, Spring(0.1, 0.05, 1e6)), []),
        (lambda: sphere(), [0, 1, 2]),
        (lambda: sphere(grading=2.0), [0, 1]),
        (lambda: sphere(kind="tet10"), []),
        (lambda: bricks(), [0, 1, 2]),
        (lambda: bricks(*CORNERS), [0, 1]),
    ],
    ids=[
        "patches",
        "free",
        "thin",
        "two",
        "askew",
        "spring",
        "sphere",
        "graded",
        "tetrahedra",
        "bricks",
        "held bricks",
    ],
)
def test_the_mirror_planes_of_a_structure(
    held: Callable[[], HeldStructure], axes: list[int]
) -> None:
    assert [mirror.axis for mirror in mirror_planes(held())] == axes


@pytest.mark.parametrize("held", [lambda: plate(), lambda: plate(*SIDES), lambda: sphere()])
def test_parts_span_all_motions_and_nothing_couples_them(held: Callable[[], HeldStructure]) -> None:
    structure = held()
    bases = symmetry_bases(structure, mirror_planes(structure))
    assert sum(basis.shape[1] for basis in bases) == len(structure.free)
    for number, basis in enumerate(bases):
        unit = (basis.T @ basis).toarray() if basis.shape[1] < 600 else np.eye(basis.shape[1])
        np.testing.assert_allclose(unit, np.eye(basis.shape[1]), atol=1e-14)
        for other in bases[:number]:
            for matrix in (structure.stiffness, structure.mass):
                assert abs(other.T @ matrix @ basis).max() <= 1e-12 * abs(matrix).max()


@pytest.mark.parametrize("held", [lambda: plate(*SIDES), lambda: bricks(*SIDES)])
def test_modes_are_those_that_arpack_finds(held: Callable[[], HeldStructure]) -> None:
    structure = held()
    found = elastic_system(structure).modes(30)
    assert isinstance(elastic_system(structure), MirroredSystem)
    expected = np.sqrt(
        eigsh(
            structure.stiffness.tocsc(),
            30,
            structure.mass.tocsc(),
            sigma=0.0,
            return_eigenvectors=False,
        )[::-1]
    )
    np.testing.assert_allclose(found.angular_frequencies, np.sort(expected), rtol=1e-9)
    np.testing.assert_allclose(
        found.shapes.T @ (structure.mass @ found.shapes), np.eye(30), atol=1e-8
    )
    left = (
        structure.stiffness @ found.shapes
        - structure.mass @ found.shapes * found.angular_frequencies**2
    )
    assert np.abs(left).max() < 1e-6 * np.abs(structure.stiffness @ found.shapes).max()


@pytest.mark.slow
def test_modes_of_a_sphere_are_those_of_the_whole() -> None:
    """Many are equal, and a number of modes may end among equal ones."""
    structure = sphere()
    whole = ElasticSystem(
        structure.stiffness, structure.mass, structure.rigid, structure.order
    ).modes(40)
    for number in (1, 5, 7, 40):
        found = elastic_system(structure).modes(number)
        np.testing.assert_allclose(
            found.angular_frequencies, whole.angular_frequencies[:number], rtol=1e-8
        )
        assert (
            np.abs(structure.rigid.T @ (structure.mass @ found.shapes)).max()
            < 1e-9 * np.abs(structure.rigid).max()
        )


def test_one_part_may_have_most_of_the_modes() -> None:
    """A long strip bends up and down in each half more often than it does anything else."""
    mesh = plate_mesh((2.0, 0.02), 0.02)
    structure = held_by(plate_structure(mesh, STEEL, 0.01))
    whole = ElasticSystem(
        structure.stiffness, structure.mass, structure.rigid, structure.order
    ).modes(12)
    np.testing.assert_allclose(
        elastic_system(structure).modes(12).angular_frequencies,
        whole.angular_frequencies,
        rtol=1e-6,
    )


def test_statics_and_counts_are_those_of_the_whole() -> None:
    structure = sphere()
    whole, found = (
        ElasticSystem(structure.stiffness, structure.mass, structure.rigid, structure.order),
        elastic_system(structure),
    )
    loads = np.random.default_rng(0).standard_normal((len(structure.free), 2))
    expected = whole.static(loads)
    np.testing.assert_allclose(found.static(loads), expected, atol=1e-9 * np.abs(expected).max())
    twelfth = whole.modes(12).angular_frequencies[-1]
    assert found.count_below(1.0001 * twelfth) == whole.count_below(1.0001 * twelfth)


@pytest.mark.parametrize("number", [0, 100000])
def test_a_number_of_modes_that_is_not_to_be_had_is_refused_as_ever(number: int) -> None:
    with pytest.raises(InputError, match="modes are not to be had from"):
        elastic_system(sphere(4)).modes(number)


@pytest.mark.slow
def test_the_factors_of_a_sphere_are_those_of_its_eighths(monkeypatch: pytest.MonkeyPatch) -> None:
    structure = sphere(6, kind="hex27")
    entries = [Factors(structure.stiffness + structure.mass, structure.order).entries]

    class Counted(Factors):
        def __init__(self, *given: object) -> None:
            super().__init__(*given)
            entries.append(self.entries)

    monkeypatch.setattr(of_modes, "Factors", Counted)
    recipe = Recipe(
        SphereOfSolids(0.025, 6, "hex27"),
        STEEL.density,
        STEEL.youngs_modulus,
        STEEL.poissons_ratio,
        (),
        Reduction(modes=30),
    )
    computed_model(recipe)
    assert max(entries[1:]) < entries[0] / 8.0
