"""First touch of moving surfaces in free motion, and the time at which overlapping
surfaces separate.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.flight import (
    approach_of,
    flight_of,
    flown,
    greatest_vibration,
    state_after,
)
from vibroimpact.dynamics.core.records import Approach, State, System

_MOST_STEPS = 100_000
_MOST_HORIZONS = 10_000
_SAMPLES = 32
_FIRST_HORIZON = 1e-6  # s, where surfaces that overlap are at rest to each other
_NO_GAP = 1e-12  # of the bound of the vibration
_ROUNDING = 4e-16  # of the sum of the magnitudes of the terms of an approach, or of a time


@compiled
def approach_in(system: System, state: State) -> Approach:
    """Return the approach of the surfaces in a state, and bounds of what the vibration
    adds to it.
    """
    approach, rate = approach_of(system, state)
    rigid = system.offset
    rigid_rate = 0.0
    terms = abs(system.offset)
    fastest = 0.0
    for coordinate in range(len(state.displacement)):
        frequency = system.frequency[coordinate]
        term = system.shape[coordinate] * state.displacement[coordinate]
        terms += abs(term)
        if coordinate < system.rigid:
            rigid += term
            rigid_rate += system.shape[coordinate] * state.velocity[coordinate]
        else:
            peak_speed = math.sqrt(
                state.velocity[coordinate] ** 2 + (frequency * state.displacement[coordinate]) ** 2
            )
            # |q''| = |w^2 q + 2 zeta w v| <= (1 + 2 zeta) w sqrt(v^2 + w^2 q^2)
            damped = 1.0 + 2.0 * system.ratio[coordinate]
            fastest += abs(system.shape[coordinate]) * peak_speed * frequency * damped
    # e = e_0 exp(-r t)
    for element in range(len(state.local)):
        fastest += abs(state.local[element]) * system.rate[element] ** 2
    return Approach(
        approach, rate, rigid, rigid_rate, greatest_vibration(system, state), fastest, terms
    )


@compiled
def fall_time(approach: float, speed: float, gravity: float, level: float) -> float:
    """Return when a rigid approach reaches a level [s] under gravity; 0 if it already
    has, infinite if it never will.
    """
    # h = v t + g t^2/2, of whose roots each branch takes the form without cancellation
    height = level - approach
    if height <= 0.0:
        return 0.0
    squared = speed * speed + 2.0 * gravity * height
    if squared < 0.0:
        return np.inf
    if gravity == 0.0:
        return height / speed if speed > 0.0 else np.inf
    root = math.sqrt(squared)
    if speed > 0.0:
        return 2.0 * height / (root + speed)
    return (root - speed) / gravity


@compiled
def time_apart(now: Approach, level: float, gravity: float) -> float:
    r"""Return how long surfaces surely stay apart [s], under a bound of the acceleration of the
    approach by what is not vibration [m/s^2].

    With a bound M of the whole acceleration, a gap G that opens at the rate :math:`\dot G` can't
    close before
    :math:`\tau = (\dot G + \sqrt{\dot G^2 + 2 M G}) / M`. Far away, the displacement of the
    vibrating surface is bounded by its energy, and
    the parabola of the rigid motion gives the time until it is that near.
    """
    gap = max(level - now.approach, 0.0)
    opening = -now.rate
    far = fall_time(now.rigid, now.rigid_rate, gravity, level - now.reach)
    most = now.fastest + abs(gravity)
    near = np.inf
    if most > 0.0:
        root = math.sqrt(opening * opening + 2.0 * most * gap)
        near = (opening + root) / most
        if opening < 0.0:  # the same without cancellation
            near = 2.0 * gap / (root - opening)
    elif opening < 0.0:  # no acceleration: without gravity and vibration
        near = (level - now.approach) / -opening
    return max(far, near)


@compiled
def is_touch(now: Approach, level: float, time: float) -> bool:
    """Is a gap closed to the rounding error of the time since the start [s]?"""
    return time > 0.0 and now.rate >= 0.0 and level - now.approach <= _ROUNDING * now.rate * time


@compiled
def is_closing(now: Approach, level: float) -> bool:
    """Is a gap about to close where the time cannot tell any more?"""
    return level - now.approach <= _NO_GAP * now.reach or now.rate >= 0.0


@compiled
def is_apart(now: Approach, level: float) -> bool:
    """Do surfaces not overlap beyond a level, or by no more than a rounding error where
    they separate?
    """
    rounding = 0.0
    if now.rate < 0.0:
        rounding = _ROUNDING * now.terms
    return now.approach <= level + rounding


@compiled
def never_separates(now: Approach, level: float, gravity: float) -> bool:
    """Does the rigid motion close beyond the range of the vibration?"""
    return gravity >= 0.0 and now.rigid_rate >= 0.0 and now.rigid - now.reach > level


@compiled
def never_returns(now: Approach, level: float, gravity: float) -> bool:
    """Does the rigid motion open beyond the range of the vibration, with no gravity that
    turns it? What slows it in a fluid does not.
    """
    return gravity <= 0.0 and now.rigid_rate <= 0.0 and now.rigid + now.reach < level


@compiled
def time_to_separation(system: System, state: State, level: float) -> float:
    """Return when surfaces that overlap beyond a level separate to it [s]; 0 if they do
    not overlap, infinite if they never separate.
    """
    time = 0.0
    horizon = 0.0
    before = np.nan
    for _ in range(_MOST_HORIZONS):
        now = state
        if time != 0.0:
            now = state_after(system, state, time)
        approach = approach_in(system, now)
        horizon = next_horizon(approach, level, horizon, before)
        before = approach.approach
        if is_apart(approach, level):
            return time
        if never_separates(approach, level, system.gravity):
            return np.inf
        # in equal samples, of which one transition serves all
        begun = time
        flight = flight_of(system, horizon / _SAMPLES)
        for sample in range(1, _SAMPLES + 1):
            time = begun + horizon * (sample / _SAMPLES)
            now = flown(system, now, flight)
            if approach_of(system, now)[0] <= level:
                break
        if time == begun:  # the time step is below rounding
            return time
    return np.inf


@compiled
def next_horizon(now: Approach, level: float, horizon: float, before: float) -> float:
    """Return for how long to look for a separation [s]: to about twice that time, or longer than
    the last horizon if that changed nothing.

    `before`: approach at the start of that [m]. It does not change over a time below the rounding
    of the time of a flight.
    """
    if now.approach == before:
        return 2.0 * horizon
    if now.rate == 0.0:
        return _FIRST_HORIZON
    return 2.0 * (now.approach - level) / abs(now.rate)


@compiled
def next_touch(system: System, state: State, level: float, until: float) -> float:
    """Return when the approach first rises to a level [s from here]; infinite if not before
    `until`.

    From an open gap no touch is stepped over: the search advances by the times for which the
    surfaces surely stay apart. Near the touch these converge as fast as Newton's method. Surfaces
    that overlap beyond the level separate first.
    """
    time = time_to_separation(system, state, level)
    if not time < until:
        return np.inf
    for _ in range(_MOST_STEPS):
        moved = state
        if time != 0.0:
            moved = state_after(system, state, time)
        now = approach_in(system, moved)
        if is_touch(now, level, time):
            return time
        step = time_apart(now, level, system.gravity)
        if time + step > until or not np.isfinite(step):
            return np.inf
        if time + step == time:
            return time if is_closing(now, level) else np.inf
        time += step
    return time
