"""The drop computed with calibrated values: constant, one per impact, or by the fitted polynomial."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.flights import Flights
from vibroimpact.calibration.matchable import MATCHABLE
from vibroimpact.calibration.matching import Tunable
from vibroimpact.calibration.observations import Observations
from vibroimpact.calibration.single_impacts import first_approach_speed, return_speeds
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.simulate import simulate

MOST_IMPACTS = 20
"""The largest number of impacts that are calibrated."""


def impact_count(problem: Problem) -> int:
    """Return the number of impacts of a drop to be calibrated."""
    return min(problem.impacts or MOST_IMPACTS, MOST_IMPACTS)


def values_by_function(tunable: Tunable, problem: Problem, function: SpeedFunction, seen: Observations) -> tuple[Floats, Floats]:
    """Return approach speeds [m/s] and values of the impacts of a drop whose value is a function of the approach speed."""
    first = first_approach_speed(problem) if seen.flights is None else float(seen.speeds[0])
    table = _impact_sequence(tunable, lambda _, speed: function(speed), impact_count(problem), first, seen.flights)
    return table["approach_speed_m_s"], table["value"]


def impact_tables(tunable: Tunable, values: Floats, by_speed: Floats, seen: Observations) -> dict[str, Mapping[str, Floats]]:
    """Return the impact tables of the drop: "constant" (first value), "variable" (one value per impact), "function" (`by_speed`).

    If the flights have drag, the impacts are computed one by one and connected by those flights.
    """
    found: dict[str, Mapping[str, Floats]] = {}
    for name, given in (("constant", values[:1]), ("variable", values), ("function", by_speed)):
        if seen.flights is None:
            found[name] = simulate(limited_to(tunable.drop(given), len(values))).impacts
        else:
            found[name] = _impact_sequence(tunable, _one_each(given), len(values), float(seen.speeds[0]), seen.flights)
    return found


def _one_each(values: Floats) -> Callable[[int, float], float]:
    return lambda impact, _: float(values[min(impact, len(values) - 1)])


def _impact_sequence(
    tunable: Tunable, value_of: Callable[[int, float], float], number: int, first: float, flights: Flights | None
) -> dict[str, Floats]:
    """Return successive impacts with the value of each, as columns of an impact table."""
    rows: list[dict[str, float]] = []
    speed = first
    for impact in range(number):
        value = tunable.allowed.clip(np.array([value_of(impact, speed)]))
        found = tunable.respond(np.array([speed]), value, np.array([impact]))
        outcomes = {column: float(found[name][0]) for name, (column, *_) in MATCHABLE.items()}
        rows.append({"impact": impact + 1, "approach_speed_m_s": speed, "value": float(value[0]), **outcomes})
        speed = float(found["next_speed"][0])
        if not speed > 0.0:
            break
        if flights is None:
            speed = float(return_speeds(tunable.drop(value), np.array([speed]))[0])
        else:
            speed = float(flights.flight(np.asarray(speed)).return_speed)
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def limited_to(problem: Problem, impacts: int) -> Problem:
    """Return the drop, ended after a number of impacts at the latest, without sensors."""
    return replace(problem, impacts=impacts, sensors=())
