"""Runs independent computations in a few processes, with progress.

In threads they would disturb each other: scikit-learn sets the filters of warnings, which all
threads share.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from threadpoolctl import threadpool_limits

from vibroimpact.recognition.extra import needs_extra

Done = TypeVar("Done")
Progress = Callable[[str, int, int], None]
"""Called with what is done, how many parts of it are done, and how many there are."""


def silent(what: str, done: int, total: int) -> None:
    """Tell nothing."""


def run_jobs(
    what: str, jobs: Sequence[Callable[[], Done]], workers: int, progress: Progress
) -> list[Done]:
    """Run functions and return their results in order.

    Parameters
    ----------
    what : str
        What they compute, for progress.
    jobs : sequence of callable
        The functions.
    workers : int
        Number of processes; with 1 they run in this one.
    progress : callable
        Called after each; what it raises ends the rest.
    """
    with needs_extra():
        from joblib import Parallel, delayed
    results: list[Done] = []
    progress(what, 0, len(jobs))
    with threadpool_limits(1):
        for result in Parallel(workers, return_as="generator")(delayed(job)() for job in jobs):
            results.append(result)
            progress(what, len(results), len(jobs))
    return results
