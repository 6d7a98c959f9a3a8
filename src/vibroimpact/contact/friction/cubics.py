"""Cubics between two points, given by value and slope at both, as functions of a parameter that goes from 0 to 1."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats


def place_of_turn(ends: Floats) -> Floats:
    """Return where the slope of a cubic changes sign, by one step of Newton's method; 0 where it does not.

    `ends`: value and slope at 0 and at 1 (4, b).
    """
    start, slope, finish, slope_there = ends
    excess, turn = finish - start - 0.5 * (slope + slope_there), slope_there - slope
    with np.errstate(divide="ignore", invalid="ignore"):
        place = -slope / turn
        place = place - 6.0 * excess * place * (1.0 - place) / (turn + 6.0 * excess * (1.0 - 2.0 * place))
    return np.where(slope * slope_there < 0.0, np.clip(place, 0.0, 1.0), 0.0)


def place_of_value(change: Floats, slope: Floats, slope_there: Floats, left: Floats) -> Floats:
    """Return where a rising cubic is below its end by `left`, by two steps of Newton's method from a parabola.

    `change`: from 0 to 1; `slope`, `slope_there`: at 0 and at 1.
    """
    root = np.sqrt(np.maximum(slope_there**2 + 4.0 * (change - slope_there) * left, 0.0))
    back = np.clip(2.0 * left / (slope_there + root + 1e-300), 0.0, 1.0)
    bend, twist = 3.0 * change - 2.0 * slope_there - slope, slope + slope_there - 2.0 * change
    for _ in range(2):
        miss = back * (slope_there + back * (bend + back * twist)) - left
        back = np.clip(back - miss / (slope_there + back * (2.0 * bend + 3.0 * back * twist) + 1e-300), 0.0, 1.0)
    return 1.0 - back
