"""The friction of a contact along a prescribed history, by its turning points."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.friction.turning_points import TurningPoints


def by_turning_points(depth: Floats, displacement: Floats) -> Floats:
    """Return the integrals I of a contact along a history of straight steps (T,), by the turning points of it.

    `depth`, `displacement`: in the same unit, the latter over kappa (T,).
    """
    curves, one, slips, known, integral, found = TurningPoints(1), np.array([0]), 0.0, None, np.zeros(1), [0.0]
    for before, deep, start, moved in zip(depth, depth[1:, None], displacement, displacement[1:, None], strict=False):
        fallen = [sign for sign in (1.0, -1.0) if deep - before < sign * (moved - start)]
        if slips and slips not in fallen:
            curves.turn(one, np.array([slips]), known, (np.array([before]), np.array([start]), integral))
        if not fallen:
            inner, outer = np.sqrt(before), np.sqrt(deep)
            integral = integral + (moved - start) * 2.0 / 3.0 * (inner + outer - inner * outer / (inner + outer))
            curves.push(one, deep, moved, integral)
            slips = 0.0
        else:
            if slips not in fallen:  # it begins to slip, where both directions may: in that in which it slips deeper
                tried = {}
                for sign in fallen:
                    curves.begin(one)
                    tried[sign] = curves.held(one, np.array([sign]), deep - sign * moved)[1][0]
                slips = min(tried, key=lambda sign: tried[sign])
                curves.begin(one)
            known = curves.held(one, np.array([slips]), deep - slips * moved)
            integral = slips * (2.0 / 3.0 * deep**1.5 - known[0])
        found.append(float(integral[0]))
    return np.array(found)
