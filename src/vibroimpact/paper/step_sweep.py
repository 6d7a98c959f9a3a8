"""The first impact of the superposed model in ever longer steps, on two meshes of the sphere, and what the paper prints of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import Literal

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.reader import load_table, read_case
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.paper.implicit_euler import PEAKS, SPENT, unresolved_impact
from vibroimpact.paper.printed import printed
from vibroimpact.paper.runs import Runs

Mesh = Literal["coarse", "fine"]

MESHES: tuple[Mesh, ...] = ("coarse", "fine")
"""As many modes as the program computes of a coarse mesh of few nodes, and the modes of the shipped case on its own mesh."""

COMPARED = ("max_force_N", "separation_speed_m_s", "sphere_strain_J")
"""What a step is judged by: the numbers that the paper prints of the first impact of Type 2."""

PHASES: Floats = (np.arange(24.0) + 0.5) / 24.0
"""Where in a step the surfaces meet."""

STEPS: Floats = np.geomspace(5e-6, 2.5e-4, 15)
"""Steps of a sweep [s], from the first that costs little to the paper's output step."""

MODES = (60, 120, 214)
"""Modes of the coarse mesh of four second-order bricks across; the last are as many as the program computes of it."""

_ACROSS = 4
_CLOSER = 25  # steps between those beside the best of a sweep


@dataclass(frozen=True, eq=False)
class Sweep:
    """What the first impact comes to in steps of several lengths.

    Parameters
    ----------
    steps : array, shape (S,)
        [s].
    found : dict of str to array, shape (S, P)
        What `unresolved_impact` gives, for each of the `PHASES`.
    """

    steps: Floats
    found: dict[str, Floats]

    def median(self, name: str) -> Floats:
        """Return the median over the phases (S,)."""
        return np.asarray(np.median(self.found[name], axis=1))

    def misfit(self, wanted: dict[str, float]) -> Floats:
        """Return the root mean square of the relative differences of the medians to what is wanted (S,)."""
        off = [self.median(name) / value - 1.0 for name, value in wanted.items()]
        return np.asarray(np.sqrt(np.mean(np.square(off), axis=0)))


def superposed(runs: Runs, kind: int, mesh: Mesh) -> Problem:
    """Return the problem of Type 2 or 3 with law and modes in series, one impact, on a mesh of the sphere."""
    return runs.problem(f"type{kind}-superposed") if mesh == "fine" else coarse(kind, MODES[-1])


@cache
def coarse(kind: int, modes: int) -> Problem:
    """Return the problem of Type 2 or 3 with law and modes in series, one impact, with some modes of the coarse mesh of the sphere."""
    table = load_table(f"paper:type{kind}-superposed")
    table["sphere"] |= {"modes": modes, "mesh": {"elements_across": _ACROSS, "kind": "hex20"}}
    return read_case(table).to_problem()


@cache
def sweep(problem: Problem, steps: tuple[float, ...] = tuple(STEPS.tolist())) -> Sweep:
    """Return what the first impact of a problem comes to in steps of several lengths [s]."""
    found = [unresolved_impact(problem, step, PHASES) for step in steps]
    return Sweep(np.array(steps), {name: np.array([one[name] for one in found]) for name in found[0]})


@cache
def resolved(problem: Problem) -> dict[str, float]:
    """Return what `unresolved_impact` gives, of the first impact when it is resolved; and duration_s, that of the contact [s]."""
    response = simulate(replace(problem, impacts=1, duration=None))
    impact = {name: float(values[0]) for name, values in response.impacts.items()}
    plate = problem.plate.modes
    followed = 0.5 / float(plate.frequencies.min()) if plate is not None else 0.0
    contact, after = np.linspace(0.0, impact["duration_s"], 401), np.linspace(impact["duration_s"], followed, 401)
    history = response.at(impact["time_s"] + np.concatenate([contact, after if followed > contact[-1] else []]))
    end = {name: float(values[len(contact) - 1]) for name, values in history.items()}
    shares = {name: end[name] for name in SPENT if name in end}
    shares["vibration_J"] = sum(end[f"{body}_J"] for body in ("sphere_vibration", "sphere_strain", "plate_kinetic", "plate_strain"))
    shares["modal_damping_J"] = end["sphere_damping_J"] + end["plate_damping_J"]
    peaks = {name: float(np.abs(history[name]).max()) for name in PEAKS if name in history}
    peaks["beyond_touch_m"] = float(problem.sphere.contact_offset - history["position_m"].min())
    return {**impact, **peaks, **shares, "integrator_J": 0.0}


def paper_impact(runs: Runs, kind: int) -> dict[str, float]:
    """Return what the paper prints of the first impact of Type 2 or 3: `COMPARED`, the speed from the height of the rebound."""
    problem = runs.problem(f"type{kind}-superposed")
    rise = printed(f"type{kind}.rebound_height").value - float(problem.sphere.contact_offset)
    speed = float(np.sqrt(2.0 * float(problem.gravity) * rise))
    values = (printed(f"type{kind}.max_force").value, speed, printed(f"type{kind}.strain_energy").value)
    return dict(zip(COMPARED, values, strict=True))


def closest(problem: Problem, wanted: dict[str, float]) -> Sweep:
    """Return the one step, and what it gives, with which a problem comes closest to what is wanted of `COMPARED`."""
    best = int(np.argmin(sweep(problem).misfit(wanted)))
    beside = STEPS[max(best - 1, 0)], STEPS[min(best + 1, len(STEPS) - 1)]
    closer = sweep(problem, tuple(np.geomspace(*beside, _CLOSER).tolist()))
    return sweep(problem, (float(closer.steps[np.argmin(closer.misfit(wanted))]),))
