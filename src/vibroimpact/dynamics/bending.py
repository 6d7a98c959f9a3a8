"""Largest bending of an elastic plate at the contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats

if TYPE_CHECKING:
    from vibroimpact.dynamics.response import Response

# number of impacts, the fastest ones, and of instants in a period of the lowest bending mode
_IMPACTS, _POINTS = 3, 64
# periods of an impact that are followed with so many instants; a longer one, of a heavy sphere,
# with as many in all
_LONGEST = 16
# part of rigid motion in a mode's kinetic energy above which it does not count as bending
_RIGID = 0.95


def largest_bending(response: Response) -> float:
    """Return the largest bending deflection of an elastic plate at the contact [m], about 1 % too
    small; NaN for a rigid plate.

    It is looked for from each touch to a period of the lowest bending mode after the impact. Modes
    in which the plate moves on its springs as a whole are left out.

    Parameters
    ----------
    response : Response
        A run of one drop.
    """
    modes, impacts = response.problem.plate.modes, response.impacts
    if modes is None or not len(impacts["time_s"]):
        return np.nan
    turning = 0.0 if modes.rotation is None else (modes.rotation**2).sum(axis=1)
    bends = (modes.participation**2).sum(axis=1) / modes.mass + turning < _RIGID
    if not bends.any():
        return 0.0
    period = 1.0 / float(modes.frequencies[bends][0])
    fastest = np.argsort(-impacts["approach_speed_m_s"], kind="stable")[:_IMPACTS]
    times = np.concatenate(
        [_instants(impacts["time_s"][one], impacts["duration_s"][one], period) for one in fastest]
    )
    moved = response.modal(times[times <= response.end_time[0]])["plate"]
    return float(np.abs(moved @ np.where(bends, modes.contact, 0.0)).max(initial=0.0))


def _instants(touch: float, duration: float, period: float) -> Floats:
    """Return instants from a touch to a period after the end of the impact [s]."""
    lasting = float(np.nan_to_num(duration))
    during = int(np.ceil(_POINTS * min(lasting / period, _LONGEST)))
    after = touch + lasting + (np.arange(_POINTS) + 0.5) / _POINTS * period
    return np.concatenate([touch + (np.arange(during) + 0.5) / max(during, 1) * lasting, after])
