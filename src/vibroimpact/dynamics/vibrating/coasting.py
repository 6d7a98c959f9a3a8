"""Recoil of a contact: its law has stopped pushing, and its surfaces still overlap."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.roots import find_root
from vibroimpact.dynamics.vibrating.active_contact import ActiveContact
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

_SAMPLES = 65


def end_of_coasting(
    free: FreeMotion, active: Sequence[ActiveContact], longest: float
) -> tuple[float, int, bool] | None:
    """Return when the first recoiling contact separates or pushes again [s from here],
    its number, and whether it separates; or None.
    """
    found = None
    for contact in active:
        begun, step = 0.0, _coasting_time_estimate(free, contact)
        while begun < longest:
            times = np.minimum(begun + step * np.linspace(0.0, 1.0, _SAMPLES), longest)
            ended = _coasting_end_values(free.system, contact, free.state(times)) > 0.0
            if ended[:, 1:].any():
                index = int(ended[:, 1:].any(axis=0).argmax())
                kind = int(ended[::-1, index + 1].argmin())  # separation (0) takes precedence
                value = along_motion(free, partial(coasting_end_value, free.system, contact, kind))
                longest = float(
                    find_root(value, times[index : index + 1], times[index + 1 : index + 2])[0]
                )
                found = longest, contact.number, kind == 0
                break
            begun, step = begun + step, 2.0 * step
    return found


def _coasting_time_estimate(free: FreeMotion, contact: ActiveContact) -> float:
    """Return an estimate of the duration of a recoil [s]."""
    above = contact.overlap(free.system, free.start)
    return max(
        above / max(-float(free.system.rates(free.start)[contact.number]), 1e-3 * contact.speed),
        1e-6 * contact.span,
    )


def _coasting_end_values(system: LinearSystem, contact: ActiveContact, states: State) -> Floats:
    """Return functions that are positive where a recoiling contact has separated, and
    where its law pushes again, (2, T).
    """
    approach, floor = system.approach(states)[..., contact.number], contact.local.release_level
    static, dissipative = contact.local.forces(
        np.maximum(approach, floor), system.outer_rates(states)[..., contact.number]
    )
    return np.stack([floor - approach, np.where(approach > floor, static + dissipative, -1.0)])


def coasting_end_value(
    system: LinearSystem, contact: ActiveContact, kind: int, states: State
) -> Floats:
    """Return a function that is positive where a recoiling contact has separated (kind
    0), or where its law pushes again (1), (T,).
    """
    return np.asarray(_coasting_end_values(system, contact, states)[kind])


def along_motion(
    motion: FreeMotion | VibratingStretch, value: Callable[[State], Floats]
) -> Callable[[Floats], Floats]:
    """Return a function of the state as a function of the time since the start of a motion [s]."""
    return lambda time: value(motion.state(time))
