"""Run a study in its folder, from the first chunk to the report, or on from where it stopped."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from functools import partial
from os import PathLike
from pathlib import Path

from vibroimpact._version import __version__
from vibroimpact.cases.build import deforms
from vibroimpact.cases.compute_points import compute_points
from vibroimpact.cases.coupling import carried_modes
from vibroimpact.cases.sweep import Sweep
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.report.study.page import write_study_report
from vibroimpact.storage.folder import SUMMARY, new_folder
from vibroimpact.storage.study import DATASET, read_study
from vibroimpact.storage.study_dataset import write_dataset
from vibroimpact.storage.study_table import MOST_ROWS, write_drops
from vibroimpact.storage.study_toml import study_toml
from vibroimpact.structures.store import receive
from vibroimpact.studies.chunk_file import FOLDER, ChunkResult, checksum, read_chunk, write_chunk
from vibroimpact.studies.columns import OUTCOME
from vibroimpact.studies.dask_workers import check_scheduler, dask_workers
from vibroimpact.studies.ledger import LEDGER, Ledger, Span, is_held, make_ledger, open_ledger
from vibroimpact.studies.run_chunks import Points, run_chunks
from vibroimpact.studies.workers import Workers, processes, this_process

STUDY = "study.toml"

MEMORY = 500e6
"""Bytes that one process may use for a chunk, where nothing else is said."""

_CHUNK = 8000  # drops of rigid bodies: a tenth of a second
_ELASTIC_CHUNK = 8  # drops of elastic ones: about as long
_PER_DROP = 40_000  # bytes that a drop of rigid bodies takes while it is computed, measured


def run_sweep(
    sweep: Sweep,
    directory: str | PathLike[str],
    *,
    resume: bool = False,
    force: bool = False,
    workers: int = 1,
    scheduler: str | None = None,
    memory: float = MEMORY,
    progress: Callable[[int, int], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> Path:
    """Run a study in a folder: `study.nc`, `drops.csv`, a report, and the ledger of its chunks.

    Each chunk of drops is written as soon as it is computed. Whatever stops the run, `resume` goes on after the last of them, and the
    results are the same to the last bit.

    Parameters
    ----------
    sweep : Sweep
        The study, as `load_sweep` or `read_sweep` reads it.
    directory : path
        The folder to make.
    resume : bool, default False
        Go on with the study that was begun there.
    force : bool, default False
        Replace the folder of a study that is there.
    workers : int, default 1
        How many processes compute; one is this process itself. A script that asks for more must do its work under
        `if __name__ == "__main__":`.
    scheduler : str, optional
        The address of a Dask scheduler whose workers compute, such as "tcp://10.0.0.5:8786"; "local" starts one with `workers`.
    memory : float, default 5e8
        Bytes that each process may use for a chunk; it sets how large chunks are, and what a study was begun with is kept.
    progress : callable, optional
        Is told how many drops are done, and of how many.
    tell : callable, optional
        Is told in words what takes long, or is made again.

    Returns
    -------
    pathlib.Path
        The folder.

    Raises
    ------
    InputError
        If something else is there, another sweep is at work in it, the ledger is damaged, or it is of another study.
    ComputationError
        If the disk is full, or the workers are gone.
    """
    folder = Path(directory)
    if scheduler is not None:
        check_scheduler(scheduler)
    if resume:
        _check_begun(folder, sweep, memory)
    else:
        _begin(folder, sweep, memory, force=force)
    with open_ledger(folder) as ledger:
        _check_same(ledger, folder, sweep)
        if not (folder / DATASET).is_file():
            _forget_damaged(ledger, folder, tell)
            _run(ledger, folder, sweep, _workers(sweep, min(workers, len(ledger.chunks("waiting"))), scheduler), progress)
            _assemble(folder, ledger.chunks("done"), sweep)
    write_study_report(read_study(folder), folder)
    return folder


def is_study(folder: Path) -> bool:
    """Was a study begun in a folder?"""
    return (folder / STUDY).is_file() or (folder / LEDGER).is_file()


def _begin(folder: Path, sweep: Sweep, memory: float, *, force: bool) -> None:
    """Make the folder of a study of which nothing is computed."""
    if is_held(folder):
        raise InputError(f"{folder}: another sweep is at work in this folder; wait for it, or name another folder")
    if is_study(folder) and not force:
        raise InputError(f"{folder}: a study is there already; go on with it by --resume, replace it by --force, or name another folder")
    with new_folder(folder, force=force) as working:
        (working / STUDY).write_text(study_toml(sweep.whole_table), encoding="utf-8")
        (working / FOLDER).mkdir()
        make_ledger(working, _facts(sweep), sweep.size, _chunk_size(sweep, memory))
        summary = {"name": _name(sweep), "version": __version__, "study": {"design": sweep.section.design, "drops": sweep.size}}
        (working / SUMMARY).write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")


def _check_begun(folder: Path, sweep: Sweep, memory: float) -> None:
    """Raise unless a study was begun in a folder; make its ledger anew if that alone is missing."""
    if not is_study(folder):
        raise InputError(f"{folder}: no study was begun in this folder; leave out --resume to begin one")
    if (folder / LEDGER).is_file():
        return
    make_ledger(folder, _facts(sweep), sweep.size, _chunk_size(sweep, memory))
    with open_ledger(folder) as ledger:
        for chunk in ledger.chunks("waiting"):
            try:
                found = read_chunk(folder, chunk.number, sweep.digest)
            except (OSError, KeyError, ValueError):
                continue
            if len(found.arrays.get(OUTCOME, ())) == chunk.size:
                ledger.done(chunk, checksum(folder, chunk.number) or "", len(found.failures), 0.0)


def _check_same(ledger: Ledger, folder: Path, sweep: Sweep) -> None:
    """Raise unless a ledger is that of a study, begun by this version."""
    facts = ledger.facts
    if facts.get("version") != __version__:
        words = f"this study was begun by vibroimpact {facts.get('version')}, and this is {__version__}"
        raise InputError(f"{folder}: {words}; go on with that version, or begin anew with --force")
    if facts.get("digest") != sweep.digest:
        words = "the study has changed since it was begun here: its case, its points or what is kept"
        raise InputError(f"{folder}: {words}; {STUDY} in it is what was begun; begin anew with --force, or in another folder")


def _forget_damaged(ledger: Ledger, folder: Path, tell: Callable[[str], None] | None) -> None:
    """Have chunks computed again that are not on disk as they were written."""
    for number, expected in ledger.checksums().items():
        if checksum(folder, number) != expected:
            ledger.undone(number)
            if tell is not None:
                tell(f"chunk {number} is not on disk as it was written; it is computed again")


def _run(ledger: Ledger, folder: Path, sweep: Sweep, workers: Workers, progress: Callable[[int, int], None] | None) -> None:
    """Compute the chunks that wait."""
    waiting = ledger.chunks("waiting")
    done = sweep.size - sum(chunk.size for chunk in waiting)
    if progress is not None:
        progress(done, sweep.size)

    def keep(chunk: Span, result: ChunkResult) -> None:
        nonlocal done
        ledger.done(chunk, write_chunk(folder, chunk.number, result, sweep.digest), len(result.failures), result.cpu)
        done += chunk.size
        if progress is not None:
            progress(done, sweep.size)

    def points(chunk: Span) -> Points:
        return sweep.plan.points(chunk.first, chunk.size)

    run_chunks(partial(compute_points, sweep.table, sweep.section.keep), points, waiting, workers, keep)


def _assemble(folder: Path, chunks: list[Span], sweep: Sweep) -> None:
    """Put the chunks together."""
    rates = {sensor.name: sensor.rate for sensor in sweep.case.sensors}
    try:
        if sweep.size <= MOST_ROWS:
            write_drops(folder, chunks, sweep.plan, sweep.meanings)
        write_dataset(folder, _name(sweep), chunks, sweep.plan, sweep.whole_table, sweep.meanings, rates)
        shutil.rmtree(folder / FOLDER, ignore_errors=True)
    except OSError as error:
        for part in folder.glob("*.part"):
            part.unlink()
        words = f"the results can't be put together: {error.strerror or error}; see to the disk, then go on with --resume"
        raise ComputationError(f"{folder}: {words}") from None


def _workers(sweep: Sweep, number: int, scheduler: str | None) -> Workers:
    """Return what starts workers; each gets the modes of elastic bodies once, so that it finds them wherever it runs."""
    setup = partial(receive, carried_modes(sweep.case) if deforms(sweep.case) else {})
    if scheduler is not None:
        return partial(dask_workers, scheduler, number, setup)
    return this_process if number <= 1 else partial(processes, number, setup)


def _facts(sweep: Sweep) -> dict[str, str]:
    return {"digest": sweep.digest, "version": __version__, "drops": str(sweep.size)}


def _chunk_size(sweep: Sweep, memory: float) -> int:
    """Return how many drops a chunk has: fewer if memory is short, and the same however many workers there are."""
    return _ELASTIC_CHUNK if deforms(sweep.case) else max(1, min(_CHUNK, int(memory / _PER_DROP)))


def _name(sweep: Sweep) -> str:
    return sweep.case.name or "a study of drops"
