"""The first meeting of a sphere with a surface that moves."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State

_MOST_STEPS = 100_000
_MOST_HORIZONS = 10_000
_ROUNDING = 4e-16  # of the terms of an approach: what is less is not an overlap
_SAMPLES = np.linspace(0.0, 1.0, 33)[1:]


def next_touch(motion: FreeMotion, level: float, until: float, contact: int = 0) -> float:
    r"""Return when the indentation first rises to a level [s since the start]; infinite if not before `until`.

    No meeting is stepped over: with a bound M of the acceleration from here on, a gap G that opens at the rate
    :math:`\dot G` can't close before :math:`\tau = (\dot G + \sqrt{\dot G^2 + 2 M G}) / M`, so the search goes from
    bound to bound, which are as near as Newton's steps once the meeting is close. Far away, the surface reaches no
    farther than its energy allows, and the sphere's parabola says when it is that near.

    Parameters
    ----------
    motion : FreeMotion
        From a state on. Where the surfaces overlap beyond the level, as in a dent that the next contact does not find again, they
        part first.
    level : float
        Indentation at which the surfaces meet [m].
    until : float
        Where to give up [s]; may be infinite.
    contact : int, default 0
        Which contact of the system.
    """
    system, gravity = motion.system, float(motion.system.gravity[contact])
    omega, size, local = system.angular_frequency, np.abs(system.shape[contact]), system.local_incidence[contact]
    time = time_to_separation(motion, level, contact)
    if not time < until:
        return np.inf
    for _ in range(_MOST_STEPS):
        state = motion.state(np.array(time))
        gap, opening = level - float(system.approach(state)[contact]), -float(system.rates(state)[contact])
        if time > 0.0 and opening <= 0.0 and gap <= -4e-16 * opening * time:
            return time
        peak_speeds, reach = _peak_speeds(system, state), _displacement_bound(system, state, contact)
        approach, speed = (float(part[contact]) for part in system.rigid_motion(state))
        far = _fall_time(approach, speed, gravity, level - reach)
        most = (
            float(size @ (peak_speeds * omega * (1.0 + 2.0 * system.damping_ratio)))
            + float(np.abs(state.local) @ (local * system.rate**2))
            + abs(gravity)
        )
        if most > 0.0:
            root = np.sqrt(opening * opening + 2.0 * most * max(gap, 0.0))
            near = (opening + root) / most if opening >= 0.0 else 2.0 * max(gap, 0.0) / (root - opening)
        else:  # nothing turns it back: without gravity, and nothing vibrates
            near = gap / -opening if opening < 0.0 else np.inf
        step = max(far, near)
        if time + step > until or not np.isfinite(step):
            return np.inf
        if time + step == time:
            return time if gap <= 1e-12 * reach or opening <= 0.0 else np.inf
        time += step
    return time


def time_to_separation(motion: FreeMotion, level: float, contact: int = 0) -> float:
    """Return when surfaces that overlap beyond a level have come back to it [s]; 0 if they do not, infinite if they never will."""
    system, time = motion.system, 0.0
    for _ in range(_MOST_HORIZONS):
        state = motion.state(np.array(time))
        approach, rate = float(system.approach(state)[contact]), float(system.rates(state)[contact])
        horizon = 2.0 * (approach - level) / abs(rate) if rate else 1e-6
        terms = float(np.abs(system.shape[contact]) @ np.abs(state.displacement)) + abs(float(system.offset[contact]))
        if approach <= level + (_ROUNDING * terms if rate < 0.0 else 0.0):
            return time
        rigid_approach, rigid_rate = (float(part[contact]) for part in system.rigid_motion(state))
        if system.gravity[contact] >= 0.0 and rigid_rate >= 0.0 and rigid_approach - _displacement_bound(system, state, contact) > level:
            return np.inf  # the sphere sinks farther than the surface ever reaches
        times = time + horizon * _SAMPLES
        parted = motion.motion(times)[0][:, contact] <= level
        later = float(times[parted.argmax() if parted.any() else -1])
        if later == time:  # rounding alone keeps them together
            return time
        time = later
    return np.inf


def _peak_speeds(system: LinearSystem, state: State) -> Floats:
    """Return how fast each mode can ever become again."""
    return np.where(system.rigid, 0.0, np.sqrt(2.0 * sum(system.energies(state))))


def _displacement_bound(system: LinearSystem, state: State, contact: int) -> float:
    """Return how far the surfaces' own motion can ever take them towards each other, or apart [m]."""
    modal = np.abs(system.shape[contact]) @ (_peak_speeds(system, state) * np.sqrt(system.flexibility))
    return float(modal + np.abs(state.local) @ system.local_incidence[contact])


def _fall_time(approach: float, speed: float, gravity: float, level: float) -> float:
    """Return when a free sphere comes down to a level of its approach [s]; 0 if it is there, infinite if it never will."""
    height = level - approach
    if height <= 0.0:
        return 0.0
    if speed * speed + 2.0 * gravity * height < 0.0:
        return np.inf
    if gravity == 0.0:
        return height / speed if speed > 0.0 else np.inf
    root = np.sqrt(speed * speed + 2.0 * gravity * height)
    return float(2.0 * height / (root + speed) if speed > 0.0 else (root - speed) / gravity)
