"""Recoil: a law has stopped pushing while the surfaces still overlap, and they move freely until they separate or it pushes again."""

from __future__ import annotations

import numpy as np

from vibroimpact.compiled import compiled, force_at
from vibroimpact.dynamics.core.flight import approach_of, dashpot_rate, state_after
from vibroimpact.dynamics.core.law import law_indentation
from vibroimpact.dynamics.core.records import Law, Manner, State, System

_SAMPLES = 64
_MOST_HORIZONS = 2_000  # each twice as long as the one before


@compiled(lambda t: t.tuple(t.real, t.real)(t.of(System), t.of(Law), t.of(State)))
def recoil_values(system: System, law: Law, state: State) -> tuple[float, float]:
    """Return numbers that are positive where a recoiling contact has separated, and where its law pushes again."""
    approach, _ = approach_of(system, state)
    pushes = -1.0
    if approach > law.release_level:
        delta = law_indentation(law, approach)
        static, dissipative = force_at(law.addresses[0])(delta, dashpot_rate(system, state), law.speed, law.coefficients)
        pushes = static + dissipative
    return law.release_level - approach, pushes


@compiled(lambda t: t.tuple(t.real, t.boolean)(t.of(System), t.of(Law), t.of(Manner), t.of(State)))
def end_of_recoil(system: System, law: Law, manner: Manner, state: State) -> tuple[float, bool]:
    """Return when a recoiling contact separates or pushes again [s from here], and whether it separates."""
    approach, rate = approach_of(system, state)
    above = max(approach - law.release_level, 0.0)
    step = max(above / max(-rate, 1e-3 * manner.motion_speed), 1e-6 * manner.span)
    begun = 0.0
    for _ in range(_MOST_HORIZONS):
        before = begun
        for sample in range(1, _SAMPLES + 1):
            time = begun + step * sample / _SAMPLES
            parted, pushes = recoil_values(system, law, state_after(system, state, time))
            if parted > 0.0 or pushes > 0.0:
                separates = parted > 0.0
                low = before
                high = time
                # by halving and the secant in turn, to the rounding of the time
                low_value = recoil_values(system, law, state_after(system, state, low))[0 if separates else 1]
                high_value = parted if separates else pushes
                for iteration in range(200):
                    if not high - low > 1e-13 * high:
                        break
                    middle = 0.5 * (low + high)
                    if iteration % 3 != 2 and low_value < 0.0:
                        middle = low + (high - low) * min(max(low_value / (low_value - high_value), 1e-3), 1.0 - 1e-3)
                    if not low < middle < high:
                        break
                    value = recoil_values(system, law, state_after(system, state, middle))[0 if separates else 1]
                    if value > 0.0:
                        high = middle
                        high_value = value
                    else:
                        low = middle
                        low_value = value
                return high, separates
            before = time
        begun += step
        step *= 2.0
        if not np.isfinite(begun + step):
            break
    return np.inf, True
