"""Runs independent computations on a few threads, with progress; scikit-learn releases the interpreter while it computes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from threadpoolctl import threadpool_limits

Done = TypeVar("Done")
Progress = Callable[[str, int, int], None]
"""Called with what is done, how many parts of it are done, and how many there are."""


def silent(what: str, done: int, total: int) -> None:
    """Tell nothing."""


def run_jobs(what: str, jobs: Sequence[Callable[[], Done]], workers: int, progress: Progress) -> list[Done]:
    """Run functions and return their results in order.

    Parameters
    ----------
    what : str
        What they compute, for progress.
    jobs : sequence of callable
        The functions.
    workers : int
        Number of threads.
    progress : callable
        Called after each; what it raises ends the rest.
    """
    found: list[Done] = []
    progress(what, 0, len(jobs))
    with threadpool_limits(1), ThreadPoolExecutor(workers) as pool:
        try:
            for one in pool.map(lambda job: job(), jobs):
                found.append(one)
                progress(what, len(found), len(jobs))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return found
