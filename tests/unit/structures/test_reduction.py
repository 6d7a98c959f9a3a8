"""Craig and Bampton's reduction of plates, and attachment modes."""

from __future__ import annotations

import numpy as np
import pytest

from support import one_in
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.structure import Structure
from vibroimpact.structures.finite_elements.surface import surface_motion
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.recipe import (
    PlateOfPlates,
    PlateOfSolids,
    Recipe,
    Reduction,
    SphereOfSolids,
    computed_model,
)
from vibroimpact.structures.reduction import attachment_modes, craig_bampton, projected
from vibroimpact.structures.supports.constraints import HeldStructure
from vibroimpact.structures.supports.edge import Edge
from vibroimpact.structures.supports.patch import Patch
from vibroimpact.structures.supports.support import Support, held_by

STEEL = Material(7850.0, 210e9, 0.3)
EDGE = (Edge("x-min", "clamped"),)
PATCH = (Patch(0.1, 0.05, 0.02),)
SIZE = (0.5, 0.4, 0.01)
PLATE, BRICKS, BALL = PlateOfPlates(SIZE, 0.14), PlateOfSolids(SIZE, 0.1), SphereOfSolids(0.025, 4)
PLACE = (0.11, -0.07)
BALL_TOP = (0.001, 0.002)
CASES = [
    (PLATE, EDGE, PLACE),
    (PLATE, (), PLACE),
    pytest.param(PLATE, PATCH, PLACE, marks=pytest.mark.slow),
    (BRICKS, EDGE, PLACE),
    (BRICKS, (), PLACE),
    (BALL, (), BALL_TOP),
]


def held(
    shape: PlateOfPlates | PlateOfSolids | SphereOfSolids, supports: tuple[Support, ...]
) -> HeldStructure:
    return held_by(shape.structure(shape.mesh(supports), STEEL), supports)


def elastic(system: HeldStructure) -> ElasticSystem:
    return ElasticSystem(system.stiffness, system.mass, system.rigid, system.order)


def vertical(structure: Structure, place: tuple[float, float], side: str) -> np.ndarray:
    motion, _ = surface_motion(structure.mesh, np.array([place]), side, structure.thickness)
    return motion[[2]].toarray()[0]


@pytest.mark.parametrize(("shape", "supports", "place"), CASES)
@pytest.mark.parametrize("modes", one_in(2, [6, 1]))
def test_attachment_modes_make_the_statics_at_a_point_exact(
    shape: PlateOfPlates, supports: tuple[Support, ...], place: tuple[float, float], modes: int
) -> None:
    """The compliance of the contact point in the modes kept is that of all of them, which
    the factors give.
    """
    reduction = Reduction(modes=modes, attachment=((place, "lower"),))
    model = computed_model(
        Recipe(
            shape, STEEL.density, STEEL.youngs_modulus, STEEL.poissons_ratio, supports, reduction
        )
    )
    assert len(model.angular_frequencies) == modes + 1
    seen = model.at(np.array([place]), "lower")[0][:, 0, 2]
    system = held(shape, supports)
    load = system.expansion.T @ vertical(system.structure, place, "lower")
    exact = load @ elastic(system).static(load)
    assert (seen**2 / model.angular_frequencies**2).sum() == pytest.approx(exact, rel=1e-6)
    truncated = computed_model(
        Recipe(
            shape,
            STEEL.density,
            STEEL.youngs_modulus,
            STEEL.poissons_ratio,
            supports,
            Reduction(modes=modes),
        )
    )
    np.testing.assert_allclose(
        model.angular_frequencies[:modes], truncated.angular_frequencies, rtol=1e-7
    )
    assert (
        truncated.at(np.array([place]), "lower")[0][:, 0, 2] ** 2 / truncated.angular_frequencies**2
    ).sum() < exact


def test_two_attachment_modes_at_one_point_are_one() -> None:
    reduction = Reduction(modes=3, attachment=((PLACE, "upper"), (PLACE, "upper")))
    model = computed_model(Recipe(PLATE, 7850.0, 210e9, 0.3, EDGE, reduction))
    assert len(model.angular_frequencies) == 4
    assert np.isfinite(model.shapes).all()


def test_attachment_modes_are_free_of_the_modes_kept() -> None:
    system = held(BRICKS, ())
    solved = elastic(system)
    modes = solved.modes(5)
    load = system.expansion.T @ vertical(system.structure, PLACE, "upper")
    found = attachment_modes(solved, modes, load[:, None])
    size = np.sqrt(np.einsum("ij,ij->j", found, solved.mass @ found))
    np.testing.assert_allclose(modes.shapes.T @ (solved.mass @ found) / size, 0.0, atol=1e-6)
    np.testing.assert_allclose(solved.rigid.T @ (solved.mass @ found) / size, 0.0, atol=1e-6)


@pytest.mark.parametrize(
    ("shape", "supports"), [(PLATE, EDGE), (BRICKS, EDGE), (PLATE, ()), (BRICKS, ())]
)
def test_craig_bampton_of_a_plate(shape: PlateOfPlates, supports: tuple[Support, ...]) -> None:
    """Frequencies come from above and converge; where the plate is held, the statics of
    the interface are exact.
    """
    system = held(shape, supports)
    solved = elastic(system)
    exact = solved.modes(5).angular_frequencies
    interface = (((0.2, 0.1), "upper"), ((-0.1, -0.1), "upper"))
    found = []
    for number in (4, 25):
        reduction = Reduction(modes=number, method="craig-bampton", interface=interface)
        model = computed_model(Recipe(shape, 7850.0, 210e9, 0.3, supports, reduction))
        assert len(model.rigid_coefficients) == (0 if supports else 6)
        found.append(model.angular_frequencies[:5] / exact - 1)
        assert (found[-1] > -1e-7).all()
    assert found[1].max() < 2e-3
    assert found[1].max() < found[0].max()


def test_craig_bampton_statics_of_a_plate() -> None:
    system = held(PLATE, EDGE)
    interface = np.array([100, 333, 334, 500])
    modes = projected(
        system.stiffness,
        system.mass,
        craig_bampton(system.stiffness, system.mass, interface, 3, system.order),
    )
    loads = np.eye(system.stiffness.shape[0])[:, interface]
    found = modes.shapes @ ((modes.shapes.T @ loads) / modes.angular_frequencies[:, None] ** 2)
    exact = elastic(system).static(loads)
    np.testing.assert_allclose(found, exact, atol=1e-7 * np.abs(exact).max())


def test_no_interface_is_refused() -> None:
    system = held(PLATE, EDGE)
    with pytest.raises(InputError, match="needs at least one interface degree of freedom"):
        craig_bampton(system.stiffness, system.mass, [], 3)


def test_all_modes_up_to_a_frequency() -> None:
    model = computed_model(Recipe(PLATE, 7850.0, 210e9, 0.3, EDGE, Reduction(max_frequency=600.0)))
    more = computed_model(
        Recipe(PLATE, 7850.0, 210e9, 0.3, EDGE, Reduction(modes=len(model.frequencies) + 1))
    )
    assert model.frequencies[-1] < 600 < more.frequencies[-1]
    np.testing.assert_allclose(model.frequencies, more.frequencies[:-1], rtol=1e-9)
    with pytest.raises(InputError, match="there is no mode below 1 Hz"):
        computed_model(Recipe(PLATE, 7850.0, 210e9, 0.3, EDGE, Reduction(max_frequency=1.0)))


@pytest.mark.parametrize(
    ("radius", "density", "modulus"),
    [(1.0, 1.0, 1.0), (0.025, 1380.0, 2.26e9), (3e-3, 7850.0, 2.1e11)],
)
def test_a_rigid_motion_leaves_no_mode_of_rounding(
    radius: float, density: float, modulus: float
) -> None:
    # the motion with one point of a free body is rigid: what is left of it has no frequency, let
    # alone one below the lowest
    reduction = Reduction(modes=6, method="craig-bampton", interface=((None, "lower"),))
    reduced = computed_model(
        Recipe(SphereOfSolids(radius, 4), density, modulus, 0.3, (), reduction)
    )
    whole = computed_model(
        Recipe(SphereOfSolids(radius, 4), density, modulus, 0.3, (), Reduction(modes=6))
    )
    np.testing.assert_allclose(
        reduced.angular_frequencies[:3], whole.angular_frequencies[:3], rtol=1e-3
    )
