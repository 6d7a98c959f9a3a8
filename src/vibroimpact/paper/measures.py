"""Quantities evaluated from a response, and their comparison with a printed value under
each treatment.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.response import Response
from vibroimpact.paper.printed import PrintedValue
from vibroimpact.paper.report_section import ComparedValue, Explanation, Kind
from vibroimpact.paper.runs import TREATMENTS, Runs, history_of

Timeline = Callable[[Response], tuple[Floats, Floats]]
"""Function of a response that returns times [s] and values [SI]; NaN breaks the line."""

Measure = Callable[[Response], float]
"""Function of a response that returns a value [SI]."""


def history_column(name: str) -> Timeline:
    """Return a function that reads a column of the history."""
    return lambda response: (history_of(response)["time_s"], history_of(response)[name])


def falling_potential(response: Response) -> tuple[Floats, Floats]:
    """Return times [s] and the potential energy of the sphere [J], zero at the start of
    each fall; NaN between falls.
    """
    history = history_of(response)
    impacts = response.impacts
    problem = response.problem
    gravity = float(problem.gravity)
    weight = float(problem.sphere.mass) * gravity
    # a fall begins where the sphere stands still, after rising with the separation speed
    tops = impacts["time_s"] + impacts["duration_s"] + impacts["separation_speed_m_s"] / gravity
    heights = np.append(history["position_m"][0], impacts["rebound_height_m"])
    time = history["time_s"]
    fall = np.searchsorted(tops, time)
    values = weight * (history["position_m"] - heights[fall])
    # NaN breaks the line between two falls, so that the step is not drawn
    breaks = np.flatnonzero(np.diff(fall)) + 1
    return np.insert(time, breaks, time[breaks]), np.insert(values, breaks, np.nan)


@lru_cache(maxsize=16)
def sphere_strain(response: Response) -> tuple[Floats, Floats]:
    """Return times [s] and the strain energy of the sphere [J]: of its modes, or of the local
    element in their place.

    Spring and dashpot of the local element act in parallel and carry the contact force, k x + c
    dx/dt = F. F is interpolated linearly between the points of the history, and x is the exact
    solution for that.
    """
    element = response.problem.local_element
    history = history_of(response)
    time = history["time_s"]
    force = history["force_N"]
    if element is None:
        return time, history["sphere_strain_J"]
    stiffness, damping = element
    rate = stiffness / damping
    elongation = np.zeros_like(time)
    for index in range(1, len(time)):
        step = time[index] - time[index - 1]
        if step <= 0.0:
            elongation[index] = elongation[index - 1]
            continue
        # one solution follows the force, late by a time constant; what differs from it decays
        lag = (force[index] - force[index - 1]) / step / rate
        begin = (force[index - 1] - lag) / stiffness
        end = (force[index] - lag) / stiffness
        left = (elongation[index - 1] - begin) * np.exp(-rate * step)
        elongation[index] = end + left
    return time, 0.5 * stiffness * elongation**2


def sphere_rotation(response: Response) -> tuple[Floats, Floats]:
    """Return times [s] and the rotational energy of the sphere [J], rounded to 1e-15 J to
    remove rounding noise.
    """
    history = history_of(response)
    return history["time_s"], np.round(history["sphere_rotational_J"], 15)


def energy_at_separation(response: Response) -> float:
    """Return the kinetic energy of the sphere's centre at the first separation [J]."""
    speed = float(response.impacts["separation_speed_m_s"][0])
    return 0.5 * float(response.problem.sphere.mass) * speed**2


def largest_of(timeline: Timeline) -> Measure:
    """Return a function for the largest magnitude over time."""
    return lambda response: float(np.nanmax(np.abs(timeline(response)[1])))


def in_first_impact(name: str) -> Measure:
    """Return a function that reads a column of the impact table at the first impact."""
    return lambda response: float(response.impacts[name][0])


def after_each_impact(timeline: Timeline) -> Callable[[Response], Floats]:
    """Return a function for the largest magnitude between each impact and the next."""

    def peaks(response: Response) -> Floats:
        (time, values) = timeline(response)
        touches = response.impacts["time_s"]
        which = np.searchsorted(touches, time, side="right")
        return np.array(
            [np.nanmax(np.abs(values[which == impact])) for impact in range(1, len(touches) + 1)]
        )

    return peaks


def energy_released(response: Response) -> float:
    """Return the potential energy of the sphere that is released from the start to its
    lowest point [J].
    """
    potential = history_of(response)["potential_J"]
    return float(potential[0] - potential.min())


def plate_energy_part(response: Response) -> float:
    """Return the sum of the plate's largest kinetic and largest strain energy over the
    energy released [%], as in the paper.
    """
    history = history_of(response)
    largest = float(history["plate_kinetic_J"].max() + history["plate_strain_J"].max())
    return 100.0 * largest / energy_released(response)


MESH_DIGITS = 5
"""Significant digits shown of values that depend on a mesh."""

FITTED = ("type2.max_force", "type2.rebound_height")
"""The printed values to which the identified treatment was fitted."""


def kind_of(treatment: str) -> Kind | None:
    """Return the kind of the values computed under a treatment, where the printed value
    alone does not decide it.
    """
    if treatment == "identified":
        return Kind.FITTED_MODEL
    return None


_IDENTIFIED = {2: "fitted to force and rebound alone", 3: "a prediction from Type 2"}
"""What a value under the identified treatment is, by type."""
_STEPS = {2: "in steps fitted to Type 2", 3: "in steps found from Type 2"}
"""Where the steps of unresolved runs are from, by type."""


def values_by_treatment(
    runs: Runs,
    kind: int,
    value: PrintedValue,
    measure: Measure,
    unresolved: tuple[float, float] | None = None,
) -> list[ComparedValue]:
    """Return a printed value of Type 2 or 3 with the value computed under each treatment.

    Parameters
    ----------
    runs : Runs
        The simulations.
    kind : int
        2 or 3.
    value : PrintedValue
        The printed value.
    measure : callable
        Function of a response that returns the value in the printed unit.
    unresolved : tuple of two floats, optional
        Range of the value in unresolved runs of the superposed model.
    """
    phrase = {
        "consistent": "elastic bodies with this contact law give another value, and "
        "no setting of this treatment that was tried keeps what is printed",
        "superposed": "the resolved superposed model gives another value, and "
        "no setting of this treatment that was tried keeps what is printed",
        "identified": _IDENTIFIED[kind],
    }
    if unresolved is not None:
        low, high = unresolved
        explanation = Explanation("", low, high)
        if explanation.contains(value):
            inside = "lies in this range"
        elif explanation.holds(value):
            inside = "agrees with this range within its few digits"
        else:
            inside = "does not lie in this range"
        steps = _STEPS[kind]
        phrase["superposed"] += (
            f". A hypothesis: unresolved, on a coarse mesh and {steps}, it gives {low:.4g} "
            f"to {high:.4g} {value.unit}, and the printed value {inside}"
        )
    return [
        ComparedValue(
            value,
            measure(runs.treated(kind, treatment)),
            by=treatment,
            otherwise=phrase[treatment],
            fitted=treatment == "identified" and value.name in FITTED,
            digits=MESH_DIGITS,
            made_by=kind_of(treatment),
        )
        for treatment in TREATMENTS
    ]
