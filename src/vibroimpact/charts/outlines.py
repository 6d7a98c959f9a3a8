"""Outlines of what holds a plate, seen from above: x and y of their corners [m]."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from vibroimpact.arrays import Bools, Floats

THIN = 0.012
"""Size of what stands for a point or an edge, relative to the longer side of the plate."""

AT_REST = 0.01
"""Part of the largest displacement below which a plate on a support is drawn at rest,
without lines of rest.
"""

_TURN = np.linspace(0.0, 2.0 * np.pi, 25)


def disc(x: float, y: float, radius: float) -> tuple[Floats, Floats]:
    """Return the outline of a disc."""
    return x + radius * np.cos(_TURN), y + radius * np.sin(_TURN)


def rectangle(x: float, y: float, length: float, width: float) -> tuple[Floats, Floats]:
    """Return the outline of a rectangle, of a length along x and a width along y."""
    return x + 0.5 * length * np.array([-1.0, 1.0, 1.0, -1.0]), y + 0.5 * width * np.array(
        [-1.0, -1.0, 1.0, 1.0]
    )


def strip(
    edge: str, across: tuple[float, float], up: tuple[float, float], wide: float
) -> tuple[Floats, Floats]:
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


def on_supports(outlines: Iterable[tuple[Floats, Floats]], x: Floats, y: Floats) -> Bools:
    """Return which points of a grid lie inside convex outlines, as an array of y and x.

    Examples
    --------
    >>> on_supports(
    ...     [rectangle(0.0, 0.0, 0.2, 0.1)], np.array([-0.2, -0.1, 0.0]), np.array([0.0, 0.1])
    ... ).tolist()
    [[False, True, True], [False, False, False]]
    """
    points = np.stack(np.meshgrid(x, y), axis=-1)
    found = np.zeros(points.shape[:2], dtype=bool)
    for outline in outlines:
        corners = np.stack(outline, axis=-1)
        side, to = np.roll(corners, -1, axis=0) - corners, points[..., None, :] - corners
        turn = side[:, 0] * to[..., 1] - side[:, 1] * to[..., 0]
        found |= (turn >= 0.0).all(axis=-1) | (turn <= 0.0).all(axis=-1)
    return found
