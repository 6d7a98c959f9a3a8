"""Five impacts of the paper's sphere: CPU time beside SciPy's DOP853 restarted at events, in one
run.

Medians of CPU time; the machine may be shared and noisy, so the ratio is what to quote. Also how
long `--help` and `demo` take, batches against single drops, and tables of drops under each law.

    python benchmarks/bench_rigid_drop.py
"""

from __future__ import annotations

import os

# before NumPy is loaded: small matrices gain nothing from threads
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
from cpu_time import cpu_ms
from scipy.integrate import solve_ivp

import vibroimpact as vi
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import contact_laws


def restarted_dop853(problem: vi.Problem, tolerance: float = 1e-10) -> list[float]:
    """The same impacts by SciPy: flight in closed form, DOP853 from touch to zero indentation."""
    mass, gravity = float(problem.sphere.mass), float(problem.gravity)
    speed = (2 * gravity * (float(problem.height) - float(problem.sphere.contact_offset))) ** 0.5
    speeds = []
    for impact in range(5):
        law = problem.law_of(impact)
        assert isinstance(law, CompliantLaw)

        def motion(
            _: float, state: np.ndarray, law: CompliantLaw = law, speed: float = speed
        ) -> tuple[float, float]:
            elastic, dissipative = law.forces(max(state[0], 0.0), state[1], speed)
            force = elastic + dissipative
            return state[1], gravity - (max(force, 0.0) if law.tension == "cut" else force) / mass

        def out(_: float, state: np.ndarray) -> float:
            return float(state[0])

        out.terminal, out.direction = True, -1  # type: ignore[attr-defined]
        solution = solve_ivp(
            motion,
            (0.0, 0.01),
            (0.0, speed),
            method="DOP853",
            rtol=tolerance,
            atol=1e-14,
            events=out,
        )
        speed = -solution.y[1, -1]
        speeds.append(speed)
    return speeds


def wall_s(*arguments: str) -> float:
    """Median wall time of the command line [s]."""
    times = []
    for _ in range(5):
        begin = time.perf_counter()
        subprocess.run(
            [sys.executable, "-m", "vibroimpact", *arguments], check=True, capture_output=True
        )
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def main() -> None:
    print(
        f"{'five impacts, tolerance 1e-9':32} {'vibroimpact':>12} {'DOP853 1e-10':>13} "
        f"{'ratio':>6}  errors, fifth rebound speed"
    )
    for name in ("theory", "constant", "variable"):
        problem = vi.load_case(f"paper:type1-{name}").to_problem()
        exact = vi.simulate(
            vi.case_of({**problem.source, "run": {"impacts": 5, "tolerance": 1e-13}})
        ).impacts["separation_speed_m_s"][4]
        ours, theirs = (
            cpu_ms(lambda p=problem: vi.simulate(p)),
            cpu_ms(lambda p=problem: restarted_dop853(p), 7),
        )
        errors = [
            abs(speed / exact - 1)
            for speed in (
                vi.simulate(problem).impacts["separation_speed_m_s"][4],
                restarted_dop853(problem)[4],
            )
        ]
        print(
            f"{name:32} {ours:9.1f} ms {theirs:10.1f} ms {theirs / ours:6.2f}  "
            f"{errors[0]:.0e}, {errors[1]:.0e}"
        )

    random = np.random.default_rng(0)
    for size in (1, 100, 10_000):
        law = LankaraniNikravesh(
            stiffness=10 ** random.uniform(7, 9, size), restitution=random.uniform(0.3, 0.95, size)
        )
        ball = vi.Body(mass=random.uniform(0.01, 1.0, size), contact_offset=0.02)
        problem = vi.Problem(
            sphere=ball, plate=vi.rigid_plate(), laws=(law,), height=random.uniform(0.5, 4.0, size)
        )
        print(
            f"batch of {size:6d}, five impacts: "
            f"{1e3 * cpu_ms(lambda p=problem: vi.simulate(p), 3) / size:10.1f} us a drop"
        )

    pair = ContactPair(2.4e9, 0.025, 0.09, 8e7, 0.28)
    for name, kind in contact_laws().items():
        ball = vi.Body(mass=0.09, contact_offset=0.025)
        problem = vi.Problem(
            sphere=ball,
            plate=vi.rigid_plate(),
            laws=(kind.example(pair),),
            height=random.uniform(0.1, 2.1, 2000),
            impacts=5,
        )
        print(
            f"table of 2,000 drops under {name:24} "
            f"{1e3 * cpu_ms(lambda p=problem: vi.tabulate(p), 3) / 2000:7.1f} us a drop"
        )

    with tempfile.TemporaryDirectory() as folder:
        print(
            f"--help {wall_s('--help'):.2f} s;  demo with report "
            f"{wall_s('demo', '-o', f'{folder}/demo', '--force'):.2f} s of wall time"
        )


if __name__ == "__main__":
    main()
