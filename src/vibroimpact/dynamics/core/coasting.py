"""Recoil: a law has stopped pushing while the surfaces still overlap, and they move
freely until they separate or it pushes again.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.compiled import compiled, force_at
from vibroimpact.dynamics.core.contact_records import Manner
from vibroimpact.dynamics.core.flight import (
    approach_of,
    dashpot_rate,
    flight_of,
    flown,
    state_after,
)
from vibroimpact.dynamics.core.law import law_indentation
from vibroimpact.dynamics.core.line_events import narrowed, secant_of
from vibroimpact.dynamics.core.line_records import Bracket
from vibroimpact.dynamics.core.records import Law, State, System

_SAMPLES = 64
_MOST_HORIZONS = 2_000  # each twice as long as the one before
_MOST_SECANTS = 200
_TIME_ROUNDING = 1e-13  # of the time of a recoil
_LEAST = 1e-300


@compiled
def push_at(law: Law, approach: float, rate: float) -> float:
    """Return the force with which a law would push at an approach of the surfaces [m] and its rate
    [m/s], negative where they are apart [N].
    """
    if approach <= law.release_level:
        return -1.0
    delta = law_indentation(law, approach)
    static, dissipative = force_at(law.addresses[0])(delta, rate, law.speed, law.coefficients)
    return float(static + dissipative)


@compiled
def coasting_values(system: System, law: Law, state: State) -> tuple[float, float]:
    """Return numbers that are positive where a recoiling contact has separated, and where
    its law pushes again.
    """
    approach, _ = approach_of(system, state)
    return law.release_level - approach, push_at(law, approach, dashpot_rate(system, state))


@compiled
def change_between(
    system: System, law: Law, state: State, low: float, high: float, separates: bool
) -> float:
    """Return when between two times [s] a recoiling contact separates, or else pushes again, to the
    rounding of the time.
    """
    kind = 0 if separates else 1
    low_value = coasting_values(system, law, state_after(system, state, low))[kind]
    high_value = coasting_values(system, law, state_after(system, state, high))[kind]
    # the change has come at the end, whatever rounding makes of its value there
    bracket = Bracket(low, high, low_value, max(high_value, _LEAST), 0)
    for _ in range(_MOST_SECANTS):
        rounding = _TIME_ROUNDING * bracket.high
        if not bracket.high - bracket.low > rounding:
            break
        middle = 0.5 * (bracket.low + bracket.high)
        if bracket.low_value < 0.0:
            middle = secant_of(bracket)
        middle = min(max(middle, bracket.low + 0.25 * rounding), bracket.high - 0.25 * rounding)
        value = coasting_values(system, law, state_after(system, state, middle))[kind]
        bracket = narrowed(bracket, middle, value)
    return bracket.high


@compiled
def end_of_coasting(system: System, law: Law, manner: Manner, state: State) -> tuple[float, bool]:
    """Return when a recoiling contact separates or pushes again [s from here], and
    whether it separates.
    """
    approach, rate = approach_of(system, state)
    above = max(approach - law.release_level, 0.0)
    # about the time to separation at the present rate
    step = max(above / max(-rate, 1e-3 * manner.motion_speed), 1e-6 * manner.span)
    begun = 0.0
    now = state
    # free motion is followed in equal samples, of which one transition serves all
    for _ in range(_MOST_HORIZONS):
        before = begun
        flight = flight_of(system, step / _SAMPLES)
        for sample in range(1, _SAMPLES + 1):
            time = begun + step * sample / _SAMPLES
            now = flown(system, now, flight)
            parted, pushes = coasting_values(system, law, now)
            if parted > 0.0 or pushes > 0.0:
                return change_between(system, law, state, before, time, parted > 0.0), parted > 0.0
            before = time
        begun += step
        step *= 2.0
        if not np.isfinite(begun + step):
            break
    return np.inf, True
