"""The paper's Type 3 with 200 modes of the plate and 60 of the sphere, and what sensors on the
plate record.

Run it with one thread: OPENBLAS_NUM_THREADS=1 python benchmarks/bench_elastic_drop.py
"""

from __future__ import annotations

import resource
import statistics
import time
from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp

import vibroimpact as vi
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.dynamics.vibrating.drop_system import system_of

REPEATS = 3


def processor_time(work) -> tuple[float, object]:
    """Return the median processor time [s] of a function, and its result."""
    spent = []
    for _ in range(REPEATS):
        begun = time.process_time()
        found = work()
        spent.append(time.process_time() - begun)
    return statistics.median(spent), found


def modal_dop853(problem: vi.Problem) -> tuple[float, float]:
    """Return processor time [s] and largest force [N] of the first contact, by SciPy's DOP853 on
    the modal equations.

    For a sphere that lies outside the contact (as in superposed), to the same tolerance.
    """
    of, law = (
        system_of(problem, float(problem.sphere.mass), float(problem.gravity)),
        problem.law_of(0),
    )
    count, shape = of.number, of.shape[0]
    speed = float(
        np.sqrt(
            2.0
            * float(problem.gravity)
            * (float(problem.height) - float(problem.sphere.contact_offset))
        )
    )

    def force(state: np.ndarray) -> float:
        delta, rate = shape @ state[:count], shape @ state[count:]
        return max(float(sum(law.forces(max(delta, 0.0), rate, speed))), 0.0)

    def slope(now: float, state: np.ndarray) -> np.ndarray:
        displacement, velocity = state[:count], state[count:]
        return np.concatenate(
            [
                velocity,
                of.load
                - shape * force(state)
                - of.damping * velocity
                - of.angular_frequency**2 * displacement,
            ]
        )

    def parted(now: float, state: np.ndarray) -> float:
        return shape @ state[:count] if now > 1e-6 else 1.0

    parted.terminal, parted.direction = True, -1
    start = np.zeros(2 * count)
    start[count] = speed * float(problem.sphere.mass) ** 0.5
    begun = time.process_time()
    solution = solve_ivp(
        slope, (0.0, 2e-3), start, method="DOP853", rtol=1e-9, atol=1e-14, events=parted
    )
    spent = time.process_time() - begun
    return spent, max(force(state) for state in solution.y.T)


def main() -> None:
    problem = vi.load_case("paper:type3").to_problem()
    vi.simulate(problem)  # whatever is computed once
    spent, response = processor_time(lambda: vi.simulate(problem))
    stretches = sum(
        len(bounce.contact.pieces) for bounce in response.bounces if bounce.contact is not None
    )
    print(
        f"Type 3, five impacts, 200 + 60 modes, tolerance 1e-9: {spent:.3f} s of processor "
        f"time ({stretches} stretches; 0.5 s asked)"
    )

    heights = np.linspace(0.5, 4.5, 40)
    spent, _ = processor_time(lambda: vi.tabulate(replace(problem, height=heights)))
    alone, _ = processor_time(
        lambda: [vi.tabulate(replace(problem, height=float(height))) for height in heights]
    )
    print(
        f"a table of forty such drops from 0.5 to 4.5 m: {1e3 * spent / 40:.0f} ms a drop "
        f"side by side, {1e3 * alone / 40:.0f} one by one"
    )

    superposed = vi.load_case("paper:type3-superposed").to_problem()
    one = replace(superposed, impacts=1)
    ours, short = processor_time(lambda: vi.simulate(one))
    theirs, force = modal_dop853(superposed)
    print(
        f"one impact, superposed: {ours:.3f} s; DOP853 on the same modes {theirs:.2f} s, "
        f"{theirs / ours:.0f} times as much "
        f"(largest force {short.impacts['max_force_N'][0]:.6f} and {force:.3f} N)"
    )

    basis = problem.plate.modes
    places = np.random.default_rng(0).uniform(-0.2, 0.2, (10, 2))
    shapes, _ = problem.models["plate"].at(places)
    watched = replace(
        problem.plate, modes=replace(basis, points={f"s{i}": shapes[:, i] for i in range(10)})
    )
    sensors = tuple(
        Sensor(f"s{i}", ("acceleration", "velocity", "displacement")[i % 3], rate=100e3)
        for i in range(10)
    )
    long = vi.simulate(
        replace(problem, plate=watched, impacts=None, duration=10.0, sensors=sensors)
    )
    long.modal([0.0])  # the timeline is made once

    def signals() -> dict[str, Signal]:
        return long.signals()

    spent, found = processor_time(signals)
    count = len(found["s0"].time)
    print(
        f"ten sensors, {count} samples each at 100 kHz, {len(long.impacts['impact'])} "
        f"impacts: {spent:.3f} s (1 s asked)"
    )
    print(
        f"largest memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} "
        "MiB (500 asked)"
    )


if __name__ == "__main__":
    main()
