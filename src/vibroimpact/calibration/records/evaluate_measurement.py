"""Evaluate a measurement with or without drag, and warn where neglected drag matters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibroimpact.calibration.observed.flights import Flights
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.calibration.observed.restitution_limit import measured_restitutions
from vibroimpact.calibration.records.fluid_flights import FluidFlights
from vibroimpact.cases.case import Case
from vibroimpact.cases.rigid.pair import sphere_density
from vibroimpact.cases.rigid.rigid_problem import fluid_of, touch_speed
from vibroimpact.dynamics.fluids.air import Air
from vibroimpact.dynamics.fluids.fluid import Fluid
from vibroimpact.dynamics.fluids.liquid import Liquid
from vibroimpact.errors import InputError

_MATTERS = 0.002
"""Relative change of a restitution by drag above which a warning is given."""

_ROOM = 2.0
"""Margin of the flight tables over the largest rise, for intermediate iterates of a fit."""


class Measurement(NamedTuple):
    """A measurement.

    A function that evaluates it for a model of the flights (None: vacuum), and the largest rise in
    it [m].
    """

    evaluated: Callable[[Flights | None], Observations]
    highest: float


def speed_at_touch(case: Case, flights: Flights | None) -> float:
    """Return the speed at first touch of a case [m/s].

    It has drag if flights are given and the case gives the height.
    """
    if flights is None or case.drop.height is None or fluid_of(case) is not None:
        return touch_speed(case)
    speed, _ = flights.speed_after_fall(np.array(case.drop.height - case.sphere.radius))
    return float(speed)


def evaluate(case: Case, measurement: Measurement, air: bool | None) -> Observations:
    """Return the evaluated measurement, with or without drag.

    It has drag if `air`, or if the drop of the case has it, as in a liquid. If neither says so, it
    is without drag, and with a warning where drag matters.

    Raises
    ------
    InputError
        If the measurement shows no impacts, or flights that are impossible in air, or the case has
        air and `air` is False, or a liquid and `air` is given.
    """
    own = fluid_of(case)
    if air is not None and isinstance(own, Liquid):
        raise InputError(
            "the sphere flies through a liquid, as given by contact.liquid; leave one of them out",
            "air",
        )
    if own is not None and air is False:
        raise InputError(
            "the sphere flies through air, as given by drop.air; leave one of them out", "air"
        )
    if case.drop.gravity == 0.0:  # no flight returns
        return measurement.evaluated(None)
    fluid = Air() if own is None else own
    flights = _flights(case, measurement, fluid)
    if air or own is not None:
        seen = measurement.evaluated(flights)
        note = _note(fluid)
        if "rebound_height" in seen.wanted:
            note += " Rebound heights are those that the sphere would reach without it."
        return replace(seen, notes=(note, *seen.notes))
    seen = measurement.evaluated(None)
    if air is None:
        doubt = _drag_doubt(seen, measurement, flights, case)
        if doubt:
            return replace(seen, doubts=(*seen.doubts, doubt))
    return seen


def _flights(case: Case, measurement: Measurement, fluid: Fluid) -> FluidFlights:
    """Return flights through a fluid that are tabulated as high as the measurement needs."""
    gravity = case.drop.gravity
    radius = case.sphere.radius
    density = float(sphere_density(case.sphere))
    if case.drop.height is None or isinstance(fluid, Liquid):
        fall = 0.0
    else:
        fall = case.drop.height - radius
    # the rise without drag from the approach speed
    pull = FluidFlights(gravity, radius, density, 1.0, fluid).pull
    rise = 0.5 * touch_speed(case) ** 2 / pull
    highest = _ROOM * max(measurement.highest, fall, rise)
    return FluidFlights(gravity, radius, density, highest, fluid)


def _note(fluid: Fluid) -> str:
    source = "Clift and Gauvin"
    if isinstance(fluid, Air) and fluid.drag_coefficient is not None:
        source = f"drag coefficient {fluid.drag_coefficient:g}"
    if isinstance(fluid, Liquid):
        return (
            "Flights have the buoyancy, drag and added mass of the liquid "
            f"({fluid.density:g} kg/m³; {source})."
        )
    return f"Flights have the drag of air ({fluid.density:g} kg/m³; {source})."


def _drag_doubt(seen: Observations, measurement: Measurement, flights: Flights, case: Case) -> str:
    """Return a warning where the neglected drag of air matters; else an empty text."""
    try:
        seen_in_air = measurement.evaluated(flights)
    except InputError:  # impossible in air, so it was not measured in air
        return ""
    without = measured_restitutions(seen, case.sphere.radius, case.drop.gravity)
    with_air = measured_restitutions(seen_in_air, case.sphere.radius, case.drop.gravity)
    if without is None or with_air is None or len(without) != len(with_air):
        return ""
    change = with_air / without - 1.0
    worst = int(np.argmax(np.abs(change)))
    if not abs(change[worst]) > _MATTERS:
        return ""
    return (
        "the flights are evaluated without the drag of air, in which the restitution of "
        f"{seen.labels[worst]} would be "
        f"{with_air[worst]:.4f}, not {without[worst]:.4f} ({100.0 * change[worst]:+.2g} %); "
        "set calibrate.air = true, or false if there was none"
    )
