"""Parallel projection of a plate and the objects on it, viewed obliquely from above."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from vibroimpact.arrays import Floats

TURN, TILT = np.radians(-32.0), np.radians(24.0)
"""Viewing direction: azimuth around the vertical, and elevation above the plane [rad]."""


def project(x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats]:
    """Return the horizontal and vertical image coordinates of points."""
    across = x * np.cos(TURN) - y * np.sin(TURN)
    up = z * np.cos(TILT) + depth(x, y) * np.sin(TILT)
    return np.asarray(across), np.asarray(up)


def depth(x: Floats, y: Floats) -> Floats:
    """Return the distance of points of the plane along the horizontal viewing direction, larger farther from the viewer."""
    return np.asarray(x * np.sin(TURN) + y * np.cos(TURN))


def show_whole(axes: Axes, across: tuple[float, float], up: tuple[float, float], ratio: float) -> None:
    """Set the limits of axes of an aspect ratio (width over height) so that a range fits in equal scales, with margins for labels."""
    width = (across[1] - across[0]) * 1.08
    height = (up[1] - up[0]) * 1.22
    width = max(width, height * ratio)
    height = width / ratio
    middle = 0.5 * (across[0] + across[1]), 0.5 * (up[0] + up[1])
    axes.set_xlim(middle[0] - 0.5 * width, middle[0] + 0.5 * width)
    axes.set_ylim(middle[1] - 0.5 * height, middle[1] + 0.5 * height)
