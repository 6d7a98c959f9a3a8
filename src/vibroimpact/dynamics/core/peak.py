"""The largest force and the largest indentation within a stretch of contact, between its nodes."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Vector
from vibroimpact.compiled import compiled, force_at
from vibroimpact.dynamics.core.records import Basis, Law

_POINTS = 33
_ROUNDS = 3  # each narrows the search to a sixteenth


@compiled
def values_between(basis: Basis, values: Vector, others: Vector, x: float) -> tuple[float, float]:
    """Return the values at x in [0, 1] of two quantities with values at the start and the
    nodes (N + 1,).
    """
    total = 0.0
    value = 0.0
    other = 0.0
    for point in range(len(values)):
        distance = x - basis.places[point]
        if distance == 0.0:
            return float(values[point]), float(others[point])
        weight = basis.barycentric[point] / distance
        total += weight
        value += weight * values[point]
        other += weight * others[point]
    return value / total, other / total


@compiled
def nodal_value_between(basis: Basis, values: Vector, x: float) -> float:
    """Return the value at x in [0, 1] of a quantity with values at the nodes alone (N,)."""
    # the weights of interpolation without the start: times the distance of each node from it
    total = 0.0
    value = 0.0
    for node in range(len(values)):
        place = basis.places[node + 1]
        distance = x - place
        if distance == 0.0:
            return float(values[node])
        weight = basis.barycentric[node + 1] * place / distance
        total += weight
        value += weight * values[node]
    return value / total


@compiled
def force_between(basis: Basis, law: Law, delta: Vector, rate: Vector, x: float) -> float:
    """Return the force of a law [N] at x in [0, 1], from its indentation and its rate at
    the start and the nodes (N + 1,).
    """
    reached, speed = values_between(basis, delta, rate, x)
    static, dissipative = force_at(law.addresses[0])(
        max(reached, law.release), speed, law.speed, law.coefficients
    )
    return float(static + dissipative)


@compiled
def peak_of(basis: Basis, values: Vector) -> tuple[float, float]:
    """Return the x in [0, 1] at which a quantity with values at the start and the nodes
    (N + 1,) is largest, and how large.
    """
    sampled = np.empty(_POINTS)
    low = 0.0
    high = 1.0
    x = 0.0
    for _ in range(_ROUNDS):
        for point in range(_POINTS):
            sampled[point], _ = values_between(
                basis, values, values, low + (high - low) * point / (_POINTS - 1)
            )
        x, low, high = narrowed(sampled, low, high)
    return x, values_between(basis, values, values, x)[0]


@compiled
def peak_of_force(basis: Basis, law: Law, delta: Vector, rate: Vector) -> tuple[float, float]:
    """Return the x in [0, 1] at which the force of `force_between` is largest, and that
    force [N].
    """
    sampled = np.empty(_POINTS)
    low = 0.0
    high = 1.0
    x = 0.0
    for _ in range(_ROUNDS):
        for point in range(_POINTS):
            sampled[point] = force_between(
                basis, law, delta, rate, low + (high - low) * point / (_POINTS - 1)
            )
        x, low, high = narrowed(sampled, low, high)
    return x, force_between(basis, law, delta, rate, x)


@compiled
def narrowed(sampled: Vector, low: float, high: float) -> tuple[float, float, float]:
    """Return about where values at evenly spaced points of an interval are largest, and the two
    points around.

    It is the vertex of the parabola through three of them, which is insensitive to rounding.
    """
    last = len(sampled) - 1
    best = 0
    for point in range(1, last + 1):
        if sampled[point] > sampled[best]:
            best = point
    step = (high - low) / last
    x = low + step * best
    if 0 < best < last:
        before = sampled[best - 1]
        after = sampled[best + 1]
        bend = 2.0 * sampled[best] - before - after
        if bend > 0.0:
            x += 0.5 * step * (after - before) / bend
    return x, low + step * max(best - 1, 0), low + step * min(best + 1, last)
