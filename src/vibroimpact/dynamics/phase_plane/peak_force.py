"""The largest force of a contact that was solved in the phase plane, which it has on the way in."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array, Floats
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.phase_plane.phase import PlaneWay

_STEPS = 5
_NEAR = 1e-5  # the last step, in y: the error is its square


def plane_peak(encounter: Encounter, coming: PlaneWay) -> tuple[Floats, Floats]:
    """Return the largest force [N] of each drop, and when it is reached, since first touch [s], NaN where it was not located.

    Damping pushes on the way in and pulls on the way out, so the largest force is never on the way out. It is at an end of a segment,
    or where the derivative of the force is zero, which is found by Newton's method from the node with the largest; the force there is
    that of the law.
    """
    rule, column, nothing = coming.rule, np.arange(len(encounter.mass)), np.zeros(len(encounter.mass))
    speed, duration = encounter.approach_speed, coming.duration
    segment, node = np.divmod(coming.force.argmax(axis=0), rule.number)
    force = coming.of(coming.force, segment)
    slopes = rule.derivatives @ force
    y, (slope, curvature) = rule.nodes[node, 0], slopes[:, node, column]
    for number in range(_STEPS):
        if number:
            slope, curvature = (rule.weights_at(y) * slopes).sum(axis=1)
        step = np.where(curvature < 0.0, slope / curvature, 0.0)
        y = np.clip(y - step, 0.0, 1.0)
        if not (np.abs(step) > _NEAR).any():
            break
    located = (curvature < 0.0) & (np.abs(step) < _NEAR)
    indentation, square = coming.at(segment, y)
    top = _sum(encounter.law.forces(indentation, np.sqrt(square), speed))
    candidates = [np.where(located, top, force[node, column]), _sum(encounter.law.forces(coming.levels[0], nothing, speed))]
    (until,) = coming.grown(segment, y, coming.pace)
    when = [np.where(located, duration - until, np.nan), duration]
    for number, level in enumerate(coming.levels[1:]):
        velocity = speed if number == rule.segments - 1 else np.sqrt(coming.ends[number])
        candidates.append(_sum(encounter.law.forces(level, velocity, speed)))
        when.append(coming.durations[number + 1 :].sum(axis=0))
    best = np.argmax(candidates, axis=0)
    return np.asarray(candidates)[best, column], np.asarray(when)[best, column]


def _sum(forces: tuple[Array, Array]) -> Floats:
    static, dissipative = forces
    return np.asarray(static + dissipative)
