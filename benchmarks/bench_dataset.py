"""Falls of the shipped populations on elastic plates: CPU time of a fall, beside the least work
that its numbers need.

The median of several plates, in one process; the machine may be shared and noisy. The least work
counts, in double precision, what no way around is known for: every mode in every sample that is
kept (two flops), and in every sample of the finer rate at which the range of an accelerometer is
followed while the sphere touches.

    OPENBLAS_NUM_THREADS=1 python benchmarks/bench_dataset.py [falls on each plate]
"""

from __future__ import annotations

import os

# before NumPy is loaded: small matrices gain nothing from threads
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import resource
import statistics
import sys
import tempfile
import time

import numpy as np

import vibroimpact as vi
from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.dynamics.sensors.overload import finer_rate
from vibroimpact.structures.recipe import modal_model_of
from vibroimpact.structures.static_compliance import static_compliance
from vibroimpact.studies.computation.compute_points import compute_points

PLATES = 3
"""Plates of each study."""


def processor_time() -> float:
    """Return the user processor time of this process [s]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_utime


def flops_per_second() -> float:
    """Return what a matrix of 1000 samples times a vector of 200 modes reaches."""
    matrix, vector, repeats = np.ones((1000, 200)), np.ones(200), 1000
    begun = processor_time()
    for _ in range(repeats):
        matrix @ vector
    return 2.0 * matrix.size * repeats / (processor_time() - begun)


def least_flops(case: vi.Case, duration: float, window: float) -> tuple[float, float]:
    """Return the flops of the samples that are kept, and of those at the finer rate
    during a contact of some duration [s].
    """
    modes = int(case.plate.modes or 0)
    kept = sum(2.0 * modes * sensor.rate * window for sensor in case.sensors)
    fine = 0.0
    for sensor in case.sensors:
        meter = sensor.accelerometer
        if meter is not None and meter.range is not None:
            fine += 2.0 * modes * finer_rate(sensor.rate, meter.resonance) * duration
    return kept, fine


def main() -> None:
    rate, count = flops_per_second(), int(sys.argv[1]) if len(sys.argv) > 1 else 64
    # empty: every plate is new
    os.environ["VIBROIMPACT_STORE"] = tempfile.mkdtemp(prefix="bench-dataset-")
    for name in ("signals:coal-gangue", "signals:river-plate"):
        sweep = vi.studies.load_sweep(name)
        assert sweep.population is not None
        assert sweep.window is not None
        on_a_plate = sweep.population.falls_per_plate
        once, each, durations = [], [], []
        for plate in range(PLATES):
            first = plate * on_a_plate
            begun = processor_time()
            recipe = elastic_bodies(sweep.case_of(first))["plate"].recipe
            modal_model_of(recipe)
            static_compliance(recipe, (0.0, 0.0))  # which factorises the plate
            once.append(processor_time() - begun)
            begun = processor_time()
            found = compute_points(
                sweep.table,
                sweep.section.keep,
                first,
                sweep.plan.points(first, count),
                sweep.window,
            )
            each.append((processor_time() - begun) / count)
            assert not found.failures
            durations.append(float(np.median(found.arrays["first_duration_s"])))
        fall, plate_time = statistics.median(each), statistics.median(once[1:])
        kept, fine = least_flops(
            sweep.case_of(0), statistics.median(durations), sweep.window.length
        )
        least, whole = (kept + fine) / rate, fall + plate_time / on_a_plate
        print(
            f"{name}: {1e3 * fall:.1f} ms of user CPU a fall (median of {PLATES} plates, "
            f"{count} falls on each)"
        )
        print(
            f"  and {plate_time:.2f} s a plate, of {on_a_plate} falls: {1e3 * whole:.1f} "
            "ms a fall in all"
        )
        print(f"  100,000 falls on two cores: {whole * 1e5 / 7200.0:.2f} h")
        print(
            f"  least work: {1e-6 * kept:.2f} Mflop for the samples kept, "
            f"{1e-6 * fine:.2f} for the contact at the finer rate,"
        )
        print(
            f"  {1e3 * least:.2f} ms at {1e-9 * rate:.1f} Gflop/s of a matrix times a "
            f"vector: a fall takes {fall / least:.0f} times that"
        )
    print(f"largest memory: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")


if __name__ == "__main__":
    begun = time.time()
    main()
    print(f"{time.time() - begun:.0f} s in all")
