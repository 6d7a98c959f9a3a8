"""Outlines of what holds a plate, seen from above: x and y of their corners [m]."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import numpy as np

from vibroimpact.arrays import Bools, Floats

THIN = 0.012
"""Size of what stands for a point or an edge, relative to the longer side of the plate."""

AT_REST = 0.01
"""Part of the largest displacement below which a plate on a support is drawn at rest.

There are then no lines of rest on the support.
"""

_AT_END = 1e-4
"""Distance of an outline from the end of a plate, relative to its size, up to which it is there."""

_ANGLES = np.linspace(0.0, 2.0 * np.pi, 25)


def disc(x: float, y: float, radius: float) -> tuple[Floats, Floats]:
    """Return the outline of a disc."""
    return x + radius * np.cos(_ANGLES), y + radius * np.sin(_ANGLES)


def rectangle(x: float, y: float, length: float, width: float) -> tuple[Floats, Floats]:
    """Return the outline of a rectangle, of a length along x and a width along y."""
    corners_x = x + 0.5 * length * np.array([-1.0, 1.0, 1.0, -1.0])
    corners_y = y + 0.5 * width * np.array([-1.0, -1.0, 1.0, 1.0])
    return corners_x, corners_y


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
    normal, end = edge.split("-")
    # ends of the plate in the direction of the normal to the edge, and along the edge
    (low, high), edge_ends = across, up
    if normal == "y":
        (low, high), edge_ends = up, across
    if end == "min":
        outer = low
        inner = low + wide
    else:
        outer = high
        inner = high - wide
    in_normal_direction = np.array([outer, inner, inner, outer])
    along_edge = np.repeat(edge_ends, 2)
    if normal == "x":
        return in_normal_direction, along_edge
    return along_edge, in_normal_direction


def strips(edge: str, outline: Floats, wide: float) -> list[tuple[Floats, Floats]]:
    """Return the outlines of strips along the parts of a plate's outline that lie at an end of it.

    Parameters
    ----------
    edge : str
        The end: "x-min", "x-max", "y-min" or "y-max".
    outline : array, shape (points, 2)
        The outline of a plate of any shape [m]; NaN interrupts it.
    wide : float
        Width of the strips [m].

    Examples
    --------
    >>> step = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.1], [0.2, 0.1], [0.2, 0.3], [0.0, 0.3], [0.0, 0.0]]
    >>> ((x, y),) = strips("y-max", np.array(step), 0.01)
    >>> x.tolist(), y.tolist()
    ([0.0, 0.0, 0.2, 0.2], [0.3, 0.29, 0.29, 0.3])
    """
    normal, end = edge.split("-")
    across = "xy".index(normal)
    low = np.nanmin(outline, axis=0)
    high = np.nanmax(outline, axis=0)
    place = {"min": low, "max": high}[end][across]
    is_at_end = np.abs(outline[:, across] - place) <= _AT_END * float((high - low).max())
    drawn = []
    for start in np.flatnonzero(is_at_end[:-1] & is_at_end[1:]).tolist():
        ends = np.sort(outline[start : start + 2], axis=0)
        sides = [(float(low[side]), float(high[side])) for side in (0, 1)]
        sides[1 - across] = (float(ends[0, 1 - across]), float(ends[1, 1 - across]))
        drawn.append(strip(edge, sides[0], sides[1], wide))
    return drawn


def inside(outline: Floats, x: Floats, y: Floats) -> Bools:
    """Return which points of a grid lie inside closed lines, as an array of y and x.

    Parameters
    ----------
    outline : array, shape (points, 2)
        The lines, each followed by NaN; lines within others are holes.
    x, y : array
        The lines of the grid.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]])
    >>> inside(square, np.array([-0.5, 0.5, 1.5]), np.array([0.5])).tolist()
    [[False, True, False]]
    """
    is_inside = np.zeros((len(y), len(x)), dtype=bool)
    for (start_x, start_y), (end_x, end_y) in pairwise(outline):
        # a ray towards +x crosses the line, which has one of its ends; NaN crosses nothing
        rows = np.flatnonzero((y >= start_y) != (y >= end_y))
        if np.isnan(start_y + end_y) or not len(rows):
            continue
        crossing = start_x + (y[rows] - start_y) / (end_y - start_y) * (end_x - start_x)
        is_inside[rows] ^= x < crossing[:, None]
    return is_inside


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
    inside = np.zeros(points.shape[:2], dtype=bool)
    for outline in outlines:
        corners = np.stack(outline, axis=-1)
        sides = np.roll(corners, -1, axis=0) - corners
        offsets = points[..., None, :] - corners
        # a point lies inside if it is on the same side of all sides
        cross = sides[:, 0] * offsets[..., 1] - sides[:, 1] * offsets[..., 0]
        inside |= (cross >= 0.0).all(axis=-1) | (cross <= 0.0).all(axis=-1)
    return inside
