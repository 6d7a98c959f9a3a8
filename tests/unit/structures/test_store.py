"""The store of modes: nothing is computed twice, and nothing that is damaged is believed."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import fields, is_dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from vibroimpact.materials import Material
from vibroimpact.structures import recipe as recipes
from vibroimpact.structures import store
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh
from vibroimpact.structures.modal_model import ModalModel
from vibroimpact.structures.recipe import (
    ImportedMesh,
    PlateOfPlates,
    PlateOfSolids,
    Recipe,
    Reduction,
    SphereOfSolids,
    modal_model_of,
)
from vibroimpact.structures.store import (
    clear_store,
    entries,
    key_of,
    load_model,
    save_model,
    store_folder,
    store_size,
)
from vibroimpact.structures.supports.bar import Bar
from vibroimpact.structures.supports.edge import Edge
from vibroimpact.structures.supports.node_set import NodeSet
from vibroimpact.structures.supports.patch import Patch, RectangularPatch
from vibroimpact.structures.supports.point import Point
from vibroimpact.structures.supports.spring import Spring

STEEL = Material(7850.0, 210e9, 0.3)
RECIPE = Recipe(
    PlateOfPlates((0.5, 0.4, 0.01), 0.2),
    7850.0,
    210e9,
    0.3,
    (Edge("x-min", "clamped"),),
    Reduction(modes=3),
)


@pytest.fixture(autouse=True)
def folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path / "store"))
    return tmp_path / "store"


def with_sets(model: ModalModel) -> ModalModel:
    mesh = replace(
        model.mesh, node_sets={"a name: ü/..": np.arange(5)}, element_sets={"all": np.arange(2)}
    )
    return replace(model, mesh=mesh, facts={"nodes": "many", "ü": "µ"})


def same(one: ModalModel, other: ModalModel) -> bool:
    def equal(first: object, second: object) -> bool:
        if is_dataclass(first):
            return all(
                equal(getattr(first, item.name), getattr(second, item.name))
                for item in fields(first)
            )
        if isinstance(first, np.ndarray):
            return (
                isinstance(second, np.ndarray)
                and first.dtype == second.dtype
                and np.array_equal(first, second)
            )
        if isinstance(first, tuple):
            return len(first) == len(second) and all(map(equal, first, second))
        if isinstance(first, dict):
            return set(first) == set(second) and all(
                equal(first[key], second[key]) for key in first
            )
        return first == second

    return equal(one, other)


def test_the_second_time_nothing_is_computed(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    assert not folder.exists()
    first = modal_model_of(RECIPE, tell=said.append)
    monkeypatch.setattr(recipes, "computed_model", lambda *_: pytest.fail("computed again"))
    second = modal_model_of(RECIPE, tell=said.append)
    assert same(first, second)
    assert said == []
    assert [path.name for path in folder.iterdir()] == [key_of(RECIPE) + ".modes"]
    np.testing.assert_array_equal(second.at(np.zeros((1, 2)))[0], first.at(np.zeros((1, 2)))[0])


def test_all_that_is_kept_comes_back() -> None:
    model = with_sets(modal_model_of(RECIPE))
    assert save_model("key", model) == ""
    found, trouble = load_model("key")
    assert trouble == ""
    assert found is not None
    assert same(found, model)
    assert load_model("another") == (None, "")


def damaged_entries(content: bytes) -> list[bytes]:
    random = np.random.default_rng(0)
    found = [
        b"",
        content[:1],
        content[: len(content) // 2],
        content[:-1],
        content[1:],
        b"\0" * len(content),
        content[:-22] + content[-21:],
    ]
    for place in [
        *random.integers(0, len(content), 150),
        *range(200),
        *range(len(content) - 200, len(content)),
    ]:
        changed = bytearray(content)
        changed[place] ^= 1 << int(random.integers(8))
        found.append(bytes(changed))
    return found


def test_a_damaged_entry_is_never_believed(folder: Path) -> None:
    """Cut short, emptied, or with one bit turned: it is said to be damaged, or it is
    right to the last bit.
    """
    model = with_sets(modal_model_of(RECIPE))
    save_model("key", model)
    path = folder / "key.modes"
    for content in damaged_entries(path.read_bytes()):
        path.write_bytes(content)
        found, trouble = load_model("key")
        assert (found is None) == bool(trouble)
        assert found is None or same(found, model)


def test_numbers_read_as_shorter_ones_are_not_believed(folder: Path) -> None:
    """One byte makes 4-byte numbers of 8-byte ones, or fewer rows: a reader that stops
    early does not verify the sums of zip members.
    """
    model = replace(
        modal_model_of(RECIPE), shapes=np.random.default_rng(0).standard_normal((12, 20_000))
    )
    save_model("key", model)
    path = folder / "key.modes"
    content = path.read_bytes()
    places = [place for place in range(len(content) - 3) if content[place : place + 3] == b"<f8"]
    for place in places:
        path.write_bytes(content[: place + 2] + b"4" + content[place + 3 :])
        found, trouble = load_model("key")
        assert (found is None and "damaged" in trouble) or same(found, model)
    place = content.index(b"(12, 20000)")
    path.write_bytes(content[: place + 1] + b" 2" + content[place + 3 :])
    assert load_model("key")[0] is None


def test_a_damaged_entry_is_computed_again_and_kept(folder: Path) -> None:
    model = modal_model_of(RECIPE)
    path = folder / (key_of(RECIPE) + ".modes")
    path.write_bytes(path.read_bytes()[:-100])
    said: list[str] = []
    again = modal_model_of(RECIPE, tell=said.append)
    assert len(said) == 1
    assert "damaged" in said[0]
    np.testing.assert_allclose(again.angular_frequencies, model.angular_frequencies, rtol=1e-12)
    assert same(modal_model_of(RECIPE, tell=said.append), again)
    assert len(said) == 1


def different_recipes() -> list[Recipe]:
    changed = [
        replace(RECIPE, density=7850.0000001),
        replace(RECIPE, youngs_modulus=210.1e9),
        replace(RECIPE, poissons_ratio=0.31),
        replace(RECIPE, supports=()),
        replace(RECIPE, shape=ImportedMesh("abc", lambda: Mesh(np.zeros((0, 3)), ()))),
        replace(RECIPE, shape=ImportedMesh("abd", lambda: Mesh(np.zeros((0, 3)), ()))),
    ]
    shapes = [
        (
            PlateOfPlates((0.5, 0.4, 0.01), 0.2),
            {"size": (0.4, 0.5, 0.01), "element_size": 0.1, "theory": "thin"},
        ),
        (
            PlateOfSolids((0.5, 0.4, 0.01), 0.2),
            {"size": (0.4, 0.5, 0.01), "element_size": 0.1, "layers": 2, "kind": "hex8"},
        ),
        (
            SphereOfSolids(0.02),
            {"radius": 0.03, "elements_across": 10, "kind": "tet10", "grading": 2.0},
        ),
    ]
    held = [
        (Edge("x-min", "clamped"), {"edge": "x-max", "condition": "simply-supported"}),
        (Patch(0.1, 0.2, 0.01), {"x": 0.2, "y": 0.1, "radius": 0.02}),
        (
            RectangularPatch(0.1, 0.2, 0.01, 0.02),
            {"x": 0.2, "y": 0.1, "length": 0.02, "width": 0.01},
        ),
        (Point(0.1, 0.2), {"x": 0.2, "y": 0.1}),
        (
            Spring(0.1, 0.2, 1e3),
            {"x": 0.2, "y": 0.1, "stiffness": 1e4, "horizontal_stiffness": 1.0, "radius": 0.01},
        ),
        (NodeSet("a"), {"name": "b", "directions": "z"}),
        (
            Bar(0.1, 0.2, 0.01, 0.3, STEEL),
            {
                "x": 0.2,
                "y": 0.1,
                "radius": 0.02,
                "length": 0.4,
                "material": replace(STEEL, density=1.0),
            },
        ),
    ]
    place = (((0.0, 0.0), "upper"),)
    kept = [
        (
            Reduction(modes=3),
            {"modes": 4, "method": "craig-bampton", "interface": place, "attachment": place},
        ),
        (Reduction(max_frequency=3e3), {"max_frequency": 4e3}),
        (Reduction(modes=3, attachment=place), {"attachment": (((0.0, 0.0), "lower"),)}),
        (Reduction(modes=3, attachment=((None, "upper"),)), {"attachment": (("a", "upper"),)}),
    ]
    for key, pairs in (("shape", shapes), ("supports", held), ("reduction", kept)):
        for value, others in pairs:
            every = [value, *(replace(value, **{name: other}) for name, other in others.items())]
            changed += [
                replace(RECIPE, **{key: (one,) if key == "supports" else one}) for one in every
            ]
    return changed


def test_keys_depend_on_every_field() -> None:
    distinct: list[Recipe] = []
    for recipe in [RECIPE, *different_recipes()]:
        if recipe not in distinct:
            distinct.append(recipe)
    assert len(distinct) > 50
    keys = [key_of(recipe) for recipe in distinct]
    assert len(set(keys)) == len(keys)
    assert key_of(replace(RECIPE)) == keys[0]


def test_keys_depend_on_the_version(monkeypatch: pytest.MonkeyPatch) -> None:
    before = key_of(RECIPE)
    monkeypatch.setattr(store, "__version__", "99.0")
    assert key_of(RECIPE) != before


def test_a_brought_mesh_is_known_by_its_digest() -> None:
    one, other = (ImportedMesh("abc", lambda: Mesh(np.zeros((0, 3)), ())) for _ in range(2))
    assert key_of(one) == key_of(other)


def test_keys_are_the_same_in_another_process() -> None:
    code = (
        "from test_store import *; print(' '.join(key_of(recipe) for recipe in "
        "different_recipes()))"
    )
    environment = {**os.environ, "PYTHONHASHSEED": "7", "PYTHONPATH": str(Path(__file__).parent)}
    printed = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment
    ).stdout
    assert printed.split() == [key_of(recipe) for recipe in different_recipes()]


def test_processes_that_save_at_once(folder: Path) -> None:
    """Two save and one loads the same entry again and again; nobody ever sees half of one."""
    model = modal_model_of(RECIPE)
    save_model("key", model)
    code = """
import sys
from vibroimpact.structures.store import load_model, save_model
model, _ = load_model("key")
for _ in range(30):
    trouble = save_model("key", model) if sys.argv[1] == "save" else load_model("key")[1]
    assert not trouble, trouble
"""
    running = [
        subprocess.Popen([sys.executable, "-c", code, what]) for what in ("save", "save", "load")
    ]
    assert [process.wait() for process in running] == [0, 0, 0]
    found, trouble = load_model("key")
    assert trouble == ""
    assert found is not None
    assert same(found, model)
    assert len(list(folder.iterdir())) == 2  # no temporary files are left


def test_a_folder_that_can_not_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path / "file" / "store"))
    said: list[str] = []
    model = modal_model_of(RECIPE, tell=said.append)
    assert len(model.frequencies) == 3
    assert any(
        "the modes can't be kept in" in text and "computed again next time" in text for text in said
    )


def test_a_full_disk_leaves_nothing_behind(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    model = modal_model_of(RECIPE)
    monkeypatch.setattr(os, "replace", full)
    assert "No space left on device" in save_model("key", model)
    assert [path.name for path in folder.iterdir()] == [key_of(RECIPE) + ".modes"]


def test_size_and_clearing(folder: Path) -> None:
    assert (store_size(), clear_store(), entries()) == (0, 0, [])
    model = modal_model_of(RECIPE)
    save_model("other", model)
    (folder / "notes.txt").write_text("mine")
    assert store_size() == sum(path.stat().st_size for path in folder.glob("*.modes"))
    assert clear_store() == 2
    assert store_size() == 0
    assert [path.name for path in folder.iterdir()] == ["notes.txt"]


def test_what_was_not_used_for_longest_goes_first(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = modal_model_of(RECIPE)
    clear_store()
    for age, key in enumerate(("old", "used", "new")):
        save_model(key, model)
        os.utime(folder / f"{key}.modes", (1e9 + age, 1e9 + age))
    os.utime(folder / "used.modes", (5e8, 5e8))
    load_model("used")  # makes it the newest
    size = (folder / "used.modes").stat().st_size
    monkeypatch.setattr(store, "_LARGEST", 2.5 * size)
    save_model("last", model)
    assert {path.stem for path in entries()} == {"used", "last"}


def test_a_store_of_thousands_is_not_looked_through_for_every_entry(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A study saves one small entry a drop; only what adds up to a hundredth of the room
    is worth a look.
    """
    looked: list[int] = []
    monkeypatch.setattr(store, "entries", lambda: looked.append(1) or [])
    monkeypatch.setattr(store, "_written", [0.0])
    size = sum(map(len, store._packed({"value": np.zeros(1)})))
    monkeypatch.setattr(store, "_LARGEST", 1000 * size)
    for number in range(25):
        store.save_entry(f"{number}", "compliance", {"value": np.zeros(1)})
    assert len(looked) == 2


def test_where_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("VIBROIMPACT_STORE")
    assert store_folder().parts[-2:] == ("vibroimpact", "modes")


def test_a_mesh_of_two_kinds_comes_back() -> None:
    """Blocks keep their order, whatever their number."""
    model = modal_model_of(RECIPE)
    block = model.mesh.blocks[0]
    many = tuple(ElementBlock(block.kind, block.connectivity + 0 * index) for index in range(12))
    many = (*many[:11], ElementBlock("hex8", np.arange(8)[None]))
    changed = replace(model, mesh=replace(model.mesh, blocks=many))
    save_model("key", changed)
    found, _ = load_model("key")
    assert found is not None
    assert same(found, changed)
