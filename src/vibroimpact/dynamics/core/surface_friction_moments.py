"""The moments with which a surface that moves resists the rolling and the twisting of a sphere,
through a stretch of contact.

See `sphere`, for the equations as well.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled
from vibroimpact.contact.friction.twisting import FULL_TWISTING, twisting_share
from vibroimpact.dynamics.core.linear import product
from vibroimpact.dynamics.core.records import Basis
from vibroimpact.dynamics.core.surface_friction_motions import (
    slowing,
    sphere_velocities,
    surface_along,
)
from vibroimpact.dynamics.core.surface_friction_records import (
    ABOUT_NORMAL,
    AT_X,
    AT_Y,
    ROLLING_X,
    ROLLING_Y,
    Motions,
    SlidingSphere,
)
from vibroimpact.dynamics.core.tangential_history import depth_under


@compiled
def slowing_spins(sphere: SlidingSphere, friction: Matrix) -> Matrix:
    """Return by how much friction and its moments slow the spins of the sphere at the
    nodes [rad/s^2] (3, N).
    """
    # -w' = (R Q + M)/I about -y and x, and M/I about z
    nodes = friction.shape[1]
    slowed = np.empty((3, nodes))
    turn = sphere.radius / sphere.inertia
    for node in range(nodes):
        slowed[0, node] = friction[ROLLING_X, node] / sphere.inertia + turn * friction[AT_X, node]
        slowed[1, node] = friction[ROLLING_Y, node] / sphere.inertia + turn * friction[AT_Y, node]
        slowed[2, node] = friction[ABOUT_NORMAL, node] / sphere.inertia
    return slowed


@compiled
def sphere_spins(basis: Basis, sphere: SlidingSphere, length: float, slowed: Matrix) -> Matrix:
    """Return the spins of the sphere about -y, x and z at the nodes [rad/s] (3, N)."""
    nodes = len(basis.time)
    spins = np.empty((3, nodes))
    for axis in range(3):
        lost = product(basis.integral, slowed[axis])
        for node in range(nodes):
            spins[axis, node] = sphere.spin[axis] - length * lost[node]
    return spins


@compiled
def twisting_moment(
    sphere: SlidingSphere, load: float, friction: float, slip: float, spin: float
) -> float:
    """Return the moment against twisting at a rate `spin` [rad/s] under a normal force,
    beside friction [N], at a slip speed [m/s].
    """
    history = sphere.history
    contact_radius = math.sqrt(history.radius * depth_under(history, load))
    most = history.coefficient * load
    used = 1.0
    if most > 0.0:
        used = friction / most
    return float(
        FULL_TWISTING * most * contact_radius * twisting_share(contact_radius * spin, slip, used)
    )


@compiled
def write_moments(
    basis: Basis,
    motions: Motions,
    sphere: SlidingSphere,
    length: float,
    normal: Vector,
    force: Matrix,
) -> None:
    """Write the moments at the nodes [N m] beside friction into `force`: they act along
    the spins without them, and end with these.
    """
    along = motions.along
    nodes = len(normal)
    slips = sphere_velocities(basis, sphere, length, slowing(sphere, force))
    surface = surface_along(along.rate, along.rate_by_force, normal, force)
    for direction in range(2):
        for node in range(nodes):
            slips[direction, node] += surface[direction, node]
    for axis in range(3):
        for node in range(nodes):
            force[ROLLING_X + axis, node] = 0.0
    free = sphere_spins(basis, sphere, length, slowing_spins(sphere, force))
    surface = surface_along(along.rate, along.rate_by_force, normal, force)
    # of the spins, of those that roll and of that about the normal
    direction_of = np.zeros((3, nodes))
    for node in range(nodes):
        roll_x = free[0, node] + surface[ROLLING_X, node]
        roll_y = free[1, node] + surface[ROLLING_Y, node]
        twist = free[2, node] + surface[ABOUT_NORMAL, node]
        free[0, node] = roll_x
        free[1, node] = roll_y
        free[2, node] = twist
        load = max(normal[node], 0.0)
        rolling = math.hypot(roll_x, roll_y)
        if rolling > 0.0:
            direction_of[0, node] = roll_x / rolling
            direction_of[1, node] = roll_y / rolling
        direction_of[2, node] = np.sign(twist)
        friction = math.hypot(force[AT_X, node], force[AT_Y, node])
        slip = math.hypot(slips[0, node], slips[1, node])
        moment = sphere.rolling_coefficient * sphere.radius * load
        force[ROLLING_X, node] = moment * direction_of[0, node]
        force[ROLLING_Y, node] = moment * direction_of[1, node]
        force[ABOUT_NORMAL, node] = (
            twisting_moment(sphere, load, friction, slip, abs(twist)) * direction_of[2, node]
        )
    slowed = sphere_spins(basis, sphere, length, slowing_spins(sphere, force))
    surface = surface_along(along.rate, along.rate_by_force, normal, force)
    last = nodes - 1
    left = np.zeros(3)
    lost = np.zeros(3)
    for axis in range(3):
        after = slowed[axis, last] + surface[ROLLING_X + axis, last]
        left[axis] = free[axis, last] * direction_of[axis, last]
        lost[axis] = (free[axis, last] - after) * direction_of[axis, last]
    rolling_share = share_left(left[0] + left[1], lost[0] + lost[1])
    twisting_left = share_left(left[2], lost[2])
    for node in range(nodes):
        force[ROLLING_X, node] *= rolling_share
        force[ROLLING_Y, node] *= rolling_share
        force[ABOUT_NORMAL, node] *= twisting_left


@compiled
def share_left(left: float, lost: float) -> float:
    """Return the part of a moment after which nothing is left of a spin, of which `left`
    is there and it would take `lost`.
    """
    if lost > left:
        return min(max(left / lost, 0.0), 1.0)
    return 1.0


@compiled
def spin_imbalance(
    basis: Basis, sphere: SlidingSphere, length: float, force: Matrix, spins: Matrix
) -> float:
    """Return the error of the balance of energy of the spins through a stretch [J]."""
    # I (w_1^2 - w_0^2)/2 as a difference of squares, and the work of friction and its moments
    slowed = slowing_spins(sphere, force)
    nodes = len(basis.time)
    imbalance = 0.0
    for axis in range(3):
        change = 0.0
        lost = 0.0
        for node in range(nodes):
            weight = length * basis.integral[nodes - 1, node]
            change -= weight * slowed[axis, node]
            lost += weight * slowed[axis, node] * spins[axis, node]
        imbalance += change * (sphere.spin[axis] + 0.5 * change) + lost
    return sphere.inertia * imbalance


@compiled
def turned_after(
    basis: Basis, sphere: SlidingSphere, length: float, force: Matrix
) -> tuple[Vector, Vector]:
    """Return what moments made of the spin [rad/s] (3,), and of the displacement [m]
    (2,), at the end of a stretch.
    """
    nodes = len(basis.time)
    last = nodes - 1
    turned = np.empty(3)
    turned_way = np.empty(2)
    for axis in range(3):
        lost = 0.0
        held_back = 0.0
        for node in range(nodes):
            lost += basis.integral[last, node] * force[ROLLING_X + axis, node]
            held_back += basis.integral_twice[last, node] * force[ROLLING_X + axis, node]
        turned[axis] = sphere.turned[axis] - length * lost / sphere.inertia
        if axis < 2:
            going_on = sphere.radius * sphere.turned[axis] * length * basis.time[last]
            more = sphere.radius * length * length * held_back / sphere.inertia
            turned_way[axis] = sphere.turned_way[axis] + going_on - more
    return turned, turned_way
