"""The same impacts in vibroimpact, SciPy, numba, heyoka, LAMMPS and EXUDYN: CPU time and error; prints the
page of benchmarks.

Programs that are not installed are left out, with a note.

    python benchmarks/bench_programs.py [docs/benchmarks.md ["a virtual machine, two cores of an AMD
    EPYC"]]
"""

from __future__ import annotations

import os

# before NumPy is loaded: small matrices gain nothing from threads
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import importlib.metadata
import importlib.util
import math
import platform
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from datetime import date
from pathlib import Path
from typing import NamedTuple

import numpy as np
from cpu_time import cpu_ms
from scipy.integrate import solve_ivp

import vibroimpact as vi

CASE = {
    "name": "rock",
    "sphere": {"radius": "25 mm", "material": "rock-paper"},
    "plate": {"material": "steel-paper"},
    "drop": {"height": "4 m"},
    "contact": {"law": "tsuji", "restitution": 0.7},
    "run": {"impacts": 5},
}
IMPACTS, DROPS = 5, 10_000
LAST_HEIGHT = re.compile(r"impact 5: .*rebound height (\S+) m")
PAGE = """# Benchmarks

<!-- made by benchmarks/bench_programs.py -->

Computing time and error of the same impacts in several programs. Times are CPU times of the computation in one session on one core
of a shared machine, {day}: medians of {runs} runs for vibroimpact and heyoka, of {fewer} for SciPy, of 3 for the others. From session to session
they have differed by up to a factor of two, so ratios near one say little.
`python benchmarks/bench_programs.py docs/benchmarks.md` generates this page; programs that are not installed are left out.

Run with Python {python}, {versions}{missing}.

## One drop, five impacts

Measured {day} on {machine}.

The paper's rock sphere dropped from 4 m on steel with Tsuji's law (restitution 0.7). LAMMPS
and EXUDYN run the files written by `vibroimpact export`; the steps per contact are those of the first contact. The error is that of the
fifth rebound height, compared with DOP853 with a relative tolerance of 1e-13.

{one}

The time of vibroimpact includes the energy ledger, the located peaks and the table of impacts; those of the others are for the motion
alone, those of LAMMPS and EXUDYN less the start of the program. The forces in the
rows of SciPy and EXUDYN are Python functions; compiled ones may be faster. heyoka compiles the equation; since the force has no Taylor series at touch,
its integration begins and ends 1e-14 m beyond.

## {drops:,} drops, one impact

Measured {day} on {machine}.

Heights from 0.5 to 4 m. numba's loop is compiled beforehand ({compile:.1f} s, not included); it represents a simple program
with Runge-Kutta steps of fixed size.

{many}

Other measurements are printed by the other scripts in `benchmarks/`: elastic bodies, modes, studies, calibration, features,
pages.

**Next:** [validation](validation.md), the comparisons of results, with their numbers.
"""


class Row(NamedTuple):
    """What a program takes [ms], and how far off it is (relative)."""

    program: str
    steps: str
    milliseconds: float
    error: float


_GROWTH, _NEXT = "## Growth", "**Next:**"


def coefficients(law: vi.laws.ContactLaw) -> tuple[float, float]:
    """Return K [N/m^1.5] and c [N s/m^1.25] of Tsuji's law, whose force is K x^1.5 + c x^0.25 v."""
    return float(law.forces(1.0, 0.0, 1.0)[0]), float(law.forces(1.0, 1.0, 1.0)[1])


def by_scipy(
    mass: float, radius: float, height: float, stiffness: float, damping: float, tolerance: float
) -> float:
    """Return the fifth rebound height [m]: flight in closed form, DOP853 from touch to
    zero indentation, the law in plain floats.
    """
    gravity = 9.80665
    speed = math.sqrt(2.0 * gravity * (height - radius))

    def motion(_: float, state: np.ndarray) -> tuple[float, float]:
        x, v = state.tolist()
        root = math.sqrt(max(x, 0.0))
        return v, gravity - (stiffness * x * root + damping * math.sqrt(root) * v) / mass

    def apart(_: float, state: np.ndarray) -> float:
        return float(state[0])

    apart.terminal, apart.direction = True, -1  # type: ignore[attr-defined]
    for _ in range(IMPACTS):
        run = solve_ivp(
            motion,
            (0.0, 0.01),
            (0.0, speed),
            method="DOP853",
            rtol=tolerance,
            atol=1e-3 * tolerance,
            events=apart,
        )
        speed = -run.y[1, -1]
    return radius + speed**2 / (2.0 * gravity)


def heyoka_drop(
    mass: float, radius: float, height: float, stiffness: float, damping: float, tolerance: float
) -> Callable[[], float]:
    """Return a function that gives the fifth rebound height [m]: flight in closed form, heyoka's
    Taylor integration from touch to release, compiled once.

    The force has no Taylor series at touch: it begins and ends just beyond.
    """
    import heyoka

    gravity, begun = 9.80665, 1e-14
    x, v = heyoka.make_vars("x", "v")
    force = stiffness * x**1.5 + damping * x**0.25 * v
    apart = heyoka.t_event(x - begun, direction=heyoka.event_direction.negative)
    motion = heyoka.taylor_adaptive(
        [(x, v), (v, gravity - force / mass)], [begun, 1.0], t_events=[apart], tol=tolerance
    )

    def fifth_height() -> float:
        speed = math.sqrt(2.0 * gravity * (height - radius))
        for _ in range(IMPACTS):
            motion.time = 0.0
            motion.state[:] = begun, speed
            motion.reset_cooldowns()
            motion.propagate_until(0.01)
            speed = -motion.state[1]
        return radius + speed**2 / (2.0 * gravity)

    return fifth_height


def numba_loop() -> Callable[..., float]:
    """Return a compiled fourth-order Runge-Kutta loop: the rebound speed after an impact;
    release by interpolation within a step.
    """
    from numba import njit

    @njit
    def rebound(speed: float, mass: float, stiffness: float, damping: float, step: float) -> float:
        x, v = 0.0, speed
        while True:
            x1, v1 = x, v
            a1 = (
                9.80665
                - (stiffness * max(x1, 0.0) ** 1.5 + damping * max(x1, 0.0) ** 0.25 * v1) / mass
            )
            x2, v2 = x + 0.5 * step * v1, v + 0.5 * step * a1
            a2 = (
                9.80665
                - (stiffness * max(x2, 0.0) ** 1.5 + damping * max(x2, 0.0) ** 0.25 * v2) / mass
            )
            x3, v3 = x + 0.5 * step * v2, v + 0.5 * step * a2
            a3 = (
                9.80665
                - (stiffness * max(x3, 0.0) ** 1.5 + damping * max(x3, 0.0) ** 0.25 * v3) / mass
            )
            x4, v4 = x + step * v3, v + step * a3
            a4 = (
                9.80665
                - (stiffness * max(x4, 0.0) ** 1.5 + damping * max(x4, 0.0) ** 0.25 * v4) / mass
            )
            before, speed_before = x, v
            x += step / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4)
            v += step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
            if x <= 0.0:
                return -(speed_before + (v - speed_before) * before / (before - x))

    @njit
    def rebounds(
        speeds: np.ndarray, mass: float, stiffness: float, damping: float, step: float
    ) -> np.ndarray:
        found = np.empty_like(speeds)
        for number in range(len(speeds)):
            found[number] = rebound(speeds[number], mass, stiffness, damping, step)
        return found

    return rebounds


def by_lammps(deck: str, steps: int) -> tuple[float, float]:
    """Return the fifth rebound height [m] and the CPU time [ms] of the exported deck with
    so many steps a contact.
    """
    (step,) = (float(one) for one in re.findall(r"timestep +(\S+)  # 20000 steps", deck))
    deck = deck.replace(f"{step!r}  # 20000", f"{step * 20000 / steps!r}  # {steps}").replace(
        "run             400000", f"run             {20 * steps}"
    )
    program = [str(Path(sys.executable).parent / "lmp"), "-log", "none", "-in", "rock.in"]
    height, whole = _run(program, "rock.in", deck)
    return height, whole - statistics.median(
        _run(program, "rock.in", "print 'impact 5: rebound height 0 m'")[1] for _ in range(3)
    )


def by_exudyn(model: str) -> tuple[float, float]:
    """Return the fifth rebound height [m] and the CPU time [ms] of the exported model,
    imports excluded.
    """
    height, whole = _run([sys.executable, "rock.py"], "rock.py", model)
    imports = "import exudyn, exudyn.itemInterface\nprint('impact 5: rebound height 0 m')"
    return height, whole - statistics.median(
        _run([sys.executable, "rock.py"], "rock.py", imports)[1] for _ in range(3)
    )


def _run(command: list[str], name: str, text: str) -> tuple[float, float]:
    """Return the fifth rebound height [m] that a program prints, and the CPU time of its
    process [ms].
    """
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / name).write_text(text, encoding="utf-8")
        printed = subprocess.run(
            command, cwd=folder, capture_output=True, text=True, check=True
        ).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return float(LAST_HEIGHT.findall(printed)[-1]), 1e3 * (
        after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    )


def shown(value: float, digits: int) -> str:
    """Return a number with so many digits, without an exponent."""
    return f"{float(f'{value:.{digits}g}'):g}"


def table(rows: list[Row], quantity: str) -> str:
    """Return rows as Markdown, with the ratio to the first."""
    lines = [
        f"| | steps per contact | CPU [ms] | relative to vibroimpact | error in {quantity} |",
        "|---|---|---|---|---|",
    ]
    for one in rows:
        took, ratio = shown(one.milliseconds, 3), shown(one.milliseconds / rows[0].milliseconds, 2)
        lines.append(f"| {one.program} | {one.steps} | {took} | {ratio} | {one.error:.0e} |")
    return "\n".join(lines)


def has(module: str) -> bool:
    """Return whether a program is installed."""
    return importlib.util.find_spec(module) is not None


def one_drop(runs: int, folder: Path) -> list[Row]:
    """Return the rows of one drop with five impacts."""
    case = vi.case_of(CASE)
    problem = case.to_problem()
    drop = (
        float(problem.sphere.mass),
        float(problem.sphere.contact_offset),
        4.0,
        *coefficients(problem.law_of(0)),
    )
    exact = by_scipy(*drop, 1e-13)

    def off(height: float) -> float:
        return abs(height / exact - 1.0)

    rows = []
    for tolerance in (1e-9, 1e-6):
        stated = vi.case_of(
            {**CASE, "run": {"impacts": IMPACTS, "tolerance": tolerance}}
        ).to_problem()
        found = float(vi.simulate(stated).impacts["rebound_height_m"][4])
        rows.append(
            Row(
                f"vibroimpact, tolerance {tolerance:.0e}",
                "",
                cpu_ms(lambda stated=stated: vi.simulate(stated), runs),
                off(found),
            )
        )
    for tolerance in (1e-9, 1e-6):
        took = cpu_ms(lambda tolerance=tolerance: by_scipy(*drop, tolerance), max(runs // 3, 3))
        rows.append(
            Row(f"SciPy, DOP853, rtol {tolerance:.0e}", "", took, off(by_scipy(*drop, tolerance)))
        )
    for tolerance in (1e-12, 1e-9) if has("heyoka") else ():
        by_heyoka = heyoka_drop(*drop, tolerance)
        took = cpu_ms(by_heyoka, runs)
        rows.append(Row(f"heyoka, Taylor, tol {tolerance:.0e}", "", took, off(by_heyoka())))
    exported = folder / "run"
    vi.simulate(case).save(exported)
    if has("lammps"):
        (deck,) = (
            path
            for path in vi.exporting.export_result(exported, "lammps", folder / "lammps")
            if path.suffix == ".in"
        )
        for steps in (100, 1000, 20_000):
            found, took = zip(
                *(by_lammps(deck.read_text(encoding="utf-8"), steps) for _ in range(3)), strict=True
            )
            rows.append(
                Row("LAMMPS, velocity Verlet", f"{steps:,}", statistics.median(took), off(found[0]))
            )
    if has("exudyn"):
        (model,) = (
            path
            for path in vi.exporting.export_result(exported, "exudyn", folder / "exudyn")
            if path.suffix == ".py"
        )
        found, took = zip(
            *(by_exudyn(model.read_text(encoding="utf-8")) for _ in range(3)), strict=True
        )
        rows.append(Row("EXUDYN, as exported", "", statistics.median(took), off(found[0])))
    return rows


def many_drops(runs: int) -> tuple[list[Row], float]:
    """Return the rows of many drops with one impact, and what numba takes to compile [s]."""
    case = vi.case_of({**CASE, "run": {"impacts": 1}})
    problem = case.to_problem()
    law, mass, radius = (
        problem.law_of(0),
        float(problem.sphere.mass),
        float(problem.sphere.contact_offset),
    )
    heights = np.random.default_rng(0).uniform(0.5, 4.0, DROPS)

    def drops(tolerance: float) -> vi.Problem:
        return vi.Problem(
            sphere=problem.sphere,
            plate=vi.rigid_plate(),
            laws=(law,),
            height=heights,
            impacts=1,
            tolerance=tolerance,
            gravity=9.80665,
        )

    exact = vi.tabulate(drops(1e-13)).impacts["separation_speed_m_s"][:, 0]

    def off(found: np.ndarray) -> float:
        return float(np.abs(found / exact - 1.0).max())

    rows = []
    for tolerance in (1e-9, 1e-6):
        stated = drops(tolerance)
        found = vi.tabulate(stated).impacts["separation_speed_m_s"][:, 0]
        rows.append(
            Row(
                f"vibroimpact, tolerance {tolerance:.0e}",
                "",
                cpu_ms(lambda stated=stated: vi.tabulate(stated), runs),
                off(found),
            )
        )
    if not has("numba"):
        return rows, math.nan
    begin = time.process_time()
    rebounds = numba_loop()
    stiffness, damping = coefficients(law)
    speeds = np.sqrt(2.0 * 9.80665 * (heights - radius))
    rebounds(speeds[:1], mass, stiffness, damping, 1e-6)
    compiled = time.process_time() - begin
    contact = float(vi.tabulate(drops(1e-9)).impacts["duration_s"].mean())
    for steps in (100, 1000, 10_000):
        given = (speeds, mass, stiffness, damping, contact / steps)
        rows.append(
            Row(
                "numba, Runge-Kutta of order four",
                f"{steps:,}",
                cpu_ms(lambda given=given: rebounds(*given), 3),
                off(rebounds(*given)),
            )
        )
    return rows, compiled


def main() -> None:
    runs = 15
    with tempfile.TemporaryDirectory() as folder:
        one = one_drop(runs, Path(folder))
    many, compiled = many_drops(runs)
    programs = {
        "numpy": "NumPy",
        "scipy": "SciPy",
        "numba": "numba",
        "lammps": "LAMMPS",
        "exudyn": "EXUDYN",
        "heyoka": "heyoka",
    }
    there = [
        f"{shown} {importlib.metadata.version(name)}"
        for name, shown in programs.items()
        if has(name)
    ]
    missing = [shown for name, shown in programs.items() if not has(name)]
    page = PAGE.format(
        runs=runs,
        fewer=max(runs // 3, 3),
        day=date.today().isoformat(),
        machine=sys.argv[2] if len(sys.argv) > 2 else platform.processor() or platform.machine(),
        python=platform.python_version(),
        versions=", ".join(there),
        missing=f"; without {', '.join(missing)}" if missing else "",
        one=table(one, "the fifth rebound height"),
        many=table(many, "the rebound speed, largest"),
        drops=DROPS,
        compile=compiled,
    )
    if len(sys.argv) > 1:
        target = Path(sys.argv[1])
        before = target.read_text(encoding="utf-8") if target.exists() else ""
        # of bench_growth.py, and written by hand
        growth = before[before.find(_GROWTH) : before.find(_NEXT)] if _GROWTH in before else ""
        target.write_text(page.replace(_NEXT, growth + _NEXT), encoding="utf-8")
    else:
        print(page)


if __name__ == "__main__":
    main()
