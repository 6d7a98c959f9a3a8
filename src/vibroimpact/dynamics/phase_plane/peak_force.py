"""The largest force of a contact that was solved in the phase plane; it occurs in compression."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array, Floats
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.phase_plane.phase import PlanePhase

_STEPS = 5
_NEAR = 1e-5  # the last step, in y: the error is its square


def peak_force(encounter: Encounter, compression: PlanePhase) -> tuple[Floats, Floats]:
    """Return the largest contact force of each drop [N] and its time since first touch [s], NaN where it was not located.

    Damping adds to the force in compression and takes from it in restitution, so the maximum lies in compression: at an end of a segment,
    or where the derivative of the interpolated force is zero, found by Newton's method from the node with the largest force. The force
    there is evaluated by the law.
    """
    rule, column, nothing = compression.rule, np.arange(len(encounter.mass)), np.zeros(len(encounter.mass))
    speed, duration = encounter.approach_speed, compression.duration
    segment, node = np.divmod(compression.force.argmax(axis=0), rule.number)
    force = compression.of(compression.force, segment)
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
    indentation, square = compression.at(segment, y)
    top = _sum(encounter.law.forces(indentation, np.sqrt(square), speed))
    candidates = [np.where(located, top, force[node, column]), _sum(encounter.law.forces(compression.levels[0], nothing, speed))]
    (until,) = compression.integrals(segment, y, compression.pace)
    when = [np.where(located, duration - until, np.nan), duration]
    for number, level in enumerate(compression.levels[1:]):
        velocity = speed if number == rule.segments - 1 else np.sqrt(compression.ends[number])
        candidates.append(_sum(encounter.law.forces(level, velocity, speed)))
        when.append(compression.durations[number + 1 :].sum(axis=0))
    best = np.argmax(candidates, axis=0)
    return np.asarray(candidates)[best, column], np.asarray(when)[best, column]


def _sum(forces: tuple[Array, Array]) -> Floats:
    static, dissipative = forces
    return np.asarray(static + dissipative)
