"""Largest bending of an elastic plate at the contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats

if TYPE_CHECKING:
    from vibroimpact.dynamics.response import Response

_IMPACTS = 3  # the fastest ones
_INSTANTS = 64  # in a period of the lowest bending mode
# periods of an impact that are followed with so many instants; a longer one, of a heavy sphere,
# with as many in all
_LONGEST = 16
# part of rigid motion in a mode's kinetic energy above which it does not count as bending
_RIGID = 0.95


def largest_bending(response: Response) -> float:
    """Return the largest bending deflection of an elastic plate at the contact [m].

    It is about 1 % too small, and NaN for a rigid plate. It is looked for from each touch to a
    period of the lowest bending mode after the impact. Modes in which the plate moves on its
    springs as a whole are left out.

    Parameters
    ----------
    response : Response
        A run of one drop.
    """
    modes = response.problem.plate.modes
    impacts = response.impacts
    if modes is None or not len(impacts["time_s"]):
        return np.nan
    # kinetic energy of translation and rotation, of modes whose whole is one
    rigid_part = (modes.participation**2).sum(axis=1) / modes.mass
    if modes.rotation is not None:
        rigid_part = rigid_part + (modes.rotation**2).sum(axis=1)
    bends = rigid_part < _RIGID
    if not bends.any():
        return 0.0
    period = 1.0 / float(modes.frequencies[bends][0])
    fastest = np.argsort(-impacts["approach_speed_m_s"], kind="stable")[:_IMPACTS]
    times = np.concatenate(
        [
            _instants(impacts["time_s"][impact], impacts["duration_s"][impact], period)
            for impact in fastest
        ]
    )
    coordinates = response.modal(times[times <= response.end_time[0]])["plate"]
    deflection = coordinates @ np.where(bends, modes.contact, 0.0)
    return float(np.abs(deflection).max(initial=0.0))


def _instants(touch: float, duration: float, period: float) -> Floats:
    """Return instants from a touch to a period after the end of the impact [s]."""
    duration = float(np.nan_to_num(duration))
    number = int(np.ceil(_INSTANTS * min(duration / period, _LONGEST)))
    during = touch + (np.arange(number) + 0.5) / max(number, 1) * duration
    after = touch + duration + (np.arange(_INSTANTS) + 0.5) / _INSTANTS * period
    return np.concatenate([during, after])
