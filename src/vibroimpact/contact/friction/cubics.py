"""Cubics between two points, given by value and slope at both, as functions of a parameter that goes from 0 to 1."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats


def cubic_at(ends: Floats, place: Floats | float) -> tuple[Floats, Floats]:
    """Return value and slope of a cubic at a place between 0 and 1; `ends`: those at 0 and at 1 (4, ...)."""
    value, slope, there, slope_there = ends
    change = there - value
    bend, twist = 3.0 * change - 2.0 * slope - slope_there, slope + slope_there - 2.0 * change
    return value + place * (slope + place * (bend + place * twist)), slope + place * (2.0 * bend + 3.0 * place * twist)


def place_of_turn(ends: Floats) -> Floats:
    """Return where the slope of a cubic changes sign, by two steps of Newton's method; 0 where it does not.

    `ends`: value and slope at 0 and at 1 (4, b).
    """
    start, slope, finish, slope_there = ends
    turn, excess = slope_there - slope, 6.0 * (finish - start - 0.5 * (slope + slope_there))
    with np.errstate(divide="ignore", invalid="ignore"):
        place = -slope / turn
        for _ in range(2):
            place -= (slope + place * (turn + excess * (1.0 - place))) / (turn + excess * (1.0 - 2.0 * place))
    return np.where(slope * slope_there < 0.0, np.clip(place, 0.0, 1.0), 0.0)


def place_of_value(ends: Floats, value: Floats | float) -> Floats:
    """Return where a cubic that passes a value between 0 and 1 does so, by six steps of Newton's method.

    `ends`: value and slope at 0 and at 1 (4, b). The steps begin on the straight line, but before the end, where the slope may be zero.
    """
    start, _, finish, _ = ends
    with np.errstate(divide="ignore", invalid="ignore"):
        place = np.minimum(np.nan_to_num((value - start) / (finish - start)), 0.75)
        for _ in range(6):
            now, slope = cubic_at(ends, place)
            place = np.clip(place - np.nan_to_num((now - value) / slope), 0.0, 1.0)
    return np.asarray(place)
