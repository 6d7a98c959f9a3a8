"""A measured record and its simulation with the values found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fit.matching import Tunable
from vibroimpact.calibration.observed.flights import VacuumFlights
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem

_MOST_CONTACTS = 20
"""Number of contacts that are shown."""

_POINTS = 801
"""Points of a simulated contact."""


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
    """Return the measured record with its simulation.

    There is one overlay for each of the first contacts of a force, one in all for a position.

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
    if not np.all(outcomes["max_force"] > 0.0):
        return ()  # an impulsive law has no force
    drop = tunable.drop(values)
    contacts = []
    for impact, (time, force) in enumerate(seen.record.pieces[:_MOST_CONTACTS]):
        simulated = _contact(drop, impact, float(seen.speeds[impact]))
        contacts.append(contact_overlay(seen.labels[impact], (time, force), simulated))
    return tuple(contacts)


def contact_overlay(
    label: str, measured: tuple[Floats, Floats], simulated: tuple[Floats, Floats]
) -> Overlay:
    """Return a contact of a record over a simulated one, aligned by the centroids of the forces.

    Parameters
    ----------
    label : str
        Name of the contact.
    measured, simulated : tuple of two arrays
        Times [s], those of the record and those since the simulated first touch, and forces [N].

    Examples
    --------
    >>> time = np.linspace(0.0, 1e-3, 11)
    >>> pulse = np.sin(np.pi * time / 1e-3)
    >>> round(contact_overlay("impact 1", (2.0 + time, pulse), (time, pulse)).touch, 9)
    2.0
    """
    # the centroid of a pulse is better determined than its ends
    touch = _centroid(*measured) - _centroid(*simulated)
    time, force = measured
    return Overlay(label, "force", (time - touch, force), simulated, touch)


def _contact(drop: Problem, impact: int, speed: float) -> tuple[Floats, Floats]:
    """Return times since first touch [s] and the force [N] of a single impact."""
    law = drop.laws[min(impact, len(drop.laws) - 1)]
    single_impact = replace(
        drop,
        laws=(law,),
        height=None,
        speed=speed,
        impacts=1,
        duration=None,
        rest_speed=0.0,
        sensors=(),
    )
    response = simulate(single_impact)
    time = np.linspace(0.0, float(response.impacts["duration_s"].flat[0]), _POINTS)
    return time, response.at(time)["force_N"]


def _centroid(time: Floats, force: Floats) -> float:
    """Return the time of the centroid of a pulse [s]."""
    push = np.maximum(force, 0.0)
    return float(np.trapezoid(time * push, time) / np.trapezoid(push, time))


def _position(drop: Problem, seen: Observations, outcomes: Mapping[str, Floats]) -> Overlay:
    """Return the record with the flight after each simulated impact.

    Each flight begins when it does in the record: one after the other, they would show errors of
    their durations that add up.
    """
    assert seen.record is not None
    radius = float(drop.sphere.contact_offset)
    gravity = float(drop.gravity)
    flight_model = seen.flights or VacuumFlights(gravity)
    time, position = seen.record.pieces[0]
    simulated = np.full_like(time, np.nan)
    flights = []
    for rebound_height, begin in zip(outcomes["rebound_height"], seen.record.begins, strict=True):
        # the rebound height is that in a vacuum
        rise = max(float(rebound_height) - radius, 0.0)
        speed = np.sqrt(2.0 * gravity * rise)
        flight = flight_model.flight(np.asarray(speed))
        end = begin + float(flight.duration)
        inside = (time >= begin) & (time <= end)
        since_apex = time[inside] - begin - flight.rise_time
        depth, _ = flight_model.depth_at(since_apex)
        simulated[inside] = radius + flight.height - depth
        flights.append((begin, end))
    return Overlay("", "position", (time, position), (time, simulated), flights=tuple(flights))
