"""What features cost: all of them, of 5,000 signals of 2,048 samples, and of 100,000 by
extrapolation; the dearest families apart.

python benchmarks/bench_features.py
"""

from __future__ import annotations

import time

import numpy as np

import vibroimpact as vi
from vibroimpact.signals.registry import families

SIGNALS, SAMPLES, RATE, WANTED = 5_000, 2_048, 50e3, 100_000


def ringing(random: np.random.Generator) -> np.ndarray:
    """Return impacts on a plate: twelve damped modes of random strengths, and noise of a
    hundredth.
    """
    since = np.arange(SAMPLES) / RATE
    modes = np.exp(-since * 2.0 * np.pi * np.geomspace(200.0, 9e3, 12)[:, None] * 0.02) * np.sin(
        2.0 * np.pi * np.geomspace(200.0, 9e3, 12)[:, None] * since
    )
    return random.standard_normal((SIGNALS, 12)) @ modes + 0.01 * random.standard_normal(
        (SIGNALS, SAMPLES)
    )


def seconds(signals: np.ndarray, names: list[str] | None = None) -> float:
    """Return the CPU time of a table [s]."""
    begin = time.process_time()
    vi.signals.feature_table(signals, RATE, names)
    return time.process_time() - begin


def main() -> None:
    random = np.random.default_rng(0)
    for what, signals in {
        "impacts that ring": ringing(random),
        "white noise": random.standard_normal((SIGNALS, SAMPLES)),
    }.items():
        whole = seconds(signals)
        print(
            f"{what}: {len(vi.signals.signal_features())} features of {SIGNALS:,} signals of {SAMPLES:,} "
            f"samples in {whole:.1f} s of CPU, "
            f"{1e3 * whole / SIGNALS:.2f} ms each; {WANTED:,} would take "
            f"{whole * WANTED / SIGNALS / 60.0:.1f} min on one core"
        )
        few = signals[:500]
        costs = {
            family.features[0].name: seconds(few, [one.name for one in family.features])
            for family in families()
        }
        dearest = sorted(costs.items(), key=lambda item: -item[1])[:4]
        print(
            "  families: "
            + ", ".join(f"{name} {1e3 * cost / len(few):.2f} ms" for name, cost in dearest)
        )


if __name__ == "__main__":
    main()
