"""CPU time, for the scripts beside it."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable


def cpu_ms(work: Callable[[], object], runs: int = 15) -> float:
    """Median CPU time of `work` in this process [ms], after a warm-up."""
    work()
    times = []
    for _ in range(runs):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return 1e3 * statistics.median(times)
