"""Quadrature over a disc: with the weight of a contact pressure, and uniform."""

from __future__ import annotations

import functools

import numpy as np

from vibroimpact.arrays import Floats

UNIFORM = 0.0
HERTZ = 0.5
"""Exponents of pressures: uniform, and Hertz's."""

_PRESSURE_RINGS = 6
_PRESSURE_ANGLES = 12
# exact to degree 11 in r^2 and harmonics up to 23 in the angle
_AREA_RINGS = 6
_AREA_ANGLES = 24


@functools.cache
def pressure_rule(exponent: float) -> tuple[Floats, Floats]:
    """Return the points (points, 2) and weights of a rule on the unit disc with a pressure.

    The weights are of sum 1; the pressure is proportional to (1 - r^2)^exponent.

    Notes
    -----
    Gauss's rule for v = (1 - r^2)^(1/2), of which the weight is v^(2 exponent + 1), on six rings of
    twelve points each. The rings are turned by half a step, so that no point lies on an axis of
    symmetry; the average of harmonics of order one to eleven in the angle is zero.

    Examples
    --------
    >>> places, weights = pressure_rule(HERTZ)
    >>> round(float(weights @ (places**2).sum(axis=1)), 12)  # of r^2
    0.4
    """
    nodes, weights = np.polynomial.legendre.leggauss(_PRESSURE_RINGS)
    v = 0.5 * (nodes + 1.0)
    ring_weights = weights * v ** (2.0 * exponent + 1.0)
    angle = 2.0 * np.pi * (np.arange(_PRESSURE_ANGLES) + 0.5) / _PRESSURE_ANGLES
    radius = np.sqrt(1.0 - v**2)[:, None]
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1).reshape(-1, 2)
    point_weights = ring_weights / ring_weights.sum() / _PRESSURE_ANGLES
    return points, np.repeat(point_weights, _PRESSURE_ANGLES)


def disc_rule(radius: float) -> tuple[Floats, Floats]:
    """Return the points (points, 2) and weights of a uniform rule on a disc around the origin.

    The weights are of sum 1. For radius 0 there is one point.

    Examples
    --------
    >>> points, weights = disc_rule(2.0)
    >>> round(float(weights @ points[:, 0] ** 2), 12)  # of a disc: radius^2 / 4
    1.0
    """
    if radius == 0.0:
        return np.zeros((1, 2)), np.ones(1)
    # in r^2, which is proportional to the area
    squared, weights = np.polynomial.legendre.leggauss(_AREA_RINGS)
    angle = 2.0 * np.pi * (np.arange(_AREA_ANGLES) + 0.5) / _AREA_ANGLES
    radii = radius * np.sqrt(0.5 * (squared + 1.0))
    points = radii[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return points.reshape(-1, 2), np.repeat(0.5 * weights / _AREA_ANGLES, _AREA_ANGLES)
