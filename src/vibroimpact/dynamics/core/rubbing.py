r"""Friction at the contact of a rigid sphere with a surface that moves, through a stretch of contact.

The contact point of the sphere moves along the surface as a particle of its effective mass :math:`m_t`, 2/7 of that of a solid sphere, the
surface by the modes of the body below, which friction bends and turns. With the displacements u of the first and w of the second,

.. math:: m_t \ddot u = m_t g_t - Q,\qquad w = \sum_i \psi_i q_i,\qquad \ddot q_i + \ldots = -\chi_i F + \psi_i Q

and Q follows from F and the history of u - w by the friction law. At the nodes of a stretch all displacements are linear in F and Q. Q is
found by iteration beside Newton's method for F: it follows from displacements before it, so that each iteration adds an order in time.

Where rolling is resisted or the sphere spins about the normal, the moments M act as well, against the part of its spin that rolls and that
about the normal, both relative to the rigid rotation of the plate, which they turn. With the moment of inertia I of the sphere

.. math:: I \dot\omega = -R Q - M,\qquad m_t \ddot u = m_t g_t - Q - \frac{m_t R}{I} M

for the spins about -y, x (and z, on which Q has no moment). Moments that would turn a spin back within a stretch are as large as brings it
to its end.

The directions of friction are further contacts of the system, the first of which is that of the normal force.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import compiled
from vibroimpact.contact.friction.twisting import twisting_share
from vibroimpact.dynamics.core.receptance import surface_motion
from vibroimpact.dynamics.core.records import Basis, Motion, Start, Surfaces
from vibroimpact.dynamics.core.rubbing_records import (
    ABOUT_NORMAL,
    AT_X,
    AT_Y,
    ROLLING_X,
    ROLLING_Y,
    WITH_MOMENTS,
    FrictionAtNodes,
    Motions,
    Rubbed,
    RubbedPart,
    Rubbing,
)
from vibroimpact.dynamics.core.tangential_history import follow_history, lost_in_microslip, with_state

_FULL_TWISTING = 3.0 * math.pi / 16.0  # moment of full twisting, over friction force and contact radius


@compiled(lambda t: t.of(Rubbing)(t.of(Rubbing), t.real))
def flown(rubbing: Rubbing, time: float) -> Rubbing:
    """Return the friction after a time without contact force [s]."""
    displacement = np.empty(2)
    velocity = np.empty(2)
    turned_way = np.empty(2)
    for direction in range(2):
        speed = rubbing.velocity[direction]
        pull = rubbing.pull[direction]
        displacement[direction] = rubbing.displacement[direction] + (speed + 0.5 * pull * time) * time
        velocity[direction] = speed + pull * time
        turned_way[direction] = rubbing.turned_way[direction] + rubbing.radius * rubbing.turned[direction] * time
    history = with_state(rubbing.history, 0.0, np.zeros_like(rubbing.history.stretch), np.zeros(2), 0.0)
    return Rubbing(
        rubbing.directions,
        rubbing.rolling_coefficient,
        rubbing.mass,
        rubbing.radius,
        rubbing.inertia,
        rubbing.pull,
        velocity,
        displacement,
        rubbing.spin,
        np.zeros(2),
        rubbing.turned,
        turned_way,
        0.0,
        rubbing.work,
        rubbing.microslip,
        history,
    )


@compiled(lambda t: t.of(Motions)(t.of(Basis), t.of(Surfaces), t.of(Start), t.of(Rubbed), t.real))
def free_motions(basis: Basis, surfaces: Surfaces, start: Start, rubbed: Rubbed, length: float) -> Motions:
    """Return the motion of the surfaces through a stretch of a length [s], across and along them."""
    across = surface_motion(basis, surfaces, start, length)
    if rubbed.rubbing.directions == 0:
        return Motions(across, across)
    return Motions(across, surface_motion(basis, rubbed.surfaces, rubbed.start, length))


@compiled(lambda t: t.of(FrictionAtNodes)(t.of(Rubbing), t.integer))
def first_friction(rubbing: Rubbing, nodes: int) -> FrictionAtNodes:
    """Return the friction with which a stretch begins, at all of its nodes."""
    force = np.zeros((rubbing.directions, nodes))
    if rubbing.directions:
        for node in range(nodes):
            force[AT_X, node] = rubbing.force[0]
            force[AT_Y, node] = rubbing.force[1]
    none = np.zeros((0, 2))
    return FrictionAtNodes(force, rubbing.history, np.zeros(0), none, none, np.zeros(0))


@compiled(lambda t: t.of(Motion)(t.of(Motions), t.matrix))
def under_friction(motions: Motions, friction: Floats) -> Motion:
    """Return the motion of the surfaces across, with what friction forces at the nodes [N] move them."""
    free = motions.across
    directions, nodes = friction.shape
    if directions == 0:
        return free
    approach = free.approach.copy()
    rate = free.rate.copy()
    closing = free.closing.copy()
    for node in range(nodes):
        closer = 0.0
        faster = 0.0
        for direction in range(directions):
            for other in range(nodes):
                column = (1 + direction) * nodes + other
                closer += motions.along.approach_by_force[node, column] * friction[direction, other]
                faster += motions.along.rate_by_force[node, column] * friction[direction, other]
        approach[node] -= closer
        rate[node] -= faster
        closing[node] -= faster
    return Motion(
        approach,
        rate,
        closing,
        free.approach_by_force,
        free.rate_by_force,
        free.approach_by_static,
        free.closing_by_static,
        free.weights,
        free.sums,
    )


@compiled(lambda t: t.matrix(t.vector, t.matrix, t.vector, t.matrix))
def surface_along(free: Floats, by_force: Floats, normal: Floats, friction: Floats) -> Floats:
    """Return what the surface below adds to displacements or velocities along it at the nodes (F, N), under forces there.

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


@compiled(lambda t: t.matrix(t.of(Rubbing), t.matrix))
def slowing(rubbing: Rubbing, friction: Floats) -> Floats:
    """Return by how much friction and its moments slow the contact point of the sphere at the nodes [m/s^2] (2, N)."""
    directions, nodes = friction.shape
    slowed = np.empty((2, nodes))
    turn = rubbing.radius / rubbing.inertia
    for direction in range(2):
        for node in range(nodes):
            slowed[direction, node] = friction[direction, node] / rubbing.mass
            if directions == WITH_MOMENTS:
                slowed[direction, node] += turn * friction[ROLLING_X + direction, node]
    return slowed


@compiled(lambda t: t.matrix(t.of(Rubbing), t.matrix))
def slowing_spins(rubbing: Rubbing, friction: Floats) -> Floats:
    """Return by how much friction and its moments slow the spins of the sphere at the nodes [rad/s^2] (3, N)."""
    nodes = friction.shape[1]
    slowed = np.empty((3, nodes))
    turn = rubbing.radius / rubbing.inertia
    for node in range(nodes):
        slowed[0, node] = friction[ROLLING_X, node] / rubbing.inertia + turn * friction[AT_X, node]
        slowed[1, node] = friction[ROLLING_Y, node] / rubbing.inertia + turn * friction[AT_Y, node]
        slowed[2, node] = friction[ABOUT_NORMAL, node] / rubbing.inertia
    return slowed


@compiled(lambda t: t.matrix(t.of(Basis), t.of(Rubbing), t.real, t.matrix))
def sphere_displacements(basis: Basis, rubbing: Rubbing, length: float, slowed: Floats) -> Floats:
    """Return the displacements of the contact point of the sphere from the start to the nodes [m] (2, N)."""
    nodes = len(basis.time)
    moved = np.empty((2, nodes))
    for direction in range(2):
        for node in range(nodes):
            time = length * basis.time[node]
            held_back = 0.0
            for other in range(nodes):
                held_back += basis.integral_twice[node, other] * slowed[direction, other]
            free = (rubbing.velocity[direction] + 0.5 * rubbing.pull[direction] * time) * time
            moved[direction, node] = free - length * length * held_back
    return moved


@compiled(lambda t: t.matrix(t.of(Basis), t.of(Rubbing), t.real, t.matrix))
def sphere_velocities(basis: Basis, rubbing: Rubbing, length: float, slowed: Floats) -> Floats:
    """Return the velocities of the contact point of the sphere at the nodes [m/s] (2, N)."""
    nodes = len(basis.time)
    velocities = np.empty((2, nodes))
    for direction in range(2):
        for node in range(nodes):
            lost = 0.0
            for other in range(nodes):
                lost += basis.integral[node, other] * slowed[direction, other]
            free = rubbing.velocity[direction] + rubbing.pull[direction] * (length * basis.time[node])
            velocities[direction, node] = free - length * lost
    return velocities


@compiled(lambda t: t.matrix(t.of(Basis), t.of(Rubbing), t.real, t.matrix))
def sphere_spins(basis: Basis, rubbing: Rubbing, length: float, slowed: Floats) -> Floats:
    """Return the spins of the sphere about -y, x and z at the nodes [rad/s] (3, N)."""
    nodes = len(basis.time)
    spins = np.empty((3, nodes))
    for axis in range(3):
        for node in range(nodes):
            lost = 0.0
            for other in range(nodes):
                lost += basis.integral[node, other] * slowed[axis, other]
            spins[axis, node] = rubbing.spin[axis] - length * lost
    return spins


@compiled(lambda t: t.of(FrictionAtNodes)(t.of(Basis), t.of(Motions), t.of(Rubbed), t.real, t.vector, t.of(FrictionAtNodes)))
def follow_friction(
    basis: Basis, motions: Motions, rubbed: Rubbed, length: float, normal: Floats, before: FrictionAtNodes
) -> FrictionAtNodes:
    """Return the friction at the nodes under normal forces there [N] (N,), from the displacements under the friction before.

    The history is followed in some steps from each node to the next.
    """
    rubbing = rubbed.rubbing
    along = motions.along
    nodes = len(normal)
    moved = sphere_displacements(basis, rubbing, length, slowing(rubbing, before.force))
    surface = surface_along(along.approach, along.approach_by_force, normal, before.force)
    steps = len(basis.forces_between)
    pressed = np.empty(1 + steps)
    pressed[0] = rubbing.normal
    steps_moved = np.empty((steps, 2))
    last_x = 0.0
    last_y = 0.0
    for step in range(steps):
        pressing = 0.0
        x = 0.0
        y = 0.0
        for node in range(nodes):
            weight = basis.displacements_between[step, node]
            pressing += basis.forces_between[step, node] * normal[node]
            x += weight * (moved[0, node] + (surface[AT_X, node] - rubbed.start.approach[1 + AT_X]))
            y += weight * (moved[1, node] + (surface[AT_Y, node] - rubbed.start.approach[1 + AT_Y]))
        pressed[1 + step] = pressing
        steps_moved[step, 0] = x - last_x
        steps_moved[step, 1] = y - last_y
        last_x = x
        last_y = y
    friction = np.empty((1 + steps, 2))
    slid = np.empty(1 + steps)
    friction[0] = rubbing.force
    slid[0] = rubbing.history.slid
    history = follow_history(rubbing.history, pressed[1:], steps_moved, friction[1:], slid[1:])
    force = before.force.copy()
    each = steps // nodes
    for node in range(nodes):
        force[AT_X, node] = friction[(node + 1) * each, 0]
        force[AT_Y, node] = friction[(node + 1) * each, 1]
    if rubbing.directions == WITH_MOMENTS:
        write_moments(basis, motions, rubbing, length, normal, force)
    return FrictionAtNodes(force, history, pressed, friction, steps_moved, slid)


@compiled(lambda t: t.real(t.of(Rubbing), t.real, t.real, t.real, t.real))
def twisting_moment(rubbing: Rubbing, load: float, friction: float, slip: float, spin: float) -> float:
    """Return the moment against twisting at a rate `spin` [rad/s] under a normal force, beside friction [N], at a slip speed [m/s]."""
    history = rubbing.history
    contact_radius = math.sqrt(history.radius * (load / history.hertz) ** (2.0 / 3.0))
    most = history.coefficient * load
    used = friction / most if most > 0.0 else 1.0
    return float(_FULL_TWISTING * most * contact_radius * twisting_share(contact_radius * spin, slip, used))


@compiled(lambda t: t.void(t.of(Basis), t.of(Motions), t.of(Rubbing), t.real, t.vector, t.matrix))
def write_moments(basis: Basis, motions: Motions, rubbing: Rubbing, length: float, normal: Floats, force: Floats) -> None:
    """Write the moments at the nodes [N m] beside friction into `force`: they act along the spins without them, and end with these."""
    along = motions.along
    nodes = len(normal)
    slips = sphere_velocities(basis, rubbing, length, slowing(rubbing, force))
    surface = surface_along(along.rate, along.rate_by_force, normal, force)
    for direction in range(2):
        for node in range(nodes):
            slips[direction, node] += surface[direction, node]
    for axis in range(3):
        for node in range(nodes):
            force[ROLLING_X + axis, node] = 0.0
    free = sphere_spins(basis, rubbing, length, slowing_spins(rubbing, force))
    surface = surface_along(along.rate, along.rate_by_force, normal, force)
    direction_of = np.zeros((3, nodes))  # of the spins, of those that roll and of that about the normal
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
        moment = rubbing.rolling_coefficient * rubbing.radius * load
        force[ROLLING_X, node] = moment * direction_of[0, node]
        force[ROLLING_Y, node] = moment * direction_of[1, node]
        force[ABOUT_NORMAL, node] = twisting_moment(rubbing, load, friction, slip, abs(twist)) * direction_of[2, node]
    slowed = sphere_spins(basis, rubbing, length, slowing_spins(rubbing, force))
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


@compiled(lambda t: t.real(t.real, t.real))
def share_left(left: float, lost: float) -> float:
    """Return the part of a moment after which nothing is left of a spin, of which `left` is there and it would take `lost`."""
    if lost > left:
        return min(max(left / lost, 0.0), 1.0)
    return 1.0


@compiled(lambda t: t.of(RubbedPart)(t.of(Basis), t.of(Motions), t.of(Rubbing), t.real, t.vector, t.of(FrictionAtNodes)))
def rubbed_part(basis: Basis, motions: Motions, rubbing: Rubbing, length: float, normal: Floats, friction: FrictionAtNodes) -> RubbedPart:
    """Return what friction does through a solved stretch, under normal forces at its nodes [N] (N,)."""
    nodes = len(normal)
    last = nodes - 1
    force = friction.force
    directions = rubbing.directions
    slip = np.zeros((directions, nodes))
    if directions == 0:
        return RubbedPart(force, slip, rubbing, 0.0, 0.0)
    slowed = slowing(rubbing, force)
    velocity = sphere_velocities(basis, rubbing, length, slowed)
    moved = sphere_displacements(basis, rubbing, length, slowed)
    surface = surface_along(motions.along.rate, motions.along.rate_by_force, normal, force)
    spins = np.zeros((3, nodes))
    if directions == WITH_MOMENTS:
        spins = sphere_spins(basis, rubbing, length, slowing_spins(rubbing, force))
    taken = 0.0
    given = 0.0
    imbalance = 0.0
    for direction in range(directions):
        for node in range(nodes):
            own = velocity[direction, node] if direction <= AT_Y else spins[direction - ROLLING_X, node]
            slip[direction, node] = own + surface[direction, node]
            weight = length * basis.integral[last, node]
            taken += weight * force[direction, node] * slip[direction, node]
            given -= weight * force[direction, node] * surface[direction, node]
    end_velocity = np.empty(2)
    end_displacement = np.empty(2)
    for direction in range(2):
        begun = rubbing.velocity[direction]
        ended = velocity[direction, last]
        end_velocity[direction] = ended
        end_displacement[direction] = rubbing.displacement[direction] + moved[direction, last]
        imbalance += rubbing.mass * (0.5 * (ended - begun) * (ended + begun) - rubbing.pull[direction] * moved[direction, last])
        for node in range(nodes):
            imbalance += length * basis.integral[last, node] * rubbing.mass * slowed[direction, node] * velocity[direction, node]
    imbalance = abs(imbalance)
    spin = rubbing.spin
    turned = rubbing.turned
    turned_way = rubbing.turned_way
    if directions == WITH_MOMENTS:
        imbalance += abs(spin_imbalance(basis, rubbing, length, force, spins))
        spin = spins[:, last].copy()
        turned, turned_way = turned_after(basis, rubbing, length, force)
    microslip = lost_in_microslip(rubbing.history, friction.pressed, friction.on_the_way, friction.moved, friction.slid)
    end = Rubbing(
        rubbing.directions,
        rubbing.rolling_coefficient,
        rubbing.mass,
        rubbing.radius,
        rubbing.inertia,
        rubbing.pull,
        end_velocity,
        end_displacement,
        spin,
        force[:2, last].copy(),
        turned,
        turned_way,
        friction.pressed[len(friction.pressed) - 1],
        rubbing.work + taken,
        rubbing.microslip + microslip,
        friction.history,
    )
    return RubbedPart(force, slip, end, given, imbalance)


@compiled(lambda t: t.real(t.of(Basis), t.of(Rubbing), t.real, t.matrix, t.matrix))
def spin_imbalance(basis: Basis, rubbing: Rubbing, length: float, force: Floats, spins: Floats) -> float:
    """Return the error of the balance of energy of the spins through a stretch [J]."""
    slowed = slowing_spins(rubbing, force)
    nodes = len(basis.time)
    imbalance = 0.0
    for axis in range(3):
        change = 0.0
        lost = 0.0
        for node in range(nodes):
            weight = length * basis.integral[nodes - 1, node]
            change -= weight * slowed[axis, node]
            lost += weight * slowed[axis, node] * spins[axis, node]
        imbalance += change * (rubbing.spin[axis] + 0.5 * change) + lost
    return rubbing.inertia * imbalance


@compiled(lambda t: t.tuple(t.vector, t.vector)(t.of(Basis), t.of(Rubbing), t.real, t.matrix))
def turned_after(basis: Basis, rubbing: Rubbing, length: float, force: Floats) -> tuple[Floats, Floats]:
    """Return what moments made of the spin [rad/s] (3,), and of the displacement [m] (2,), at the end of a stretch."""
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
        turned[axis] = rubbing.turned[axis] - length * lost / rubbing.inertia
        if axis < 2:
            going_on = rubbing.radius * rubbing.turned[axis] * length * basis.time[last]
            more = rubbing.radius * length * length * held_back / rubbing.inertia
            turned_way[axis] = rubbing.turned_way[axis] + going_on - more
    return turned, turned_way
