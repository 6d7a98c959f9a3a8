"""What an impact costs in a system of many balls: on a floor, in a row, on a plate that vibrates.

python benchmarks/bench_systems.py
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from cpu_time import cpu_ms

import vibroimpact as vi
from vibroimpact.structures.modal_model import ModalBasis

COUNTS = (1, 10, 100)
MODES = 60
RUNS = 5
LAW = vi.laws.HuntCrossley(stiffness=1e9, restitution=0.7)


def falling_on(ground: vi.MovingBody, count: int) -> vi.System:
    """Return balls that fall from 1 to 50 mm on a body below all of them."""
    gaps = np.linspace(1e-3, 50e-3, count)
    balls = {f"{ball}": vi.MovingBody(mass=0.1) for ball in range(count)}
    contacts = {
        name: vi.PointContact(above=name, below="ground", law=LAW, gap=gap)
        for name, gap in zip(balls, gaps, strict=True)
    }
    return vi.System(
        bodies={"ground": ground, **balls}, contacts=contacts, gravity=(0.0, 0.0, -9.81)
    )


def plate(count: int) -> vi.MovingBody:
    """Return a plate with modes at random, seen at each ball."""
    random = np.random.default_rng(1)
    frequencies = np.sort(random.uniform(100.0, 8000.0, MODES))
    normal = np.array([0.0, 0.0, 1.0])
    shapes = {
        f"{ball}": np.outer(random.uniform(-0.5, 0.5, MODES), normal) for ball in range(count)
    }
    modes = ModalBasis(
        frequencies, np.full(MODES, 0.01), np.zeros(MODES), np.zeros((MODES, 3)), shapes
    )
    return vi.MovingBody(mass=math.inf, modes=modes)


def row(count: int) -> vi.System:
    """Return balls in a row that touch, of which the first comes at 1 m/s."""
    balls = {
        f"{ball}": vi.MovingBody(mass=0.1, velocity=(0.0, 0.0, 0.0 if ball else 1.0))
        for ball in range(count + 1)
    }
    contacts = {
        f"{ball}": vi.PointContact(below=f"{ball}", above=f"{ball + 1}", law=LAW)
        for ball in range(count)
    }
    return vi.System(bodies=balls, contacts=contacts)


def main() -> None:
    for count in COUNTS:
        floor = vi.MovingBody(mass=math.inf)
        for name, system, duration in (
            ("on a floor", falling_on(floor, count), 0.1),
            (f"on a plate with {MODES} modes", falling_on(plate(count), count), 0.1),
            ("in a row", row(count), 5e-3),
        ):
            response = vi.simulate_system(system, duration=duration)
            impacts = len(response.impacts["time_s"])
            took = cpu_ms(partial(vi.simulate_system, system, duration=duration), RUNS)
            print(
                f"{count:4d} balls {name}: {impacts} impacts, {took / impacts:.2f} ms an impact, "
                f"ledger {response.energy['closure_relative']:.0e}"
            )


if __name__ == "__main__":
    main()
