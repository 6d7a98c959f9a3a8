"""The first impact of the superposed model over the step length, on two meshes of the
sphere, and the step closest to the paper.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import Literal

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.reader import case_of, load_table
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.paper.implicit_euler import ENERGY_SHARES, PEAKS, unresolved_impact
from vibroimpact.paper.printed import printed
from vibroimpact.paper.runs import Runs

Mesh = Literal["coarse", "fine"]

MESHES: tuple[Mesh, ...] = ("coarse", "fine")
"""Meshes of the sphere: a coarse one with all modes that are computed for it, and that of
the shipped case with its modes.
"""

COMPARED = ("max_force_N", "separation_speed_m_s", "sphere_strain_J")
"""Quantities of the first impact that the misfit compares with the printed numbers."""

PHASES: Floats = (np.arange(24.0) + 0.5) / 24.0
"""Phases of the touch in a step, as `unresolved_impact` takes them."""

STEPS: Floats = np.geomspace(5e-6, 2.5e-4, 15)
"""Steps of a sweep [s], from the shortest affordable one to the paper's output step."""

MODES = (60, 120, 214)
"""Numbers of modes of the coarse mesh, of four second-order bricks across; the last is
the largest that is computed for it.
"""

_ELEMENTS_ACROSS = 4
_REFINED_STEPS = 25  # steps of the refined sweep between the neighbours of the best step


@dataclass(frozen=True, eq=False)
class StepSweep:
    """Results of `unresolved_impact` over the step length.

    Parameters
    ----------
    steps : array, shape (S,)
        Step lengths [s].
    found : dict of str to array, shape (S, P)
        Results for each of the `PHASES`.
    """

    steps: Floats
    found: dict[str, Floats]

    def median(self, name: str) -> Floats:
        """Return the median over the phases, (S,)."""
        return np.asarray(np.median(self.found[name], axis=1))

    def misfit(self, target: dict[str, float]) -> Floats:
        """Return the root mean square of the relative differences between the medians and
        target values, (S,).
        """
        differences = [self.median(name) / value - 1.0 for name, value in target.items()]
        return np.asarray(np.sqrt(np.mean(np.square(differences), axis=0)))


def superposed(runs: Runs, kind: int, mesh: Mesh) -> Problem:
    """Return the superposed problem of Type 2 or 3 on one of the `MESHES` of the sphere."""
    if mesh == "fine":
        return runs.problem(f"type{kind}-superposed")
    return coarse(kind, MODES[-1])


@cache
def coarse(kind: int, modes: int) -> Problem:
    """Return the superposed problem of Type 2 or 3 with a number of modes of the coarse
    mesh of the sphere.
    """
    table = load_table(f"paper:type{kind}-superposed")
    table["sphere"] |= {
        "modes": modes,
        "mesh": {"elements_across": _ELEMENTS_ACROSS, "kind": "hex20"},
    }
    return case_of(table).to_problem()


@cache
def sweep_steps(problem: Problem, steps: tuple[float, ...] = tuple(STEPS.tolist())) -> StepSweep:
    """Return the unresolved first impact of a problem over step lengths [s]."""
    impacts = [unresolved_impact(problem, step, PHASES) for step in steps]
    results = {name: np.array([impact[name] for impact in impacts]) for name in impacts[0]}
    return StepSweep(np.array(steps), results)


@cache
def resolved_impact(problem: Problem) -> dict[str, float]:
    """Return the results of `unresolved_impact` for the resolved first impact, and its
    impact table with duration_s, the contact time.
    """
    response = simulate(replace(problem, impacts=1, duration=None))
    impact = {name: float(values[0]) for name, values in response.impacts.items()}
    duration = impact["duration_s"]
    contact_times = np.linspace(0.0, duration, 401)
    times = contact_times
    plate = problem.plate.modes
    half_period = 0.0
    if plate is not None:
        half_period = 0.5 / float(plate.frequencies.min())
    if half_period > duration:
        # the plate swings through after the sphere has left it
        later_times = np.linspace(duration, half_period, 401)
        times = np.concatenate([contact_times, later_times])
    history = response.at(impact["time_s"] + times)
    peaks = {name: float(np.abs(history[name]).max()) for name in PEAKS if name in history}
    lowest = history["position_m"].min()
    peaks["beyond_touch_m"] = float(problem.sphere.contact_offset - lowest)

    separation = len(contact_times) - 1
    end = {name: float(values[separation]) for name, values in history.items()}
    shares = {name: end[name] for name in ENERGY_SHARES if name in end}
    vibrating = ("sphere_vibration_J", "sphere_strain_J", "plate_kinetic_J", "plate_strain_J")
    shares["vibration_J"] = sum(end[name] for name in vibrating)
    shares["modal_damping_J"] = end["sphere_damping_J"] + end["plate_damping_J"]
    shares["integrator_J"] = 0.0  # a resolved impact has no loss by the method
    return {**impact, **peaks, **shares}


def paper_impact(runs: Runs, kind: int) -> dict[str, float]:
    """Return the printed `COMPARED` quantities of the first impact of Type 2 or 3; the
    speed follows from the rebound height.
    """
    problem = runs.problem(f"type{kind}-superposed")
    rise = printed(f"type{kind}.rebound_height").value - float(problem.sphere.contact_offset)
    force = printed(f"type{kind}.max_force").value
    speed = float(np.sqrt(2.0 * float(problem.gravity) * rise))
    strain_energy = printed(f"type{kind}.strain_energy").value
    return dict(zip(COMPARED, (force, speed, strain_energy), strict=True))


def closest(problem: Problem, target: dict[str, float]) -> StepSweep:
    """Return the sweep of the one step with the least misfit to target values of the
    `COMPARED` quantities.
    """
    best = int(np.argmin(sweep_steps(problem).misfit(target)))
    shorter = STEPS[max(best - 1, 0)]
    longer = STEPS[min(best + 1, len(STEPS) - 1)]
    steps = np.geomspace(shorter, longer, _REFINED_STEPS)
    refined = sweep_steps(problem, tuple(steps.tolist()))
    step = float(refined.steps[np.argmin(refined.misfit(target))])
    return sweep_steps(problem, (step,))
