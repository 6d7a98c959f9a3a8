"""Thinning of long histories: the number of points kept of each segment."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats, Indices

MOST_POINTS = 1_000_000
"""Most points of a history that is stored in a file, about 100 MB."""

_WHOLE = 0.25  # part of the points reserved for the first segments, which are kept in full
_LEAST = 3  # points of a segment: its ends, which are events, and its middle


def points_kept(points: Indices, most: int) -> Indices:
    """Return the number of points to keep of each segment of a history, about `most` in total.

    If it is too long the first segments keep all of theirs, up to a quarter of `most`; each of the
    others keeps equally many.

    Parameters
    ----------
    points : array of int, shape (segments,)
        Number of points that resolve each segment.
    most : int
        Largest total number; exceeded only where three points per segment are more.

    Examples
    --------
    >>> points_kept(np.array([50, 60, 60, 50, 60, 60]), 200).tolist()
    [50, 30, 30, 30, 30, 30]
    """
    if points.sum() <= most:
        return points
    whole = np.cumsum(points) <= _WHOLE * most
    share = int((most - points[whole].sum()) / np.count_nonzero(~whole))
    return np.where(whole, points, np.minimum(points, max(share, _LEAST)))


def thinned(grid: Floats, count: int) -> Floats:
    """Return `count` evenly spaced points of a grid, including its ends."""
    if count >= len(grid):
        return grid
    return np.asarray(grid[np.linspace(0.0, len(grid) - 1.0, count).round().astype(int)])
