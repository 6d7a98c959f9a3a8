"""Studies from the file to the report: time, memory, two processes beside one, Dask beside
processes.

Medians and ratios of one run; the machine may be shared and noisy. Times of the chunks are
wall-clock times, with workers that have begun; what comes after the chunks, putting together and
drawing, is one process' work and told apart.

    python benchmarks/bench_sweep.py [million]     "million" adds a study of a million drops
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is loaded

import resource
import statistics
import sys
import tempfile
import time
from functools import partial
from pathlib import Path
from typing import Any

import vibroimpact as vi
from vibroimpact.cases.elastic.coupling import carried_modes
from vibroimpact.structures.store import receive
from vibroimpact.studies.computation.compute_points import compute_points
from vibroimpact.studies.computation.dask_workers import dask_workers
from vibroimpact.studies.computation.ledger import Span
from vibroimpact.studies.computation.run_chunks import run_chunks
from vibroimpact.studies.computation.workers import Workers, processes, this_process

ROCK = {"density": 1380, "youngs_modulus": "2.26 GPa", "poissons_ratio": 0.28}
RIGID: dict[str, Any] = {
    "sphere": {"radius": "25 mm", "material": ROCK},
    "plate": {"material": "steel-paper"},
    "drop": {"height": "2 m"},
    "contact": {"law": "lankarani-nikravesh", "restitution": 0.7},
    "run": {"impacts": 5, "tolerance": 1e-8},
}
OVER: dict[str, Any] = {
    "sphere.radius": {"from": "5 mm", "to": "50 mm"},
    "sphere.material.youngs_modulus": {"from": "0.1 GPa", "to": "100 GPa", "scale": "log"},
    "contact.restitution": {"from": 0.3, "to": 1.0},
    "drop.height": {"from": "0.2 m", "to": "5 m"},
}
SPOTS = {"a1": [0.1, 0.05], "a2": [-0.1, 0.05], "a3": [-0.1, -0.05], "a4": [0.1, -0.05]}
ELASTIC: dict[str, Any] = {
    "sphere": {"radius": "25 mm", "material": ROCK},
    "plate": {
        "size": ["520 mm", "420 mm", "8 mm"],
        "material": "steel-paper",
        "model": "elastic",
        "modes": 100,
        "supports": {"type": "patches", "spacing": ["458.4 mm", "360 mm"], "radius": "20 mm"},
        "damping": 0.01,
    },
    "drop": {"speed": "4 m/s"},
    "contact": {"law": "lankarani-nikravesh", "restitution": 0.7},
    "run": {"duration": "50 ms"},
    "sensors": [{"name": name, "position": spot, "rate": "50 kHz"} for name, spot in SPOTS.items()],
}
OVER_ELASTIC: dict[str, Any] = {
    "drop.position.x": {"from": "-150 mm", "to": "150 mm"},
    "drop.position.y": {"from": "-100 mm", "to": "100 mm"},
    "sphere.radius": {"from": "10 mm", "to": "30 mm"},
    "sphere.material.youngs_modulus": {"from": "1 GPa", "to": "30 GPa", "scale": "log"},
    "contact.restitution": {"from": 0.4, "to": 0.9},
    "drop.speed": {"from": "1 m/s", "to": "6 m/s"},
}


def drawn(case: dict[str, Any], over: dict[str, Any], samples: int, *keep: str) -> vi.studies.Sweep:
    return vi.studies.sweep_of(
        {
            **case,
            "sweep": {
                "design": "latin-hypercube",
                "samples": samples,
                "over": over,
                "keep": ["impacts", *keep],
            },
        }
    )


def cpu_seconds() -> float:
    """CPU time of this process and of those that it had [s]."""
    return sum(
        used.ru_utime + used.ru_stime
        for used in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    )


def peak_mib() -> tuple[float, float]:
    """Largest memory of this process, and of any that it had [MiB]."""
    own, others = (
        resource.getrusage(who).ru_maxrss / 1024
        for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    )
    return own, others


def whole(name: str, sweep: vi.studies.Sweep, workers: int) -> None:
    """Run a study into a folder, and say what it took."""
    begin, cpu, done_at = time.perf_counter(), cpu_seconds(), 0.0

    def progress(done: int, total: int) -> None:
        nonlocal done_at
        if done == total:
            done_at = time.perf_counter() - begin

    with tempfile.TemporaryDirectory() as folder:
        path = vi.studies.run_sweep(
            sweep, Path(folder, "study"), workers=workers, progress=progress
        )
        size = sum(file.stat().st_size for file in path.rglob("*") if file.is_file()) / 2**20
    own, others = peak_mib()
    took = time.perf_counter() - begin
    print(
        f"{name}, {workers} process{'es' if workers > 1 else ''}: drops {done_at:.1f} s, "
        f"with dataset, table and report {took:.1f} s, "
        f"CPU {cpu_seconds() - cpu:.1f} s, {size:.0f} MiB on disk; memory so far {own:.0f} "
        f"MiB, of workers {others:.0f} MiB",
        flush=True,
    )


def seconds_of(start: Workers, sweep: vi.studies.Sweep, chunk: int) -> float:
    """Wall-clock time of the chunks of a study [s], from those after the first quarter:
    then all workers have begun.
    """
    chunks = [
        Span(number, first, chunk) for number, first in enumerate(range(0, sweep.size, chunk))
    ]
    quarter = len(chunks) // 4
    ends: list[float] = []

    def points(span: Span) -> Any:
        return sweep.plan.points(span.first, span.size)

    def keep(span: Span, result: Any) -> None:
        ends.append(time.perf_counter())

    run_chunks(
        partial(compute_points, sweep.table, sweep.section.keep), points, chunks, start, keep
    )
    return (ends[-1] - ends[quarter - 1]) / (len(chunks) - quarter) * len(chunks)


def scaling(name: str, sweep: vi.studies.Sweep, chunk: int, entries: dict[str, bytes]) -> None:
    """Print one process, two, and a Dask cluster of two, three times each."""
    setup = partial(receive, entries)
    ways: dict[str, Workers] = {
        "one process": this_process,
        "two processes": partial(processes, 2, setup, Path(tempfile.gettempdir())),
        "Dask, two workers": partial(dask_workers, "local", 2, setup),
    }
    times = {
        way: [seconds_of(start, sweep, chunk) for _ in range(3)] for way, start in ways.items()
    }
    one, two, dask = (statistics.median(values) for values in times.values())
    told = ", ".join(f"{way} {statistics.median(values):.1f} s" for way, values in times.items())
    print(
        f"{name}: {told}; two are {one / two:.2f} times as fast as one, Dask takes "
        f"{dask / two:.2f} of the time of processes",
        flush=True,
    )


def main() -> None:
    whole("100,000 rigid drops", drawn(RIGID, OVER, 100_000), 1)
    whole(
        "1,000 drops on an elastic plate, 100 modes, four sensors",
        drawn(ELASTIC, OVER_ELASTIC, 1000, "signals"),
        2,
    )
    scaling("480,000 rigid drops, chunks of 8,000", drawn(RIGID, OVER, 480_000), 8000, {})
    elastic = drawn(ELASTIC, OVER_ELASTIC, 320, "signals")
    scaling("320 drops on an elastic plate, chunks of 16", elastic, 16, carried_modes(elastic.case))
    if "million" in sys.argv:
        whole("1,000,000 rigid drops", drawn(RIGID, OVER, 1_000_000), 2)


if __name__ == "__main__":
    main()
