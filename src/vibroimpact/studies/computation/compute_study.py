"""Compute a study in its folder, chunk by chunk, up to the dataset, or resume one."""

from __future__ import annotations

import math
import os
import shutil
from collections.abc import Callable
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.cases.elastic.coupling import carried_modes
from vibroimpact.cases.rigid.run_ends import impact_limit
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.files.check_sums import sealed
from vibroimpact.files.result_folder import SUMMARY, new_folder
from vibroimpact.structures.store import receive
from vibroimpact.studies.computation.chunk_file import (
    FOLDER,
    ChunkResult,
    checksum,
    read_chunk,
    write_chunk,
)
from vibroimpact.studies.computation.compute_points import compute_points
from vibroimpact.studies.computation.dask_workers import check_scheduler, dask_workers
from vibroimpact.studies.computation.drops_table import MOST_ROWS, write_drops
from vibroimpact.studies.computation.ledger import (
    LEDGER,
    Ledger,
    Span,
    busy,
    is_held,
    make_ledger,
    open_ledger,
)
from vibroimpact.studies.computation.run_chunks import Points, run_chunks
from vibroimpact.studies.computation.study_folder import (
    DATASET,
    STUDY,
    clear_study,
    is_study,
    recover_study,
    study_toml,
)
from vibroimpact.studies.computation.workers import Workers, processes, this_process
from vibroimpact.studies.computation.write_dataset import write_dataset
from vibroimpact.studies.planning.sweep import LONG, Sweep

MEMORY = 500e6
"""Default memory for the drops of a chunk [bytes]."""

LEAST_MEMORY = 1e6
"""Minimum memory for the drops of a chunk [bytes]."""

_CHUNK = 8000  # drops with rigid bodies per chunk: a tenth of a second
_ELASTIC_CHUNK = 32  # drops with elastic bodies per chunk: a second
# of a population at least, before all falls on a plate are one chunk, so that one process computes
# its modes
_PLATE_CHUNKS = 16
_DROP_MEMORY = 4000.0  # of a drop during computation, without its results [bytes]
_COPIES = 4.0  # of the results of a drop, until they are written

_FEW_CHUNKS = 40  # the overhead of so many chunks is two seconds, whatever their size
# impacts with rigid bodies, or drops with elastic ones, in a chunk that limit its overhead to a
# third
_USEFUL_IMPACTS = 15_000
_USEFUL_ELASTIC_DROPS = 3

_MANY_DROPS = 50_000  # above which assembling the dataset takes seconds

Progress = Callable[[int, int], None]
Tell = Callable[[str], None]


def compute_study(
    sweep: Sweep,
    directory: str | PathLike[str],
    *,
    resume: bool = False,
    force: bool = False,
    workers: int = 1,
    scheduler: str | None = None,
    memory: float = MEMORY,
    progress: Progress | None = None,
    modes_progress: Callable[[float], None] | None = None,
    tell: Tell | None = None,
) -> Path:
    """Compute a study in a folder: `study.nc`, `drops.csv`, and the ledger of its chunks.

    `run_sweep` also writes the report.

    Parameters
    ----------
    sweep, directory, resume, force, workers, scheduler, memory, progress, modes_progress, tell
        As for `run_sweep`.

    Returns
    -------
    pathlib.Path
        The folder.

    Raises
    ------
    InputError, ComputationError
        As for `run_sweep`.
    """
    _check_settings(sweep, workers, memory)
    if not resume:
        _check_memory(sweep, memory)
    folder = Path(directory)
    if scheduler is not None:
        check_scheduler(scheduler)
    recover_study(folder)
    if resume and is_study(folder):
        _restore_ledger(folder, sweep, memory)
    else:
        _create(folder, sweep, memory, force=force and not resume)
    # the open ledger locks the folder against other processes
    with open_ledger(folder) as ledger:
        clear_study(folder)
        _check_same(ledger, folder, sweep)
        if not (folder / DATASET).is_file():
            _invalidate_damaged(ledger, folder, tell)
            number = min(workers, len(ledger.chunks("waiting")))
            start_workers = _workers(folder, sweep, number, scheduler, modes_progress, tell)
            _run(ledger, folder, sweep, start_workers, progress)
            if tell is not None and sweep.size >= _MANY_DROPS:
                tell("all drops are done; assembling the results")
            _assemble(folder, ledger, sweep)
        shutil.rmtree(folder / FOLDER, ignore_errors=True)
    return folder


def _check_settings(sweep: Any, workers: Any, memory: Any) -> None:
    """Check the arguments of `run_sweep`, which may come from a script."""
    if not isinstance(sweep, Sweep):
        raise InputError(
            f"a study is wanted, as vi.studies.load_sweep(...) reads it, not {sweep!r}"
        )
    if not isinstance(workers, int) or workers < 1:
        raise InputError(f"{workers!r} is not allowed; it must be a whole number from 1", "workers")
    if isinstance(memory, str) or not memory >= LEAST_MEMORY:
        raise InputError(
            f"{memory!r} is not allowed; it must be a number of bytes, {LEAST_MEMORY:g} or more",
            "memory",
        )


def _create(folder: Path, sweep: Sweep, memory: float, *, force: bool) -> None:
    """Create the folder of a new study: case, summary and ledger."""
    if is_held(folder):
        raise InputError(busy(folder))
    if is_study(folder) and not force:
        remedy = (
            "continue it with --resume if it is this one, replace it with "
            "--force, or name another folder"
        )
        raise InputError(f"{folder}: a study is there already; {remedy}")
    with new_folder(folder, force=force) as working:
        (working / STUDY).write_text(study_toml(sweep.whole_table), encoding="utf-8")
        (working / FOLDER).mkdir()
        make_ledger(working, _facts(sweep), sweep.size, chunk_size(sweep, memory))
        (working / SUMMARY).write_bytes(sealed(_summary(sweep)))


def _summary(sweep: Sweep) -> dict[str, Any]:
    """Return the content of `summary.json`, which gets the checksum of the dataset later."""
    return {
        "name": sweep.name,
        "version": __version__,
        "study": {"design": sweep.section.design, "drops": sweep.size},
    }


def _restore_ledger(folder: Path, sweep: Sweep, memory: float) -> None:
    """Rebuild the ledger of a study from its chunk files if it is missing."""
    if (folder / LEDGER).is_file():
        return
    make_ledger(folder, _facts(sweep), sweep.size, chunk_size(sweep, memory))
    with open_ledger(folder) as ledger:
        for chunk in ledger.chunks("waiting"):
            try:
                result = read_chunk(folder, chunk, sweep.digest)
            except (OSError, KeyError, ValueError):
                continue
            ledger.done(chunk, checksum(folder, chunk.number) or "", len(result.failures))


def _check_same(ledger: Ledger, folder: Path, sweep: Sweep) -> None:
    """Check that a ledger belongs to this study and was created with the present versions."""
    facts = ledger.facts
    present_facts = _facts(sweep)
    for key, package in (("version", "vibroimpact"), ("numpy", "NumPy")):
        if facts.get(key) != present_facts[key]:
            raise InputError(
                f"{folder}: this study was begun with {package} {facts.get(key)}, and this is "
                f"{present_facts[key]}; go on with that version, or begin anew with --force "
                "in place of --resume"
            )
    if facts.get("digest") != present_facts["digest"]:
        raise InputError(
            f"{folder}: the study has changed since it was begun here: its case, its points, "
            f"its files or what is kept; {STUDY} in it is what was begun; begin anew with --force "
            "in place of --resume, or in another folder"
        )


def _invalidate_damaged(ledger: Ledger, folder: Path, tell: Tell | None) -> None:
    """Mark chunks for recomputation whose files do not match their checksums."""
    for number, expected in ledger.checksums().items():
        if checksum(folder, number) != expected:
            ledger.undone(number)
            if tell is not None:
                tell(f"chunk {number} on disk is damaged or missing; it is computed again")


def _run(
    ledger: Ledger, folder: Path, sweep: Sweep, workers: Workers, progress: Progress | None
) -> None:
    """Compute the waiting chunks."""
    waiting = ledger.chunks("waiting")
    done = sweep.size - sum(chunk.size for chunk in waiting)
    if progress is not None:
        progress(done, sweep.size)

    def keep(chunk: Span, result: ChunkResult) -> None:
        nonlocal done
        ledger.done(chunk, write_chunk(folder, chunk, result, sweep.digest), len(result.failures))
        done += chunk.size
        if progress is not None:
            progress(done, sweep.size)

    def points(chunk: Span) -> Points:
        return sweep.plan.points(chunk.first, chunk.size)

    run_chunks(
        partial(compute_points, sweep.table, sweep.section.keep, window=sweep.window),
        points,
        waiting,
        workers,
        keep,
    )


def _assemble(folder: Path, ledger: Ledger, sweep: Sweep) -> None:
    """Write table and dataset from the chunks.

    The dataset comes last, as its presence marks a complete study.
    """
    chunks = ledger.chunks("done")
    waiting = ledger.chunks("waiting")
    if waiting:
        verb = "is" if len(waiting) == 1 else "are"
        raise ComputationError(
            f"{folder}: {len(waiting)} of the chunks {verb} not done; go on with --resume"
        )
    rates = {sensor.name: sensor.rate for sensor in sweep.case.sensors}
    try:
        if sweep.size <= MOST_ROWS:
            write_drops(folder, chunks, sweep.digest, sweep.plan, sweep.meanings)
        write_dataset(
            folder,
            sweep.name,
            chunks,
            sweep.digest,
            sweep.plan,
            sweep.whole_table,
            sweep.meanings,
            rates,
            _summary(sweep),
        )
    except OSError as error:
        reason = str(error)
        if error.errno:
            reason = os.strerror(error.errno)
        raise ComputationError(
            f"{folder}: the results can't be put together: {reason}; see to the disk, then go on "
            "with --resume"
        ) from None


def _workers(
    folder: Path,
    sweep: Sweep,
    number: int,
    scheduler: str | None,
    modes_progress: Callable[[float], None] | None,
    tell: Tell | None,
) -> Workers:
    """Return a function that starts workers.

    Each receives the modes of the first point once, wherever it runs.
    """
    from threadpoolctl import threadpool_limits  # imported late: it inspects all loaded libraries

    entries = {}
    if sweep.deforms and number:
        with threadpool_limits(1):  # as the workers compute them
            entries = carried_modes(sweep.case, modes_progress, tell)
    setup = partial(receive, entries)
    if scheduler is not None:
        return partial(dask_workers, scheduler, number, setup)
    if number <= 1:
        return this_process
    return partial(processes, number, setup, folder / FOLDER)


def _facts(sweep: Sweep) -> dict[str, str]:
    return {"digest": sweep.digest, "version": __version__, "numpy": np.__version__}


def least_memory(sweep: Sweep) -> float:
    """Return the least useful memory per chunk [bytes].

    With less, the overhead of chunks lengthens the study by more than a third.

    Parameters
    ----------
    sweep : Sweep
        The study.
    """
    if sweep.deforms:
        useful_drops = _USEFUL_ELASTIC_DROPS
    else:
        useful_drops = math.ceil(_USEFUL_IMPACTS / (impact_limit(sweep.case) or LONG))
    drops = min(useful_drops, math.ceil(sweep.size / _FEW_CHUNKS))
    return max(LEAST_MEMORY, drops * _drop_memory(sweep))


def _check_memory(sweep: Sweep, memory: float) -> None:
    """Check that the memory per chunk is not so small that the overhead of chunks dominates."""
    least = least_memory(sweep)
    if memory < least:
        size = chunk_size(sweep, memory)
        raise InputError(
            f"{memory / 1e6:.10g} MB is too little for {sweep.size:,} drops: computed "
            f"{size:,} at a time they take over a third longer; "
            f"give {math.ceil(least / 1e6)} MB or more",
            "memory",
        )


def _drop_memory(sweep: Sweep) -> float:
    """Return the memory of one drop of a chunk [bytes]."""
    return _DROP_MEMORY + _COPIES * sweep.bytes / sweep.size


def chunk_size(sweep: Sweep, memory: float) -> int:
    """Return the number of drops per chunk, which does not depend on the number of workers.

    It is smaller if memory is short.

    Parameters
    ----------
    sweep : Sweep
        The study.
    memory : float
        Memory for the drops of a chunk [bytes].
    """
    most = _CHUNK
    if sweep.deforms:
        falls_per_plate = 1
        if sweep.population is not None:
            falls_per_plate = sweep.population.falls_per_plate
        most = max(_ELASTIC_CHUNK, min(falls_per_plate, sweep.size // _PLATE_CHUNKS))
    return max(1, min(most, int(memory / _drop_memory(sweep))))
