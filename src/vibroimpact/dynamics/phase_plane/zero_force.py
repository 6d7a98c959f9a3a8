"""Where on a way out the force of a law that may not pull becomes zero."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.phase_plane.collocation import DENSE
from vibroimpact.dynamics.phase_plane.phase import PlaneWay

_ROUNDING = 1e-11  # of the largest force
_STEPS = 12
_NEAR = 1e-6  # in y


def pulls(way: PlaneWay) -> tuple[Bools, Bools]:
    """Tell where on a way the formula of the force pulls before the surfaces part.

    Returns
    -------
    at : array of bool, shape (S times DENSE, B)
        At which of evenly spaced y of all segments.
    between : array of bool, shape (B,)
        Whether it does so between two of these before, as parabolas tell.
    """
    force = way.rule.dense @ way.rule.split(way.force)
    slack = _ROUNDING * np.abs(way.force).max(axis=0)
    at = force < -slack
    at[0, 0] = at[-1, -1] = False  # where it is zero but for rounding
    left, middle, right = force[:, :-2], force[:, 1:-1], force[:, 2:]
    least = middle - 0.125 * (right - left) ** 2 / (left - 2.0 * middle + right)
    dips = (middle < left) & (middle <= right) & (least < -slack)
    seen, dipped = (np.maximum.accumulate(part.reshape(-1, part.shape[-1])) for part in (at[:, 1:-1], dips))
    return at.reshape(-1, at.shape[-1]), np.asarray((dipped & ~seen).any(axis=0))


def end_of_push(encounter: Encounter, way: PlaneWay, pulling: Bools) -> tuple[Drops, Floats]:
    """Return in which segment and at which y the force becomes zero first, (B,), of drops that pull somewhere.

    The force at the nodes is smooth, and its interpolant says where to look; then the law says what it is.
    """
    rule = way.rule
    segment, point = np.divmod(pulling.argmax(axis=0), DENSE)
    force = way.of(way.force, segment)
    slopes = rule.derivatives[0] @ force
    high, low = point / (DENSE - 1.0), np.maximum(point - 1.0, 0.0) / (DENSE - 1.0)
    y, some = 0.5 * (low + high), pulling.any(axis=0)
    for _ in range(_STEPS):
        weights = rule.weights_at(y)
        slope = (weights * slopes).sum(axis=0)
        before, y = y, np.clip(y - (weights * force).sum(axis=0) / slope, low, high)
        if not (np.abs(y - before)[some] > _NEAR).any():  # and the next step is its square
            break
    delta, square = way.at(segment, y)
    exact = np.add(*encounter.law.forces(delta, -np.sqrt(square), encounter.approach_speed))
    return segment, np.clip(y - exact / slope, low, high)
