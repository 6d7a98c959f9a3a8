"""Reduction of long lines to the points that are visible."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats, Indices

COLUMNS = 1500
"""Number of columns into which a long line is divided: more than the resolution of a chart."""

_AT_ONCE = 2**17  # points sorted at once, which bounds the memory of the sort


def decimated(x: Floats, y: Floats, columns: int = COLUMNS) -> tuple[Floats, Floats]:
    """Return a line reduced to its visible points.

    They are the first, last, lowest and highest in each of a number of columns. Lines of up to four
    points a column, and those whose x does not ascend, are returned as they are. NaN in y
    interrupts a line.

    Examples
    --------
    >>> time = np.linspace(0.0, 1.0, 100_001)
    >>> x, y = decimated(time, np.where(time == 0.5, 1.0, 0.0))
    >>> len(x) < 6001, float(y.max())
    (True, 1.0)
    """
    if len(x) <= 4 * columns or not bool(np.all(np.diff(x) >= 0.0)):
        return x, y
    is_gap = np.isnan(y)
    points = np.flatnonzero(~is_gap)

    def block(first: int, last: int) -> tuple[Floats, Floats]:
        return x[points[first:last]], y[points[first:last]]

    visible = visible_points(len(points), block, columns)
    if visible is not None:
        points = points[visible]
    # both sides of the ends of each gap: it interrupts the line, and no part between two of them is
    # a single point
    ends = np.flatnonzero(np.diff(is_gap))
    kept = np.union1d(points, np.concatenate([ends, ends + 1]))
    return x[kept], y[kept]


def visible_points(
    count: int, part: Callable[[int, int], tuple[Floats, Floats]], columns: int = COLUMNS
) -> Indices | None:
    """Return the indices of the visible points of a line; None if all are.

    A long line is decimated in blocks, and the blocks' points once more: sorting all points at once
    would take several times the memory of the line.

    Parameters
    ----------
    count : int
        Number of points.
    part : callable
        Function that returns x and y of the points from a first to a last one.
    columns : int
        Number of columns into which the line is divided; up to four points of each are kept.
    """
    if count <= 4 * columns:
        return None
    (first_x,), _ = part(0, 1)
    (last_x,), _ = part(count - 1, count)
    edges = np.linspace(first_x, last_x, columns + 1)[1:-1]
    block_indices = []
    block_x = []
    block_y = []
    for first in range(0, count, _AT_ONCE):
        x, y = part(first, min(first + _AT_ONCE, count))
        kept = _extreme(x, y, edges)
        block_indices.append(kept + first)
        block_x.append(x[kept])
        block_y.append(y[kept])
    indices = np.concatenate(block_indices)
    if len(block_indices) == 1:
        return indices
    # blocks share columns at their ends
    kept = _extreme(np.concatenate(block_x), np.concatenate(block_y), edges)
    return np.asarray(indices[kept])


def _extreme(x: Floats, y: Floats, edges: Floats) -> Indices:
    """Return the indices of the first, last, lowest and highest point of a line in each column.

    `edges` are the x between columns.
    """
    column = np.searchsorted(edges, x, side="right")
    starts = np.flatnonzero(np.diff(column, prepend=-1))
    ends = np.append(starts[1:], len(x)) - 1
    by_height = np.lexsort((y, column))
    return np.unique(np.concatenate([starts, ends, by_height[starts], by_height[ends]]))


_SPREAD = 60
"""Points that a thinned line has at least, along the whole and along each window."""

_FLAT = 3e-4
"""Largest distance of a point left out from the line, relative to its range: a tenth of a pixel."""


def thinned(
    x: Floats, y: Floats, windows: Sequence[tuple[float, float]] = ()
) -> tuple[Floats, Floats]:
    """Return a line reduced to the points that are seen in it and in windows shown enlarged.

    Points that lie on a straight line between others are left out, but not so many that none is
    found near a pointer; the lowest and the highest stay.

    Parameters
    ----------
    x, y : array
        The line; `x` ascends, NaN in `y` interrupts it.
    windows : sequence of tuple of float
        The ranges of x that are shown enlarged.

    Examples
    --------
    >>> time = np.linspace(0.0, 1.0, 100_001)
    >>> x, y = thinned(time, np.where(time == 0.5, 1.0, 0.0), [(0.4999, 0.5001)])
    >>> len(x) < 100, float(y.max()), x[np.searchsorted(x, 0.5) + 1].round(6).tolist()
    (True, 1.0, 0.50001)
    """
    if not len(x):
        return x, y
    kept = [_needed_points(x, y)]
    for start, end in windows:
        first = int(np.searchsorted(x, start))
        last = int(np.searchsorted(x, end, side="right"))
        # with the points beyond, so that the line reaches the ends
        beyond = np.clip([first - 1, last], 0, len(x) - 1)
        kept += [beyond, first + _needed_points(x[first:last], y[first:last])]
    indices = _ascending(np.concatenate(kept), len(x))
    return x[indices], y[indices]


def _ascending(indices: Indices, count: int) -> Indices:
    """Return indices below a number in their order, each once; faster than by sorting."""
    is_chosen = np.zeros(count, dtype=bool)
    is_chosen[indices] = True
    return np.flatnonzero(is_chosen)


def _needed_points(x: Floats, y: Floats) -> Indices:
    """Return the indices of the points of a line that are seen."""
    count = len(x)
    if not count:
        return np.empty(0, dtype=np.intp)

    def block(first: int, last: int) -> tuple[Floats, Floats]:
        return x[first:last], y[first:last]

    visible = visible_points(count, block)
    if visible is None:
        visible = np.arange(count)
    spread = np.searchsorted(x, np.linspace(x[0], x[-1], _SPREAD)).clip(max=count - 1)
    is_gap = np.isnan(y)
    gaps = np.flatnonzero(is_gap)
    points = np.flatnonzero(~is_gap)
    before_gaps = gaps[gaps > 0] - 1
    after_gaps = gaps[gaps < count - 1] + 1
    fixed = np.concatenate([[0, count - 1], spread, gaps, before_gaps, after_gaps])
    if len(points):
        lowest = points[np.argmin(y[points])]
        highest = points[np.argmax(y[points])]
        fixed = np.append(fixed, [lowest, highest])
    fixed = _ascending(fixed, count)
    candidates = _ascending(np.concatenate([visible, fixed]), count)
    needed = _bends(x[candidates], y[candidates], np.searchsorted(candidates, fixed))
    return np.asarray(candidates[needed])


def _bends(x: Floats, y: Floats, fixed: Indices) -> Indices:
    """Return the indices of fixed points of a line, and of bends between them.

    Between two points the farthest from their chord is kept, and so on in both halves (Ramer,
    Douglas and Peucker), until no point is farther than a tenth of a pixel.
    """
    finite = np.isfinite(y)
    tolerance = 0.0
    if finite.any():
        tolerance = _FLAT * float(np.ptp(y[finite]))
    kept = np.zeros(len(x), dtype=bool)
    kept[fixed] = True
    # of each chord the first and the last point; all chords are divided at once
    first = fixed[:-1]
    last = fixed[1:]
    while True:
        has_points = last - first > 1
        first = first[has_points]
        last = last[has_points]
        if not len(first):
            return np.flatnonzero(kept)
        count = last - first - 1
        starts = np.cumsum(count) - count
        chord = np.repeat(np.arange(len(first)), count)
        point = np.arange(len(chord)) - np.repeat(starts - first - 1, count)
        width = (x[last] - x[first])[chord]
        along = np.divide(
            x[point] - x[first][chord], width, out=np.zeros(len(point)), where=width > 0.0
        )
        height = y[first][chord] + (y[last] - y[first])[chord] * along
        distance = np.abs(y[point] - height)
        distance[np.isnan(distance)] = 0.0
        farthest = np.maximum.reduceat(distance, starts)
        # of several points equally far the first
        candidates = np.flatnonzero(distance == farthest[chord])
        of_chord = np.flatnonzero(np.diff(chord[candidates], prepend=-1))
        is_bent = farthest > tolerance
        bend = point[candidates[of_chord]][is_bent]
        kept[bend] = True
        first, last = (
            np.concatenate([first[is_bent], bend]),
            np.concatenate([bend, last[is_bent]]),
        )


def rounded(values: NDArray[np.floating[Any]], part: float) -> NDArray[np.floating[Any]]:
    """Return values rounded to multiples of a power of two, whose digits compress.

    Parameters
    ----------
    values : array
        The values.
    part : float
        Largest step of the rounded values, relative to the largest magnitude.

    Examples
    --------
    >>> rounded(np.array([1.0, 0.3, 0.001]), 0.01).tolist()
    [1.0, 0.296875, 0.0]
    """
    largest = float(np.nanmax(np.abs(values), initial=0.0))
    if largest == 0.0 or not np.isfinite(largest):
        return values
    step = 2.0 ** np.floor(np.log2(part * largest))
    return values.dtype.type(step) * np.round(values / values.dtype.type(step))
