"""Tables of 100,000 rigid drops of five impacts: CPU time and achieved error, beside a compiled
loop and SciPy.

Everything in one run, on one core; the machine may be shared and noisy, so the ratios are what to
quote. Errors are the largest of 2,000 drops, of the restitution, against `simulate` at a tolerance
of 1e-13.

    python benchmarks/bench_study.py
"""

from __future__ import annotations

import os

# before NumPy is loaded: small matrices gain nothing from threads
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import importlib.util
import resource
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import vibroimpact as vi
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh

NUMBER, CHUNK, CHECKED, SAMPLE, IMPACTS = 100_000, 20_000, 2_000, 100, 5
TOLERANCE = 1e-8
GRAVITY = 9.80665
Floats = NDArray[np.float64]


def random_drops(number: int) -> vi.Problem:
    """Spheres of random radius, modulus, height and restitution."""
    random = np.random.default_rng(0)
    radius, modulus = random.uniform(0.005, 0.05, number), 10 ** random.uniform(8, 11, number)
    law = LankaraniNikravesh(
        stiffness=4 / 3 * modulus * np.sqrt(radius), restitution=random.uniform(0.3, 1.0, number)
    )
    ball = vi.Body(mass=4 / 3 * np.pi * 2500 * radius**3, contact_offset=radius)
    height = radius + random.uniform(0.1, 5.0, number)
    return vi.Problem(
        sphere=ball,
        plate=vi.rigid_plate(),
        laws=(law,),
        height=height,
        gravity=GRAVITY,
        impacts=IMPACTS,
        tolerance=TOLERANCE,
    )


def numbers_of(problem: vi.Problem) -> Floats:
    """What the other programs need: mass, fall, stiffness and damping factor of each
    drop, (B, 4).
    """
    law = problem.laws[0]
    assert isinstance(law, LankaraniNikravesh)
    fall = np.asarray(problem.height) - problem.sphere.contact_offset
    return np.stack(
        [
            np.asarray(problem.sphere.mass),
            fall,
            np.asarray(law.stiffness),
            np.asarray(law.damping_factor),
        ],
        axis=1,
    )


def cpu_seconds(work: Callable[[], Floats], runs: int) -> tuple[float, Floats]:
    """Least CPU time of `work` [s], and what it returned."""
    least, found = np.inf, work()
    for _ in range(runs):
        begin = time.process_time()
        found = work()
        least = min(least, time.process_time() - begin)
    return least, found


def tabulated(problem: vi.Problem) -> Floats:
    """Restitution of every impact by `tabulate`, in chunks as a study would ask for them."""
    chunks = [
        problem.take(slice(begin, begin + CHUNK))
        for begin in range(0, len(np.asarray(problem.height)), CHUNK)
    ]
    return np.concatenate([vi.tabulate(chunk).impacts["restitution_achieved"] for chunk in chunks])


def compiled_loop() -> Callable[[Floats, float], Floats] | None:
    """A loop over drops by hand, compiled by numba: Dormand and Prince's pair of orders 5
    and 4, adaptive, every stage written out.
    """
    if importlib.util.find_spec("numba") is None:
        return None
    import numba

    @numba.njit(inline="always", fastmath=True, error_model="numpy")
    def acceleration(delta: float, rate: float, per_mass: float, factor: float) -> float:
        return (
            GRAVITY - per_mass * delta * np.sqrt(delta) * (1.0 + factor * rate)
            if delta > 0.0
            else GRAVITY
        )

    @numba.njit(inline="always", fastmath=True, error_model="numpy")
    def step_from(
        x: float, v: float, a1: float, h: float, k: float, f: float
    ) -> tuple[float, float, float, float, float]:
        v2 = v + h * 0.2 * a1
        a2 = acceleration(x + h * 0.2 * v, v2, k, f)
        v3 = v + h * (3 / 40 * a1 + 9 / 40 * a2)
        a3 = acceleration(x + h * (3 / 40 * v + 9 / 40 * v2), v3, k, f)
        v4 = v + h * (44 / 45 * a1 - 56 / 15 * a2 + 32 / 9 * a3)
        a4 = acceleration(x + h * (44 / 45 * v - 56 / 15 * v2 + 32 / 9 * v3), v4, k, f)
        v5 = v + h * (19372 / 6561 * a1 - 25360 / 2187 * a2 + 64448 / 6561 * a3 - 212 / 729 * a4)
        x5 = x + h * (19372 / 6561 * v - 25360 / 2187 * v2 + 64448 / 6561 * v3 - 212 / 729 * v4)
        a5 = acceleration(x5, v5, k, f)
        v6 = v + h * (
            9017 / 3168 * a1 - 355 / 33 * a2 + 46732 / 5247 * a3 + 49 / 176 * a4 - 5103 / 18656 * a5
        )
        x6 = x + h * (
            9017 / 3168 * v - 355 / 33 * v2 + 46732 / 5247 * v3 + 49 / 176 * v4 - 5103 / 18656 * v5
        )
        a6 = acceleration(x6, v6, k, f)
        v7 = v + h * (
            35 / 384 * a1 + 500 / 1113 * a3 + 125 / 192 * a4 - 2187 / 6784 * a5 + 11 / 84 * a6
        )
        x7 = x + h * (
            35 / 384 * v + 500 / 1113 * v3 + 125 / 192 * v4 - 2187 / 6784 * v5 + 11 / 84 * v6
        )
        a7 = acceleration(x7, v7, k, f)
        ev = h * (
            71 / 57600 * a1
            - 71 / 16695 * a3
            + 71 / 1920 * a4
            - 17253 / 339200 * a5
            + 22 / 525 * a6
            - a7 / 40
        )
        ex = h * (
            71 / 57600 * v
            - 71 / 16695 * v3
            + 71 / 1920 * v4
            - 17253 / 339200 * v5
            + 22 / 525 * v6
            - v7 / 40
        )
        return x7, v7, a7, ex, ev

    @numba.njit(fastmath=True, error_model="numpy")
    def all_drops(drops: Floats, tolerance: float) -> Floats:
        found = np.empty((len(drops), IMPACTS))
        for drop in range(len(drops)):
            mass, fall, stiffness, damping = drops[drop]
            speed, k = np.sqrt(2.0 * GRAVITY * fall), stiffness / mass
            for impact in range(IMPACTS):
                depth = (1.25 * speed * speed / k) ** 0.4
                f, h, x, v, a = damping / speed, 0.05 * depth / speed, 0.0, speed, GRAVITY
                while True:
                    end, rate, pull, ex, ev = step_from(x, v, a, h, k, f)
                    error = max(abs(ex) / depth, abs(ev) / speed) / tolerance
                    if error > 1.0:
                        h *= max(0.2, 0.9 * error**-0.2)
                        continue
                    # out: change the step to the end of the contact, by Newton's method
                    if end <= 0.0:
                        for _ in range(20):
                            if abs(end) < 1e-14 * depth:
                                break
                            h -= end / rate
                            end, rate, pull, ex, ev = step_from(x, v, a, h, k, f)
                        break
                    x, v, a = end, rate, pull
                    h *= min(5.0, 0.9 * max(error, 1e-6) ** -0.2)
                found[drop, impact] = -rate / speed
                speed = -rate
        return found

    return all_drops


def by_scipy(drops: Floats, tolerance: float) -> Floats:
    """The same by SciPy's `solve_ivp`, a contact a call, with the release as an event."""
    found = np.empty((len(drops), IMPACTS))
    for drop, (mass, fall, stiffness, damping) in enumerate(drops.tolist()):
        speed = (2.0 * GRAVITY * fall) ** 0.5
        for impact in range(IMPACTS):
            depth = (1.25 * mass * speed * speed / stiffness) ** 0.4

            def motion(
                _: float,
                state: Floats,
                per_mass: float = stiffness / mass,
                factor: float = damping / speed,
            ) -> tuple[float, float]:
                delta, rate = max(float(state[0]), 0.0), float(state[1])
                return rate, GRAVITY - per_mass * delta**1.5 * (1.0 + factor * rate)

            def out(_: float, state: Floats) -> float:
                return float(state[0])

            out.terminal, out.direction = True, -1  # type: ignore[attr-defined]
            scales = [tolerance * depth, tolerance * speed]
            span = (0.0, 20.0 * depth / speed)
            end = solve_ivp(
                motion, span, (0.0, speed), method="DOP853", rtol=tolerance, atol=scales, events=out
            ).y[1, -1]
            found[drop, impact], speed = -end / speed, -float(end)
    return found


def by_exudyn(drops: Floats, tolerance: float) -> Floats:
    """The same by EXUDYN's DOPRI5 with adaptive steps, a contact a call; the flight in
    closed form.
    """
    import exudyn as exu
    from exudyn.itemInterface import (
        CoordinateSpringDamper,
        LoadCoordinate,
        MarkerNodeCoordinate,
        Mass1D,
        Node1D,
        NodePointGround,
    )

    found = np.empty((len(drops), IMPACTS))
    for drop, (mass, fall, stiffness, damping) in enumerate(drops.tolist()):
        now = {"factor": 0.0}

        def spring(
            _system: object,
            _t: float,
            _item: int,
            gap: float,
            rate: float,
            *_: object,
            k: float = stiffness,
            of: dict = now,
        ) -> float:
            return -k * (-gap) ** 1.5 * (1.0 - of["factor"] * rate) if gap < 0.0 else 0.0

        def goes_on(system: object, _t: float) -> bool:
            data = system.systemData  # type: ignore[attr-defined]
            return not (data.GetODE2Coordinates()[0] > 0.0 and data.GetODE2Coordinates_t()[0] > 0.0)

        speed, system = (2.0 * GRAVITY * fall) ** 0.5, exu.SystemContainer().AddSystem()
        ground = system.AddMarker(
            MarkerNodeCoordinate(nodeNumber=system.AddNode(NodePointGround()), coordinate=0)
        )
        node = system.AddNode(Node1D())
        system.AddObject(Mass1D(mass=mass, nodeNumber=node))
        ball = system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        system.AddObject(
            CoordinateSpringDamper(markerNumbers=[ground, ball], springForceUserFunction=spring)
        )
        system.AddLoad(LoadCoordinate(markerNumber=ball, load=-mass * GRAVITY))
        system.SetPreStepUserFunction(goes_on)
        system.Assemble()
        for impact in range(IMPACTS):
            depth = (1.25 * mass * speed * speed / stiffness) ** 0.4
            settings, now["factor"] = exu.SimulationSettings(), damping / speed
            settings.solution.file.write = False
            settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = (
                20.0 * depth / speed,
                20,
            )
            settings.timeIntegration.minimumStepSize = 1e-9 * depth / speed
            (
                settings.timeIntegration.relativeTolerance,
                settings.timeIntegration.absoluteTolerance,
            ) = tolerance, 1e-2 * tolerance * depth
            for name, value in (("", 0.0), ("_t", -speed)):
                getattr(system.systemData, f"SetODE2Coordinates{name}")(
                    [value], exu.ConfigurationType.Initial
                )
            system.SolveDynamic(settings, solverType=exu.DynamicSolverType.DOPRI5)
            gap, rate = (
                float(system.systemData.GetODE2Coordinates()[0]),
                float(system.systemData.GetODE2Coordinates_t()[0]),
            )
            out = (rate * rate + 2.0 * GRAVITY * gap) ** 0.5
            found[drop, impact], speed = out / speed, out
    return found


def matched(run: Callable[[float], Floats], exact: Floats) -> float:
    """The loosest tolerance, a power of the root of ten, at which a program achieves the
    error that is asked.
    """
    for power in np.arange(7.0, 13.5, 0.5):
        if np.abs(run(10**-power) - exact).max() <= TOLERANCE:
            return float(10**-power)
    return 1e-13


def row(name: str, microseconds: float, error: float, ours: float) -> None:
    print(
        f"  {name:52} {microseconds:9.1f} us a drop {microseconds / ours:8.2f} x   error "
        f"{error:.0e}",
        flush=True,
    )


def main() -> None:
    problem = random_drops(NUMBER)
    drops, few = numbers_of(problem), problem.take(slice(0, CHECKED))
    exact = vi.simulate(replace(few, tolerance=1e-13)).impacts["restitution_achieved"]
    print(
        f"{NUMBER:,} random drops of {IMPACTS} impacts, Lankarani and Nikravesh's law; "
        f"error asked: {TOLERANCE:g} in restitution"
    )
    seconds, found = cpu_seconds(lambda: tabulated(problem), 3)
    ours = 1e6 * seconds / NUMBER
    row(
        f"tabulate, {seconds:.2f} s for all",
        ours,
        float(np.abs(found[:CHECKED] - exact).max()),
        ours,
    )
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    seconds, found = cpu_seconds(lambda: vi.simulate(few).impacts["restitution_achieved"], 2)
    row(
        f"simulate, with histories, batch of {CHECKED:,}",
        1e6 * seconds / CHECKED,
        float(np.abs(found - exact).max()),
        ours,
    )

    loop = compiled_loop()
    if loop is None:
        print("  numba: not installed")
    else:
        tolerance = matched(lambda value: loop(drops[:CHECKED], value), exact)
        seconds, found = cpu_seconds(lambda: loop(drops, tolerance), 2)
        name = f"numba, adaptive Dormand-Prince 5(4), tolerance {tolerance:.0e}"
        row(name, 1e6 * seconds / NUMBER, float(np.abs(found[:CHECKED] - exact).max()), ours)
    others = [("solve_ivp DOP853", by_scipy)]
    if importlib.util.find_spec("exudyn") is None:
        print("  EXUDYN: not installed")
    else:
        others.append(("EXUDYN DOPRI5", by_exudyn))
    sample = drops[:SAMPLE]
    for name, program in others:
        tolerance = matched(lambda value, program=program: program(sample, value), exact[:SAMPLE])
        seconds, found = cpu_seconds(
            lambda program=program, tolerance=tolerance: program(sample, tolerance), 1
        )
        error = float(np.abs(found - exact[:SAMPLE]).max())
        row(
            f"{name}, tolerance {tolerance:.0e}, {SAMPLE} drops",
            1e6 * seconds / SAMPLE,
            error,
            ours,
        )
    print(f"  peak memory after the tables: {peak:.0f} MiB")


if __name__ == "__main__":
    main()
