"""Lines of equal value of a map: zero thick, negative ones dashed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats

_PARTS = np.array([0.3, 0.6, 0.9])
"""Levels, relative to the largest magnitude."""

_ROUNDING = 1e-6
"""Part of the largest magnitude below which a value is that of rounding."""

_AT_REST, _NEAR = 0.002, 0.03
"""Part of the largest magnitude below which a map is at rest, if it is so within a
distance: less than where lines of rest cross.
"""


class Contours(NamedTuple):
    """Lines of equal value that look alike: the values over the grid, the levels, width
    [pt] and dashes.
    """

    values: Floats
    levels: tuple[float, ...]
    width: float
    dashed: bool = False


def contours_of(values: Floats) -> Iterator[Contours]:
    """Yield the lines of equal value of a map: negative ones, zero, and positive ones, as far as it
    has them.

    The zero line is left out where values and their neighbours are at rest, as it would follow
    rounding errors there.

    Examples
    --------
    >>> x, y = np.meshgrid(np.linspace(-1.0, 1.0, 5), np.linspace(0.0, 1.0, 3))
    >>> [(found.levels, found.dashed) for found in contours_of(x)]
    [((-0.9, -0.6, -0.3), True), ((0.0,), False), ((0.3, 0.6, 0.9), False)]
    >>> [found.levels for found in contours_of(y)]
    [(0.3, 0.6, 0.9)]
    """
    most = float(np.nanmax(np.abs(values), initial=0.0)) or 1.0
    lines = [
        Contours(values, tuple((-most * _PARTS[::-1]).tolist()), 0.5, dashed=True),
        Contours(_without_rest(values, most), (0.0,), 1.2),
        Contours(values, tuple((most * _PARTS).tolist()), 0.5),
    ]
    for line in lines:
        low, high = np.nanmin(line.values, initial=np.inf), np.nanmax(line.values, initial=-np.inf)
        levels = tuple(level for level in line.levels if low < level < high)
        if levels:
            yield line._replace(levels=levels)


def _without_rest(values: Floats, most: float) -> Floats:
    """Return values with NaN where they and those near them hardly differ from zero."""
    size = np.nan_to_num(np.abs(values))
    near = math.ceil(_NEAR * max(values.shape))
    rest = (_largest_within(size, 1) < _ROUNDING * most) | (
        _largest_within(size, near) < _AT_REST * most
    )
    return np.where(rest, np.nan, values)


def _largest_within(values: Floats, reach: int) -> Floats:
    """Return the largest value in the square of a reach around each point."""
    for axis in (0, 1):
        padded = np.pad(values, [(reach, reach) if side == axis else (0, 0) for side in (0, 1)])
        values = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1, axis=axis).max(
            axis=-1
        )
    return values
