"""Damage to any file that is read back ends in a sentence, or changes nothing: no number
is believed that was not written.
"""

from __future__ import annotations

import json
import random
import re
import shutil
from collections.abc import Callable
from dataclasses import asdict, is_dataclass, replace
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import hostile_runs
import vibroimpact as vi
from support import plain_case
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.exporting.load_drop import load_drop
from vibroimpact.paper.report.folder import reproduce_paper
from vibroimpact.paper.report.reproduction import load_reproduction
from vibroimpact.results.deflection import Deflection
from vibroimpact.results.result import Result, result_of
from vibroimpact.structures.store import load_entry, save_entry
from vibroimpact.studies.computation.chunk_file import (
    ChunkResult,
    chunk_path,
    read_chunk,
    write_chunk,
)
from vibroimpact.studies.computation.ledger import Span, make_ledger, open_ledger
from written_results import write_result


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out the process that looks for the part to name: what is refused is refused before."""
    monkeypatch.setattr(
        "vibroimpact.files.damaged_part.damaged_part", lambda path: "", raising=False
    )


class Damage(NamedTuple):
    """What is done to a file: reproducible from its seed."""

    file: str
    kind: str
    seed: int


def mark(value: Any) -> str:
    """Return a fingerprint of all numbers and texts in a value; it is not the one that is
    tested.
    """

    def plain(one: Any) -> Any:
        if isinstance(one, np.ndarray):
            kept = one.tolist() if one.dtype == object else [one.dtype.str, one.tobytes().hex()]
            return [one.shape, kept]
        if is_dataclass(one) and not isinstance(one, type):
            return [type(one).__name__, plain(asdict(one))]
        if isinstance(one, dict):
            return sorted((str(key), plain(item)) for key, item in one.items())
        if isinstance(one, (list, tuple)):
            return [plain(item) for item in one]
        return repr(one)

    return sha256(json.dumps(plain(value)).encode()).hexdigest()


def damaged(data: bytes, damage: Damage) -> bytes:
    """Return the content of a file with a damage."""
    draw, size = random.Random(damage.seed), len(data)
    place = draw.randrange(size)
    if damage.kind == "bit":
        return data[:place] + bytes([data[place] ^ 1 << draw.randrange(8)]) + data[place + 1 :]
    if damage.kind == "bytes":
        length = draw.choice((1, 2, 8, 64))
        return (data[:place] + draw.randbytes(length) + data[place + length :])[:size]
    if damage.kind == "zeros":
        length = draw.choice((8, 512, 4096))
        place -= place % length
        return (data[:place] + bytes(length) + data[place + length :])[:size]
    if damage.kind == "torn":
        return data[:place]
    return text_damaged(data, draw)


def text_damaged(data: bytes, draw: random.Random) -> bytes:
    """Return a text in which one number is another, or a value of another kind."""
    found = list(re.finditer(rb"-?\d+(\.\d+)?(e-?\d+)?|\"[^\"\n]*\"|null", data))
    match = draw.choice(found)
    other = draw.choice(
        (b"[1, 2]", b"null", b"{}", b'"x"', b"-1e400", b"1e308", b"7", b"[]", b"true")
    )
    return data[: match.start()] + other + data[match.end() :]


def damages(files: list[str], few: int, seed: int) -> list[Damage]:
    """Return damages of each kind to each file."""
    draw = random.Random(seed)
    return [
        Damage(file, kind, draw.getrandbits(32))
        for file in files
        for kind in ("bit", "bytes", "zeros", "torn", "text")
        for _ in range(hostile_runs.number(few))
        if kind != "text" or file.endswith((".json", ".toml"))
    ]


def check(
    read: Callable[[Path], Any], folder: Path, copy: Path, expected: str, damage: Damage
) -> None:
    """Read a folder of which a file was damaged; fails if that gives other numbers."""
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(folder, copy)
    content = (copy / damage.file).read_bytes()
    (copy / damage.file).write_bytes(damaged(content, damage))
    if (copy / damage.file).read_bytes() == content:
        return
    found = mark(read(copy))
    assert found == expected, f"{damage} changed what was read in silence"


def no_failures(read: Callable[[Path], Any], folder: Path, files: list[str], few: int) -> None:
    expected = mark(read(folder))
    copy = folder.with_name("copy")
    found = hostile_runs.failures(
        partial(check, read, folder, copy, expected),
        damages(files, few, seed=hostile_runs.seed(18)),
    )
    assert not found, found


def a_result() -> Result:
    """A result that has all that one may have."""
    result, draw = result_of(vi.simulate(vi.case_of(plain_case()))), np.random.default_rng(1)
    sensors = [
        Signal(Sensor(name, "acceleration", (0.0, 0.0, 1.0), 5e4), draw.normal(size=size), 0.1)
        for name, size in (("a1", 700), ("zero", 300))
    ]
    sensors[1].value[:] = 0.0
    grid = Deflection(
        np.arange(5.0),
        np.arange(20.0),
        np.arange(10.0),
        draw.normal(size=(5, 10, 20)).astype(np.float32),
        np.ones(5),
        np.ones(5),
        (0.1, 0.2),
    )
    peaks = {
        "plate": {
            "max_velocity_m_s": 0.5,
            "frequencies_Hz": [100.0, 200.0],
            "frequency_errors": [0.1, None],
        }
    }
    facts: dict[str, float | str] = {"treatment": "consistent", "compliance_m_N": 1e-9}
    return replace(
        result,
        deformation=facts,
        truncation={"plate": 0.01},
        peaks=peaks,
        signals={one.sensor.name: one for one in sensors},
        deflection=grid,
    )


def read_all_of_a_result(folder: Path) -> Any:
    result = vi.load_result(folder)
    return [
        result.case, result.impacts, result.history, result.energy, result.status, result.provenance, result.deformation, result.truncation,
        result.peaks, result.signals, result.deflection,
    ]  # fmt: skip


def test_results(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    write_result(a_result(), tmp_path / "out")
    no_failures(
        read_all_of_a_result,
        tmp_path / "out",
        ["result.nc", "result.nc", "summary.json", "case.toml"],
        12,
    )


def read_all_of_a_study(folder: Path) -> Any:
    study = vi.studies.load_study(folder)
    values = [study.values(name) for name in study.shapes]
    return [
        replace(study, path=Path()),
        values,
        study.doubts,
        study.times("a1") if "signal_a1" in study.shapes else None,
    ]


def test_studies(tmp_path: Path) -> None:
    over = {
        "drop.height": ["1 m", "2 m", "3 m"],
        "contact.restitution": [0.3, 0.5, 0.9],
        "plate.material": ["steel", "aluminium"],
    }
    sweep = vi.studies.sweep_of({**plain_case(), "sweep": {"over": over}})
    no_failures(
        read_all_of_a_study, vi.studies.run_sweep(sweep, tmp_path / "out"), ["study.nc"], 12
    )


def read_calibration(folder: Path) -> Any:
    drop = load_drop(folder)
    return [drop.impacts, drop.radius, drop.mass, drop.height, drop.function]


@pytest.fixture(scope="module")
def calibration(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of

    case = plain_case(
        contact={"law": "adams-impact", "damping_max": 100.0},
        run={"impacts": 2},
        calibrate={"target": {"restitution": 0.6}},
    )
    what = calibration_of(case)
    return calibrate_case(what).save(tmp_path_factory.mktemp("calibrations") / "out")


def test_calibrations(calibration: Path) -> None:
    no_failures(read_calibration, calibration, ["calibration.json", "case.toml"], 4)


def test_parts_of_a_reproduction(tmp_path: Path) -> None:
    reproduce_paper(tmp_path / "out", ["table1"])
    no_failures(load_reproduction, tmp_path / "out", ["parts/table1.json"], 10)


def read_chunk_or_refuse(folder: Path) -> Any:
    try:
        found = read_chunk(folder, Span(0, 0, 400), "study")
    except (OSError, KeyError, ValueError) as error:  # which have it computed again
        raise vi.InputError("refused") from error
    return [dict(found.arrays), dict(found.failures)]


def test_chunks(tmp_path: Path) -> None:
    arrays = {
        "force": np.arange(400.0),
        "outcome": np.full(400, 3, dtype=np.int8),
        "none": np.zeros(400),
    }
    (tmp_path / "out").mkdir()
    write_chunk(tmp_path / "out", Span(0, 0, 400), ChunkResult(arrays, {7: "it broke"}), "study")
    file = str(chunk_path(Path(), 0))
    no_failures(read_chunk_or_refuse, tmp_path / "out", [file], 25)


def read_ledger(folder: Path) -> Any:
    with open_ledger(folder) as ledger:
        return [ledger.chunks("waiting"), [one._replace() for one in ledger.chunks("done")]]


def test_ledgers(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    make_ledger(tmp_path / "out", {"digest": "x" * 64, "version": "0"}, 5_000, 10)
    no_failures(read_ledger, tmp_path / "out", ["ledger.sqlite"], 15)


def test_the_store_of_modes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path / "out"))
    assert save_entry("abc", "modes", {"shapes": np.arange(300.0), "left": np.zeros((0, 3))}) == ""

    def read(folder: Path) -> Any:
        monkeypatch.setenv("VIBROIMPACT_STORE", str(folder))
        found, trouble = load_entry("abc", "modes", dict)
        if found is None:
            raise vi.InputError(trouble)
        return found

    no_failures(read, tmp_path / "out", ["abc.modes"], 25)
