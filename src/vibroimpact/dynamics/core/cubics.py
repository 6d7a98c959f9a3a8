"""Cubics over a step, as functions of a parameter that goes from 0 to 1."""

from __future__ import annotations

from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.friction_records import Cubic

_MOST_ITERATIONS = 6
_BEFORE_END = 0.75  # at the end itself the slope may be zero


@compiled
def cubic_at(cubic: Cubic, share: float) -> tuple[float, float]:
    """Return value and slope of a cubic at a share of the step."""
    # Hermite's cubic: value, slope, bend and twist are its coefficients from the constant on
    change = cubic.end_value - cubic.value
    bend = 3.0 * change - 2.0 * cubic.slope - cubic.end_slope
    twist = cubic.slope + cubic.end_slope - 2.0 * change
    value = cubic.value + share * (cubic.slope + share * (bend + share * twist))
    return value, cubic.slope + share * (2.0 * bend + 3.0 * share * twist)


@compiled
def turn_of(cubic: Cubic) -> float:
    """Return the share of the step at which the slope of a cubic changes sign; 0 where it
    does not.
    """
    if not cubic.slope * cubic.end_slope < 0.0:
        return 0.0
    # the slope is s + x (turn + excess (1 - x)); it begins at the zero of its straight line
    turn = cubic.end_slope - cubic.slope
    excess = 6.0 * (cubic.end_value - cubic.value - 0.5 * (cubic.slope + cubic.end_slope))
    share = -cubic.slope / turn
    for _ in range(2):  # Newton's method
        share -= (cubic.slope + share * (turn + excess * (1.0 - share))) / (
            turn + excess * (1.0 - 2.0 * share)
        )
    return min(max(share, 0.0), 1.0)


@compiled
def share_at(cubic: Cubic, value: float) -> float:
    """Return the share of the step at which a cubic that passes a value does so, by
    Newton's method from the straight line.
    """
    rise = cubic.end_value - cubic.value
    share = 0.0
    if rise != 0.0:
        share = min((value - cubic.value) / rise, _BEFORE_END)
    for _ in range(_MOST_ITERATIONS):
        now, slope = cubic_at(cubic, share)
        if slope != 0.0:
            share -= (now - value) / slope
        share = min(max(share, 0.0), 1.0)
    return share
