"""Parallel projection of a plate and the objects on it, viewed obliquely from above, and
the light on them.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats

TURN = np.radians(-32.0)
TILT = np.radians(24.0)
"""Viewing direction: azimuth around the vertical, and elevation above the plane [rad]."""

VIEWER: Floats = np.array(
    [-np.sin(TURN) * np.cos(TILT), -np.cos(TURN) * np.cos(TILT), np.sin(TILT)]
)
"""Unit vector towards the viewer."""

_LIGHT: Floats = np.array([-0.35, -0.45, 0.82])


def project(x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats]:
    """Return the horizontal and vertical image coordinates of points."""
    across = x * np.cos(TURN) - y * np.sin(TURN)
    up = z * np.cos(TILT) + depth(x, y) * np.sin(TILT)
    return np.asarray(across), np.asarray(up)


def projected(points: Floats) -> Floats:
    """Return the image coordinates of points (..., 3), (..., 2)."""
    return np.stack(project(*np.moveaxis(points, -1, 0)), axis=-1)


def depth(x: Floats, y: Floats) -> Floats:
    """Return the distance of points of the plane along the horizontal viewing direction,
    larger farther from the viewer.
    """
    return np.asarray(x * np.sin(TURN) + y * np.cos(TURN))


def light_on(normals: Floats) -> Floats:
    """Return the light on surfaces with unit normals (..., 3), from 0 in the shade to 1.

    Examples
    --------
    >>> light_on(np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])).round(2).tolist()
    [0.82, 0.0]
    """
    return np.asarray(np.clip(normals @ _LIGHT / np.linalg.norm(_LIGHT), 0.0, 1.0))
