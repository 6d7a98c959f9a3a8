"""The largest force of a contact that was solved in the phase plane, which it has on the way in."""

from __future__ import annotations

import numpy as np

from vibroimpact.contact.pair import Array
from vibroimpact.dynamics.collocation import Floats
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.half_contact import HalfContact
from vibroimpact.dynamics.plane_rule import PlaneRule

_NEAR = 2e-3  # from the top, in y: where a cubic through it is exact to 1e-11


def plane_peak(encounter: Encounter, rule: PlaneRule, coming: HalfContact) -> tuple[Floats, Floats]:
    """Return the largest force [N] of each drop, and when it is reached, since first touch [s], NaN where it was not located.

    Damping pushes on the way in and pulls on the way out, so the largest force is never on the way out. It is first touch,
    the deepest point, or where the derivative of the force is zero: near the node with the largest force, by Taylor's series
    about it, and then by one step of Newton's method, the force there being that of the law.
    """
    force, column, nothing = coming.force, np.arange(coming.force.shape[1]), np.zeros(coming.force.shape[1])
    speed, depth = encounter.approach_speed, coming.depth
    node = force.argmax(axis=0)
    slopes = [derivative @ force for derivative in rule.derivatives]
    first, second, third = (slope[node, column] for slope in slopes)
    step = -first / second
    step = -first / (second + 0.5 * third * step)
    near = rule.nodes[node, 0]
    y = np.clip(near + step, 0.0, 1.0)
    weights = rule.weights_at(y)
    slope, curvature, square = (np.einsum("nb,nb->b", weights, values) for values in (slopes[0], slopes[1], coming.squares))
    located = (curvature < 0.0) & (np.abs(slope) < _NEAR * np.abs(curvature))
    indentation = depth * (1.0 - y * y) ** encounter.law.root
    top = _sum(encounter.law.forces(indentation, y * np.sqrt(square), speed))
    top -= slope**2 / curvature * (0.5 + third * slope / (6.0 * curvature**2))
    pace = -depth * rule.slope / np.sqrt(coming.squares)
    until = np.einsum("nb,nb->b", weights, (rule.integral @ pace)[:-1])
    ends = (_sum(encounter.law.forces(depth, nothing, speed)), _sum(encounter.law.forces(nothing, speed, speed)))
    candidates = np.stack([np.where(located, top, force[node, column]), *ends])
    best = candidates.argmax(axis=0)
    when = np.stack([np.where(located, coming.duration - until, np.nan), coming.duration, nothing])
    return candidates[best, column], when[best, column]


def _sum(forces: tuple[Array, Array]) -> Floats:
    static, dissipative = forces
    return np.asarray(static + dissipative)
