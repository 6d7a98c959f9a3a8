"""What a process keeps in its memory: many drops on one plate read it, factorise it and
find its modes once.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from vibroimpact.materials import Material
from vibroimpact.structures import recipe as recipes
from vibroimpact.structures import static_compliance as statics
from vibroimpact.structures.memory_cache import MemoryCache
from vibroimpact.structures.recipe import (
    PlateOfPlates,
    Recipe,
    Reduction,
    SphereOfSolids,
    computed_model,
    modal_model_of,
    model_key,
)
from vibroimpact.structures.static_compliance import computed_compliance
from vibroimpact.structures.store import entries, has_model
from vibroimpact.structures.supports.edge import EDGES, Edge

ROCK = Material(1380.0, 2.26e9, 0.28)
CLAMPED = tuple(Edge(edge, "clamped") for edge in EDGES)
PLATE = Recipe(
    PlateOfPlates((0.5, 0.4, 0.02), 0.1), 7850.0, 210e9, 0.3, CLAMPED, Reduction(modes=3)
)
SPHERE = Recipe(
    SphereOfSolids(0.025, 4, "hex20"),
    ROCK.density,
    ROCK.youngs_modulus,
    ROCK.poissons_ratio,
    (),
    Reduction(modes=10),
)


@pytest.fixture(autouse=True)
def folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path / "store"))
    return tmp_path / "store"


def stored(recipe: Recipe) -> bool:
    return has_model(model_key(recipe))


def test_what_was_used_last_stays() -> None:
    cache = MemoryCache[int](capacity=10)
    for key, size in (("a", 4), ("b", 4), ("c", 2)):
        cache.put(key, ord(key), size)
    assert cache.get("a") == ord("a")  # so that "b" is the oldest
    cache.put("d", ord("d"), 3)
    assert [cache.get(key) for key in "abcd"] == [ord("a"), None, ord("c"), ord("d")]
    cache.put("a", 1, 9)  # again, and larger
    assert [cache.get(key) for key in "acd"] == [1, None, None]
    cache.put("large", 2, 11)
    assert cache.get("large") is None
    cache.clear()
    assert cache.get("a") is None


def test_a_model_is_read_once(
    monkeypatch: pytest.MonkeyPatch, folder: Path, tmp_path: Path
) -> None:
    modal_model_of(PLATE)
    read = modal_model_of(PLATE)
    assert not read.shapes.flags.writeable  # it is shared
    monkeypatch.setattr(recipes, "load_model", lambda *_: pytest.fail("read again"))
    assert modal_model_of(PLATE) is read
    monkeypatch.undo()
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path / "another"))
    assert modal_model_of(PLATE) is not read  # another store has nothing yet


def test_what_the_store_does_not_take_is_computed_once(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path / "file" / "store"))
    first = modal_model_of(PLATE)
    assert modal_model_of(PLATE) is first


def test_a_plate_is_factorised_once_for_all_places(monkeypatch: pytest.MonkeyPatch) -> None:
    places = [(0.0, 0.0), (0.03, 0.05), (0.24, -0.19)]
    fresh = []
    for place in places:
        statics._FACTORISED.clear()
        fresh.append(computed_compliance(PLATE, place))
    monkeypatch.setattr(statics, "held_by", lambda *_: pytest.fail("factorised again"))
    assert [computed_compliance(PLATE, place) for place in places] == fresh
    monkeypatch.undo()
    softer = replace(PLATE, youngs_modulus=70e9)
    assert computed_compliance(softer, places[0]) == pytest.approx(3.0 * fresh[0], rel=1e-9)


@pytest.mark.parametrize(
    "more", [{}, {"attachment": ((None, "lower"),)}], ids=["modal", "attachment"]
)
def test_spheres_that_are_similar_share_their_modes(
    folder: Path, more: dict[str, tuple[tuple[None, str], ...]]
) -> None:
    """Of any size, density and modulus they are those that would be computed for it, to
    rounding.
    """
    recipe = replace(SPHERE, reduction=Reduction(modes=10, **more))  # type: ignore[arg-type]
    assert not stored(recipe)
    for other in (
        recipe,
        replace(recipe, shape=SphereOfSolids(0.004, 4, "hex20")),
        replace(recipe, density=7850.0, youngs_modulus=2.1e11),
    ):
        found, direct = modal_model_of(other), computed_model(other)
        assert stored(other)
        np.testing.assert_allclose(found.angular_frequencies, direct.angular_frequencies, rtol=1e-9)
        np.testing.assert_allclose(found.mesh.nodes, direct.mesh.nodes, rtol=1e-12, atol=1e-15)
        for name in ("mass", "centre", "inertia"):
            values = [getattr(model.properties, name) for model in (found, direct)]
            np.testing.assert_allclose(
                *values, rtol=1e-9, atol=1e-9 * np.abs(direct.properties.inertia).max()
            )
        # equal frequencies let modes mix, but not what they carry together
        places = other.shape.radius * np.array([[0.0, 0.0], [0.1, 0.2]])  # type: ignore[attr-defined]
        flexibility = []
        for model in (found, direct):
            shapes = (
                model.at(places, "lower")[0].reshape(len(model.shapes), -1)
                / model.angular_frequencies[:, None]
            )
            flexibility.append(shapes.T @ shapes)
        np.testing.assert_allclose(
            *flexibility, rtol=1e-6, atol=1e-8 * np.abs(flexibility[1]).max()
        )
        momenta = [np.abs(model.participation).max(axis=0) for model in (found, direct)]
        np.testing.assert_allclose(*momenta, atol=1e-8 * found.properties.mass**0.5)
        assert (
            np.linalg.matrix_rank(
                found.rigid_coefficients / np.abs(found.rigid_coefficients).max(axis=0)
            )
            == 6
        )
    assert len(entries()) == 1


def test_spheres_that_are_not_similar_do_not(folder: Path) -> None:
    modal_model_of(SPHERE)
    assert not stored(replace(SPHERE, poissons_ratio=0.3))
    assert not stored(replace(SPHERE, reduction=Reduction(modes=11)))
    assert not stored(replace(SPHERE, reduction=Reduction(max_frequency=40e3)))
