"""Where chunks are computed: in this process, in processes of this machine, or (`dask_workers`) by those of a Dask scheduler."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from multiprocessing import resource_tracker
from multiprocessing.context import SpawnContext, SpawnProcess
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any, NamedTuple

from vibroimpact.errors import ComputationError

Setup = Callable[[], object]
"""What a worker does once before its first chunk; it is pickled."""


class WorkerPool(NamedTuple):
    """Workers that are there: what gives them work, and a function that says how many chunks may be on the way, so that none waits."""

    executor: Executor
    in_flight: Callable[[], int]


Workers = Callable[[], AbstractContextManager[WorkerPool]]
"""Starts workers, and ends them when the context does."""


class _SynchronousExecutor(Executor):
    """An executor that does its work when it is given it."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


@contextmanager
def this_process() -> Iterator[WorkerPool]:
    """Compute in this process, which has what `Setup` would bring."""
    yield WorkerPool(_SynchronousExecutor(), lambda: 1)


class _FileExecutor(Executor):
    """An executor whose results come by files: a worker that is killed while it sends much would leave its leader waiting for the rest."""

    def __init__(self, pool: Executor, folder: Path) -> None:
        self.pool, self.folder = pool, folder

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        result: Future[Any] = Future()
        self.pool.submit(_to_file, self.folder, fn, args, kwargs).add_done_callback(partial(_from_file, result))
        return result


def _to_file(folder: Path, fn: Callable[..., Any], args: Any, kwargs: Any) -> Path:
    """Write what comes of a call to a file of its own, in a worker."""
    result = fn(*args, **kwargs)
    try:
        with NamedTemporaryFile(dir=folder, prefix="result-", delete=False) as file:
            pickle.dump(result, file)
    except OSError as error:
        Path(file.name).unlink(missing_ok=True)
        words = "see to the disk, then go on with --resume; the chunks that are done stay"
        raise ComputationError(f"{folder}: what was computed can't be written: {error.strerror}; {words}") from None
    return Path(file.name)


def _from_file(result: Future[Any], written: Future[Path]) -> None:
    """Hand on what a worker wrote, or why it did not."""
    try:
        path = written.result()
        result.set_result(pickle.loads(path.read_bytes()))
        path.unlink()
    except BaseException as error:
        result.set_exception(error)


class _InterruptImmuneProcess(SpawnProcess):
    """A process that takes no notice of Ctrl-C from its first instruction on: that is for the one that leads."""

    def start(self) -> None:
        """Start it, while this thread lets interrupts wait: it inherits that, and what has waited here comes up at the end."""
        if not hasattr(signal, "pthread_sigmask"):  # Windows
            super().start()
            return
        resource_tracker.ensure_running()  # which has interrupts come up when it starts
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            super().start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


class _InterruptImmuneContext(SpawnContext):
    """Starts processes that take no notice of Ctrl-C, whenever an executor starts them; spawned, for a fork would copy locks of threads."""

    Process = _InterruptImmuneProcess


@contextmanager
def processes(number: int, setup: Setup, folder: Path) -> Iterator[WorkerPool]:
    """Compute in `number` processes of this machine, which leave their results in a folder until they are taken."""
    pool = ProcessPoolExecutor(number, _InterruptImmuneContext(), initializer=_begin, initargs=(setup,))
    try:
        yield WorkerPool(_FileExecutor(pool, folder), lambda: 2 * number)
    finally:
        pool.shutdown(cancel_futures=True)  # each ends after the chunk that it is at, or with this process


def _begin(setup: Setup) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    setup()


def _end_with_parent() -> None:
    """End this process when the one that leads is gone, even if it was killed: nobody would give it work, or end it."""
    parent = multiprocessing.parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)
