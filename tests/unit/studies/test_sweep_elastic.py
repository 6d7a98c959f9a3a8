"""Studies of drops on an elastic plate: signals, noise, failures, and modes that travel
to the workers of a Dask scheduler.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import vibroimpact as vi
from studies import study_table
from vibroimpact.structures.store import PLACE, entries
from vibroimpact.studies.computation.compute_study import compute_study
from vibroimpact.studies.planning.swept_keys import case_at
from waiting import wait_until

PLATE = {
    "size": ["520 mm", "420 mm", "8 mm"],
    "material": "steel-paper",
    "model": "elastic",
    "supports": "clamped",
    "modes": 4,
    "damping": 0.02,
}
SENSORS = [
    {"name": "a1", "position": [0.1, 0.05], "rate": "20 kHz", "accelerometer": {"noise": 1.0}},
    {"name": "v2", "position": [-0.1, 0.05], "rate": "20 kHz", "quantity": "velocity"},
]
OVER: dict[str, Any] = {"drop.position.x": [0.0, 0.1], "drop.speed": [1.0, 2.0, 3.0]}


def elastic_table(**sweep: Any) -> dict[str, Any]:
    given = {"keep": ["impacts", "signals"], "over": OVER, **sweep}
    return study_table(
        given, plate=PLATE, sensors=SENSORS, drop={"speed": 2.0}, run={"duration": "5 ms"}
    )


@pytest.fixture(scope="module")
def own_store(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    with pytest.MonkeyPatch.context() as patched:
        store = tmp_path_factory.mktemp("store")
        patched.setenv(PLACE, str(store))
        yield store


@pytest.fixture(scope="module")
def study(own_store: Path, tmp_path_factory: pytest.TempPathFactory) -> vi.studies.Study:
    return vi.studies.load_study(
        compute_study(
            vi.studies.sweep_of(elastic_table()), tmp_path_factory.mktemp("study") / "out"
        )
    )


def alone(*place: int) -> vi.Response:
    table = {key: value for key, value in elastic_table().items() if key != "sweep"}
    values = {key: levels[at] for (key, levels), at in zip(OVER.items(), place, strict=True)}
    return vi.simulate(case_at(table, values))


@pytest.mark.slow
def test_the_drops_are_those_of_single_runs(study: vi.studies.Study) -> None:
    for place in ((0, 0), (1, 2)):
        single = alone(*place)
        for name in ("max_force_N", "restitution_achieved", "energy_to_vibration_J"):
            np.testing.assert_array_equal(study.values(name, *place, 0), single.impacts[name][0])
        velocity = single.signals()["v2"].value.astype(np.float32)
        np.testing.assert_array_equal(study.values("signal_v2", *place), velocity)
        assert study.values("v2_max_magnitude", *place) == pytest.approx(np.abs(velocity).max())


def test_the_noise_is_that_of_one_drop_alone(study: vi.studies.Study) -> None:
    noise = []
    for speed in range(3):
        (sensor,) = (one for one in alone(0, speed).problem.sensors if one.name == "a1")
        assert sensor.instrument is not None
        quiet = vi.sensors.Sensor("a1", rate=sensor.rate)
        noise.append(
            study.values("signal_a1", 0, speed) - alone(0, speed).signals(quiet)["a1"].value
        )
    for number, values in enumerate(noise):
        drawn = np.random.default_rng([zlib.crc32(b"a1"), 0, number]).standard_normal(len(values))
        # single precision of some hundred m/s2
        np.testing.assert_allclose(values, drawn, atol=1e-3)


def test_signals_have_a_time_and_units(study: vi.studies.Study) -> None:
    with xr.open_dataset(study.path, engine="h5netcdf") as data:
        assert data["signal_a1"].dims == ("drop.position.x", "drop.speed", "time")
        assert data["signal_a1"].attrs["units"] == "m/s2"
        assert data["signal_v2"].attrs["units"] == "m/s"
        np.testing.assert_allclose(data["time"], np.arange(101) / 20e3, rtol=1e-12)
        assert data["v2_max_magnitude"].dims == ("drop.position.x", "drop.speed")


def test_what_is_left_in_vibration_is_kept(own_store: Path, tmp_path: Path) -> None:
    """Of a drop that comes to rest, as a single run has it; there is nothing to say of
    one that flies.
    """
    given = {
        "plate": PLATE,
        "contact": {"law": "lankarani-nikravesh", "restitution": 0.2},
        "drop": {"speed": 2.0},
        "run": {"duration": "0.1 s"},
    }
    sweep = vi.studies.sweep_of(study_table({"over": {"drop.speed": [0.02, 2.0]}}, **given))
    folder = compute_study(sweep, tmp_path / "out")
    left = vi.studies.load_study(folder).values("left_in_vibration_J")
    resting = vi.simulate(sweep.case_of(0))
    assert resting.outcomes[0].at_rest
    np.testing.assert_array_equal(left, [resting.rest.left[0], np.nan])
    header, first, second = (folder / "drops.csv").read_text(encoding="utf-8").splitlines()
    at = header.split(",").index("left_in_vibration_J")
    assert float(first.split(",")[at]) == left[0] > 0.0
    assert not second.split(",")[at]


def test_a_drop_outside_the_plate_fails_by_itself(own_store: Path, tmp_path: Path) -> None:
    over = {"plate.size.length": [0.52, 0.3], "drop.position.x": [0.0, 0.2]}
    study = vi.studies.load_study(
        compute_study(vi.studies.sweep_of(elastic_table(over=over)), tmp_path / "out")
    )
    assert list(study.failures) == [3]
    assert "(0.2, 0) m lies outside the plate" in study.failures[3]
    assert np.isfinite(study.values("largest_force_N")).tolist() == [[True, True], [True, False]]
    assert np.isnan(study.values("signal_v2", 1, 1)).all()


# a scheduler and its workers, with a store of their own ------------------------------------------


@pytest.fixture
def scheduler(tmp_path: Path) -> Iterator[tuple[str, list[subprocess.Popen[bytes]], Path]]:
    """A Dask scheduler with two workers that do not see the store of this process: its
    address, the workers, their store.
    """
    from distributed import Client

    store, file = tmp_path / "their store", tmp_path / "scheduler.json"
    quiet: dict[str, Any] = {
        "stdout": subprocess.DEVNULL,
        "stderr": subprocess.DEVNULL,
        "env": {**os.environ, PLACE: str(store)},
        "cwd": tmp_path,
    }
    dask = [sys.executable, "-m", "distributed.cli."]
    begin = [
        sys.executable,
        "-m",
        "distributed.cli.dask_scheduler",
        "--port",
        "0",
        "--no-dashboard",
        "--scheduler-file",
        str(file),
    ]
    running = [subprocess.Popen(begin, **quiet)]
    join = [
        f"{dask[2]}dask_worker",
        "--scheduler-file",
        str(file),
        "--nthreads",
        "1",
        "--no-dashboard",
        "--no-nanny",
    ]
    running += [subprocess.Popen([*dask[:2], *join], **quiet) for _ in range(2)]
    try:
        wait_until(lambda: file.exists() and file.read_text() != "", *running)
        with Client(scheduler_file=str(file), timeout="1 h") as client:
            client.wait_for_workers(2)
            address = client.scheduler.address
        yield address, running[1:], store
    finally:
        for process in running:
            process.kill()
            process.wait()


@pytest.mark.slow
def test_modes_travel_to_workers_that_do_not_see_the_store(
    study: vi.studies.Study,
    scheduler: tuple[str, list[subprocess.Popen[bytes]], Path],
    tmp_path: Path,
) -> None:
    address, _, store = scheduler
    folder = compute_study(
        vi.studies.sweep_of(elastic_table()), tmp_path / "out", scheduler=address
    )
    names = {path.name for path in entries()}
    theirs = {path.name for path in store.iterdir()}
    assert theirs & names, "nothing travelled"
    assert len([name for name in theirs if name.endswith(".modes")]) == 1
    assert (folder / "study.nc").read_bytes() == study.path.read_bytes()


@pytest.mark.slow
def test_a_dask_worker_that_is_killed_costs_nothing(
    study: vi.studies.Study,
    scheduler: tuple[str, list[subprocess.Popen[bytes]], Path],
    tmp_path: Path,
) -> None:
    address, workers, _ = scheduler
    # several chunks
    over = {"drop.position.x": [0.0, 0.1], "drop.speed": {"from": 1.0, "to": 3.0, "number": 64}}
    sweep = vi.studies.sweep_of(elastic_table(over=over))
    killed = threading.Event()

    def progress(done: int, total: int) -> None:
        if 0 < done < total and not killed.is_set():
            killed.set()
            workers[0].send_signal(signal.SIGKILL)

    disturbed = compute_study(sweep, tmp_path / "out", scheduler=address, progress=progress)
    assert killed.is_set()
    undisturbed = compute_study(sweep, tmp_path / "undisturbed")
    assert (disturbed / "study.nc").read_bytes() == (undisturbed / "study.nc").read_bytes()
