"""Dispatch chunks to workers, and recover from workers that die."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)

from vibroimpact.errors import ComputationError
from vibroimpact.studies.computation.chunk_file import ChunkResult
from vibroimpact.studies.computation.ledger import Span
from vibroimpact.studies.computation.workers import Workers
from vibroimpact.studies.planning.axes import Values

Points = Mapping[str, Values]
"""The values of some drops by swept key."""

_DEATHS = 2  # deaths of a worker with a single chunk in flight after which the chunk is abandoned


def run_chunks(
    work: Callable[[int, Points], ChunkResult],
    points: Callable[[Span], Points],
    chunks: Iterable[Span],
    start: Workers,
    keep: Callable[[Span, ChunkResult], None],
) -> None:
    """Compute chunks, and pass each result on as soon as it is available, in any order.

    If a worker dies, the chunks in flight are computed again one at a time. A chunk that then kills
    its worker repeatedly is abandoned: all its drops count as failed, and the other chunks
    continue.

    Parameters
    ----------
    work : callable
        Takes the number of the first drop of a chunk and its points, returns their results; it must
        be picklable.
    points : callable
        Returns the points of a chunk.
    chunks : iterable of Span
        The chunks to compute.
    start : callable
        Starts workers.
    keep : callable
        Called with each chunk and its results.

    Raises
    ------
    ComputationError
        If the workers can't be started, or the scheduler is gone.
    """
    waiting = deque(chunks)
    suspects = deque[Span]()  # chunks that were in flight when a worker died
    deaths = Counter[int]()  # by the number of the chunk that a worker computed alone
    while waiting or suspects:
        running: dict[Future[ChunkResult], Span] = {}
        try:
            with start() as (executor, in_flight):
                _check_alive(executor)
                while waiting or suspects or running:
                    # suspects one at a time, to see which of them kills its worker
                    source = suspects or waiting
                    most = 1 if suspects else in_flight()
                    while source and len(running) < most:
                        chunk = source[0]
                        running[executor.submit(work, chunk.first, points(chunk))] = chunk
                        # only now: submit raises if a worker died while the last result was stored
                        source.popleft()
                    for future in wait(running, return_when=FIRST_COMPLETED).done:
                        keep(running[future], _result(future, running[future]))
                        del running[future]
        except BrokenExecutor:
            lost_chunks = sorted(running.values())
            if len(lost_chunks) == 1:
                chunk = lost_chunks[0]
                deaths[chunk.number] += 1
                if deaths[chunk.number] >= _DEATHS:
                    keep(chunk, _abandoned(chunk))
                    continue
            suspects.extend(lost_chunks)
        except CancelledError:
            raise ComputationError(
                "the scheduler and its workers are gone; what is done stays: go on with --resume"
            ) from None


def _check_alive(executor: Executor) -> None:
    """Check that a trivial task succeeds, so that later failures are due to a chunk."""
    try:
        executor.submit(int).result()
    except BrokenExecutor:
        raise ComputationError(
            "the processes die before they have computed anything; memory may be too short for "
            "them, or a script that starts them does not do its work under: "
            'if __name__ == "__main__":'
        ) from None


def _result(future: Future[ChunkResult], chunk: Span) -> ChunkResult:
    """Return the results of a chunk.

    Dask reports one that killed several workers by an exception of its own.
    """
    try:
        return future.result()
    except BrokenExecutor:
        raise
    except Exception as error:
        if type(error).__name__ == "KilledWorker":
            return _abandoned(chunk)
        raise


def _abandoned(chunk: Span) -> ChunkResult:
    """Return the results of a chunk whose drops all count as failed."""
    reason = "the process that computed it died, again and again; it may have run out of memory"
    return ChunkResult({}, dict.fromkeys(range(chunk.size), reason))
