"""First touch of surfaces in free motion, and separation of surfaces that overlap."""

from __future__ import annotations

import numpy as np

from vibroimpact.dynamics.core import touch
from vibroimpact.dynamics.core.records import Approach
from vibroimpact.dynamics.vibrating.fluid_motion import FluidMotion
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion

_MOST_STEPS = 100_000
_MOST_HORIZONS = 10_000
_SAMPLES = np.linspace(0.0, 1.0, 33)[1:]


def next_touch(motion: FreeMotion, level: float, until: float) -> float:
    """Return when the indentation first rises to a level [s since the start].

    It is infinite if that is not before `until`. From an open gap no touch is stepped over.

    Parameters
    ----------
    motion : FreeMotion
        Motion from a state on. Surfaces that overlap beyond the level, as in a dent that does not
        affect the next contact, separate first.
    level : float
        Indentation at which the surfaces touch [m].
    until : float
        End of the search [s]; may be infinite.
    """
    if isinstance(motion, FluidMotion):
        return _next_touch_in_fluid(motion, level, until)
    return float(touch.next_touch(motion.system.record_of(0), motion.start.record, level, until))


def time_to_separation(motion: FreeMotion, level: float) -> float:
    """Return when surfaces that overlap beyond a level separate to it [s].

    It is 0 if they do not overlap, and infinite if they never separate.
    """
    if isinstance(motion, FluidMotion):
        return _time_to_separation_in_fluid(motion, level)
    return float(touch.time_to_separation(motion.system.record_of(0), motion.start.record, level))


# through a fluid, where the flight is not that of the core
# ------------------------------------------------------------------


def _approach(motion: FluidMotion, time: float) -> Approach:
    """Return the approach and its derivatives at a time [s]."""
    return touch.approach_in(motion.system.record_of(0), motion.state_after(time).record)


def _next_touch_in_fluid(motion: FluidMotion, level: float, until: float) -> float:
    """Return when the indentation first rises to a level [s], as `next_touch`."""
    time = _time_to_separation_in_fluid(motion, level)
    if not time < until:
        return np.inf
    gravity = float(motion.system.gravity[0])
    for _ in range(_MOST_STEPS):
        approach = _approach(motion, time)
        if touch.is_touch(approach, level, time):
            return time
        if touch.never_returns(approach, level, gravity):
            return np.inf
        # the surfaces stay apart for this time
        step = touch.time_apart(approach, level, motion.pull(time))
        if time + step > until or not np.isfinite(step):
            return np.inf
        if time + step == time:  # the time step is below rounding
            if not touch.is_closing(approach, level):
                return np.inf
            return time
        time += step
    return time


def _time_to_separation_in_fluid(motion: FluidMotion, level: float) -> float:
    """Return when surfaces that overlap separate [s], as `time_to_separation`."""
    gravity = float(motion.system.gravity[0])
    time = 0.0
    horizon = 0.0
    last_approach = np.nan
    for _ in range(_MOST_HORIZONS):
        approach = _approach(motion, time)
        # a shorter time is lost in that of the flight
        shortest = float(np.spacing(motion.flight.start[0] + time))
        horizon = max(touch.next_horizon(approach, level, horizon, last_approach), shortest)
        last_approach = approach.approach
        if touch.is_apart(approach, level):
            return time
        if touch.never_separates(approach, level, gravity):
            return np.inf
        times = time + horizon * _SAMPLES
        separated = motion.motion(times)[0][:, 0] <= level
        first = separated.argmax() if separated.any() else -1
        next_time = float(times[first])
        if next_time == time:  # the time step is below rounding
            return time
        time = next_time
    return np.inf
