"""A study as it is run: its results are those of single drops, however it is computed;
and what its folder holds.
"""

from __future__ import annotations

import csv
import json
import socket
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import vibroimpact as vi
from studies import OVER, RANDOM, study_file, study_table
from support import plain_case
from vibroimpact.studies.computation import compute_points as compute_points_module
from vibroimpact.studies.computation.compute_points import compute_points
from vibroimpact.studies.computation.compute_study import chunk_size, compute_study
from vibroimpact.studies.computation.dask_workers import dask_workers
from vibroimpact.studies.computation.ledger import Span
from vibroimpact.studies.computation.run_chunks import run_chunks
from vibroimpact.studies.computation.workers import processes, this_process
from vibroimpact.studies.planning.swept_keys import case_at

PEAKS = ("first_restitution_achieved", "largest_force_N", "total_energy_lost_J")


def run(folder: Path, sweep: object = None, **changes: object) -> vi.studies.Study:
    return vi.studies.load_study(
        compute_study(vi.studies.sweep_of(study_table(sweep, **changes)), folder / "study")
    )


def single(study: vi.studies.Study, *place: int) -> dict[str, Any]:
    """The impacts of a drop of a study, run by itself."""
    at = place if "sample" not in study.dimensions else place * len(study.coordinates)
    values = {
        key: column[index]
        for (key, column), index in zip(study.coordinates.items(), at, strict=True)
    }
    table = {key: value for key, value in study.table.items() if key != "sweep"}
    return vi.simulate(
        case_at(table, {key: _plain(value) for key, value in values.items()})
    ).impacts


def _plain(value: Any) -> Any:
    if isinstance(value, str):
        return json.loads(value) if value.startswith("[") else value
    return value


@pytest.mark.parametrize(
    ("sweep", "changes", "places"),
    [
        ({"over": OVER}, {}, [(0, 0), (3, 2), (1, 1)]),
        (RANDOM, {}, [(0,), (77,), (199,)]),
        (
            {
                "design": "zip",
                "over": {"sphere.radius": [0.01, 0.02], "drop.height": ["1 m", "2 m"]},
            },
            {},
            [(0,), (1,)],
        ),
        (
            {"over": {"contact.law": ["flores", "hunt-crossley"], "drop.height": [1.0, 2.0]}},
            {},
            [(0, 0), (1, 1)],
        ),
        (
            {"over": {"sphere.material": ["steel", "rock-paper"], "drop.height": [1.0, 2.0]}},
            {},
            [(0, 1), (1, 0)],
        ),
        (
            {
                "over": {
                    "sphere.material.density": [1000.0, 2000.0],
                    "plate.material.poissons_ratio": [0.1, 0.3],
                }
            },
            {},
            [(0, 1), (1, 0)],
        ),
        ({"over": {"run.duration": [0.7, 1.1]}}, {"run": {}}, [(0,), (1,)]),
        (
            {"over": {"drop.gravity": [9.8, 1.6], "run.tolerance": [1e-9, 1e-7]}},
            {},
            [(0, 0), (1, 1)],
        ),
        ({"over": {"drop.speed": [1.0, 3.0]}}, {"drop": {}}, [(0,), (1,)]),
        (
            {
                "over": {
                    "sphere.material.yield_strength": ["20 MPa", "2 GPa"],
                    "drop.height": [1.0, 2.0],
                }
            },
            {
                "contact": {"law": "thornton"},
                "plate__material": {
                    "density": 7850,
                    "youngs_modulus": 2e11,
                    "poissons_ratio": 0.3,
                    "yield_strength": 5e8,
                },
            },
            [(0, 1), (1, 0)],
        ),
        (
            {"over": {"contact.damping_max": [[50.0, 20.0], [30.0]]}},
            {"contact": {"law": "adams-impact", "full_damping_penetration": 1e-4}},
            [(0,), (1,)],
        ),
    ],
)
def test_the_drops_of_a_study_are_those_of_single_runs(
    tmp_path: Path, sweep: dict, changes: dict, places: list[tuple[int, ...]]
) -> None:
    study = run(tmp_path, sweep, **changes)
    assert not study.failures
    for place in places:
        alone = single(study, *place)
        number = len(alone["impact"])
        assert study.values("number_of_impacts", *place) == number
        for name in (
            "time_s",
            "duration_s",
            "approach_speed_m_s",
            "restitution_achieved",
            "max_force_N",
            "energy_lost_J",
        ):
            values = study.values(name, *place)
            np.testing.assert_allclose(values[:number], alone[name], rtol=2e-8, atol=1e-12)
            assert np.isnan(values[number:]).all()
        np.testing.assert_allclose(
            study.values("largest_force_N", *place), alone["max_force_N"].max(), rtol=2e-8
        )
        np.testing.assert_allclose(
            study.values("first_restitution_achieved", *place),
            alone["restitution_achieved"][0],
            rtol=2e-8,
        )


def test_batches_do_not_show(tmp_path: Path) -> None:
    over = {key: value for key, value in RANDOM["over"].items() if key != "drop.height"}
    table = study_table(
        {**RANDOM, "over": over, "samples": 4003, "keep": ["peaks"]},
        run__impacts=1,
        drop={"speed": 3.0, "gravity": 0.0},
    )
    study = vi.studies.load_study(compute_study(vi.studies.sweep_of(table), tmp_path / "study"))
    assert "max_force_N" not in study.shapes
    asked = study.values("first_restitution_asked")
    np.testing.assert_array_equal(asked, study.coordinates["contact.restitution"])
    law = vi.laws.find_contact_law("lankarani-nikravesh")(stiffness=1.0, restitution=asked)
    without_gravity = vi.laws.achieved_restitution(law, np.ones(len(asked)), np.ones(len(asked)))
    np.testing.assert_allclose(
        study.values("first_restitution_achieved"), without_gravity, rtol=2e-9
    )


def test_the_dataset_opens_in_xarray_with_units_on_everything(tmp_path: Path) -> None:
    study = run(tmp_path)
    with xr.open_dataset(study.path, engine="h5netcdf") as data:
        assert data["max_force_N"].dims == ("sphere.radius", "contact.restitution", "impact")
        assert data["largest_force_N"].dims == ("sphere.radius", "contact.restitution")
        assert data["max_force_N"].shape == (4, 3, 3)
        assert {str(name) for name in data.variables if "units" not in data[name].attrs} == set()
        assert data["sphere.radius"].attrs["units"] == "m"
        chosen = data["first_restitution_achieved"].sel(
            {"contact.restitution": 0.6, "sphere.radius": 0.05}, method="nearest"
        )
        assert float(chosen) == pytest.approx(
            float(single(study, 3, 1)["restitution_achieved"][0]), rel=1e-8
        )


def test_the_table_has_a_row_a_drop(tmp_path: Path) -> None:
    study = run(tmp_path)
    with (study.path.parent / "drops.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == study.size == 12
    assert float(rows[5]["sphere.radius [m]"]) == study.coordinates["sphere.radius"][1]
    assert float(rows[5]["contact.restitution"]) == 0.8
    for name in PEAKS:
        np.testing.assert_array_equal(
            [float(row[name]) for row in rows], study.values(name).ravel()
        )


def test_a_drop_that_fails_is_kept_with_its_reason_and_the_rest_go_on(tmp_path: Path) -> None:
    study = run(
        tmp_path, {"over": {"sphere.radius": ["5 mm", "50 mm"], "drop.height": ["1 m", "20 mm"]}}
    )
    assert study.failures == {3: next(iter(study.failures.values()))}
    assert "0.02 m does not lift the sphere off the surface" in study.failures[3]
    assert np.isfinite(study.values("largest_force_N")).tolist() == [[True, True], [True, False]]
    assert study.values("outcome")[1, 1] == list(vi.Outcome).index(vi.Outcome.FAILED)
    alone = single(study, 0, 1)
    np.testing.assert_allclose(study.values("max_force_N", 0, 1), alone["max_force_N"], rtol=1e-9)


def test_nothing_of_a_failed_drop_is_a_result(monkeypatch: pytest.MonkeyPatch) -> None:
    def some_fail(problem: vi.Problem) -> vi.Response:
        table = vi.tabulate(problem)
        return replace(table, outcomes=(table.outcomes[0], vi.Outcome.FAILED, table.outcomes[2]))

    monkeypatch.setattr(compute_points_module, "tabulate", some_fail)
    found = compute_points(
        plain_case(), ("impacts",), 0, {"drop.height": np.array([1.0, 2.0, 3.0])}
    )
    assert found.failures.keys() == {1}
    assert found.arrays["outcome"][1] == list(vi.Outcome).index(vi.Outcome.FAILED)
    assert found.arrays["doubts"][1] == 0
    for name, values in found.arrays.items():
        assert name in ("outcome", "doubts") or (
            np.isnan(values[1]).all() and not np.isnan(values[::2]).all()
        )


def test_drops_that_can_not_begin_do_not_hold_up_the_others(tmp_path: Path) -> None:
    values = np.random.default_rng(0).permutation(np.linspace(0.005, 0.06, 2000))
    points = {"sphere.radius": values, "drop.height": values[::-1]}
    found = compute_points(plain_case(), ("impacts",), 0, points)
    assert (
        list(found.failures)
        == np.flatnonzero(points["drop.height"] <= points["sphere.radius"]).tolist()
    )
    assert len(found.failures) > 500
    np.testing.assert_array_equal(
        np.isnan(found.arrays["largest_force_N"]), points["drop.height"] <= points["sphere.radius"]
    )


def test_drops_with_few_impacts_have_no_numbers_beyond_them(tmp_path: Path) -> None:
    study = run(
        tmp_path,
        {"over": {"drop.height": ["30 mm", "0.5 m", "4 m"]}},
        run={"impacts": "all"},
        contact__restitution=0.3,
    )
    numbers = study.values("number_of_impacts")
    assert len(set(numbers.tolist())) > 1
    np.testing.assert_array_equal(np.isfinite(study.values("max_force_N")).sum(axis=1), numbers)


def test_whole_numbers_are_numbers(tmp_path: Path) -> None:
    study = run(tmp_path, {"over": {"run.impacts": [3, 1, 2]}})
    assert study.coordinates["run.impacts"].tolist() == [3, 1, 2]
    with xr.open_dataset(study.path, engine="h5netcdf") as data:
        assert int(data["number_of_impacts"].sel({"run.impacts": 2})) == 2


def test_a_chunk_is_small_where_any_level_deforms() -> None:
    elastic = {
        "size": [0.5, 0.4, 0.008],
        "supports": "clamped",
        "modes": 4,
        "material": "steel-paper",
        "model": "elastic",
    }
    over = {"plate.supports": ["clamped", "simply-supported"], "drop.height": [1.0, 2.0]}
    assert chunk_size(vi.studies.sweep_of(study_table({"over": over}, plate=elastic)), 5e8) == 32
    assert chunk_size(vi.studies.sweep_of(study_table(RANDOM)), 5e8) == 8000
    drawn = vi.studies.sweep_of(study_table(RANDOM))
    # what a drop takes while it is computed, and four times what is kept of it
    each = 4000 + 4 * drawn.bytes / drawn.size
    assert chunk_size(drawn, 200 * each + 1) == 200


def test_whole_sections_compare_laws_with_parameters_of_their_own(tmp_path: Path) -> None:
    laws = [{"law": "hertz"}, {"law": "flores", "restitution": 0.6}]
    sweep = vi.studies.sweep_of(study_table({"over": {"contact": laws, "drop.height": [1.0, 2.0]}}))
    study = vi.studies.load_study(compute_study(sweep, tmp_path / "study"))
    for number, law in enumerate(laws):
        alone = vi.simulate(vi.case_of(plain_case(contact=law, drop={"height": 2.0})))
        np.testing.assert_allclose(
            study.values("max_force_N", number, 1), alone.impacts["max_force_N"], rtol=1e-8
        )
        of_number = vi.simulate(sweep.case_of(2 * number + 1))
        np.testing.assert_array_equal(
            of_number.impacts["max_force_N"], alone.impacts["max_force_N"]
        )
    rows = (tmp_path / "study" / "drops.csv").read_text(encoding="utf-8")
    assert study.coordinates["contact"][1] == json.dumps(laws[1])
    assert json.dumps(laws[1]).replace('"', '""') in rows
    with pytest.raises(vi.InputError, match="there is no drop 4; the study has 4"):
        sweep.case_of(4)


def test_keys_without_quotes_are_the_same_keys(tmp_path: Path) -> None:
    nested = {
        "over": {
            "sphere": {"radius": ["5 mm"], "material": {"density": [1000.0]}},
            "drop": {"height": {"from": 1, "to": 2, "number": 2}},
        }
    }
    assert list(vi.studies.sweep_of(study_table(nested)).axes) == [
        "sphere.radius",
        "sphere.material.density",
        "drop.height",
    ]


def test_a_distribution_can_come_from_a_file(tmp_path: Path) -> None:
    (tmp_path / "sieve.csv").write_text(
        "# sieved\nRadius [mm];count\n5,5;1\n6,5;1\n7,5;2\n", encoding="utf-8"
    )
    over = {"sphere.radius": {"file": "sieve.csv", "column": "radius"}}
    listed = vi.studies.load_sweep(study_file(tmp_path, {"over": over}))
    np.testing.assert_allclose(listed.plan.columns["sphere.radius"], [0.0055, 0.0065, 0.0075])
    drawn = vi.studies.load_sweep(
        study_file(tmp_path, {"design": "sobol", "samples": 1024, "over": over})
    )
    values, counts = np.unique(drawn.plan.columns["sphere.radius"], return_counts=True)
    np.testing.assert_allclose(values, [0.0055, 0.0065, 0.0075])
    assert np.ptp(counts) <= 2
    over["sphere.radius"] |= {"column": "Radius [mm]", "weights": "count"}
    weighted = vi.studies.load_sweep(
        study_file(tmp_path, {"design": "sobol", "samples": 1024, "over": over})
    )
    assert np.unique(weighted.plan.columns["sphere.radius"], return_counts=True)[1].tolist() == [
        256,
        256,
        512,
    ]


def test_a_run_takes_no_notice_of_the_section(tmp_path: Path) -> None:
    case = vi.load_case(study_file(tmp_path))
    np.testing.assert_array_equal(
        vi.simulate(case).impacts["max_force_N"],
        vi.simulate(vi.case_of(study_table())).impacts["max_force_N"],
    )
    assert vi.case_of(case.to_problem().source).sweep == case.sweep


# where it is computed ----------------------------------------------------------------------------


def _chunks(start: Any) -> list[bytes]:
    """What comes of four chunks."""
    sweep = vi.studies.sweep_of(study_table(RANDOM))
    found: dict[int, bytes] = {}

    def keep(chunk: Span, result: Any) -> None:
        assert not result.failures
        found[chunk.number] = b"".join(values.tobytes() for values in result.arrays.values())

    chunks = [Span(number, 50 * number, 50) for number in range(4)]
    run_chunks(
        partial(compute_points, sweep.table, ("impacts",)),
        lambda chunk: sweep.plan.points(chunk.first, chunk.size),
        chunks,
        start,
        keep,
    )
    return [found[number] for number in range(4)]


def _nothing() -> None:
    pass


@pytest.mark.slow
def test_processes_compute_the_same_bits(tmp_path: Path) -> None:
    assert _chunks(partial(processes, 2, _nothing, tmp_path)) == _chunks(this_process)


@pytest.mark.slow
def test_dask_computes_the_same_bits() -> None:
    with socket.socket() as other:
        with suppress(OSError):  # then it is taken already
            other.bind(("", 8787))  # where Dask's dashboards are
            other.listen()
        assert _chunks(partial(dask_workers, "local", 2, _nothing)) == _chunks(this_process)
