"""Points and weights that average over a disc."""

from __future__ import annotations

import functools

import numpy as np

from vibroimpact.arrays import Floats

UNIFORM, HERTZ = 0.0, 0.5
"""Exponents of pressures: the same everywhere, and Hertz's."""

_RINGS = 6
_ANGLES = 12


@functools.cache
def disc_points(exponent: float) -> tuple[Floats, Floats]:
    """Return places on the unit disc, shape (points, 2), and weights of sum 1 that go with (1 - r^2)^exponent.

    Notes
    -----
    Gauss's rule for v = (1 - r^2)^(1/2), of which the weight is v^(2 exponent + 1), on six rings; on each twelve points, turned by
    half a step so that none lies on an axis of symmetry: fields that go with the cosine or sine of the angle, or of two to eleven
    times it, average to nothing.

    Examples
    --------
    >>> places, weights = disc_points(HERTZ)
    >>> round(float(weights @ (places**2).sum(axis=1)), 12)  # of r^2
    0.4
    """
    nodes, weights = np.polynomial.legendre.leggauss(_RINGS)
    root = 0.5 * (nodes + 1.0)
    share = weights * root ** (2.0 * exponent + 1.0)
    angle = 2.0 * np.pi * (np.arange(_ANGLES) + 0.5) / _ANGLES
    radius = np.sqrt(1.0 - root**2)[:, None]
    places = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1).reshape(-1, 2)
    return places, np.repeat(share / share.sum() / _ANGLES, _ANGLES)
