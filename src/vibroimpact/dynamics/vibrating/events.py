"""Events of contacts that are not part of a stretch of others: touches, and ends of recoil.

In recoil the law of a contact has stopped pushing, and its surfaces still overlap.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.roots import find_root
from vibroimpact.dynamics.vibrating.active_contact import ActiveContact
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.radau_eigenbasis import GRID
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

ZERO_RATE = 1e-9  # of the speed of the motion: a slower approach counts as having turned already

_SAMPLES = 65
"""Instants at which a part of a recoil is searched for its end."""

SEPARATES = 0
PUSHES = 1
"""The ways in which a recoil may end."""


@dataclass(frozen=True)
class OtherEvent:
    """Event of a contact that is not part of a stretch.

    `value`: its function of the state, positive after the event. `act`: the action it causes. `x`:
    where it lies in the stretch.
    """

    value: Callable[[State], Floats]
    act: Callable[[], object]
    x: float = np.inf


def first_crossing(values: Floats) -> float | None:
    """Return the x of the first grid point at which values have become positive, or None."""
    crossed = (values[1:] > 0.0) & (values[:-1] <= 0.0)
    return float(GRID[1:][crossed][0]) if crossed.any() else None


def end_of_coasting(
    free: FreeMotion, active: Sequence[ActiveContact], longest: float
) -> tuple[float, int, bool] | None:
    """Return when the first recoiling contact separates or pushes again [s from here].

    With its number, and whether it separates; None if none does within the longest time.
    """
    first_end = None
    for contact in active:
        begin = 0.0
        span = _coasting_time_estimate(free, contact)
        while begin < longest:
            times = np.minimum(begin + span * np.linspace(0.0, 1.0, _SAMPLES), longest)
            ended = _coasting_end_values(free.system, contact, free.state(times)) > 0.0
            if ended[:, 1:].any():
                index = int(ended[:, 1:].any(axis=0).argmax())
                # separation takes precedence
                end = SEPARATES if ended[SEPARATES, index + 1] else PUSHES
                value = along_motion(free, partial(coasting_end_value, free.system, contact, end))
                root = find_root(value, times[index : index + 1], times[index + 1 : index + 2])
                longest = float(root[0])
                first_end = longest, contact.number, end == SEPARATES
                break
            begin += span
            span *= 2.0
    return first_end


def _coasting_time_estimate(free: FreeMotion, contact: ActiveContact) -> float:
    """Return an estimate of the duration of a recoil [s]."""
    overlap = contact.overlap(free.system, free.start)
    separation_speed = -float(free.system.rate_at(free.start, contact.number))
    return max(overlap / max(separation_speed, 1e-3 * contact.speed), 1e-6 * contact.span)


def _coasting_end_values(system: LinearSystem, contact: ActiveContact, states: State) -> Floats:
    """Return functions that are positive where a recoiling contact has ended its recoil, (2, T).

    The first is positive where it has separated, the second where its law pushes again.
    """
    approach = system.approach_at(states, contact.number)
    release_level = contact.local.release_level
    static, dissipative = contact.local.forces(
        np.maximum(approach, release_level), system.outer_rates(states)[..., contact.number]
    )
    force = np.where(approach > release_level, static + dissipative, -1.0)
    return np.stack([release_level - approach, force])


def coasting_end_value(
    system: LinearSystem, contact: ActiveContact, end: int, states: State
) -> Floats:
    """Return a function that is positive where a recoil has ended in one of its ways, (T,).

    `end`: `SEPARATES`, or `PUSHES` again.
    """
    return np.asarray(_coasting_end_values(system, contact, states)[end])


def along_motion(
    motion: FreeMotion | VibratingStretch, value: Callable[[State], Floats]
) -> Callable[[Floats], Floats]:
    """Return a function of the state as a function of the time since the start of a motion [s]."""

    def value_at(time: Floats) -> Floats:
        return value(motion.state(time))

    return value_at
