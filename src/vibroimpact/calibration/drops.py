"""The whole drop with a calibrated value: the same at each impact, another at each, and by the fitted function."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from vibroimpact.calibration.matching import Tunable
from vibroimpact.calibration.observations import Floats
from vibroimpact.calibration.one_impact import first_speed
from vibroimpact.calibration.speed_function import SpeedFunction
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.simulate import simulate

MOST_IMPACTS = 20
"""Impacts of a drop that goes on to rest which are calibrated."""


def impacts_of(problem: Problem) -> int:
    """Return how many impacts of a drop are calibrated."""
    return min(problem.impacts or MOST_IMPACTS, MOST_IMPACTS)


def by_function(tunable: Tunable, problem: Problem, function: SpeedFunction) -> tuple[Floats, Floats]:
    """Return approach speeds [m/s] and values of the impacts of a drop whose value follows its approach speed."""
    speeds, values, speed = [], [], first_speed(problem)
    for impact in range(impacts_of(problem)):
        value = tunable.allowed.clip(np.array([function(speed)]))
        speeds.append(speed)
        values.append(float(value[0]))
        speed = float(tunable.respond(np.array([speed]), value, np.array([impact]))["next_speed"][0])
        if not speed > 0.0:
            break
    return np.array(speeds), np.array(values)


def drops_with(tunable: Tunable, values: Floats, by_speed: Floats) -> dict[str, Mapping[str, Floats]]:
    """Return the impact tables of the drop with the first value at each impact, with each its own, and with those of the function."""
    found: dict[str, Mapping[str, Floats]] = {}
    for name, given in (("constant", values[:1]), ("variable", values), ("function", by_speed)):
        found[name] = simulate(shortened(tunable.drop(given), len(values))).impacts
    return found


def shortened(problem: Problem, impacts: int) -> Problem:
    """Return a drop that stops after so many impacts at the latest."""
    return replace(problem, impacts=impacts, sensors=())
