r"""Friction at the contact of a rigid sphere with a surface that moves, through a stretch of
contact.

The contact point of the sphere moves along the surface as a particle of its effective mass
:math:`m_t`, 2/7 of that of a solid sphere, the surface by the modes of the body below, which
friction bends and turns. With the displacements u of the first and w of the second,

.. math::

    m_t \ddot u = m_t g_t - Q,\qquad w = \sum_i \psi_i q_i,\qquad
    \ddot q_i + \ldots = -\chi_i F + \psi_i Q

and Q follows from F and the history of u - w by the friction law. At the nodes of a stretch all
displacements are linear in F and Q. Q is found by iteration beside Newton's method for F: it
follows from displacements before it, so that each iteration adds an order in time.

Where rolling is resisted or the sphere spins about the normal, the moments M act as well, against
the part of its spin that rolls and that about the normal, both relative to the rigid rotation of
the plate, which they turn. With the moment of inertia I of the sphere

.. math:: I \dot\omega = -R Q - M,\qquad m_t \ddot u = m_t g_t - Q - \frac{m_t R}{I} M

for the spins about -y, x (and z, on which Q has no moment). Moments that would turn a spin back
within a stretch are as large as brings it to its end.

The directions of friction are further contacts of the system, the first of which is that of the
normal force.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.linear import write_row
from vibroimpact.dynamics.core.receptance import modal_weights, surface_motion
from vibroimpact.dynamics.core.records import Basis, ModalWeights, Motion, Start, Surfaces
from vibroimpact.dynamics.core.surface_friction_moments import (
    slowing_spins,
    sphere_spins,
    spin_imbalance,
    turned_after,
    write_moments,
)
from vibroimpact.dynamics.core.surface_friction_motions import (
    slowing,
    sphere_displacements,
    sphere_velocities,
    surface_along,
)
from vibroimpact.dynamics.core.surface_friction_records import (
    AT_X,
    AT_Y,
    ROLLING_X,
    WITH_MOMENTS,
    FrictionAtNodes,
    Motions,
    SlidingPart,
    SlidingSphere,
    SlidStretch,
)
from vibroimpact.dynamics.core.tangential_history import (
    follow_history,
    lost_in_microslip,
    with_state,
)


@compiled
def flown(sphere: SlidingSphere, time: float) -> SlidingSphere:
    """Return the friction after a time without contact force [s]."""
    displacement = np.empty(2)
    velocity = np.empty(2)
    turned_way = np.empty(2)
    for direction in range(2):
        speed = sphere.velocity[direction]
        pull = sphere.pull[direction]
        displacement[direction] = (
            sphere.displacement[direction] + (speed + 0.5 * pull * time) * time
        )
        velocity[direction] = speed + pull * time
        turned_way[direction] = (
            sphere.turned_way[direction] + sphere.radius * sphere.turned[direction] * time
        )
    history = with_state(
        sphere.history,
        0.0,
        np.zeros_like(sphere.history.stretch),
        np.zeros(2),
        0.0,
    )
    return SlidingSphere(
        sphere.directions,
        sphere.rolling_coefficient,
        sphere.mass,
        sphere.radius,
        sphere.inertia,
        sphere.pull,
        velocity,
        displacement,
        sphere.spin,
        np.zeros(2),
        sphere.turned,
        turned_way,
        0.0,
        sphere.work,
        sphere.microslip,
        history,
    )


@compiled
def weights_across_and_along(
    surfaces: Surfaces, start: Start, sliding: SlidStretch
) -> tuple[ModalWeights, ModalWeights]:
    """Return the weights of the modes in the motion of the surfaces, across and along them."""
    across = modal_weights(surfaces, start)
    if sliding.sphere.directions == 0:
        return across, across
    return across, modal_weights(sliding.surfaces, sliding.start)


@compiled
def free_motions(
    basis: Basis,
    surfaces: Surfaces,
    start: Start,
    sliding: SlidStretch,
    weights: ModalWeights,
    weights_along: ModalWeights,
    length: float,
) -> Motions:
    """Return the motion of the surfaces through a stretch of a length [s], across and
    along them.
    """
    across = surface_motion(basis, surfaces, weights, start, length)
    if sliding.sphere.directions == 0:
        return Motions(across, across)
    return Motions(
        across, surface_motion(basis, sliding.surfaces, weights_along, sliding.start, length)
    )


@compiled
def first_friction(sphere: SlidingSphere, nodes: int) -> FrictionAtNodes:
    """Return the friction with which a stretch begins, at all of its nodes."""
    force = np.zeros((sphere.directions, nodes))
    if sphere.directions:
        for node in range(nodes):
            force[AT_X, node] = sphere.force[0]
            force[AT_Y, node] = sphere.force[1]
    none = np.zeros((0, 2))
    return FrictionAtNodes(force, sphere.history, np.zeros(0), none, none, np.zeros(0))


@compiled
def under_friction(motions: Motions, friction: Matrix) -> Motion:
    """Return the motion of the surfaces across, with what friction forces at the nodes
    [N] move them.
    """
    # directions of friction follow the normal contact as further contacts: their columns begin
    # after its nodes
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


@compiled
def follow_friction(
    basis: Basis,
    motions: Motions,
    sliding: SlidStretch,
    length: float,
    normal: Vector,
    before: FrictionAtNodes,
) -> FrictionAtNodes:
    """Return the friction at the nodes under normal forces there [N] (N,), from the displacements
    under the friction before.

    The history is followed in some steps from each node to the next.
    """
    # u - w under the forces of the last iteration
    sphere = sliding.sphere
    along = motions.along
    nodes = len(normal)
    moved = sphere_displacements(basis, sphere, length, slowing(sphere, before.force))
    surface = surface_along(along.approach, along.approach_by_force, normal, before.force)
    steps = len(basis.forces_between)
    pressed = np.empty(1 + steps)
    pressed[0] = sphere.normal
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
            x += weight * (
                moved[0, node] + (surface[AT_X, node] - sliding.start.approach[1 + AT_X])
            )
            y += weight * (
                moved[1, node] + (surface[AT_Y, node] - sliding.start.approach[1 + AT_Y])
            )
        pressed[1 + step] = pressing
        steps_moved[step, 0] = x - last_x
        steps_moved[step, 1] = y - last_y
        last_x = x
        last_y = y
    # Q from the law along that way; the first row is the state at the start
    friction = np.empty((1 + steps, 2))
    slid = np.empty(1 + steps)
    write_row(friction, 0, sphere.force)
    slid[0] = sphere.history.slid
    history = follow_history(sphere.history, pressed[1:], steps_moved, friction[1:], slid[1:])
    force = before.force.copy()
    each = steps // nodes
    for node in range(nodes):
        force[AT_X, node] = friction[(node + 1) * each, 0]
        force[AT_Y, node] = friction[(node + 1) * each, 1]
    if sphere.directions == WITH_MOMENTS:
        write_moments(basis, motions, sphere, length, normal, force)
    return FrictionAtNodes(force, history, pressed, friction, steps_moved, slid)


@compiled
def sliding_part(
    basis: Basis,
    motions: Motions,
    sphere: SlidingSphere,
    length: float,
    normal: Vector,
    friction: FrictionAtNodes,
) -> SlidingPart:
    """Return what friction does through a solved stretch, under normal forces at its
    nodes [N] (N,).
    """
    nodes = len(normal)
    last = nodes - 1
    force = friction.force
    directions = sphere.directions
    slip = np.zeros((directions, nodes))
    if directions == 0:
        return SlidingPart(force, slip, sphere, 0.0, 0.0)
    slowed = slowing(sphere, force)
    velocity = sphere_velocities(basis, sphere, length, slowed)
    moved = sphere_displacements(basis, sphere, length, slowed)
    surface = surface_along(motions.along.rate, motions.along.rate_by_force, normal, force)
    spins = np.zeros((3, nodes))
    if directions == WITH_MOMENTS:
        spins = sphere_spins(basis, sphere, length, slowing_spins(sphere, force))
    taken = 0.0
    given = 0.0
    imbalance = 0.0
    for direction in range(directions):
        for node in range(nodes):
            if direction <= AT_Y:
                own = velocity[direction, node]
            else:
                own = spins[direction - ROLLING_X, node]
            slip[direction, node] = own + surface[direction, node]
            # the slip is u' - w', and `surface` -w': friction takes Q (u' - w'), and the surface is
            # given Q w'
            weight = length * basis.integral[last, node]
            taken += weight * force[direction, node] * slip[direction, node]
            given -= weight * force[direction, node] * surface[direction, node]
    end_force = np.empty(2)
    end_velocity = np.empty(2)
    end_displacement = np.empty(2)
    for direction in range(2):
        begun = sphere.velocity[direction]
        ended = velocity[direction, last]
        end_force[direction] = force[direction, last]
        end_velocity[direction] = ended
        end_displacement[direction] = sphere.displacement[direction] + moved[direction, last]
        imbalance += sphere.mass * (
            0.5 * (ended - begun) * (ended + begun)
            - sphere.pull[direction] * moved[direction, last]
        )
        for node in range(nodes):
            # change of the kinetic energy, less the work of gravity and of friction
            imbalance += (
                length
                * basis.integral[last, node]
                * sphere.mass
                * slowed[direction, node]
                * velocity[direction, node]
            )
    imbalance = abs(imbalance)  # so that it can't cancel that of the spins
    spin = sphere.spin
    turned = sphere.turned
    turned_way = sphere.turned_way
    if directions == WITH_MOMENTS:
        imbalance += abs(spin_imbalance(basis, sphere, length, force, spins))
        spin = np.empty(3)
        for axis in range(3):
            spin[axis] = spins[axis, last]
        turned, turned_way = turned_after(basis, sphere, length, force)
    microslip = lost_in_microslip(
        sphere.history,
        friction.pressed,
        friction.on_the_way,
        friction.moved,
        friction.slid,
    )
    end = SlidingSphere(
        sphere.directions,
        sphere.rolling_coefficient,
        sphere.mass,
        sphere.radius,
        sphere.inertia,
        sphere.pull,
        end_velocity,
        end_displacement,
        spin,
        end_force,
        turned,
        turned_way,
        friction.pressed[len(friction.pressed) - 1],
        sphere.work + taken,
        sphere.microslip + microslip,
        friction.history,
    )
    return SlidingPart(force, slip, end, given, imbalance)
