"""A parallel projection: how things on a plate appear from above and aside."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from vibroimpact.arrays import Floats

TURN, TILT = np.radians(-32.0), np.radians(24.0)
"""From where one looks: around the vertical, and above the plane."""


def project(x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats]:
    """Return where points appear on the picture, across and up."""
    across = x * np.cos(TURN) - y * np.sin(TURN)
    up = z * np.cos(TILT) + depth(x, y) * np.sin(TILT)
    return np.asarray(across), np.asarray(up)


def depth(x: Floats, y: Floats) -> Floats:
    """Return how far away points of the plane are from who looks."""
    return np.asarray(x * np.sin(TURN) + y * np.cos(TURN))


def show_whole(axes: Axes, across: tuple[float, float], up: tuple[float, float], ratio: float) -> None:
    """Show a range whole and unsheared, in a picture of a ratio of width to height, with room for words above and below."""
    width = (across[1] - across[0]) * 1.08
    height = (up[1] - up[0]) * 1.22
    width = max(width, height * ratio)
    height = width / ratio
    middle = 0.5 * (across[0] + across[1]), 0.5 * (up[0] + up[1])
    axes.set_xlim(middle[0] - 0.5 * width, middle[0] + 0.5 * width)
    axes.set_ylim(middle[1] - 0.5 * height, middle[1] + 0.5 * height)
