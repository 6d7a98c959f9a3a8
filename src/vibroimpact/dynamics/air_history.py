"""What air has taken in the history of one drop."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.flight_in_air import AirFlight
from vibroimpact.dynamics.leg import Leg


def air_lost(legs: Sequence[Leg], mass: float, time: Floats) -> Floats:
    """Return the energy that air has taken by times since the start of a run [J] (T,), from the flights of one drop of a mass [kg]."""
    begin = np.maximum(np.searchsorted([float(leg.flight.start[0]) for leg in legs], time, side="right") - 1, 0)
    found, before = np.zeros(len(time)), 0.0
    for number, leg in enumerate(legs):
        if isinstance(leg.flight, AirFlight):
            here = begin == number
            if here.any():
                found[here] = before + mass * leg.flight.lost(np.minimum(time[here], leg.flight_end[0])[:, None])[:, 0]
            before += mass * float(leg.flight.lost(leg.flight_end)[0])
    return found
