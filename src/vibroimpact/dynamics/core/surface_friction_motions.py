"""The motion of the contact point of a sphere and of the surface below along each other, under
friction at the nodes of a stretch.

See `sphere`, for the equations as well.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.linear import product
from vibroimpact.dynamics.core.records import Basis
from vibroimpact.dynamics.core.surface_friction_records import (
    ROLLING_X,
    WITH_MOMENTS,
    SlidingSphere,
)


@compiled
def surface_along(free: Vector, by_force: Matrix, normal: Vector, friction: Matrix) -> Matrix:
    """Return what the surface below adds to displacements or velocities along it at the nodes (F,
    N), under forces there.

    free (M,), by_force (M, M): of a `Motion` along, its approach or its rate.
    """
    directions, nodes = friction.shape
    moved = np.empty((directions, nodes))
    for direction in range(directions):
        for node in range(nodes):
            row = (1 + direction) * nodes + node
            value = free[row]
            for other in range(nodes):
                value -= by_force[row, other] * normal[other]
            for pushing in range(directions):
                for other in range(nodes):
                    value -= by_force[row, (1 + pushing) * nodes + other] * friction[pushing, other]
            moved[direction, node] = value
    return moved


@compiled
def slowing(sphere: SlidingSphere, friction: Matrix) -> Matrix:
    """Return by how much friction and its moments slow the contact point of the sphere at
    the nodes [m/s^2] (2, N).
    """
    # g - u'' = Q/m_t + R M/I
    directions, nodes = friction.shape
    slowed = np.empty((2, nodes))
    turn = sphere.radius / sphere.inertia
    for direction in range(2):
        for node in range(nodes):
            slowed[direction, node] = friction[direction, node] / sphere.mass
            if directions == WITH_MOMENTS:
                slowed[direction, node] += turn * friction[ROLLING_X + direction, node]
    return slowed


@compiled
def sphere_displacements(
    basis: Basis, sphere: SlidingSphere, length: float, slowed: Matrix
) -> Matrix:
    """Return the displacements of the contact point of the sphere from the start to the
    nodes [m] (2, N).
    """
    # gravity in closed form, friction integrated twice by the rule
    nodes = len(basis.time)
    moved = np.empty((2, nodes))
    for direction in range(2):
        held_back = product(basis.integral_twice, slowed[direction])
        for node in range(nodes):
            time = length * basis.time[node]
            free = (sphere.velocity[direction] + 0.5 * sphere.pull[direction] * time) * time
            moved[direction, node] = free - length * length * held_back[node]
    return moved


@compiled
def sphere_velocities(basis: Basis, sphere: SlidingSphere, length: float, slowed: Matrix) -> Matrix:
    """Return the velocities of the contact point of the sphere at the nodes [m/s] (2, N)."""
    nodes = len(basis.time)
    velocities = np.empty((2, nodes))
    for direction in range(2):
        lost = product(basis.integral, slowed[direction])
        for node in range(nodes):
            free = sphere.velocity[direction] + sphere.pull[direction] * (length * basis.time[node])
            velocities[direction, node] = free - length * lost[node]
    return velocities
