"""What the figures of the paper show over time: columns of a response's history, and energies made from them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.dynamics.response import Response
from vibroimpact.report.excerpt import Floats
from vibroimpact.reproduction.runs import history_of

Timeline = Callable[[Response], tuple[Floats, Floats]]
"""From a response to times [s] and values [SI]."""


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


def in_first_impact(name: str) -> Callable[[Response], float]:
    """Return what gives a column of the impact table, of the first impact."""
    return lambda response: float(response.impacts[name][0])
