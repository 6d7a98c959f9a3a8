"""Free falls of drops onto a plate at rest."""

from __future__ import annotations

import math

from vibroimpact.arrays import Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.drop_records import GAP, GRAVITY, TIME, VELOCITY, FreeFall


@compiled
def next_touch(state: Vector, level: float) -> FreeFall:
    """Return the flight that a drop is about to make until its gap is at a level [m].

    That is zero, or below it in a dent. The speed of touch v follows from v^2 = v0^2 + 2 g h, and
    the time is (v0 + v)/g = 2 h/(v - v0), with the height h above the level.
    """
    start = state[TIME]
    velocity = state[VELOCITY]
    gravity = state[GRAVITY]
    height = state[GAP] - level
    speed = math.sqrt(max(velocity * velocity + 2.0 * gravity * height, 0.0))
    if velocity > 0.0:
        if gravity == 0.0:
            return FreeFall(start, math.inf, math.inf, speed, False)
        return FreeFall(
            start, start + velocity / gravity, start + (velocity + speed) / gravity, speed, False
        )
    if speed > velocity and not (gravity == 0.0 and velocity == 0.0):
        # the same root without cancellation
        return FreeFall(start, start, start + 2.0 * height / (speed - velocity), speed, False)
    return FreeFall(start, start, math.inf, speed, False)
