"""A measured record and what is simulated with the values found, for the same times."""

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

_MOST = 5  # contacts that are drawn
_POINTS = 201


@dataclass(frozen=True)
class Overlay:
    """A piece of a record, and the same simulated.

    Parameters
    ----------
    label : str
        What it shows, such as "impact 1, line 305".
    quantity : "force" or "position"
        The contact force [N], or the height of the sphere's centre above the plate [m].
    measured, simulated : tuple of two arrays
        Times [s], from the simulated first touch for a force and those of the record for a position, and values.
    """

    label: str
    quantity: Literal["force", "position"]
    measured: tuple[Floats, Floats]
    simulated: tuple[Floats, Floats]


def overlays(tunable: Tunable, seen: Observations, values: Floats, outcomes: Mapping[str, Floats]) -> tuple[Overlay, ...]:
    """Return a record beside what is simulated: each of the first contacts of a force, or all flights of a position.

    Parameters
    ----------
    tunable : Tunable
        What was tuned.
    seen : Observations
        What was measured; nothing is returned if that was no record, or one of a force that the law does not have.
    values : array, shape (n,)
        The value found for each impact.
    outcomes : mapping of str to array, shape (n,)
        What the impacts are like with these values.
    """
    if seen.record is None:
        return ()
    if seen.record.quantity == "position":
        return (_position(tunable.drop(values), seen, outcomes),)
    drop, found = tunable.drop(values), []
    if not np.all(outcomes["max_force"] > 0.0):
        return ()  # a law without a force
    for number, (time, force) in enumerate(seen.record.pieces[:_MOST]):
        at, simulated = _contact(drop, number, float(seen.speeds[number]))
        shift = _middle(time, force) - _middle(at, simulated)  # the middle of a pulse is told better than its ends
        found.append(Overlay(seen.labels[number], "force", (time - shift, force), (at, simulated)))
    return tuple(found)


def _contact(drop: Problem, number: int, speed: float) -> tuple[Floats, Floats]:
    """Return times since first touch [s] and the force [N] of an impact by itself."""
    law = drop.laws[min(number, len(drop.laws) - 1)]
    begun = replace(drop, laws=(law,), height=None, speed=speed, impacts=1, duration=None, rest_speed=0.0, sensors=())
    response = simulate(begun)
    time = np.linspace(0.0, float(response.impacts["duration_s"].flat[0]), _POINTS)
    return time, response.at(time)["force_N"]


def _middle(time: Floats, force: Floats) -> float:
    push = np.maximum(force, 0.0)
    return float(np.trapezoid(time * push, time) / np.trapezoid(push, time))


def _position(drop: Problem, seen: Observations, outcomes: Mapping[str, Floats]) -> Overlay:
    """Return the record beside the flights that each impact sends up, as long after one another as contacts last."""
    assert seen.record is not None
    radius, gravity = float(drop.sphere.contact_offset), float(drop.gravity)
    flying = seen.flights or VacuumFlights(gravity)
    time, position = seen.record.pieces[0]
    simulated, begin = np.full_like(time, np.nan), seen.record.begin
    for rebound, lasting in zip(outcomes["rebound_height"], np.append(outcomes["duration"][1:], 0.0), strict=True):
        flown = flying.flight(np.asarray(np.sqrt(2.0 * gravity * max(float(rebound) - radius, 0.0))))
        inside = (time >= begin) & (time <= begin + flown.duration)
        simulated[inside] = radius + flown.height - flying.depth_at(time[inside] - begin - flown.rise_time)[0]
        begin += float(flown.duration) + float(lasting)
    return Overlay("", "position", (time, position), (time, simulated))
