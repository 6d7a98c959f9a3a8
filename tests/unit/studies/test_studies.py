"""The points of a study: axes, designs, plans; and the ledger and the files that keep its
chunks.
"""

from __future__ import annotations

import sqlite3
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

import vibroimpact as vi
from vibroimpact.studies.computation.chunk_file import (
    ChunkResult,
    checksum,
    read_chunk,
    write_chunk,
)
from vibroimpact.studies.computation.ledger import LEDGER, Span, is_held, make_ledger, open_ledger
from vibroimpact.studies.planning.axes import Axis, Listed, Normal, Spaced
from vibroimpact.studies.planning.design import Asked, designs, find_design
from vibroimpact.studies.planning.plan import Plan
from vibroimpact.studies.planning.population import Population

PARTS = (np.arange(400) + 0.5) / 400
AXES: dict[str, Axis] = {
    "a": Spaced(1.0, 3.0, 5),
    "b": Normal(10.0, 2.0, 4),
    "c": Listed((0.1, 0.2, 0.4)),
}
POPULATION = Population(
    {"x": 1.0, "y": 2.0},
    {"x": {"sphere.d": Spaced(0.0, 1.0, 2)}, "y": {"sphere.d": Spaced(5.0, 6.0, 2)}},
    2,
    3,
)


@pytest.mark.parametrize(
    ("axis", "known"),
    [
        (Spaced(1.0, 3.0, 5), stats.uniform(1.0, 2.0)),
        (Spaced(1.0, 100.0, 5, "log"), stats.loguniform(1.0, 100.0)),
        (Normal(2.0, 0.3, 5), stats.norm(2.0, 0.3)),
        (Normal(2.0, 0.3, 5, at_least=1.9, at_most=2.6), stats.truncnorm(-1 / 3, 2.0, 2.0, 0.3)),
        (Normal(2.0, 0.3, 5, at_least=1.0), stats.truncnorm(-1.0 / 0.3, np.inf, 2.0, 0.3)),
    ],
)
def test_quantiles_are_those_of_scipy(axis: Axis, known: stats.rv_continuous) -> None:
    np.testing.assert_allclose(axis.quantiles(PARTS), known.ppf(PARTS), rtol=1e-12)


def test_a_lognormal_has_the_mean_and_the_deviation_that_were_asked_for() -> None:
    values = Normal(2.0, 0.5, 5, lognormal=True).quantiles((np.arange(1_000_000) + 0.5) / 1_000_000)
    assert values.mean() == pytest.approx(2.0, rel=1e-5)
    assert values.std() == pytest.approx(0.5, rel=1e-4)


def test_a_truncated_lognormal_stays_inside() -> None:
    values = Normal(2.0, 0.5, 5, 1.5, 2.5, lognormal=True).quantiles(
        np.array([0.0, 0.5, 1.0 - 2**-53])
    )
    assert values[0] >= 1.5
    assert values[-1] == pytest.approx(2.5)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Normal(-1.0, 1.0, 3, lognormal=True), "mean: -1 is not allowed"),
        (
            lambda: Normal(1.0, 0.1, 3, at_least=5.0),
            "at_least: 0 % of the distribution is at least 5",
        ),
        (
            lambda: Normal(1.0, 0.1, 3, at_most=-5.0),
            "at_most: 0 % of the distribution is at most -5",
        ),
    ],
)
def test_impossible_distributions_are_refused(make: object, words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        make()  # type: ignore[operator]


@pytest.mark.parametrize("name", designs())
def test_a_plan_has_the_size_that_its_design_said_and_is_the_same_again(name: str) -> None:
    design = find_design(name)
    axes = {"a": Spaced(1.0, 3.0, 4), "b": Spaced(1.0, 2.0, 4)} if name == "zip" else AXES
    asked = Asked(axes, 16, 7, POPULATION if name == "population" else None)
    plan = design.plan(asked)
    assert plan.size == design.size(asked)
    assert plan.digest() == design.plan(asked).digest()
    assert (plan.digest() == design.plan(replace(asked, seed=8)).digest()) is not design.is_drawn
    whole = plan.points(0, plan.size)
    for key, values in plan.points(3, 5).items():
        np.testing.assert_array_equal(values, whole[key][3:8])


def test_whole_numbers_stay_what_they_are() -> None:
    assert Listed((3, 1, 2)).levels().dtype == np.int64
    assert Listed((3, 1.5)).levels().dtype == object
    assert Listed((True, False)).levels().dtype == object


def test_a_grid_has_every_combination_once() -> None:
    plan = find_design("grid").plan(Asked(AXES))
    points = plan.points(0, plan.size)
    assert (
        len(set(zip(*(values.tolist() for values in points.values()), strict=True)))
        == plan.size
        == 5 * 4 * 3
    )


def test_a_latin_hypercube_has_one_point_in_every_part_of_every_axis() -> None:
    plan = find_design("latin-hypercube").plan(
        Asked({"a": Spaced(0.0, 1.0, 2), "b": Spaced(0.0, 1.0, 2)}, 50, 1)
    )
    for values in plan.columns.values():
        assert sorted((values * 50).astype(int)) == list(range(50))
    assert abs(np.corrcoef(*plan.columns.values())[0, 1]) < 0.3


def test_saltelli_takes_over_one_axis_of_the_second_block_at_a_time() -> None:
    plan = find_design("saltelli").plan(
        Asked({"a": Spaced(0.0, 1.0, 2), "b": Spaced(0.0, 1.0, 2)}, 8, 1)
    )
    a, b = (
        np.stack([plan.columns[key][block * 8 : block * 8 + 8] for block in range(4)])
        for key in "ab"
    )
    np.testing.assert_array_equal(a[2], a[1])
    np.testing.assert_array_equal(b[2], b[0])
    np.testing.assert_array_equal(a[3], a[0])
    np.testing.assert_array_equal(b[3], b[1])


@pytest.mark.parametrize(
    ("name", "samples", "words"), [("sobol", 100, "take 64 or 128"), ("saltelli", 3, "take 2 or 4")]
)
def test_sequences_want_powers_of_two(name: str, samples: int, words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        find_design(name).size(Asked(AXES, samples))


def test_an_unknown_design_is_named_with_the_closest() -> None:
    with pytest.raises(
        vi.InputError,
        match='there is no design "latin"; there are grid, latin-hypercube, population, saltelli, '
        "sobol, zip",
    ):
        find_design("latin")


def test_the_fingerprint_sees_every_value() -> None:
    columns = {"a": np.array([1.0, 2.0]), "b": np.array(["x", "y"], dtype=object)}
    digests = {Plan("zip", columns, False).digest(), Plan("grid", columns, True).digest()}
    digests.add(
        Plan("zip", {**columns, "a": np.array([1.0, np.nextafter(2.0, 3.0)])}, False).digest()
    )
    digests.add(Plan("zip", {**columns, "b": np.array(["x", "z"], dtype=object)}, False).digest())
    assert len(digests) == 4


# the ledger and the files ------------------------------------------------------------------------


def test_a_ledger_keeps_what_was_noted(tmp_path: Path) -> None:
    make_ledger(tmp_path, {"digest": "x"}, 25, 10)
    with open_ledger(tmp_path) as ledger:
        assert [tuple(chunk) for chunk in ledger.chunks("waiting")] == [
            (0, 0, 10),
            (1, 10, 10),
            (2, 20, 5),
        ]
        ledger.done(ledger.chunks("waiting")[1], "abc", 3)
    with open_ledger(tmp_path) as ledger:
        assert ledger.facts == {"digest": "x", "size": "25"}
        assert ledger.checksums() == {1: "abc"}
        ledger.undone(1)
        assert len(ledger.chunks("waiting")) == 3
        assert ledger.checksums() == {}


def test_a_ledger_that_is_open_is_held(tmp_path: Path) -> None:
    make_ledger(tmp_path, {}, 1, 1)
    assert not is_held(tmp_path)
    with open_ledger(tmp_path):
        assert is_held(tmp_path)
        with pytest.raises(vi.InputError, match="another sweep is at work"), open_ledger(tmp_path):
            pass
    assert not is_held(tmp_path)


def test_a_folder_without_a_ledger_is_no_study(tmp_path: Path) -> None:
    with (
        pytest.raises(vi.InputError, match="this is not the folder of a study"),
        open_ledger(tmp_path),
    ):
        pass


@pytest.mark.parametrize("damage", ["text", "torn", "empty", "other"])
def test_a_damaged_ledger_is_refused_with_what_to_do(tmp_path: Path, damage: str) -> None:
    make_ledger(tmp_path, {"digest": "x"}, 10_000, 2)
    path = tmp_path / LEDGER
    data = path.read_bytes()
    if damage == "other":
        path.unlink()
        connection = sqlite3.connect(path)
        connection.execute("CREATE TABLE something (x)")
        connection.commit()
        connection.close()
    else:
        path.write_bytes(
            {"text": b"not a database at all" * 100, "torn": data[: len(data) // 2], "empty": b""}[
                damage
            ]
        )
    with (
        pytest.raises(vi.InputError, match="delete this file and go on with --resume"),
        open_ledger(tmp_path),
    ):
        pass


def test_a_chunk_comes_back_as_it_was_written(tmp_path: Path) -> None:
    arrays = {
        "force": np.array([[1.0, np.nan]]),
        "outcome": np.array([3], dtype=np.int8),
        "nothing": np.zeros((1, 0)),
    }
    chunk = Span(3, 30, 1)
    found = write_chunk(tmp_path, chunk, ChunkResult(arrays, {0: "it broke"}), "study")
    assert (
        found
        == checksum(tmp_path, 3)
        == write_chunk(tmp_path, chunk, ChunkResult(arrays, {0: "it broke"}), "study")
    )
    back = read_chunk(tmp_path, chunk, "study")
    assert back.failures == {0: "it broke"}
    for name, values in arrays.items():
        assert back.arrays[name].dtype == values.dtype
        np.testing.assert_array_equal(back.arrays[name], values)
    for other, study in ((chunk, "another"), (Span(3, 31, 1), "study"), (Span(3, 30, 2), "study")):
        with pytest.raises(ValueError, match="of another study, or has other drops"):
            read_chunk(tmp_path, other, study)
    assert checksum(tmp_path, 4) is None


def test_a_chunk_that_was_damaged_does_not_come_back(tmp_path: Path) -> None:
    write_chunk(tmp_path, Span(0, 0, 5000), ChunkResult({"force": np.arange(5000.0)}, {}), "study")
    file = tmp_path / "chunks" / "000000.h5"
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(bytes(data))
    with pytest.raises((OSError, KeyError, ValueError)):
        read_chunk(tmp_path, Span(0, 0, 5000), "study")
