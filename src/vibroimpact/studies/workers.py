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
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any, NamedTuple

from vibroimpact.errors import ComputationError

Setup = Callable[[], object]
"""What a worker does once before its first chunk; it is pickled."""


class Crew(NamedTuple):
    """Workers that are there: what gives them work, and a function that says how many chunks may be on the way, so that none waits."""

    executor: Executor
    in_flight: Callable[[], int]


Workers = Callable[[], AbstractContextManager[Crew]]
"""Starts workers, and ends them when the context does."""


class _AtOnce(Executor):
    """An executor that does its work when it is given it."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


@contextmanager
def this_process() -> Iterator[Crew]:
    """Compute in this process, which has what `Setup` would bring."""
    yield Crew(_AtOnce(), lambda: 1)


class _ByFile(Executor):
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


@contextmanager
def processes(number: int, setup: Setup, folder: Path) -> Iterator[Crew]:
    """Compute in `number` processes of this machine, which leave their results in a folder until they are taken."""
    # spawned, not forked: a fork would copy locks that threads of this process hold
    pool = ProcessPoolExecutor(number, multiprocessing.get_context("spawn"), initializer=_begin, initargs=(setup,))
    try:
        with _interrupts_ignored():  # by the processes that start now, from their first instruction on
            pool.submit(int)
        yield Crew(_ByFile(pool, folder), lambda: 2 * number)
    finally:
        pool.shutdown(cancel_futures=True)  # each ends after the chunk that it is at, or with this process


@contextmanager
def _interrupts_ignored() -> Iterator[None]:
    """Let processes that start now take no notice of Ctrl-C, which is for the one that leads."""
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread may say so
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


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
