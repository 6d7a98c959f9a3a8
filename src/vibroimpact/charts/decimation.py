"""Reduction of long lines to the points that are visible."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from vibroimpact.arrays import Floats, Indices

COLUMNS = 1500
"""Number of columns into which a long line is divided: more than the resolution of a chart."""

_AT_ONCE = 2**17  # points sorted at once, which bounds the memory of the sort


def decimated(x: Floats, y: Floats, columns: int = COLUMNS) -> tuple[Floats, Floats]:
    """Return a line reduced to its visible points: the first, last, lowest and highest in each of a
    number of columns.

    Lines of up to four points a column, and those whose x does not ascend, are returned as they
    are. NaN in y interrupts a line.

    Examples
    --------
    >>> time = np.linspace(0.0, 1.0, 100_001)
    >>> x, y = decimated(time, np.where(time == 0.5, 1.0, 0.0))
    >>> len(x) < 6001, float(y.max())
    (True, 1.0)
    """
    if len(x) <= 4 * columns or not bool(np.all(np.diff(x) >= 0.0)):
        return x, y
    gaps = np.isnan(y)
    there = np.flatnonzero(~gaps)
    kept = visible_points(
        len(there), lambda first, last: (x[there[first:last]], y[there[first:last]]), columns
    )
    shown = there if kept is None else there[kept]
    # both sides of the ends of each gap: it interrupts the line, and no part between two of them is
    # a single point
    ends = np.flatnonzero(np.diff(gaps))
    shown = np.union1d(shown, np.concatenate([ends, ends + 1]))
    return x[shown], y[shown]


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
    edges = np.linspace(part(0, 1)[0][0], part(count - 1, count)[0][0], columns + 1)[1:-1]
    found, xs, ys = [], [], []
    for first in range(0, count, _AT_ONCE):
        x, y = part(first, min(first + _AT_ONCE, count))
        kept = _extreme(x, y, edges)
        found.append(kept + first)
        xs.append(x[kept])
        ys.append(y[kept])
    indices = np.concatenate(found)
    return (
        indices
        if len(found) == 1
        else np.asarray(indices[_extreme(np.concatenate(xs), np.concatenate(ys), edges)])
    )


def _extreme(x: Floats, y: Floats, edges: Floats) -> Indices:
    """Return the indices of the first, last, lowest and highest point of a line in each
    column, given the x of the edges between them.
    """
    column = np.searchsorted(edges, x, side="right")
    starts = np.flatnonzero(np.diff(column, prepend=-1))
    ends = np.append(starts[1:], len(x)) - 1
    by_height = np.lexsort((y, column))
    return np.unique(np.concatenate([starts, ends, by_height[starts], by_height[ends]]))


_SPREAD, _FLAT = 60, 3e-4
"""Points that a thinned line has along the whole and along each window at least, and the largest
distance of a point left out from the line, relative to its range there: a tenth of a pixel."""


def thinned(
    x: Floats, y: Floats, windows: Sequence[tuple[float, float]] = ()
) -> tuple[Floats, Floats]:
    """Return a line reduced to the points that are seen in the whole of it and in windows of x that
    are shown enlarged.

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
    kept = [_seen(x, y)]
    for start, end in windows:
        first, last = int(np.searchsorted(x, start)), int(np.searchsorted(x, end, side="right"))
        # with the points beyond, so that the line reaches the ends
        beyond = np.clip([first - 1, last], 0, len(x) - 1)
        kept += [beyond, first + _seen(x[first:last], y[first:last])]
    chosen = np.unique(np.concatenate(kept))
    return (x[chosen], y[chosen]) if len(x) else (x, y)


def _seen(x: Floats, y: Floats) -> Indices:
    """Return the indices of the points of a line that are seen."""
    if not len(x):
        return np.empty(0, dtype=np.intp)
    found = visible_points(len(x), lambda first, last: (x[first:last], y[first:last]))
    drawn = np.arange(len(x)) if found is None else found
    spread = np.searchsorted(x, np.linspace(x[0], x[-1], _SPREAD)).clip(max=len(x) - 1)
    gaps, there = np.flatnonzero(np.isnan(y)), np.flatnonzero(~np.isnan(y))
    extremes = there[[np.argmin(y[there]), np.argmax(y[there])]] if len(there) else gaps
    beside = np.concatenate([gaps[gaps > 0] - 1, gaps[gaps < len(x) - 1] + 1])
    fixed = np.unique(np.concatenate([[0, len(x) - 1], spread, gaps, beside, extremes]))
    drawn = np.union1d(drawn, fixed)
    return np.asarray(drawn[_bends(x[drawn], y[drawn], np.searchsorted(drawn, fixed))])


def _bends(x: Floats, y: Floats, fixed: Indices) -> Indices:
    """Return the indices of fixed points of a line, and of those between them without
    which it would be another line.
    """
    away = _FLAT * float(np.ptp(y[np.isfinite(y)])) if np.isfinite(y).any() else 0.0
    kept, open_parts = (
        set(fixed.tolist()),
        list(zip(fixed[:-1].tolist(), fixed[1:].tolist(), strict=True)),
    )
    while open_parts:
        first, last = open_parts.pop()
        if last - first < 2:
            continue
        width = x[last] - x[first]
        chord = y[first] + (y[last] - y[first]) * (
            (x[first + 1 : last] - x[first]) / width if width > 0.0 else 0.0
        )
        off = np.abs(y[first + 1 : last] - chord)
        farthest = int(np.argmax(off))
        if off[farthest] > away:
            middle = first + 1 + farthest
            kept.add(middle)
            open_parts += [(first, middle), (middle, last)]
    return np.array(sorted(kept), dtype=np.intp)
