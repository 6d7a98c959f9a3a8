"""Measurements of a sphere that flew through air: evaluated with its drag, or in doubt without."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibroimpact.calibration.air_flights import AirFlights
from vibroimpact.calibration.flights import Flights
from vibroimpact.calibration.observations import Observations
from vibroimpact.calibration.restitution_limit import measured_restitutions
from vibroimpact.cases.case import Case
from vibroimpact.cases.rigid import first_speed
from vibroimpact.dynamics.air import AIR_DENSITY
from vibroimpact.errors import InputError

_MATTERS = 0.002  # of a restitution

_ROOM = 2.0  # more than the highest rise, since a fit may go astray before it settles


class Measurement(NamedTuple):
    """What was measured: how to evaluate it with given flights (in a vacuum: None), and the highest rise that it tells of [m]."""

    evaluated: Callable[[Flights | None], Observations]
    highest: float


def speed_at_touch(case: Case, flights: Flights | None) -> float:
    """Return the speed of the first touch of a case [m/s]: in air, if it falls through that from a height."""
    if flights is None or case.drop.height is None:
        return first_speed(case)
    return float(flights.speed_after_fall(np.array(case.drop.height - case.sphere.radius))[0])


def evaluate(case: Case, measurement: Measurement, air: bool | None) -> Observations:
    """Return what a measurement tells, with the drag of air in its flights or without; doubted where nothing says which, and it matters.

    Raises
    ------
    InputError
        If the measurement tells of no impacts, or of none that there are in air.
    """
    if case.drop.gravity == 0.0:  # no flight ends
        return measurement.evaluated(None)
    highest = max(measurement.highest, (case.drop.height or 0.0) - case.sphere.radius, 0.5 * first_speed(case) ** 2 / case.drop.gravity)
    flights = AirFlights(case.drop.gravity, case.sphere.radius, case.sphere.material.density, _ROOM * highest)
    if air:
        note = f"Flights have the drag of air ({AIR_DENSITY:g} kg/m³; Clift and Gauvin)."
        seen = measurement.evaluated(flights)
        heights = " Rebound heights are those that the sphere would reach without it." if "rebound_height" in seen.wanted else ""
        return replace(seen, notes=(note + heights, *seen.notes))
    seen = measurement.evaluated(None)
    if air is None and (doubt := _doubt(seen, measurement, flights, case)):
        return replace(seen, doubts=(*seen.doubts, doubt))
    return seen


def _doubt(seen: Observations, measurement: Measurement, flights: Flights, case: Case) -> str:
    try:
        other = measurement.evaluated(flights)
    except InputError:  # which tells of a sphere that never flew through air
        return ""
    without, with_air = (measured_restitutions(one, case.sphere.radius, case.drop.gravity) for one in (seen, other))
    if without is None or with_air is None or len(without) != len(with_air):
        return ""
    off = with_air / without - 1.0
    worst = int(np.argmax(np.abs(off)))
    if not abs(off[worst]) > _MATTERS:
        return ""
    return (
        f"the flights are evaluated without the drag of air, in which the restitution of {seen.labels[worst]} would be "
        f"{with_air[worst]:.4f}, not {without[worst]:.4f} ({100.0 * off[worst]:+.2g} %); set calibrate.air = true, or false if there "
        "was none"
    )
