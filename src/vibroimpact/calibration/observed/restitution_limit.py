"""Measured restitutions, and the limit up to which values above 1 are attributed to noise."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.observed.observations import Observations

_DEVIATIONS = 3.0
"""Standard deviations above 1 that are attributed to noise."""

_LEAST = 0.01
"""Excess over 1 that is accepted where the noise is unknown."""

_MOST = 0.1
"""Largest excess over 1 that is accepted where the noise is estimated from the scatter."""


class RestitutionLimit(NamedTuple):
    """The largest accepted restitution of each impact, (n,), and the reason in words."""

    most: Floats
    why: str


def measured_restitutions(seen: Observations, radius: float, gravity: float) -> Floats | None:
    """Return the measured restitution of each impact, (n,); None if no rebound was measured."""
    if "separation_speed" in seen.wanted:
        return seen.wanted["separation_speed"] / seen.speeds
    if "rebound_height" in seen.wanted:
        return np.asarray(
            np.sqrt(2.0 * gravity * np.maximum(seen.wanted["rebound_height"] - radius, 0.0))
            / seen.speeds
        )
    return None


def restitution_limit(
    speeds: Floats, restitutions: Floats, deviations: Floats | None
) -> RestitutionLimit:
    """Return the value above 1 up to which a measured restitution is attributed to noise.

    The limit lies three standard deviations above 1 where these are given. Otherwise it lies three
    times the scatter of the values not above 1 about a parabola of the approach speed, at least 1 %
    and at most 10 %.

    Parameters
    ----------
    speeds, restitutions : array, shape (n,)
        Approach speeds [m/s] and restitutions.
    deviations : array, shape (n,), optional
        Standard deviations of the restitutions.

    Examples
    --------
    >>> restitution_limit(np.array([1.0, 2.0]), np.array([1.003, 0.9]), None).most.tolist()
    [1.01, 1.01]
    >>> restitution_limit(np.array([1.0]), np.array([1.003]), np.array([0.002])).most.tolist()
    [1.006]
    """
    if deviations is not None:
        return RestitutionLimit(1.0 + _DEVIATIONS * deviations, "three standard deviations")
    possible = restitutions <= 1.0
    degree = min(2, len(np.unique(speeds[possible])) - 1)
    freedom = int(np.count_nonzero(possible)) - degree - 1
    if degree < 0 or freedom < 1:
        return RestitutionLimit(
            np.full(len(speeds), 1.0 + _LEAST), "1 %, as no standard deviation is given"
        )
    powers = np.vander(speeds[possible] / speeds.max(), degree + 1)
    coefficients = np.linalg.lstsq(powers, restitutions[possible], rcond=None)[0]
    residual = restitutions[possible] - powers @ coefficients
    scatter = float(np.sqrt(residual @ residual / freedom))
    excess = float(np.clip(_DEVIATIONS * scatter, _LEAST, _MOST))
    if _LEAST < excess < _MOST:
        why = "three times the scatter of the others"
    else:
        why = f"{100.0 * excess:g} %, as no standard deviation is given"
    return RestitutionLimit(np.full(len(speeds), 1.0 + excess), why)
