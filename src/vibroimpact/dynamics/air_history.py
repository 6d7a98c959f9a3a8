"""Columns of the history of one drop that flies through air."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.flight_in_air import AirFlight
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.rigid.segments import FlightSegment, Segment


def air_history(problem: Problem, impacts: Mapping[str, Floats], segment: Segment, times: Floats) -> dict[str, Floats]:
    """Return the energy that air has taken by times since the start of a segment [J], and the acceleration if it is a flight."""
    before = int(np.searchsorted(impacts["time_s"], segment.start, side="right"))
    taken = np.full_like(times, impacts["air_lost_J"][:before].sum())
    if not (isinstance(segment, FlightSegment) and isinstance(segment.flight, AirFlight)):
        return {"air_J": taken}
    flight, time = segment.flight, segment.flight.start + times
    return {"air_J": taken + float(problem.sphere.mass) * flight.lost(time), "acceleration_m_s2": flight.acceleration(time)}
