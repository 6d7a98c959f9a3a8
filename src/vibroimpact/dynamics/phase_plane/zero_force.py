"""The point of the restitution phase where the force of a law without tension becomes zero."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.phase_plane.collocation import DENSE
from vibroimpact.dynamics.phase_plane.phase import PlanePhase

_ROUNDING = 1e-11  # of the largest force
_STEPS = 12
_NEAR = 1e-6  # in y


def tensile_points(phase: PlanePhase) -> tuple[Bools, Bools]:
    """Return where the formula of the force is tensile before the surfaces separate.

    Returns
    -------
    at : array of bool, shape (S times DENSE, B)
        At which of evenly spaced y in all segments.
    between : array of bool, shape (B,)
        Whether a parabola through three of these points is tensile between them, before the first tensile point.
    """
    force = phase.rule.dense @ phase.rule.split(phase.force)
    slack = _ROUNDING * np.abs(phase.force).max(axis=0)
    at = force < -slack
    at[0, 0] = at[-1, -1] = False  # where it is zero to rounding
    left, middle, right = force[:, :-2], force[:, 1:-1], force[:, 2:]
    least = middle - 0.125 * (right - left) ** 2 / (left - 2.0 * middle + right)
    dips = (middle < left) & (middle <= right) & (least < -slack)
    seen, dipped = (np.maximum.accumulate(part.reshape(-1, part.shape[-1])) for part in (at[:, 1:-1], dips))
    return at.reshape(-1, at.shape[-1]), np.asarray((dipped & ~seen).any(axis=0))


def zero_force_point(encounter: Encounter, phase: PlanePhase, pulling: Bools) -> tuple[Drops, Floats]:
    """Return segment and y (B,) of the first zero of the force, for drops whose force is tensile somewhere.

    Newton's method finds the zero of the interpolated force; one more step uses the force of the law itself.
    """
    rule = phase.rule
    segment, point = np.divmod(pulling.argmax(axis=0), DENSE)
    force = phase.of(phase.force, segment)
    slopes = rule.derivatives[0] @ force
    high, low = point / (DENSE - 1.0), np.maximum(point - 1.0, 0.0) / (DENSE - 1.0)
    y, some = 0.5 * (low + high), pulling.any(axis=0)
    for _ in range(_STEPS):
        weights = rule.weights_at(y)
        slope = (weights * slopes).sum(axis=0)
        before, y = y, np.clip(y - (weights * force).sum(axis=0) / slope, low, high)
        if not (np.abs(y - before)[some] > _NEAR).any():  # the next step would be about its square
            break
    delta, square = phase.at(segment, y)
    exact = np.add(*encounter.law.forces(delta, -np.sqrt(square), encounter.approach_speed))
    return segment, np.clip(y - exact / slope, low, high)
