"""What stops a study loses nothing: kills, dead workers, a full disk, a damaged ledger,
two sweeps in one folder, Ctrl-C.
"""

from __future__ import annotations

import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from textwrap import dedent
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from studies import RANDOM, study_file, study_table
from vibroimpact.studies.computation import compute_study as computing
from vibroimpact.studies.computation import write_dataset as study_dataset
from vibroimpact.studies.computation.chunk_file import ChunkResult
from vibroimpact.studies.computation.compute_points import compute_points
from vibroimpact.studies.computation.compute_study import compute_study
from vibroimpact.studies.computation.ledger import LEDGER, Span, make_ledger, open_ledger
from vibroimpact.studies.computation.run_chunks import run_chunks
from vibroimpact.studies.computation.workers import WorkerPool, processes, this_process
from waiting import wait_until

DRAWN = vi.studies.sweep_of(study_table(RANDOM))
SMALL = int(200 * (4000 + 4 * DRAWN.bytes / DRAWN.size)) + 1
"""Memory with which a chunk of three impacts has 200 drops."""

MANY = {**RANDOM, "samples": 8000}


def sweep_command(study: Path, folder: Path, *options: str) -> list[str]:
    return [
        sys.executable,
        "-m",
        "vibroimpact",
        "sweep",
        str(study),
        "-o",
        str(folder),
        "--memory",
        str(SMALL),
        *options,
    ]


def results(folder: Path) -> tuple[bytes, bytes]:
    return (folder / "study.nc").read_bytes(), (folder / "drops.csv").read_bytes()


def chunks_done(folder: Path) -> int:
    return len(list((folder / "chunks").glob("*.h5")))


def killed_again_and_again(tmp_path: Path, kills: int, seed: int) -> None:
    """Run a study that is killed at random moments, and compare it with one that was left
    in peace.
    """
    study, random_moment = study_file(tmp_path, MANY), random.Random(seed)
    undisturbed = compute_study(
        vi.studies.load_sweep(study), tmp_path / "undisturbed", memory=SMALL
    )
    folder, done, progressed, killed = tmp_path / "disturbed", 0, 0, 0
    for number in range(kills):
        begun = (folder / LEDGER).exists()
        options = ["--processes", str(1 + number % 2), *(["--resume"] if begun else [])]
        running = subprocess.Popen(
            sweep_command(study, folder, *options),
            stderr=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
        )
        if not begun or number % 3:  # else at once, before anything is done
            wait_until(
                lambda before=done, it=running: (
                    chunks_done(folder) > before or it.poll() is not None
                )
            )
        time.sleep(random_moment.uniform(0.0, 0.15))
        # on a busy machine it may do many chunks before it is seen, and be done
        if running.poll() is not None:
            break
        running.kill()
        running.wait()
        killed += 1
        progressed += chunks_done(folder) > done
        done = chunks_done(folder)
    assert killed >= (kills + 1) // 2
    assert progressed >= (killed + 1) // 2
    compute_study(vi.studies.load_sweep(study), folder, resume=True)
    assert results(folder) == results(undisturbed)


@pytest.mark.slow
def test_a_study_that_is_killed_goes_on_to_the_same_bits(tmp_path: Path) -> None:
    killed_again_and_again(tmp_path, 1, seed=1)


@pytest.mark.slow
def test_a_study_that_is_killed_twenty_times_goes_on_to_the_same_bits(
    tmp_path: Path, population: Callable[[int], int]
) -> None:
    killed_again_and_again(tmp_path, population(20), seed=2)


@pytest.mark.slow
def test_no_process_outlives_the_one_that_leads(tmp_path: Path) -> None:
    study = study_file(tmp_path, MANY)
    command = sweep_command(study, tmp_path / "out", "--processes", "2")
    leader = subprocess.Popen(command, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    wait_until(lambda: chunks_done(tmp_path / "out") > 0, leader)
    children = _children(leader.pid)
    leader.kill()
    leader.wait()
    assert children
    wait_until(lambda: not any(_is_alive(child) for child in children))


def _children(parent: int) -> list[int]:
    return [
        int(child)
        for task in Path(f"/proc/{parent}/task").iterdir()
        for child in (task / "children").read_text().split()
    ]


def _is_alive(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.slow
def test_ctrl_c_says_how_to_go_on(tmp_path: Path) -> None:
    study, folder = study_file(tmp_path, MANY), tmp_path / "out"
    running = subprocess.Popen(
        sweep_command(study, folder, "--processes", "2"),
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    wait_until(lambda: chunks_done(folder) > 0, running)
    os.killpg(running.pid, signal.SIGINT)  # as a terminal does: all processes of the group get it
    told = running.communicate()[1]
    assert running.returncode == 130
    first, last = told.strip().splitlines()
    assert first == "vibroimpact: stopping after what is under way; Ctrl-C once more stops at once"
    assert last.startswith(
        "vibroimpact: interrupted; completed drops are kept; continue with: vibroimpact sweep"
    )
    assert f"-o {folder} --resume" in last
    assert 0 < chunks_done(folder) < 40
    compute_study(vi.studies.load_sweep(study), folder, resume=True)


# workers that die --------------------------------------------------------------------------------


def _nothing() -> None:
    pass


def _dies(mark: str, always: bool, first: int, points: Any) -> ChunkResult:
    """Compute a chunk; the one that begins at drop 100 ends its process, always or the
    first time.
    """
    if first == 100 and (always or not Path(mark).exists()):
        Path(mark).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return compute_points(study_table(RANDOM), ("impacts",), first, points)


def _with_a_death(tmp_path: Path, *, always: bool) -> dict[int, ChunkResult]:
    sweep, found = vi.studies.sweep_of(study_table(RANDOM)), {}
    chunks = [Span(number, 50 * number, 50) for number in range(4)]

    def keep(chunk: Span, result: ChunkResult) -> None:
        assert chunk.number not in found
        found[chunk.number] = result

    work = partial(_dies, str(tmp_path / "mark"), always)
    run_chunks(
        work,
        lambda chunk: sweep.plan.points(chunk.first, chunk.size),
        chunks,
        partial(processes, 2, _nothing, tmp_path),
        keep,
    )
    return found


@pytest.mark.slow
def test_a_worker_that_is_killed_costs_nothing(tmp_path: Path) -> None:
    found = _with_a_death(tmp_path, always=False)
    assert (tmp_path / "mark").exists()
    sweep = vi.studies.sweep_of(study_table(RANDOM))
    for number in range(4):
        alone = compute_points(
            sweep.table, ("impacts",), 50 * number, sweep.plan.points(50 * number, 50)
        )
        assert not found[number].failures
        for name, values in alone.arrays.items():
            assert values.tobytes() == found[number].arrays[name].tobytes()


@pytest.mark.slow
def test_a_chunk_that_kills_every_worker_is_given_up_and_the_rest_go_on(tmp_path: Path) -> None:
    found = _with_a_death(tmp_path, always=True)
    assert len(found) == 4
    assert found[2].failures == dict.fromkeys(
        range(50),
        "the process that computed it died, again and again; it may have run out of memory",
    )
    assert not any(found[number].failures for number in (0, 1, 3))


def test_a_chunk_of_which_nothing_came_has_its_place_in_the_results(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sweep = vi.studies.sweep_of(study_table({**RANDOM, "samples": 500}))
    whole = vi.studies.load_study(compute_study(sweep, tmp_path / "whole", memory=SMALL))

    def compute(table: Any, keep: Any, first: int, points: Any, window: Any) -> ChunkResult:
        return (
            compute_points(table, keep, first, points, window)
            if first != 200
            else ChunkResult({}, dict.fromkeys(range(200), "it died"))
        )

    monkeypatch.setattr(computing, "compute_points", compute)
    study = vi.studies.load_study(compute_study(sweep, tmp_path / "out", memory=SMALL))
    assert study.failures == dict.fromkeys(range(200, 400), "it died")
    for name in ("max_force_N", "largest_force_N"):
        values, expected = study.values(name), whole.values(name)
        assert np.isnan(values[200:400]).all()
        np.testing.assert_array_equal(
            np.delete(values, slice(200, 400), axis=0), np.delete(expected, slice(200, 400), axis=0)
        )
    assert set(study.values("outcome")[200:400]) == {list(vi.Outcome).index(vi.Outcome.FAILED)}


def _cannot_begin() -> None:
    raise SystemExit


def test_a_worker_that_dies_while_a_chunk_is_kept_costs_nothing() -> None:
    class Dying(ThreadPoolExecutor):
        submitted = 0

        def submit(self, *given: Any, **more: Any) -> Future[Any]:
            Dying.submitted += 1
            if Dying.submitted == 4:
                raise BrokenExecutor
            return super().submit(*given, **more)

    @contextmanager
    def start() -> Any:
        with Dying(1) as executor:
            yield WorkerPool(executor, lambda: 2)

    kept: list[int] = []
    chunks = [Span(number, number, 1) for number in range(6)]
    run_chunks(
        lambda first, points: ChunkResult({}, {}),
        lambda chunk: {},
        chunks,
        start,
        lambda chunk, _: kept.append(chunk.number),
    )
    assert sorted(set(kept)) == list(range(6))


@pytest.mark.slow
def test_processes_that_never_begin_are_told_and_no_chunk_is_blamed(tmp_path: Path) -> None:
    with pytest.raises(vi.ComputationError, match="die before they have computed anything"):
        run_chunks(
            _dies,
            lambda chunk: {},
            [Span(0, 0, 1)],
            partial(processes, 1, _cannot_begin, tmp_path),
            lambda *_: None,
        )  # type: ignore[arg-type]


def test_a_scheduler_that_goes_away_is_told() -> None:
    class Gone:
        def submit(self, *_: Any) -> Future[Any]:
            future: Future[Any] = Future()
            future.cancel()
            future.set_running_or_notify_cancel()
            return future

    @contextmanager
    def start() -> Any:
        yield WorkerPool(Gone(), lambda: 2)  # type: ignore[arg-type]

    with pytest.raises(vi.ComputationError, match="the scheduler and its workers are gone"):
        run_chunks(_dies, lambda chunk: {}, [Span(0, 0, 1)], start, lambda *_: None)  # type: ignore[arg-type]


# the disk ----------------------------------------------------------------------------------------


def _small_disk() -> bool:
    """Can a process make a file system of its own?"""
    command = [
        "unshare",
        "--map-root-user",
        "--mount",
        "sh",
        "-c",
        "mount -t tmpfs -o size=1m tmpfs /mnt",
    ]
    return (
        shutil.which("unshare") is not None
        and subprocess.run(command, capture_output=True, check=False).returncode == 0
    )


@pytest.mark.slow
@pytest.mark.skipif(not _small_disk(), reason="no file systems can be mounted here")
def test_a_full_disk_ends_the_study_and_room_lets_it_go_on(tmp_path: Path) -> None:
    study = study_file(tmp_path, {**RANDOM, "samples": 4000})
    undisturbed = compute_study(
        vi.studies.load_sweep(study), tmp_path / "undisturbed", memory=SMALL
    )
    begin = subprocess.list2cmdline(sweep_command(study, Path("/mnt/out"), "--processes", "1"))
    script = f"""
        mount -t tmpfs -o size=1m tmpfs /mnt
        {begin}; echo "status $?"
        ls /mnt/out/chunks | wc -l
        mount -o remount,size=4m /mnt
        {begin} --resume; echo "status $?"
        mount -o remount,size=64m /mnt
        {begin} --resume && cp -r /mnt/out {tmp_path}/resumed; echo "status $?"
    """
    command = ["unshare", "--map-root-user", "--mount", "sh", "-c", script]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "No space left on device" in ran.stderr
    assert "see to the disk, then go on with --resume" in ran.stderr
    assert "Traceback" not in ran.stderr
    lines = [
        line
        for line in ran.stdout.splitlines()
        if line.startswith("status") or line.strip().isdigit()
    ]
    assert lines[0] == "status 1"
    assert 0 < int(lines[1]) < 20
    # room for the chunks, not for what they are put together to; then for all
    assert lines[2:] == ["status 1", "status 0"]
    assert results(tmp_path / "resumed") == results(undisturbed)


def test_a_disk_that_fills_while_the_results_are_put_together_is_told(tmp_path: Path) -> None:
    sweep = vi.studies.sweep_of(study_table({**RANDOM, "samples": 100}))
    expected = results(compute_study(sweep, tmp_path / "undisturbed"))
    limits, kept = resource.getrlimit(resource.RLIMIT_FSIZE), study_dataset._reserve_space

    def enough_for_now(path: Path, size: int) -> None:
        kept(path, size)
        resource.setrlimit(resource.RLIMIT_FSIZE, (5000, limits[1]))

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(study_dataset, "_reserve_space", enough_for_now)
        try:
            with pytest.raises(
                vi.ComputationError,
                match=r"the results can't be put together: File too large; see to the disk",
            ):
                compute_study(sweep, tmp_path / "out")
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    compute_study(sweep, tmp_path / "out", resume=True)
    assert results(tmp_path / "out") == expected


def test_a_chunk_that_can_not_be_written_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sweep = vi.studies.sweep_of(study_table(RANDOM))

    def full(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(os, "fsync", full)
        with pytest.raises(
            vi.ComputationError,
            match=r"000000.h5: the chunk can't be written: No space left on device; see to the "
            r"disk",
        ):
            compute_study(sweep, tmp_path / "out")
    assert list((tmp_path / "out" / "chunks").iterdir()) == []
    compute_study(sweep, tmp_path / "out", resume=True)
    assert results(tmp_path / "out") == results(compute_study(sweep, tmp_path / "undisturbed"))


# the folder --------------------------------------------------------------------------------------


def stopped(folder: Path, sweep: vi.studies.Sweep, after: int = 1) -> None:
    """Begin a study and stop it after some of its drops."""

    class Stop(BaseException):
        pass

    def progress(done: int, total: int) -> None:
        if done >= after:
            raise Stop

    with pytest.raises(Stop):
        compute_study(sweep, folder, memory=SMALL, progress=progress)


def test_a_second_sweep_in_a_folder_is_refused(tmp_path: Path) -> None:
    sweep = vi.studies.sweep_of(study_table({**RANDOM, "samples": 600}))
    folder = tmp_path / "out"
    stopped(folder, sweep)
    with open_ledger(folder):
        for options in ({"resume": True}, {"force": True}, {}):
            with pytest.raises(vi.InputError, match="another sweep is at work in this folder"):
                compute_study(sweep, folder, **options)  # type: ignore[arg-type]
    with pytest.raises(
        vi.InputError,
        match=r"a study is there already; continue it with --resume if it is this one, replace "
        r"it with --force",
    ):
        compute_study(sweep, folder)
    compute_study(sweep, folder, resume=True)


def test_the_journal_of_a_ledger_whose_process_was_killed_goes_with_the_next_opening(
    tmp_path: Path,
) -> None:
    make_ledger(tmp_path, {}, 10, 10)
    script = f"""
        import os, signal
        from pathlib import Path
        from vibroimpact.studies.computation.ledger import Span, open_ledger
        with open_ledger(Path({str(tmp_path)!r})) as ledger:
            ledger.done(Span(0, 0, 10), "", 0)
            os.kill(os.getpid(), signal.SIGKILL)
    """
    subprocess.run([sys.executable, "-c", dedent(script)], check=False)
    assert sorted(path.name for path in tmp_path.iterdir()) == [LEDGER, f"{LEDGER}-journal"]
    with open_ledger(tmp_path) as ledger:
        assert [chunk.number for chunk in ledger.chunks("done")] == [0]
    assert [path.name for path in tmp_path.iterdir()] == [LEDGER]


def test_a_damaged_ledger_is_refused_and_made_anew_from_the_chunks(tmp_path: Path) -> None:
    sweep, folder = vi.studies.sweep_of(study_table({**RANDOM, "samples": 1000})), tmp_path / "out"
    stopped(folder, sweep, after=600)
    data = (folder / LEDGER).read_bytes()
    (folder / LEDGER).write_bytes(data[:4096] + os.urandom(len(data) - 4096))
    with pytest.raises(
        vi.InputError, match=r"the ledger is damaged .* delete this file and go on with --resume"
    ):
        compute_study(sweep, folder, resume=True)
    (folder / LEDGER).unlink()
    (folder / "chunks" / "000001.h5").write_bytes(b"torn")
    computed = []
    compute_study(
        sweep, folder, resume=True, memory=SMALL, progress=lambda done, total: computed.append(done)
    )
    assert computed == [400, 600, 800, 1000]  # two of the three chunks that were there are taken up
    assert results(folder) == results(compute_study(sweep, tmp_path / "undisturbed", memory=SMALL))


def test_chunks_of_another_size_are_not_taken_up(tmp_path: Path) -> None:
    sweep, folder = vi.studies.sweep_of(study_table({**RANDOM, "samples": 1000})), tmp_path / "out"
    stopped(folder, sweep, after=600)
    (folder / LEDGER).unlink()
    compute_study(sweep, folder, resume=True, memory=2 * SMALL)
    np.testing.assert_array_equal(
        vi.studies.load_study(folder).values("first_restitution_asked"),
        sweep.plan.columns["contact.restitution"],
    )


def test_a_chunk_that_is_not_as_it_was_written_is_computed_again(tmp_path: Path) -> None:
    sweep, folder, told = (
        vi.studies.sweep_of(study_table({**RANDOM, "samples": 1000})),
        tmp_path / "out",
        [],
    )
    stopped(folder, sweep, after=600)
    file = folder / "chunks" / "000001.h5"
    file.write_bytes(file.read_bytes()[:-1] + b"x")
    compute_study(sweep, folder, resume=True, tell=told.append)
    assert told == ["chunk 1 on disk is damaged or missing; it is computed again"]
    assert results(folder) == results(compute_study(sweep, tmp_path / "undisturbed", memory=SMALL))


def test_another_study_does_not_go_on_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sweep, folder = vi.studies.sweep_of(study_table({**RANDOM, "samples": 600})), tmp_path / "out"
    stopped(folder, sweep)
    changed = vi.studies.sweep_of(study_table({**RANDOM, "samples": 600, "seed": 1}))
    with pytest.raises(
        vi.InputError,
        match=r"the study has changed since it was begun here.*study.toml in it is what was begun",
    ):
        compute_study(changed, folder, resume=True)
    with monkeypatch.context() as patched:
        patched.setattr(computing, "__version__", "9.9")
        with pytest.raises(
            vi.InputError,
            match=r"begun with vibroimpact .*, and this is 9.9; go on with that version",
        ):
            compute_study(sweep, folder, resume=True)
    # what was begun is there, and is the same
    compute_study(vi.studies.load_sweep(folder / "study.toml"), folder, resume=True)
    # nothing is left to do
    compute_study(vi.studies.load_sweep(folder / "study.toml"), folder, resume=True)
    with pytest.raises(
        vi.InputError, match=r"this is a study of many drops, not the result of a run"
    ):
        vi.load_result(folder)


def test_resume_begins_where_nothing_was_begun_and_replaces_nothing(tmp_path: Path) -> None:
    sweep = vi.studies.sweep_of(study_table({**RANDOM, "samples": 10}))
    begun, again = (
        compute_study(sweep, tmp_path / name, resume=name == "begun") for name in ("begun", "again")
    )
    assert results(begun) == results(again)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "thesis.tex").write_text("years")
    for force in (False, True):
        with pytest.raises(vi.InputError, match="the folder is there"):
            compute_study(sweep, tmp_path / "other", resume=True, force=force)


def test_a_study_takes_the_place_of_another_only_if_it_is_told_to(tmp_path: Path) -> None:
    sweep = vi.studies.sweep_of(study_table({**RANDOM, "samples": 10}))
    folder = compute_study(sweep, tmp_path / "out")
    before = results(folder)
    with pytest.raises(vi.InputError, match="a study is there already"):
        compute_study(sweep, folder)
    assert results(folder) == before
    compute_study(vi.studies.sweep_of(study_table({**RANDOM, "samples": 12})), folder, force=True)
    assert results(folder) != before


def test_this_process_computes_as_well() -> None:
    with this_process() as crew:
        assert crew.executor.submit(int, "3").result() == 3
        assert isinstance(crew.executor.submit(int, "x").exception(), ValueError)


# Ctrl-C at any moment ----------------------------------------------------------------------------


def interrupted_after(seconds: float, study: Path, folder: Path) -> tuple[int, str]:
    """Run a study of two processes, and send an interrupt to all of them, as a terminal
    does; return its status and what it told.
    """
    command = [
        sys.executable,
        "-m",
        "vibroimpact",
        "sweep",
        str(study),
        "-o",
        str(folder),
        "--processes",
        "2",
        "--yes",
    ]
    running = subprocess.Popen(
        command,
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
    )
    time.sleep(seconds)
    os.killpg(running.pid, signal.SIGINT)
    told = running.communicate(timeout=300)[1]
    return running.returncode, told


@pytest.mark.slow
def test_ctrl_c_is_never_lost(tmp_path: Path, population: Callable[[int], int]) -> None:
    study = study_file(tmp_path, {**RANDOM, "samples": 2_000_000})  # which would take a minute
    for number in range(0, 24, 24 // population(24)):
        status, told = interrupted_after(0.4 + 0.2 * number, study, tmp_path / f"out{number}")
        # by the signal itself before the command has begun, on a loaded machine after seconds, with
        # a traceback of the interpreter's own while that starts
        assert status in ((1, 130, -signal.SIGINT) if number < 8 else (1, 130)), (number, told)
        assert told.count("Traceback") <= (number < 3), (number, told)


def test_an_interrupt_waits_while_a_process_is_started_and_is_not_lost(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from multiprocessing.context import SpawnProcess

    from vibroimpact.studies.computation import workers

    seen: list[str] = []

    def starts(self: object) -> None:
        # what goes to the process may wake a thread of pytest
        signal.pthread_kill(threading.get_ident(), signal.SIGINT)
        seen.append("started")

    monkeypatch.setattr(SpawnProcess, "start", starts)
    before = signal.signal(signal.SIGINT, lambda *_: seen.append("told"))
    try:
        workers._InterruptImmuneProcess(target=_nothing).start()
    finally:
        signal.signal(signal.SIGINT, before)
    assert seen == ["started", "told"]


@pytest.mark.slow
def test_all_processes_are_deaf_to_interrupts(tmp_path: Path) -> None:
    with processes(2, _nothing, tmp_path) as crew:
        masks = [crew.executor.submit(_hears_interrupts).result() for _ in range(2)]
    assert masks == [False, False]


def _hears_interrupts() -> bool:
    return signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())


def test_an_error_in_a_batch_is_that_of_no_drop(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As a law of another package may raise what it likes: the drops are computed singly."""
    from vibroimpact.studies.computation import compute_points

    def fails(problem: vi.Problem) -> None:
        raise ValueError("no batches")

    monkeypatch.setattr(compute_points, "tabulate", fails)
    sweep = vi.studies.load_sweep(study_file(tmp_path, {**RANDOM, "samples": 3}))
    study = vi.studies.load_study(vi.studies.run_sweep(sweep, tmp_path / "out"))
    assert not study.failures
    assert np.isfinite(study.values("max_force_N")).all()
