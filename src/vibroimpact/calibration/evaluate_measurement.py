"""Evaluate a measurement with or without aerodynamic drag, and warn where drag was neglected but matters."""

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
from vibroimpact.cases.rigid import touch_speed
from vibroimpact.dynamics.air import Air
from vibroimpact.errors import InputError

_MATTERS = 0.002  # relative change of a restitution by drag above which a warning is given

_ROOM = 2.0  # margin of the flight tables over the largest rise, for intermediate iterates of a fit


class Measurement(NamedTuple):
    """A measurement: a function that evaluates it for a model of the flights (None: vacuum), and the largest rise in it [m]."""

    evaluated: Callable[[Flights | None], Observations]
    highest: float


def speed_at_touch(case: Case, flights: Flights | None) -> float:
    """Return the speed at first touch of a case [m/s], with drag if flights are given and the case gives the height."""
    if flights is None or case.drop.height is None or case.drop.air is not None:
        return touch_speed(case)
    return float(flights.speed_after_fall(np.array(case.drop.height - case.sphere.radius))[0])


def evaluate(case: Case, measurement: Measurement, air: bool | None) -> Observations:
    """Return the evaluated measurement, with drag if `air`, or if the drop of the case has it.

    If neither says so, it is without drag, and with a warning where drag matters.

    Raises
    ------
    InputError
        If the measurement shows no impacts, or flights that are impossible in air, or the case has air and `air` is False.
    """
    own = case.drop.air
    if own is not None and air is False:
        raise InputError("the sphere flies through air, as given by drop.air; leave one of them out", "air")
    if case.drop.gravity == 0.0:  # no flight returns
        return measurement.evaluated(None)
    highest = max(measurement.highest, (case.drop.height or 0.0) - case.sphere.radius, 0.5 * touch_speed(case) ** 2 / case.drop.gravity)
    through = Air() if own is None else own.air()
    flights = AirFlights(case.drop.gravity, case.sphere.radius, case.sphere.material.density, _ROOM * highest, through)
    if air or own is not None:
        source = "Clift and Gauvin" if through.drag_coefficient is None else f"drag coefficient {through.drag_coefficient:g}"
        note = f"Flights have the drag of air ({through.density:g} kg/m³; {source})."
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
    except InputError:  # impossible in air, so it was not measured in air
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
