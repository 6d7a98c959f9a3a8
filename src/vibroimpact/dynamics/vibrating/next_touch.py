"""First touch of moving surfaces in free motion, and the time at which overlapping surfaces separate."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State

_MOST_STEPS = 100_000
_MOST_HORIZONS = 10_000
_ROUNDING = 4e-16  # of the sum of the magnitudes of the terms of an approach: a smaller overlap is a rounding error
_SAMPLES = np.linspace(0.0, 1.0, 33)[1:]


def next_touch(motion: FreeMotion, level: float, until: float, contact: int = 0) -> float:
    r"""Return when the indentation first rises to a level [s since the start]; infinite if not before `until`.

    From an open gap no touch is stepped over. With a bound M of the acceleration from here on, a gap G that opens at the rate
    :math:`\dot G` can't close before :math:`\tau = (\dot G + \sqrt{\dot G^2 + 2 M G}) / M`, so the search advances by these bounds;
    near the touch they converge as fast as Newton's method. Far away, the displacement of the vibrating surface is bounded by its
    energy, and the parabola of the rigid motion gives the time until it is that near.

    Parameters
    ----------
    motion : FreeMotion
        Motion from a state on. Surfaces that overlap beyond the level, as in a dent that does not affect the next contact, separate first.
    level : float
        Indentation at which the surfaces touch [m].
    until : float
        End of the search [s]; may be infinite.
    contact : int, default 0
        Number of the contact in the system.
    """
    system = motion.system
    omega, size, local = system.angular_frequency, np.abs(system.shape[contact]), system.local_incidence[contact]
    time = time_to_separation(motion, level, contact)
    if not time < until:
        return np.inf
    for _ in range(_MOST_STEPS):
        state, gravity = motion.state(np.array(time)), float(motion.pull(time)[contact])
        gap, opening = level - float(system.approach(state)[contact]), -float(system.rates(state)[contact])
        # the gap is closed to the rounding error of the time
        if time > 0.0 and opening <= 0.0 and gap <= -4e-16 * opening * time:
            return time
        # the larger of two lower bounds of the time to touch: from the range of the vibration, and from the bound of the acceleration
        peak_speeds, reach = _peak_speeds(system, state), _displacement_bound(system, state, contact)
        approach, speed = (float(part[contact]) for part in system.rigid_motion(state))
        if system.gravity[contact] <= 0.0 and speed <= 0.0 and approach < level - reach:
            return np.inf  # what slows a sphere in a fluid does not bring it back
        far = _fall_time(approach, speed, gravity, level - reach)
        most = (
            float(size @ (peak_speeds * omega * (1.0 + 2.0 * system.damping_ratio)))
            + float(np.abs(state.local) @ (local * system.rate**2))
            + abs(gravity)
        )
        if most > 0.0:
            root = np.sqrt(opening * opening + 2.0 * most * max(gap, 0.0))
            near = (opening + root) / most if opening >= 0.0 else 2.0 * max(gap, 0.0) / (root - opening)
        else:  # no acceleration: without gravity and vibration
            near = gap / -opening if opening < 0.0 else np.inf
        step = max(far, near)
        if time + step > until or not np.isfinite(step):
            return np.inf
        if time + step == time:
            return time if gap <= 1e-12 * reach or opening <= 0.0 else np.inf
        time += step
    return time


def time_to_separation(motion: FreeMotion, level: float, contact: int = 0) -> float:
    """Return when surfaces that overlap beyond a level separate to it [s]; 0 if they do not overlap, infinite if they never separate."""
    system, time = motion.system, 0.0
    horizon, before = 0.0, np.nan
    for _ in range(_MOST_HORIZONS):
        state = motion.state(np.array(time))
        approach, rate = float(system.approach(state)[contact]), float(system.rates(state)[contact])
        overlap = approach - level
        needed = 2.0 * overlap / abs(rate) if rate else 1e-6
        # at least twice the last one where that changed little, as below the rounding of the time of a flight
        horizon = max(needed, 2.0 * horizon) if overlap > 0.5 * before else needed
        before = overlap
        terms = float(np.abs(system.shape[contact]) @ np.abs(state.displacement)) + abs(float(system.offset[contact]))
        if approach <= level + (_ROUNDING * terms if rate < 0.0 else 0.0):
            return time
        rigid_approach, rigid_rate = (float(part[contact]) for part in system.rigid_motion(state))
        if system.gravity[contact] >= 0.0 and rigid_rate >= 0.0 and rigid_approach - _displacement_bound(system, state, contact) > level:
            return np.inf  # the rigid motion closes beyond the range of the vibration: they never separate
        times = time + horizon * _SAMPLES
        parted = motion.motion(times)[0][:, contact] <= level
        later = float(times[parted.argmax() if parted.any() else -1])
        if later == time:  # the time step is below rounding
            return time
        time = later
    return np.inf


def _peak_speeds(system: LinearSystem, state: State) -> Floats:
    """Return an upper bound of the future speed of each mode, from its energy."""
    return np.where(system.rigid, 0.0, np.sqrt(state.velocity**2 + (system.angular_frequency * state.displacement) ** 2))


def _displacement_bound(system: LinearSystem, state: State, contact: int) -> float:
    """Return an upper bound of the future contribution of modes and massless elements to the approach [m]."""
    modal = np.abs(system.shape[contact]) @ (_peak_speeds(system, state) * np.sqrt(system.flexibility))
    return float(modal + np.abs(state.local) @ system.local_incidence[contact])


def _fall_time(approach: float, speed: float, gravity: float, level: float) -> float:
    """Return when the rigid approach reaches a level [s] under gravity; 0 if it already has, infinite if it never will."""
    height = level - approach
    if height <= 0.0:
        return 0.0
    if speed * speed + 2.0 * gravity * height < 0.0:
        return np.inf
    if gravity == 0.0:
        return height / speed if speed > 0.0 else np.inf
    root = np.sqrt(speed * speed + 2.0 * gravity * height)
    return float(2.0 * height / (root + speed) if speed > 0.0 else (root - speed) / gravity)
