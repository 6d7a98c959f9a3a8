"""How many points of a history are kept of each of its segments, where it would become too long."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats, Indices

MOST_POINTS = 1_000_000
"""Of a history that is kept in a file: a hundred million bytes of it."""

_WHOLE = 0.25  # of those points: what the first segments get, so that they are kept whole
_LEAST = 3  # points of a segment: both of its ends, which are events, and its middle


def points_kept(points: Indices, most: int) -> Indices:
    """Return how many points each segment of a history keeps, so that they are about `most` in all.

    If it is too long the first segments keep all of theirs, up to a quarter of `most`; each of the others keeps equally many.

    Parameters
    ----------
    points : array of int, shape (segments,)
        How many points draw each segment well.
    most : int
        How many points there may be in all; there are more only where three a segment are.

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
    """Return so many points of a grid, evenly, its ends among them."""
    return grid if count >= len(grid) else grid[np.linspace(0.0, len(grid) - 1.0, count).round().astype(int)]
