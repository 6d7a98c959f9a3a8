"""Largest bending of an elastic plate at the contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from vibroimpact.dynamics.response import Response

_IMPACTS, _POINTS = 3, 64  # number of touches, and of instants in a period of the lowest bending mode after each
_RIGID = 0.95  # part of rigid motion in a mode's kinetic energy above which it does not count as bending


def largest_bending(response: Response) -> float:
    """Return the largest bending deflection of an elastic plate at the contact [m], about 1 % too small; NaN for a rigid plate.

    Modes in which the plate moves on its springs as a whole are left out.

    Parameters
    ----------
    response : Response
        A run of one drop.
    """
    modes, touches = response.problem.plate.modes, response.impacts["time_s"][:_IMPACTS]
    if modes is None or not len(touches):
        return np.nan
    turning = 0.0 if modes.rotation is None else (modes.rotation**2).sum(axis=1)
    bends = (modes.participation**2).sum(axis=1) / modes.mass + turning < _RIGID
    if not bends.any():
        return 0.0
    after = (np.arange(_POINTS) + 0.5) / _POINTS / float(modes.frequencies[bends][0])
    times = (touches[:, None] + after).ravel()
    moved = response.modal(times[times <= response.end_time[0]])["plate"]
    return float(np.abs(moved @ np.where(bends, modes.contact, 0.0)).max(initial=0.0))
