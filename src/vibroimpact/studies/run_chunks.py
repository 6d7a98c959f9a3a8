"""Have chunks computed, as many at a time as there are workers, and lose none to a worker that dies."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait

from vibroimpact.errors import ComputationError
from vibroimpact.studies.axes import Values
from vibroimpact.studies.chunk_file import ChunkResult
from vibroimpact.studies.ledger import Span
from vibroimpact.studies.workers import Workers

Points = Mapping[str, Values]
"""The values of some drops by the swept keys."""

_DEATHS = 2  # of the worker, with a chunk alone on it, before the chunk is given up


def run_chunks(
    work: Callable[[int, Points], ChunkResult],
    points: Callable[[Span], Points],
    chunks: Iterable[Span],
    start: Workers,
    keep: Callable[[Span, ChunkResult], None],
) -> None:
    """Compute chunks and hand each on as soon as it is there, in whatever order.

    If a worker dies, the chunks that were on the way are computed again, one at a time. One that is alone then and ends its worker
    again is given up: each of its drops failed, and the rest go on.

    Parameters
    ----------
    work : callable
        Takes the number of the first drop of a chunk and the points of all, returns what came of them; it is pickled.
    points : callable
        Returns the points of a chunk.
    chunks : iterable of Span
        What is to be done.
    start : callable
        Starts workers.
    keep : callable
        Is given each chunk with what came of it.

    Raises
    ------
    ComputationError
        If the workers are gone for good.
    """
    waiting, suspects, deaths = deque(chunks), deque[Span](), Counter[int]()
    while waiting or suspects:
        running: dict[Future[ChunkResult], Span] = {}
        try:
            with start() as (executor, in_flight):
                _check_alive(executor)
                while waiting or suspects or running:
                    source, most = (suspects, 1) if suspects else (waiting, in_flight())
                    while source and len(running) < most:
                        running[executor.submit(work, source[0].first, points(source[0]))] = source[0]
                        source.popleft()  # not before: a worker may have died while the last chunk was kept
                    for future in wait(running, return_when=FIRST_COMPLETED).done:
                        keep(running[future], _result(future, running[future]))
                        del running[future]
        except BrokenExecutor:
            lost = sorted(running.values())
            if len(lost) == 1:
                alone = lost[0]
                deaths[alone.number] += 1
                if deaths[alone.number] >= _DEATHS:
                    keep(alone, _given_up(alone))
                    continue
            suspects.extend(lost)
        except CancelledError:
            raise ComputationError("the scheduler and its workers are gone; what is done stays: go on with --resume") from None


def _check_alive(executor: Executor) -> None:
    """Raise if not even nothing can be computed: then no chunk is to blame."""
    try:
        executor.submit(int).result()
    except BrokenExecutor:
        words = 'a script that starts processes must do its work under: if __name__ == "__main__":'
        raise ComputationError(f"the processes die before they have computed anything; {words}") from None


def _result(future: Future[ChunkResult], chunk: Span) -> ChunkResult:
    """Return what came of a chunk; Dask itself gives up one that ended worker after worker."""
    try:
        return future.result()
    except BrokenExecutor:
        raise
    except Exception as error:
        if type(error).__name__ == "KilledWorker":
            return _given_up(chunk)
        raise


def _given_up(chunk: Span) -> ChunkResult:
    reason = "the process that computed it died, again and again; it may have run out of memory"
    return ChunkResult({}, dict.fromkeys(range(chunk.size), reason))
