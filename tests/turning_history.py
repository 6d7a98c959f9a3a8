"""The friction of a contact along a prescribed history, by its turning points."""

from __future__ import annotations

import itertools

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core.turning_points import (
    add_rim,
    begin_at_rim,
    end_slip,
    held_at,
    new_curve,
)


def by_turning_points(depth: Floats, displacement: Floats) -> Floats:
    """Return the integrals I of a contact along a history of straight steps (T,), by the turning
    points of it.

    `depth`, `displacement`: in the same unit, the latter over kappa (T,).
    """
    curve = new_curve(2 * len(depth) + 2)
    direction = 0.0
    held = 0.0
    front = 0.0
    integral = 0.0
    integrals = [0.0]
    path = list(zip(depth.tolist(), displacement.tolist(), strict=True))
    for (before, start), (deep, moved) in itertools.pairwise(path):
        directions = [sign for sign in (1.0, -1.0) if deep - before < sign * (moved - start)]
        if direction and direction not in directions:
            end_slip(curve, direction, held, front, before, start, integral)
        if not directions:
            inner = before**0.5
            outer = deep**0.5
            integral += (
                (moved - start) * 2.0 / 3.0 * (inner + outer - inner * outer / (inner + outer))
            )
            add_rim(curve, deep, moved, integral)
            direction = 0.0
        else:
            # it begins to slip, where both directions may: in that in which it slips deeper
            if direction not in directions:
                fronts = {}
                for sign in directions:
                    begin_at_rim(curve)
                    fronts[sign] = held_at(curve, sign, deep - sign * moved)[1]
                direction = min(fronts, key=lambda sign: fronts[sign])
                begin_at_rim(curve)
            held, front = held_at(curve, direction, deep - direction * moved)
            integral = direction * (2.0 / 3.0 * deep**1.5 - held)
        integrals.append(integral)
    return np.array(integrals)
