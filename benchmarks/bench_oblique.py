"""What friction costs: batches of oblique drops beside the same drops along the normal.

python benchmarks/bench_oblique.py
"""

from __future__ import annotations

import statistics
import time

import numpy as np

import vibroimpact as vi

DROPS, PAIRS = 100_000, 3


def problem(law, friction, random) -> vi.Problem:
    """Return drops with one impact each; along the normal if friction is None."""
    speed, angle = random.uniform(1.0, 5.0, DROPS), random.uniform(0.0, 1.3, DROPS)
    oblique = (
        None
        if friction is None
        else vi.Oblique(velocity=(speed * np.sin(angle), 0.0), friction=friction)
    )
    ball = vi.Body(mass=random.uniform(0.01, 0.1, DROPS), contact_offset=0.01)
    return vi.Problem(
        sphere=ball,
        plate=vi.rigid_plate(),
        laws=(law,),
        speed=speed * np.cos(angle),
        gravity=0.0,
        impacts=1,
        oblique=oblique,
    )


def seconds(stated: vi.Problem) -> float:
    """Return the CPU time of a table of drops [s]."""
    begin = time.process_time()
    vi.tabulate(stated)
    return time.process_time() - begin


def main() -> None:
    pair = {"effective_modulus": 1e9, "effective_shear_modulus": 0.8e9, "effective_radius": 0.01}
    laws = {
        "hertz": {},
        "hunt-crossley": {"restitution": 0.7},
        "tsuji": {"restitution": 0.7, "effective_mass": 0.03},
    }
    for name, parameters in laws.items():
        law = vi.laws.find_contact_law(name)(stiffness=1.333e8, **parameters)
        for friction in ("mdr", "mindlin", "coulomb"):
            rubs = vi.friction.find_friction_law(friction)(
                coefficient=0.3, **({} if friction == "coulomb" else pair)
            )
            times = []
            for seed in range(PAIRS):
                plain, oblique = (
                    seconds(problem(law, one, np.random.default_rng(seed))) for one in (None, rubs)
                )
                times.append((plain, oblique))
            normal, whole = (statistics.median(column) for column in zip(*times, strict=True))
            ratio = statistics.median(second / first for first, second in times)
            each = [f"{1e6 * one / DROPS:.1f} us" for one in (normal, whole)]
            print(
                f"{name}, {friction}: {each[0]} along the normal, {each[1]} oblique, "
                f"{ratio:.1f} times"
            )


if __name__ == "__main__":
    main()
