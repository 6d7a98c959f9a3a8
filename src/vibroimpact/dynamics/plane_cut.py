"""Where on a way out the force of a law that may not pull becomes zero."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.collocation import Floats
from vibroimpact.dynamics.contact import Drops
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.plane_rule import DENSE
from vibroimpact.dynamics.plane_way import PlaneWay

_ROUNDING = 1e-11  # of the largest force
_STEPS = 3


def pulls(way: PlaneWay) -> NDArray[np.bool_]:
    """Tell at which of evenly spaced y of all segments the formula of the force pulls before the surfaces part, (S times DENSE, B)."""
    found = way.rule.dense @ way.rule.split(way.force) < -_ROUNDING * np.abs(way.force).max(axis=0)
    found[0, 0] = found[-1, -1] = False  # where it is zero but for rounding
    return np.asarray(found.reshape(-1, found.shape[-1]))


def end_of_push(encounter: Encounter, way: PlaneWay, pulling: NDArray[np.bool_]) -> tuple[Drops, Floats]:
    """Return in which segment and at which y the force becomes zero first, (B,), of drops that pull somewhere.

    The force at the nodes is smooth, and its interpolant says where to look; then the law says what it is.
    """
    rule = way.rule
    segment, point = np.divmod(pulling.argmax(axis=0), DENSE)
    force = way.of(way.force, segment)
    slopes = rule.derivatives[0] @ force
    high, low = point / (DENSE - 1.0), np.maximum(point - 1.0, 0.0) / (DENSE - 1.0)
    y = 0.5 * (low + high)
    for _ in range(_STEPS):
        weights = rule.weights_at(y)
        slope = (weights * slopes).sum(axis=0)
        y = np.clip(y - (weights * force).sum(axis=0) / slope, low, high)
    delta, square = way.at(segment, y)
    exact = np.add(*encounter.law.forces(delta, -np.sqrt(square), encounter.approach_speed))
    return segment, np.clip(y - exact / slope, low, high)
