"""How time and memory grow: exponents over rows of a table, samples, impacts, modes and duration.
Each measurement is a process of its own.

python benchmarks/bench_growth.py [NAME ...]
"""

from __future__ import annotations

import math
import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import vibroimpact as vi

RIGID: dict[str, Any] = {
    "sphere": {"radius": 0.025, "material": "steel"},
    "plate": {"material": "steel"},
    "drop": {"height": 1.0},
    "contact": {"law": "hunt-crossley", "restitution": 0.7},
    "run": {"impacts": 1},
}
PLATE = {
    "size": [0.3, 0.25, 0.01],
    "material": "steel",
    "model": "elastic",
    "supports": "clamped",
    "damping": 0.01,
}


def calibrated_rows(rows: int, folder: Path) -> None:
    """Restitutions in a table."""
    random = np.random.default_rng(1)
    speed = random.uniform(1.0, 8.0, rows)
    restitution = np.clip(0.8 - 0.02 * speed + 0.01 * random.standard_normal(rows), 0.05, 0.99)
    lines = [f"{fast:.6f},{value:.6f}\n" for fast, value in zip(speed, restitution, strict=True)]
    (folder / "table.csv").write_text("approach_speed_m_s,restitution\n" + "".join(lines))
    target = {"target": {"file": str(folder / "table.csv")}, "model": "hunt-crossley"}
    what = vi.calibration.calibration_of({**RIGID, "calibrate": target})
    vi.calibration.calibrate_case(what).save(folder / "found")


def friction_rows(rows: int, folder: Path) -> None:
    """Oblique impacts in a table, from which friction is fitted."""
    random = np.random.default_rng(1)
    speed, along = random.uniform(1.0, 8.0, rows), random.uniform(0.5, 6.0, rows)
    after = np.maximum(along - 0.34 * speed, 5.0 / 7.0 * along) + 0.02 * random.standard_normal(
        rows
    )
    lines = [
        f"{row[0]:.6f},{row[1]:.6f},{row[2]:.6f}\n" for row in zip(speed, along, after, strict=True)
    ]
    (folder / "table.csv").write_text(
        "approach_speed_m_s,approach_velocity_x_m_s,separation_velocity_x_m_s\n" + "".join(lines)
    )
    contact = {
        "law": "newton",
        "restitution": 0.7,
        "friction": {"law": "coulomb", "coefficient": 0.1},
    }
    section = {"parameter": ["friction.coefficient"], "target": {"file": str(folder / "table.csv")}}
    case = {**RIGID, "contact": contact, "drop": {"speed": 3.0, "angle": 0.5}, "calibrate": section}
    what = vi.calibration.calibration_of(case)
    vi.calibration.calibrate_case(what).save(folder / "found")


def wave_samples(samples: int, folder: Path) -> None:
    """Features of a sound."""
    from scipy.io import wavfile

    wavfile.write(
        folder / "sound.wav",
        48000,
        (9000 * np.random.default_rng(1).standard_normal(samples)).clip(-30000, 30000).astype("i2"),
    )
    vi.signals.record_table(
        vi.signals.load_records(folder / "sound.wav"), ["rms", "kurtosis", "spectral_centroid"]
    )


def impacts(number: int, folder: Path) -> None:
    """A rigid drop, simulated and written."""
    case = {
        **RIGID,
        "contact": {"law": "hunt-crossley", "restitution": 0.999},
        "run": {"impacts": number, "rest_speed": 1e-9},
    }
    vi.simulate(vi.case_of(case)).save(folder / "drop")


def modes(number: int, folder: Path) -> None:
    """Modes of a plate on one mesh."""
    plate = {**PLATE, "modes": number, "mesh": {"element_size": 0.02}}
    vi.simulate(vi.case_of({**RIGID, "plate": plate, "drop": {"speed": 1.0}}))


def duration(milliseconds: int, folder: Path) -> None:
    """An elastic drop with a sensor."""
    sensor = {"name": "a", "position": [0.05, 0.03], "rate": 50e3}
    case = {
        **RIGID,
        "plate": {**PLATE, "modes": 10},
        "drop": {"speed": 1.0},
        "run": {"duration": 1e-3 * milliseconds},
        "sensors": [sensor],
    }
    vi.simulate(vi.case_of(case)).signals()


def sensors(number: int, folder: Path) -> None:
    """An elastic drop with so many sensors."""
    every = [
        {"name": f"a{one}", "position": [0.1 * one / number, 0.03], "rate": 50e3}
        for one in range(number)
    ]
    case = {
        **RIGID,
        "plate": {**PLATE, "modes": 10},
        "drop": {"speed": 1.0},
        "run": {"duration": 0.2},
        "sensors": every,
    }
    vi.simulate(vi.case_of(case)).signals()


MEASURED: dict[str, tuple[Callable[[int, Path], None], tuple[int, ...]]] = {
    "rows": (calibrated_rows, (1000, 2000, 4000)),
    "friction": (friction_rows, (1000, 2000, 4000)),
    "samples": (wave_samples, (1_000_000, 2_000_000, 4_000_000)),
    "impacts": (impacts, (400, 800, 1600)),
    "modes": (modes, (40, 80, 160)),
    "duration": (duration, (4000, 8000, 16000)),
    "sensors": (sensors, (16, 32, 64)),
}


def measured(name: str, size: int) -> tuple[float, float]:
    """Return processor time [s] and largest memory [MB] of a process of its own, less
    those of one that only imports the program.
    """
    found = subprocess.run(
        [sys.executable, __file__, "--one", name, str(size)],
        check=True,
        capture_output=True,
        text=True,
    )
    time, memory = map(float, found.stdout.split()[-2:])
    return time, memory


def one(name: str, size: int) -> None:
    """Measure one size in this process."""
    begun = resource.getrusage(resource.RUSAGE_SELF)
    with TemporaryDirectory() as folder:
        MEASURED[name][0](size, Path(folder))
    used = resource.getrusage(resource.RUSAGE_SELF)
    print(
        used.ru_utime + used.ru_stime - begun.ru_utime - begun.ru_stime,
        (used.ru_maxrss - begun.ru_maxrss) / 1024.0,
    )


def main() -> None:
    """Print a table of times, memory and their exponents from the last doubling."""
    for name in sys.argv[1:] or MEASURED:
        sizes = MEASURED[name][1]
        found = [measured(name, size) for size in sizes]
        grown = [
            math.log(max(last, 1e-3) / max(before, 1e-3)) / math.log(sizes[-1] / sizes[-2])
            for before, last in zip(*found[-2:], strict=True)
        ]
        each = ", ".join(
            f"{size:,}: {time:.2f} s {memory:.0f} MB"
            for size, (time, memory) in zip(sizes, found, strict=True)
        )
        print(
            f"{name:<9} time ~ n^{grown[0]:.2f}, memory ~ n^{grown[1]:.2f}   ({each})", flush=True
        )


if __name__ == "__main__":
    if sys.argv[1:2] == ["--one"]:
        one(sys.argv[2], int(sys.argv[3]))
    else:
        main()
