"""The paper reproduced: CPU and wall time of the whole command, with an empty store of modes and
with a full one.

Asked are 3 minutes of CPU without stored modes, and 60 s with them.

    python benchmarks/bench_reproduce.py
"""

from __future__ import annotations

import os

# before NumPy is loaded: small matrices gain nothing from threads
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def run(folder: Path, store: Path) -> tuple[float, float]:
    """CPU and wall time [s] of `vibroimpact reproduce`."""
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    command = [sys.executable, "-m", "vibroimpact", "reproduce", "-o", str(folder)]
    subprocess.run(
        command,
        check=True,
        capture_output=True,
        env={**os.environ, "VIBROIMPACT_STORE": str(store)},
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (
        after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
        time.perf_counter() - begin,
    )


def main() -> None:
    with tempfile.TemporaryDirectory() as working:
        for name in ("empty", "full"):
            cpu, wall = run(Path(working) / name, Path(working) / "store")
            print(f"{name:5} store of modes: {cpu:5.1f} s of CPU, {wall:5.1f} s of wall time")


if __name__ == "__main__":
    main()
