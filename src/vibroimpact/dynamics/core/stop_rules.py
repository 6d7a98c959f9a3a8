"""Rules that end the run of a drop in its flight, and the rule by which it is at rest.

How a contact ends is decided at its release, and with the rule of rest whether a sphere is at rest
then.

A rule is a function that returns when it ends a run [s], infinite where it does not. A further one
is a function of this file, with a number that `end_under` knows.
"""

from __future__ import annotations

import math

from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.drop_records import END_LEFT, FreeFall, StopRules

AT_TIME, AFTER_IMPACTS, BESIDE_PLATE = range(3)
"""Kinds of rules; their values are a time [s], a number of impacts, and none."""


@compiled
def is_too_slow(speed: float, rest_speed: float) -> bool:
    """Does a sphere that separates at a speed [m/s] count as at rest? It does below the rest speed,
    or if it does not separate.
    """
    return speed < rest_speed or speed == 0.0


@compiled
def end_at_time(time: float, flight: FreeFall) -> float:
    """Return the end of a run at a time [s], or after a contact that is under way then."""
    return max(time, flight.start)


@compiled
def end_after_impacts(number: float, flight: FreeFall, impacts: int) -> float:
    """Return the end of a run after so many impacts [s], at the top of the rebound."""
    if impacts >= number:
        return min(flight.top, flight.touch)
    return math.inf


@compiled
def end_beside_plate(flight: FreeFall) -> float:
    """Return the end of a run where a sphere beside the plate is level with its surface [s]."""
    return flight.touch if flight.is_beside else math.inf


@compiled
def end_under(kind: int, value: float, flight: FreeFall, impacts: int) -> float:
    """Return when a rule of a kind ends a run [s]."""
    if kind == AT_TIME:
        return end_at_time(value, flight)
    if kind == BESIDE_PLATE:
        return end_beside_plate(flight)
    return end_after_impacts(value, flight, impacts)


@compiled
def first_end(rules: StopRules, flight: FreeFall, impacts: int) -> tuple[float, int]:
    """Return when the first rule ends a run [s], and how it ends then.

    Of two rules that end it at one time the first counts. A drop that no rule ends and that never
    touches again stops as it leaves.
    """
    time = math.inf
    ending = END_LEFT
    for rule in range(len(rules.kinds)):
        end = end_under(rules.kinds[rule], rules.values[rule], flight, impacts)
        if end < time:
            time = end
            ending = rules.endings[rule]
    if flight.touch == math.inf and time == math.inf:
        time = flight.start
    return time, ending
