"""The printed dampings, and their function of the approach speed: as printed, and as least squares gives it."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.paper.printed import printed
from vibroimpact.paper.runs import IMPACTS

POWERS = np.arange(3)
"""The powers of the approach speed, as the coefficients are ordered."""


def printed_dampings() -> Floats:
    """Return the printed damping of each impact [N s/m]."""
    return np.array([printed(f"damping.{impact}").value for impact in IMPACTS])


def printed_function(speeds: Floats) -> Floats:
    """Return the damping that the printed function gives at approach speeds [m/s], in N s/m.

    Examples
    --------
    >>> printed_function(np.array([8.82666])).round(3).tolist()
    [179.781]
    """
    return function_at(speeds, np.array([printed(f"damping_function.{power + 1}").value for power in POWERS]))


def parabola(speeds: Floats) -> Floats:
    """Return the coefficients of the least-squares parabola through the printed dampings, lowest power first [SI].

    Parameters
    ----------
    speeds : array
        Approach speeds of the five impacts along the last axis [m/s].
    """
    return np.asarray(np.linalg.pinv(speeds[..., None] ** POWERS) @ printed_dampings())


def function_at(speeds: Floats, coefficients: Floats) -> Floats:
    """Return the dampings [N s/m] at approach speeds [m/s] along the last axis, from coefficients along the last axis [SI]."""
    return np.asarray(speeds[..., None] ** POWERS @ coefficients[..., None])[..., 0]
