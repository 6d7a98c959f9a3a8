"""Entries of the store on their way to a process that does not see its disk."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.cases.elastic.coupling import carried_modes
from vibroimpact.errors import InputError
from vibroimpact.structures.store import carry, entries, receive

TABLE = {
    "sphere": {
        "radius": "25 mm",
        "material": "rock-paper",
        "model": "elastic",
        "modes": 5,
        "mesh": {"elements_across": 4},
    },
    "plate": {
        "size": ["500 mm", "400 mm", "20 mm"],
        "material": "steel-paper",
        "model": "elastic",
        "modes": 5,
        "mesh": {"element_size": "100 mm"},
        "supports": {"type": "edge", "edge": "x-min", "condition": "clamped"},
    },
    "drop": {"speed": 2.0, "position": [0.1, 0.05]},
    "contact": {"law": "hertz"},
    "run": {"impacts": 1},
}


@pytest.fixture(autouse=True)
def folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path / "here"))
    return tmp_path / "here"


@pytest.fixture(scope="module")
def computed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, bytes]]:
    """A store with what a case needs, and what is carried of it."""
    place = tmp_path_factory.mktemp("computed")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("VIBROIMPACT_STORE", str(place))
        return place, carried_modes(vi.case_of(TABLE))


@pytest.fixture
def elsewhere(
    computed: tuple[Path, dict[str, bytes]],
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> dict[str, bytes]:
    """What a case needs, and a store that is empty."""
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path / "there"))
    return dict(computed[1])


def test_who_receives_computes_nothing(
    computed: tuple[Path, dict[str, bytes]],
    elsewhere: dict[str, bytes],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert sorted(name.partition(".")[2] for name in elsewhere) == [
        "compliance",
        "compliance",
        "modes",
        "modes",
    ]
    assert receive(elsewhere) == ""
    for name in ("recipe.computed_model", "static_compliance.computed_compliance"):
        monkeypatch.setattr(
            f"vibroimpact.structures.{name}", lambda *_: pytest.fail("computed again")
        )
    monkeypatch.setattr(
        "vibroimpact.cases.elastic.coupling.mesh_compliance",
        lambda *_: pytest.fail("computed again"),
    )
    there = vi.case_of(TABLE).to_problem()
    monkeypatch.setenv("VIBROIMPACT_STORE", str(computed[0]))
    here = vi.case_of(TABLE).to_problem()
    for name in ("sphere", "plate"):
        np.testing.assert_array_equal(
            getattr(there, name).modes.contact, getattr(here, name).modes.contact
        )
    assert there.quasi_static == here.quasi_static


def test_what_is_not_there_is_left_out(elsewhere: dict[str, bytes]) -> None:
    assert carry(name.partition(".")[0] for name in elsewhere) == {}
    receive(elsewhere)
    assert carry(name.partition(".")[0] for name in elsewhere) == elsewhere


def test_what_is_here_stays(elsewhere: dict[str, bytes]) -> None:
    receive(elsewhere)
    before = {path: path.stat().st_ino for path in entries()}
    assert receive(elsewhere) == ""
    assert {path: path.stat().st_ino for path in entries()} == before


def test_what_was_damaged_on_its_way_is_refused(elsewhere: dict[str, bytes]) -> None:
    for name, data in elsewhere.items():
        for wrong in (b"", data[:-1], data[:20] + bytes([data[20] ^ 1]) + data[21:]):
            with pytest.raises(InputError, match="damaged on its way"):
                receive({name: wrong})
    assert entries() == []


@pytest.mark.parametrize(
    "name", ["../there.modes", "there", "there.txt", ".modes", "a/b.modes", "a.b.modes"]
)
def test_only_entries_are_received(elsewhere: dict[str, bytes], name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not the name of an entry"):
        receive({name: next(iter(elsewhere.values()))})
    assert not (tmp_path / "there").exists()


def test_a_store_that_can_not_be_written(elsewhere: dict[str, bytes], tmp_path: Path) -> None:
    (tmp_path / "there").write_text("in the way")
    assert "can't be kept in" in receive(elsewhere)


def test_rigid_bodies_need_nothing() -> None:
    assert carried_modes(vi.load_case("paper:type1-theory")) == {}
