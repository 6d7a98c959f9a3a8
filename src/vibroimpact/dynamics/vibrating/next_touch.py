"""First touch of moving surfaces in free motion, and the time at which overlapping
surfaces separate.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.dynamics.core import touch
from vibroimpact.dynamics.core.records import Approach
from vibroimpact.dynamics.vibrating.fluid_motion import FluidMotion
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion

_MOST_STEPS = 100_000
_MOST_HORIZONS = 10_000
_SAMPLES = np.linspace(0.0, 1.0, 33)[1:]


def next_touch(motion: FreeMotion, level: float, until: float, contact: int = 0) -> float:
    """Return when the indentation first rises to a level [s since the start]; infinite if not
    before `until`.

    From an open gap no touch is stepped over.

    Parameters
    ----------
    motion : FreeMotion
        Motion from a state on. Surfaces that overlap beyond the level, as in a dent that does not
        affect the next contact, separate first.
    level : float
        Indentation at which the surfaces touch [m].
    until : float
        End of the search [s]; may be infinite.
    contact : int, default 0
        Number of the contact in the system.
    """
    if isinstance(motion, FluidMotion):
        return _next_touch_in_fluid(motion, level, until)
    return float(
        touch.next_touch(motion.system.record_of(contact), motion.start.record, level, until)
    )


def time_to_separation(motion: FreeMotion, level: float, contact: int = 0) -> float:
    """Return when surfaces that overlap beyond a level separate to it [s]; 0 if they do
    not overlap, infinite if they never separate.
    """
    if isinstance(motion, FluidMotion):
        return _time_to_separation_in_fluid(motion, level)
    return float(
        touch.time_to_separation(motion.system.record_of(contact), motion.start.record, level)
    )


# through a fluid, in which the sphere flies by steps that are not those of the core


def _approach(motion: FluidMotion, time: float) -> Approach:
    return touch.approach_in(motion.system.record_of(0), motion.state_after(time).record)


def _next_touch_in_fluid(motion: FluidMotion, level: float, until: float) -> float:
    time = _time_to_separation_in_fluid(motion, level)
    if not time < until:
        return np.inf
    for _ in range(_MOST_STEPS):
        now = _approach(motion, time)
        if touch.is_touch(now, level, time):
            return time
        if touch.never_returns(now, level, float(motion.system.gravity[0])):
            return np.inf
        step = touch.time_apart(now, level, motion.pull(time))
        if time + step > until or not np.isfinite(step):
            return np.inf
        if time + step == time:
            return time if touch.is_closing(now, level) else np.inf
        time += step
    return time


def _time_to_separation_in_fluid(motion: FluidMotion, level: float) -> float:
    system, time = motion.system, 0.0
    horizon, before = 0.0, np.nan
    for _ in range(_MOST_HORIZONS):
        now = _approach(motion, time)
        # a shorter time is lost in that of the flight
        shortest = float(np.spacing(motion.flight.start[0] + time))
        horizon = max(touch.next_horizon(now, level, horizon, before), shortest)
        before = now.approach
        if touch.is_apart(now, level):
            return time
        if touch.never_separates(now, level, float(system.gravity[0])):
            return np.inf
        times = time + horizon * _SAMPLES
        parted = motion.motion(times)[0][:, 0] <= level
        later = float(times[parted.argmax() if parted.any() else -1])
        if later == time:  # the time step is below rounding
            return time
        time = later
    return np.inf
