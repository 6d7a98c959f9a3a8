"""The drop computed with calibrated values: constant, one per impact, or by the polynomial."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fit.matching import Tunable
from vibroimpact.calibration.fit.single_impacts import first_approach_speed, return_speeds
from vibroimpact.calibration.observed.flights import Flights
from vibroimpact.calibration.observed.matchable import MATCHABLE
from vibroimpact.calibration.observed.noise import standard_deviations
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem

MOST_IMPACTS = 20
"""The largest number of impacts that are calibrated."""

_OTHER_DROP = 0.005
_SURE = 3.0
"""Deviation of the first speed that was measured from that of the drop above which it was another
drop: a fraction, and a number of standard deviations.
"""


def impact_count(problem: Problem) -> int:
    """Return the number of impacts of a drop to be calibrated."""
    return min(problem.impacts or MOST_IMPACTS, MOST_IMPACTS)


def is_other_drop(problem: Problem, seen: Observations) -> bool:
    """Return whether measured successive impacts begin at another speed than the drop.

    The speeds differ by more than noise and half a per cent.
    """
    if not (seen.measured and seen.of_the_drop) or seen.flights is not None:
        return False
    speed = float(seen.speeds[0])
    deviation = float(standard_deviations(seen.speed_noise)[0])
    difference = abs(speed - first_approach_speed(problem))
    return difference > max(_OTHER_DROP * speed, _SURE * deviation)


def values_by_function(
    tunable: Tunable, function: SpeedFunction, number: int, first: float, flights: Flights | None
) -> tuple[Floats, Floats]:
    """Return approach speeds [m/s] and values of impacts whose value is a function of the speed.

    `first` is the approach speed of the first impact [m/s], `number` the largest number of impacts.
    """
    table = _impact_sequence(tunable, lambda _, speed: function(speed), number, first, flights)
    return table["approach_speed_m_s"], table["value"]


def impact_tables(
    tunable: Tunable, values: Floats, by_speed: Floats, seen: Observations
) -> dict[str, Mapping[str, Floats]]:
    """Return the impact tables of the drop with calibrated values.

    They are "constant" (first value), "variable" (one value per impact), "function" (`by_speed`).
    What was measured successively begins at its own first speed. If the flights have drag, the
    impacts are computed one by one and connected by those flights.
    """
    prescribed = {"constant": values[:1], "variable": values, "function": by_speed}
    first_speed = float(seen.speeds[0])
    tables: dict[str, Mapping[str, Floats]] = {}
    for name, prescribed_values in prescribed.items():
        if seen.flights is None:
            drop = limited_to(tunable.drop(prescribed_values), len(values))
            if seen.measured and seen.of_the_drop:
                drop = replace(drop, height=None, speed=first_speed)
            tables[name] = simulate(drop).impacts
        else:
            tables[name] = _impact_sequence(
                tunable, _by_impact(prescribed_values), len(values), first_speed, seen.flights
            )
    return tables


def _by_impact(values: Floats) -> Callable[[int, float], float]:
    """Return the value of each impact; the last value holds for all further impacts."""

    def value_of(impact: int, speed: float) -> float:
        return float(values[min(impact, len(values) - 1)])

    return value_of


def _impact_sequence(
    tunable: Tunable,
    value_of: Callable[[int, float], float],
    number: int,
    first: float,
    flights: Flights | None,
) -> dict[str, Floats]:
    """Return successive impacts with the value of each, as columns of an impact table.

    `value_of` returns the value of an impact from its number and its approach speed [m/s].
    """
    rows: list[dict[str, float]] = []
    speed = first
    for impact in range(number):
        value = tunable.allowed.clip(np.array([value_of(impact, speed)]))
        outcomes = tunable.respond(np.array([speed]), value, np.array([impact]))
        rows.append(
            {
                "impact": impact + 1,
                "approach_speed_m_s": speed,
                "value": float(value[0]),
                **{
                    quantity.column: float(outcomes[name][0])
                    for name, quantity in MATCHABLE.items()
                },
            }
        )
        speed = float(outcomes["next_speed"][0])
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
