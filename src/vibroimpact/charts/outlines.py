"""Outlines of what holds a plate, seen from above: x and y of their corners [m]."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats

THIN = 0.012
"""Size of what stands for a point or an edge, relative to the longer side of the plate."""

_TURN = np.linspace(0.0, 2.0 * np.pi, 25)


def disc(x: float, y: float, radius: float) -> tuple[Floats, Floats]:
    """Return the outline of a disc."""
    return x + radius * np.cos(_TURN), y + radius * np.sin(_TURN)


def rectangle(x: float, y: float, length: float, width: float) -> tuple[Floats, Floats]:
    """Return the outline of a rectangle, of a length along x and a width along y."""
    return x + 0.5 * length * np.array([-1.0, 1.0, 1.0, -1.0]), y + 0.5 * width * np.array([-1.0, -1.0, 1.0, 1.0])


def strip(edge: str, across: tuple[float, float], up: tuple[float, float], wide: float) -> tuple[Floats, Floats]:
    """Return the outline of a strip inside a plate, along an edge of it.

    Parameters
    ----------
    edge : str
        The edge: "x-min", "x-max", "y-min" or "y-max".
    across, up : tuple of two floats
        Smallest and largest x, and y, of the plate [m].
    wide : float
        Width of the strip [m].

    Examples
    --------
    >>> x, y = strip("x-min", (-0.25, 0.25), (-0.2, 0.2), 0.01)
    >>> x.tolist(), y.tolist()
    ([-0.25, -0.24, -0.24, -0.25], [-0.2, -0.2, 0.2, 0.2])
    """
    side, end = edge.split("-")
    (low, high), along = (across, up) if side == "x" else (up, across)
    at, inner = (low, low + wide) if end == "min" else (high, high - wide)
    first, second = np.array([at, inner, inner, at]), np.repeat(along, 2)
    return (first, second) if side == "x" else (second, first)
