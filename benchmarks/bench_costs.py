"""What long runs take, beside what is foretold of them: CPU time and peak memory, each in a process
of its own.

    python benchmarks/bench_costs.py [all]      "all" adds 57,000 impacts, which take minutes

Before histories were packed, structures taken apart and times of samples left out they took: 57,000
impacts 280 s and 2.9 GB, 600 s of a sensor 14 s and 2.1 GB, 300 modes of a sphere 125 s and 2.8 GB.
"""

from __future__ import annotations

import os

# before NumPy is loaded: what is measured is one core
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROCK = {"density": 1380, "youngs_modulus": "2.26 GPa", "poissons_ratio": 0.28}
SUPPORTS = {"type": "patches", "spacing": ["458.4 mm", "360 mm"], "radius": "20 mm"}
BOUNCING: dict[str, Any] = {
    "sphere": {"radius": "25 mm", "material": ROCK},
    "plate": {"material": "steel-paper"},
    "drop": {"height": "1 m"},
    "contact": {"law": "lankarani-nikravesh", "restitution": 0.999},
    "run": {"impacts": "all"},
}
VIBRATING: dict[str, Any] = {
    **BOUNCING,
    "plate": {
        "size": ["520 mm", "420 mm", "8 mm"],
        "material": "steel-paper",
        "model": "elastic",
        "modes": 100,
        "supports": SUPPORTS,
        "damping": 0.01,
    },
    "contact": {"law": "lankarani-nikravesh", "restitution": 0.7},
    "run": {"duration": "600 s"},
    "sensors": [{"name": "a1", "position": ["100 mm", "50 mm"], "rate": "50 kHz"}],
}
CASES: dict[str, dict[str, Any]] = {
    "5,700 impacts, to rest": BOUNCING,
    "57,000 impacts, to rest": {
        **BOUNCING,
        "contact": {"law": "lankarani-nikravesh", "restitution": 0.9999},
    },
    "600 s, a sensor of 50 kHz": VIBRATING,
    "300 modes of a sphere": {
        **BOUNCING,
        "sphere": {"radius": "25 mm", "material": ROCK, "model": "elastic", "modes": 300},
        "run": {"impacts": 1},
    },
}


def measure(name: str) -> None:
    """Run a case, and print what it took."""
    import vibroimpact as vi
    from vibroimpact.cases.costs import describe_costs

    case = vi.case_of(CASES[name])
    told = describe_costs(case)
    begun = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        vi.simulate(case).save(Path(folder, "result"))
        size = sum(file.stat().st_size for file in Path(folder).rglob("*") if file.is_file()) / 1e6
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(
        f"{name:28} {time.process_time() - begun:7.1f} s CPU {peak:7.0f} MB {size:7.0f} MB on disk",
        flush=True,
    )
    for sentence in told:
        print(f"  foretold: {sentence}", flush=True)


def main() -> None:
    """Measure each case with an empty store of modes."""
    for name in CASES:
        if name.startswith("57") and "all" not in sys.argv:
            continue
        with tempfile.TemporaryDirectory() as store:
            subprocess.run(
                [sys.executable, __file__, "--one", name],
                check=True,
                env={**os.environ, "VIBROIMPACT_STORE": store},
            )


if __name__ == "__main__":
    if "--one" in sys.argv:
        measure(sys.argv[-1])
    else:
        main()
