"""Workers that compute chunks: this process, or processes of this machine.

For those of a Dask scheduler see `dask_workers`.
"""

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
"""Called once in each worker before its first chunk; it must be picklable."""


class WorkerPool(NamedTuple):
    """Running workers.

    Attributes
    ----------
    executor : Executor
        Their executor.
    in_flight : callable
        Returns the number of chunks to keep in flight so that no worker is idle.
    """

    executor: Executor
    in_flight: Callable[[], int]


Workers = Callable[[], AbstractContextManager[WorkerPool]]
"""Context manager that starts workers and ends them on exit."""


class _SynchronousExecutor(Executor):
    """An executor that computes synchronously on submission."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


@contextmanager
def this_process() -> Iterator[WorkerPool]:
    """Provide this process as the only worker; it needs no setup."""
    yield WorkerPool(_SynchronousExecutor(), lambda: 1)


class _FileExecutor(Executor):
    """An executor that transfers results by files.

    A worker killed while sending through a pipe would block the parent process.
    """

    def __init__(self, pool: Executor, folder: Path) -> None:
        self.pool = pool
        self.folder = folder

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        result: Future[Any] = Future()
        written = self.pool.submit(_to_file, self.folder, fn, args, kwargs)
        written.add_done_callback(partial(_from_file, result))
        return result


def _to_file(folder: Path, fn: Callable[..., Any], args: Any, kwargs: Any) -> Path:
    """Write the result of a call, in a worker, to a new file, and return its path."""
    result = fn(*args, **kwargs)
    path = folder
    try:
        with NamedTemporaryFile(dir=folder, prefix="result-", delete=False) as file:
            path = Path(file.name)
            pickle.dump(result, file)
    except OSError as error:
        if path is not folder:
            path.unlink(missing_ok=True)
        remedy = "see to the disk, then go on with --resume; the chunks that are done stay"
        raise ComputationError(
            f"{folder}: what was computed can't be written: {error.strerror}; {remedy}"
        ) from None
    return path


def _from_file(result: Future[Any], written: Future[Path]) -> None:
    """Set the result of a future from the file that a worker wrote, or its exception."""
    try:
        path = written.result()
        result.set_result(pickle.loads(path.read_bytes()))
        path.unlink()
    except BaseException as error:
        result.set_exception(error)


class _InterruptImmuneProcess(SpawnProcess):
    """A process that ignores Ctrl-C from its first instruction on; its parent handles it."""

    def start(self) -> None:
        """Start the process with SIGINT blocked in this thread, which the child inherits.

        A pending signal is delivered afterwards.
        """
        if not hasattr(signal, "pthread_sigmask"):  # Windows
            super().start()
            return
        resource_tracker.ensure_running()  # it unblocks signals when it starts, so start it before
        previous_mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            super().start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, previous_mask)


class _InterruptImmuneContext(SpawnContext):
    """Context of processes that ignore Ctrl-C, whenever an executor starts them.

    They are spawned, as a fork would copy held locks of threads.
    """

    Process = _InterruptImmuneProcess


@contextmanager
def processes(number: int, setup: Setup, folder: Path) -> Iterator[WorkerPool]:
    """Provide processes of this machine, which pass their results through files in a folder."""
    pool = ProcessPoolExecutor(
        number, _InterruptImmuneContext(), initializer=_begin, initargs=(setup,)
    )
    try:
        yield WorkerPool(_FileExecutor(pool, folder), lambda: 2 * number)
    finally:
        # each ends after its current chunk, or with this process
        pool.shutdown(cancel_futures=True)


def _begin(setup: Setup) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    setup()


def _end_with_parent() -> None:
    """End this process when its parent has ended, even if the parent was killed."""
    parent = multiprocessing.parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)
