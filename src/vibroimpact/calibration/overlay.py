"""A measured record and its simulation with the values found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.flights import VacuumFlights
from vibroimpact.calibration.matching import Tunable
from vibroimpact.calibration.observations import Observations
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.simulate import simulate

_MOST = 20  # contacts that are shown
_POINTS = 801


@dataclass(frozen=True)
class Overlay:
    """A piece of a record and its simulation.

    Parameters
    ----------
    label : str
        Name, such as "impact 1, line 305".
    quantity : "force" or "position"
        The contact force [N], or the height of the sphere's centre above the plate [m].
    measured, simulated : tuple of two arrays
        Times [s], relative to the simulated first touch for a force and those of the record for a
        position, and values.
    touch : float
        Time of the simulated first touch in the record of a force [s].
    flights : tuple of (float, float)
        Begin and end of each simulated flight in the record of a position [s].
    """

    label: str
    quantity: Literal["force", "position"]
    measured: tuple[Floats, Floats]
    simulated: tuple[Floats, Floats]
    touch: float = 0.0
    flights: tuple[tuple[float, float], ...] = ()


def overlays(
    tunable: Tunable, seen: Observations, values: Floats, outcomes: Mapping[str, Floats]
) -> tuple[Overlay, ...]:
    """Return the measured record with its simulation: one overlay for each of the first contacts of
    a force, one in all for a position.

    Parameters
    ----------
    tunable : Tunable
        The tuned parameter.
    seen : Observations
        The measurement; the result is empty if it is not a record, or a force record and the law
        has no force.
    values : array, shape (n,)
        The value found for each impact.
    outcomes : mapping of str to array, shape (n,)
        Quantities of the impacts with these values.
    """
    if seen.record is None:
        return ()
    if seen.record.quantity == "position":
        return (_position(tunable.drop(values), seen, outcomes),)
    drop, found = tunable.drop(values), []
    if not np.all(outcomes["max_force"] > 0.0):
        return ()  # an impulsive law has no force
    for number, (time, force) in enumerate(seen.record.pieces[:_MOST]):
        at, simulated = _contact(drop, number, float(seen.speeds[number]))
        # the centroid of a pulse is better determined than its ends
        shift = _middle(time, force) - _middle(at, simulated)
        found.append(
            Overlay(seen.labels[number], "force", (time - shift, force), (at, simulated), shift)
        )
    return tuple(found)


def _contact(drop: Problem, number: int, speed: float) -> tuple[Floats, Floats]:
    """Return times since first touch [s] and the force [N] of a single impact."""
    law = drop.laws[min(number, len(drop.laws) - 1)]
    begun = replace(
        drop,
        laws=(law,),
        height=None,
        speed=speed,
        impacts=1,
        duration=None,
        rest_speed=0.0,
        sensors=(),
    )
    response = simulate(begun)
    time = np.linspace(0.0, float(response.impacts["duration_s"].flat[0]), _POINTS)
    return time, response.at(time)["force_N"]


def _middle(time: Floats, force: Floats) -> float:
    push = np.maximum(force, 0.0)
    return float(np.trapezoid(time * push, time) / np.trapezoid(push, time))


def _position(drop: Problem, seen: Observations, outcomes: Mapping[str, Floats]) -> Overlay:
    """Return the record with the flight after each simulated impact, from when it begins in the
    record.

    One after the other, they would show errors of their durations that add up.
    """
    assert seen.record is not None
    radius, gravity = float(drop.sphere.contact_offset), float(drop.gravity)
    flying = seen.flights or VacuumFlights(gravity)
    time, position = seen.record.pieces[0]
    simulated, flights = np.full_like(time, np.nan), []
    for rebound, begin in zip(outcomes["rebound_height"], seen.record.begins, strict=True):
        flown = flying.flight(
            np.asarray(np.sqrt(2.0 * gravity * max(float(rebound) - radius, 0.0)))
        )
        inside = (time >= begin) & (time <= begin + flown.duration)
        simulated[inside] = (
            radius + flown.height - flying.depth_at(time[inside] - begin - flown.rise_time)[0]
        )
        flights.append((begin, begin + float(flown.duration)))
    return Overlay("", "position", (time, position), (time, simulated), flights=tuple(flights))
