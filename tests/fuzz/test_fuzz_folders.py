"""Folders of results whose files were changed, and whose checksums are right: every command that
reads them back refuses, or does its work.

What a disk damages is refused by its checksum (`test_fuzz_results`); this is what another program
or a person could have written.
"""

from __future__ import annotations

import random
import shutil
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import vibroimpact as vi
from folder_mutations import damage_folder
from hammer_test import TABLE
from hostile_runs import failures, number, seed
from support import plain_case
from vibroimpact.bayes_error.falls import falls_of_study
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.exporting.load_drop import load_drop
from vibroimpact.paper.report.folder import reproduce_paper
from vibroimpact.studies.computation.ledger import LEDGER


class Change(NamedTuple):
    """A file of a folder, and the seed of its change."""

    file: str
    seed: int


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out the other process that looks at files first: of these HDF5 neither hangs
    nor crashes.
    """
    monkeypatch.setattr("vibroimpact.files.damaged_part.damaged_part", lambda path: "")
    monkeypatch.setattr("vibroimpact.files.damaged_part.endures", lambda path: True, raising=False)


def changes(files: list[str], count: int, first: int) -> list[Change]:
    draw = random.Random(seed(first))
    return [
        Change(files[place % len(files)], draw.getrandbits(32)) for place in range(number(count))
    ]


def use_changed(use: Callable[[Path], Any], folder: Path, change: Change) -> None:
    copy = folder.with_name("copy")
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(folder, copy)
    damage_folder(copy, change.file, random.Random(change.seed))
    use(copy)


def no_failures(
    use: Callable[[Path], Any], folder: Path, files: list[str], count: int, first: int
) -> None:
    told = failures(partial(use_changed, use, folder), changes(files, count, first))
    assert not told, told


FEW = pytest.mark.parametrize("few", [1, pytest.param(10, marks=pytest.mark.slow)])


def use_result(folder: Path) -> None:
    vi.remake_report(folder)
    load_drop(folder)


@pytest.mark.slow
@FEW
def test_results(few: int, tmp_path: Path) -> None:
    case = vi.case_of({**TABLE, "run": {"impacts": 1, "duration": "20 ms"}})
    vi.simulate(case).save(tmp_path / "out")
    no_failures(
        use_result,
        tmp_path / "out",
        ["result.nc", "result.nc", "summary.json", "case.toml"],
        12 * few,
        51,
    )


def use_study(folder: Path) -> None:
    study = vi.studies.load_study(folder)
    assert study.report.answer
    for name in study.shapes:
        study.values(name)


def bound_study(folder: Path) -> None:
    falls_of_study(vi.studies.load_study(folder))


@pytest.fixture(scope="module")
def studies(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folders of a study of rigid drops, and of one with classes and signals."""
    place = tmp_path_factory.mktemp("studies")
    over = {
        "drop.height": ["1 m", "2 m", "3 m"],
        "contact.restitution": [0.3, 0.5],
        "plate.material": ["steel", "aluminium"],
    }
    vi.studies.run_sweep(
        vi.studies.sweep_of({**plain_case(), "sweep": {"over": over}}), place / "rigid"
    )
    of_class = {"over": {"contact.restitution": {"from": 0.4, "to": 0.6}}}
    sweep = {
        "design": "population",
        "samples": 8,
        "falls_per_rock": 2,
        "rocks_per_plate": 4,
        "over": {"drop.height": {"from": "0.8 m", "to": "1 m"}},
        "classes": {"coal": of_class, "gangue": of_class},
    }
    vi.studies.run_sweep(vi.studies.sweep_of({**plain_case(), "sweep": sweep}), place / "classes")
    return place


@pytest.mark.slow
@FEW
def test_studies(few: int, studies: Path) -> None:
    no_failures(
        use_study, studies / "rigid", ["study.nc", "study.nc", "summary.json"], 12 * few, 53
    )
    no_failures(bound_study, studies / "classes", ["study.nc"], 6 * few, 54)


def resume(sweep: vi.studies.Sweep, folder: Path) -> None:
    vi.studies.run_sweep(sweep, folder, resume=True)


@FEW
def test_ledgers(few: int, tmp_path: Path) -> None:
    sweep = vi.studies.sweep_of(
        {**plain_case(), "sweep": {"over": {"drop.height": ["1 m", "2 m", "3 m"]}}}
    )

    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        vi.studies.run_sweep(sweep, tmp_path / "out", progress=stop)
    chunks = [f"chunks/{file.name}" for file in (tmp_path / "out" / "chunks").iterdir()]
    no_failures(
        partial(resume, sweep),
        tmp_path / "out",
        [LEDGER, LEDGER, "summary.json", *chunks],
        6 * few,
        55,
    )


@FEW
def test_calibrations(few: int, tmp_path: Path) -> None:
    case = plain_case(
        contact={"law": "adams-impact", "damping_max": 100.0},
        run={"impacts": 2},
        calibrate={"target": {"restitution": 0.6}},
    )
    what = calibration_of(case)
    folder = calibrate_case(what).save(tmp_path / "out")
    no_failures(
        load_drop, folder, ["calibration.json", "calibration.json", "case.toml"], 6 * few, 56
    )


@FEW
def test_reproductions(few: int, tmp_path: Path) -> None:
    reproduce_paper(tmp_path / "out", ["table1"])
    no_failures(
        vi.remake_report, tmp_path / "out", ["parts/table1.json", "summary.json"], 6 * few, 57
    )
