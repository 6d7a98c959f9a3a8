"""A contact that recoils: its law has stopped pushing, and its surfaces still overlap."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.roots import find_root
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.touching import Touching

_SAMPLES = 65


def end_of_recoil(free: FreeMotion, touching: Sequence[Touching], longest: float) -> tuple[float, int, bool] | None:
    """Return when the first contact that recoils parts or pushes again [s from here], which, and whether it parts."""
    found = None
    for touch in touching:
        begun, step = 0.0, _time_to_recoil(free, touch)
        while begun < longest:
            times = np.minimum(begun + step * np.linspace(0.0, 1.0, _SAMPLES), longest)
            ended = _recoil(free.system, touch, free.state(times)) > 0.0
            if ended[:, 1:].any():
                index = int(ended[:, 1:].any(axis=0).argmax())
                kind = int(ended[::-1, index + 1].argmin())  # parted (0), if both
                value = after(free, partial(recoil_of, free.system, touch, kind))
                longest = float(find_root(value, times[index : index + 1], times[index + 1 : index + 2])[0])
                found = longest, touch.number, kind == 0
                break
            begun, step = begun + step, 2.0 * step
    return found


def _time_to_recoil(free: FreeMotion, touch: Touching) -> float:
    """Return about how long a contact takes to recoil [s]."""
    above = touch.overlap(free.system, free.start)
    return max(above / max(-float(free.system.rates(free.start)[touch.number]), 1e-3 * touch.speed), 1e-6 * touch.span)


def _recoil(system: LinearSystem, touch: Touching, states: State) -> Floats:
    """Return what is positive where a contact that recoils has parted, and where its law pushes again, (2, T)."""
    approach, floor = system.approach(states)[..., touch.number], touch.local.release_level
    static, dissipative = touch.local.forces(np.maximum(approach, floor), system.outer_rates(states)[..., touch.number])
    return np.stack([floor - approach, np.where(approach > floor, static + dissipative, -1.0)])


def recoil_of(system: LinearSystem, touch: Touching, kind: int, states: State) -> Floats:
    """Return what is positive where a contact that recoils has parted (0), or where its law pushes again (1), (T,)."""
    return np.asarray(_recoil(system, touch, states)[kind])


def after(motion: FreeMotion | VibratingStretch, value: Callable[[State], Floats]) -> Callable[[Floats], Floats]:
    """Return a function of the state as one of the time since the start of a motion [s]."""
    return lambda time: value(motion.state(time))
