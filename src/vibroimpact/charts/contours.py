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

_AT_REST = 0.002
"""Part of the largest magnitude below which a map is at rest, if its neighbourhood is, too."""

_NEAR = 0.03
"""Size of the neighbourhood, relative to the map: larger than where lines of rest cross."""


class Contours(NamedTuple):
    """Lines of equal value that look alike.

    They are those of values over a grid at some levels, of a width [pt], full or dashed.
    """

    values: Floats
    levels: tuple[float, ...]
    width: float
    dashed: bool = False


def contours_of(values: Floats) -> Iterator[Contours]:
    """Yield the lines of equal value of a map: negative ones, zero, and positive ones.

    Levels that it does not reach are left out. The zero line is left out where values and their
    neighbours are at rest, as it would follow rounding errors there.

    Examples
    --------
    >>> x, y = np.meshgrid(np.linspace(-1.0, 1.0, 5), np.linspace(0.0, 1.0, 3))
    >>> [(contours.levels, contours.dashed) for contours in contours_of(x)]
    [((-0.9, -0.6, -0.3), True), ((0.0,), False), ((0.3, 0.6, 0.9), False)]
    >>> [contours.levels for contours in contours_of(y)]
    [(0.3, 0.6, 0.9)]
    """
    largest = float(np.nanmax(np.abs(values), initial=0.0)) or 1.0
    negative = tuple((-largest * _PARTS[::-1]).tolist())
    positive = tuple((largest * _PARTS).tolist())
    for contours in (
        Contours(values, negative, 0.5, dashed=True),
        Contours(_without_rest(values, largest), (0.0,), 1.2),
        Contours(values, positive, 0.5),
    ):
        low = np.nanmin(contours.values, initial=np.inf)
        high = np.nanmax(contours.values, initial=-np.inf)
        levels = tuple(level for level in contours.levels if low < level < high)
        if levels:
            yield contours._replace(levels=levels)


def _without_rest(values: Floats, largest: float) -> Floats:
    """Return values with NaN where they and those near them hardly differ from zero."""
    magnitude = np.nan_to_num(np.abs(values))
    near = math.ceil(_NEAR * max(values.shape))
    is_rounding = _largest_within(magnitude, 1) < _ROUNDING * largest
    is_at_rest = _largest_within(magnitude, near) < _AT_REST * largest
    return np.where(is_rounding | is_at_rest, np.nan, values)


def _largest_within(values: Floats, reach: int) -> Floats:
    """Return the largest value in the square of a reach around each point."""
    # first along one side, then along the other
    for axis, padding in enumerate([((reach, reach), (0, 0)), ((0, 0), (reach, reach))]):
        padded = np.pad(values, padding)
        windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1, axis=axis)
        values = windows.max(axis=-1)
    return values
