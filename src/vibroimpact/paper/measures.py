"""What is measured of a run: quantities over time, and single values."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.response import Response
from vibroimpact.paper.runs import history_of

Timeline = Callable[[Response], tuple[Floats, Floats]]
"""From a response to times [s] and values [SI]; NaN where a line is broken."""

Measure = Callable[[Response], float]
"""From a response to a value [SI]."""


def column(name: str) -> Timeline:
    """Return what gives a column of the history."""
    return lambda response: (history_of(response)["time_s"], history_of(response)[name])


def falling_potential(response: Response) -> tuple[Floats, Floats]:
    """Return the potential energy of the sphere, zero where each fall begins; NaN where one fall gives way to the next."""
    history, impacts, problem = history_of(response), response.impacts, response.problem
    gravity = float(problem.gravity)
    tops = impacts["time_s"] + impacts["duration_s"] + impacts["separation_speed_m_s"] / gravity
    heights = np.append(history["position_m"][0], impacts["rebound_height_m"])
    time = history["time_s"]
    fall = np.searchsorted(tops, time)
    values = float(problem.sphere.mass) * gravity * (history["position_m"] - heights[fall])
    breaks = np.flatnonzero(np.diff(fall)) + 1
    return np.insert(time, breaks, time[breaks]), np.insert(values, breaks, np.nan)


@lru_cache(maxsize=16)
def sphere_strain(response: Response) -> tuple[Floats, Floats]:
    """Return times [s] and the strain energy of the sphere [J]: of its modes, or of the local element that stands for them.

    Spring and dashpot of the local element lie side by side and carry the contact force: k x + c dx/dt = F. Between two points of
    the history F is taken for a straight line, for which x is exact.
    """
    element, history = response.problem.local_element, history_of(response)
    time, force = history["time_s"], history["force_N"]
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
        lag = (force[index] - force[index - 1]) / step / rate
        begin = (force[index - 1] - lag) / stiffness
        elongation[index] = (force[index] - lag) / stiffness + (elongation[index - 1] - begin) * np.exp(-rate * step)
    return time, 0.5 * stiffness * elongation**2


def sphere_rotation(response: Response) -> tuple[Floats, Floats]:
    """Return times [s] and the energy of the sphere's rotation [J]; what is below 1e-15 J is rounding, and left out."""
    history = history_of(response)
    return history["time_s"], np.round(history["sphere_rotational_J"], 15)


def energy_at_separation(response: Response) -> float:
    """Return the kinetic energy of the sphere's centre at the first separation [J]."""
    return 0.5 * float(response.problem.sphere.mass) * float(response.impacts["separation_speed_m_s"][0]) ** 2


def largest_of(timeline: Timeline) -> Measure:
    """Return what gives the largest magnitude over time."""
    return lambda response: float(np.nanmax(np.abs(timeline(response)[1])))


def in_first_impact(name: str) -> Measure:
    """Return what gives a column of the impact table, of the first impact."""
    return lambda response: float(response.impacts[name][0])


def after_each_impact(timeline: Timeline) -> Callable[[Response], Floats]:
    """Return what gives the largest magnitude after each impact, before the next."""

    def peaks(response: Response) -> Floats:
        (time, values), touches = timeline(response), response.impacts["time_s"]
        which = np.searchsorted(touches, time, side="right")
        return np.array([np.nanmax(np.abs(values[which == impact])) for impact in range(1, len(touches) + 1)])

    return peaks


def energy_released(response: Response) -> float:
    """Return the potential energy of the sphere that is released down to its deepest point [J]."""
    potential = history_of(response)["potential_J"]
    return float(potential[0] - potential.min())


def plate_energy_part(response: Response) -> float:
    """Return the plate's largest kinetic and its largest strain energy, added, of the energy released [%]: as the paper counts."""
    history = history_of(response)
    return 100.0 * float(history["plate_kinetic_J"].max() + history["plate_strain_J"].max()) / energy_released(response)
