"""Calibration of the paper's five impacts, of a range of 200 speeds, and others: CPU time on one
core.

Asked: the five impacts within 1 s, 200 speeds within 5 s.
"""

from __future__ import annotations

import os

# before NumPy is loaded: small matrices gain nothing from threads
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
from collections.abc import Callable

import numpy as np

import vibroimpact as vi

MODEL, THEORY = vi.load_case("paper:type1-constant"), vi.load_case("paper:type1-theory")
HEIGHTS = {"rebound_heights": [2.411, 1.457, 0.885, 0.541], "standard_deviation": 0.002}


def cpu_seconds(call: Callable[[], object], repeats: int = 5) -> float:
    """Return the median CPU time of a call [s]."""
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        call()
        times.append(time.process_time() - begin)
    return float(np.median(times))


def measured(**more: object) -> object:
    """Calibrate to measured heights."""
    table = {
        "sphere": {"radius": 0.025, "material": "rock-paper"},
        "plate": {"material": "steel-paper"},
        "drop": {"height": 4.0, "gravity": 9.8},
        "contact": {"law": "adams-impact"},
        "calibrate": {"target": HEIGHTS, "degree": 1, **more},
    }
    return vi.calibration.calibrate_case(vi.calibration.calibration_of(table))


def main() -> None:
    """Print a row each."""
    vi.calibration.calibrate(MODEL, THEORY)  # imports
    rows = {
        "the paper's five impacts": lambda: vi.calibration.calibrate(MODEL, THEORY),
        "200 speeds from 0.5 to 10 m/s": lambda: vi.calibration.calibrate(
            MODEL, THEORY, speeds=np.linspace(0.5, 10.0, 200)
        ),
        "rebound and force, weighted": lambda: vi.calibration.calibrate(
            MODEL, THEORY, weights={"separation_speed": 1.0, "max_force": 0.5}
        ),
        "four measured heights": measured,
        "four measured heights, 400 draws": lambda: measured(bootstrap=400),
    }
    one = cpu_seconds(lambda: vi.simulate(MODEL))
    print(f"calibration, CPU time on one core; one run of five impacts takes {1e3 * one:.0f} ms")
    for name, call in rows.items():
        seconds = cpu_seconds(call)
        print(f"  {name:34} {seconds:7.3f} s   {seconds / one:6.0f} runs")


if __name__ == "__main__":
    main()
