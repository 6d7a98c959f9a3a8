"""The static compliance of a plate: computed once, kept, refused; and averages of modes
over a disc.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures import static_compliance as module
from vibroimpact.structures.finite_elements.disc_quadrature import HERTZ, UNIFORM, pressure_rule
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.recipe import (
    ImportedMesh,
    PlateOfPlates,
    PlateOfSolids,
    Recipe,
    Reduction,
    SphereOfSolids,
    modal_model_of,
)
from vibroimpact.structures.static_compliance import computed_compliance, static_compliance
from vibroimpact.structures.store import clear_store, entries, store_size
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.supports.spring import Spring

STEEL = Material(7850.0, 210e9, 0.3)
CLAMPED = tuple(Edge(edge, "clamped") for edge in EDGES)
RECIPE = Recipe(PlateOfPlates((0.5, 0.4, 0.02), 0.1), 7850.0, 210e9, 0.3, CLAMPED)
SOLIDS = replace(RECIPE, shape=PlateOfSolids((0.5, 0.4, 0.02), 0.05))
MIDDLE = (0.0, 0.0)
AT = (0.01, 0.06)  # inside an element


@pytest.fixture(autouse=True)
def folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path / "store"))
    return tmp_path / "store"


def test_the_second_time_nothing_is_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    first = static_compliance(RECIPE, MIDDLE)
    monkeypatch.setattr(module, "computed_compliance", lambda *_: pytest.fail("computed again"))
    assert static_compliance(RECIPE, MIDDLE) == first
    assert static_compliance(replace(RECIPE, reduction=Reduction(modes=7)), (0, 0)) == first


def test_places_and_recipes_are_told_apart(folder: Path) -> None:
    asked = [(RECIPE, MIDDLE), (RECIPE, (0.1, 0.0)), (replace(RECIPE, youngs_modulus=70e9), MIDDLE)]
    assert len({static_compliance(*one) for one in asked}) == 3
    assert len(list(folder.glob("*.compliance"))) == 3
    assert computed_compliance(RECIPE, MIDDLE) == pytest.approx(
        computed_compliance(asked[2][0], MIDDLE) / 3, rel=1e-9
    )


def test_a_damaged_entry_is_computed_again(folder: Path) -> None:
    first = static_compliance(RECIPE, MIDDLE)
    (path,) = folder.iterdir()
    content = path.read_bytes()
    path.write_bytes(content[:-3] + bytes([content[-3] ^ 1]) + content[-2:])
    said: list[str] = []
    assert static_compliance(RECIPE, MIDDLE, tell=said.append) == pytest.approx(first, rel=1e-12)
    assert len(said) == 1
    assert "damaged" in said[0]
    static_compliance(RECIPE, MIDDLE, tell=said.append)
    assert len(said) == 1


def test_a_store_that_can_not_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path / "file" / "store"))
    said: list[str] = []
    assert static_compliance(RECIPE, MIDDLE, tell=said.append) > 0.0
    assert "the compliance can't be kept in" in said[-1]


def test_clearing_the_store_takes_both_kinds(folder: Path) -> None:
    modal_model_of(replace(RECIPE, reduction=Reduction(modes=2)))
    static_compliance(RECIPE, MIDDLE)
    assert {path.suffix for path in entries()} == {".modes", ".compliance"}
    assert store_size() == sum(path.stat().st_size for path in folder.iterdir())
    assert clear_store() == 2
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize(
    "recipe",
    # which can turn about its edge
    [replace(RECIPE, supports=()), replace(SOLIDS, supports=(Edge("x-min", "simply-supported"),))],
    ids=["free", "hinged"],
)
def test_what_is_not_held_yields_without_its_rigid_motion(recipe: Recipe) -> None:
    """Of the order of that of a clamped plate, as its own inertia holds it;
    `test_free_plates` has it to a per cent.
    """
    held = static_compliance(replace(recipe, supports=CLAMPED), MIDDLE)
    assert 0.5 < static_compliance(recipe, MIDDLE) / held < 5.0


def test_a_sphere_is_refused(folder: Path) -> None:
    with pytest.raises(InputError, match="is that of a plate"):
        static_compliance(Recipe(SphereOfSolids(0.025, 4, "hex8"), 7850.0, 210e9, 0.3), MIDDLE)
    assert not folder.exists()


@pytest.mark.parametrize("recipe", [RECIPE, SOLIDS], ids=["plates", "solids"])
def test_beside_the_body(recipe: Recipe) -> None:
    with pytest.raises(InputError, match=r"\(0.3, 0\) m is not on the body"):
        static_compliance(recipe, (0.3, 0.0))


@pytest.mark.parametrize("recipe", [RECIPE, SOLIDS], ids=["plates", "solids"])
def test_near_an_edge_the_disc_is_cut(recipe: Recipe) -> None:
    """What lies of it on the plate counts: on the edge itself half of it."""
    free = replace(recipe, supports=CLAMPED[:1])
    nearly, edge = (computed_compliance(free, (x, 0.02)) for x in (0.24, 0.25))
    assert nearly < edge < 1.3 * nearly


def test_a_body_with_a_hole() -> None:
    """Near a hole the disc is cut too, though the box around the body has no hole."""
    whole = box_mesh((0.5, 0.4, 0.02), (10, 8, 1), "hex20")
    middle = whole.nodes[whole.blocks[0].connectivity].mean(axis=1)
    kept = whole.blocks[0].connectivity[(np.abs(middle[:, :2]) > 0.051).any(axis=1)]
    used, numbers = np.unique(kept, return_inverse=True)
    mesh = Mesh(
        whole.nodes[used], (replace(whole.blocks[0], connectivity=numbers.reshape(kept.shape)),)
    )
    recipe = replace(RECIPE, shape=ImportedMesh("hole", lambda: mesh))
    assert computed_compliance(recipe, (0.051, 0.01)) > computed_compliance(recipe, (0.07, 0.01))
    with pytest.raises(InputError, match="not on the body"):
        computed_compliance(recipe, MIDDLE)


def test_either_side_of_solids() -> None:
    """Load and response change places (Maxwell)."""
    upper, lower = (computed_compliance(SOLIDS, (0.05, 0.02), side) for side in ("upper", "lower"))
    assert upper == pytest.approx(lower, rel=1e-9)


def test_springs_in_series() -> None:
    """A plate on soft springs under a load at its middle sinks by what the springs give,
    and bends besides.
    """
    springs = tuple(Spring(x, y, 1e4, 1e4) for x in (-0.2, 0.2) for y in (-0.15, 0.15))
    soft, hard = (
        computed_compliance(
            replace(RECIPE, supports=tuple(replace(spring, stiffness=value) for spring in springs)),
            MIDDLE,
        )
        for value in (1e4, 2e4)
    )
    assert soft - hard == pytest.approx(1 / 4e4 - 1 / 8e4, rel=1e-6)


@pytest.mark.parametrize("exponent", [UNIFORM, HERTZ])
def test_discs(exponent: float) -> None:
    """Moments of r^2 are those of the weight, and waves around the disc average to nothing."""
    places, weights = pressure_rule(exponent)
    x, y = places.T
    assert weights.sum() == pytest.approx(1.0)
    for power in range(5):
        moment = np.prod([k / (k + exponent + 1.0) for k in range(1, power + 1)])
        assert weights @ (x**2 + y**2) ** power == pytest.approx(moment, rel=1e-12)
    for n in range(1, 12):
        assert abs(weights @ (x + 1j * y) ** n) < 1e-14


def test_modes_averaged_over_a_disc() -> None:
    model = modal_model_of(replace(RECIPE, reduction=Reduction(modes=6)))
    point = model.at(np.array([AT]))[0][:, 0]
    np.testing.assert_allclose(model.averaged(AT, 0.0), point, rtol=1e-12, atol=1e-14)
    radius, step = 0.01, 1e-3
    around = model.at(np.array(AT) + step * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]]))[0]
    curvature = (around.sum(axis=1) - 4 * point) / step**2
    expected = point + 0.25 * 0.4 * radius**2 * curvature  # r^2 is 0.4 on average
    np.testing.assert_allclose(
        model.averaged(AT, radius)[:, 2], expected[:, 2], atol=3e-4 * np.abs(expected[:, 2]).max()
    )
    assert model.averaged(AT, radius).shape == (6, 3)
    with pytest.raises(InputError, match="the patch: "):
        model.averaged((0.249, 0.0), radius, what="the patch")
