"""Small differences of the motion through stretches of contact, by the linearised equations at
their nodes.

The forces at the nodes solve equations whose Jacobian is known, and all other quantities are linear
in the forces. A difference of the state at the start gives that at the end by one more linear
solve. Differences are taken at equal times.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.attempt import basis_of, surface_start
from vibroimpact.dynamics.core.contact_records import Bodies, Solved
from vibroimpact.dynamics.core.law import BY_DELTA, BY_RATE, STIFFNESS
from vibroimpact.dynamics.core.linear import product, solve_in_place
from vibroimpact.dynamics.core.path import stretch_path
from vibroimpact.dynamics.core.receptance import modal_weights, surface_motion
from vibroimpact.dynamics.core.records import Bases, Contacts, Motion, State
from vibroimpact.dynamics.core.stretch import (
    indentations_by,
    linearise_contact,
    write_force_jacobian,
)


@compiled
def force_differences(
    motion: Motion, linear: Matrix, approach: Vector, static: Vector, dissipative: Vector
) -> tuple[Vector, Vector]:
    """Return the differences of the contact forces and of their static parts at the nodes [N] (M,).

    Parameters
    ----------
    motion : Motion
        Motion of the surfaces from the difference of the state at the start.
    linear : array, shape (7, M)
        The laws at the nodes, as `linearise` gives them.
    approach, static, dissipative : array, shape (M,)
        What a varied law changes, at fixed indentations and rates: the approach [m], and the parts
        of the force [N].
    """
    # the equations of `stretch.newton_step`, linear in the differences: with the indentations
    # eliminated, (I + D R + K B) dF = changes of the force at fixed forces
    size = len(approach)
    columns = np.empty((size, size + 1))
    missing = motion.approach - approach
    if len(motion.approach_by_static):
        missing -= product(motion.approach_by_static, static)
    for row in range(size):
        for column in range(size):
            columns[row, column] = motion.approach_by_force[row, column]
        columns[row, size] = missing[row]
    by = indentations_by(linear, motion, columns)
    matrix = np.empty((size, size))
    right = np.empty((size, 1))
    write_force_jacobian(linear, motion, by, matrix)
    for row in range(size):
        force_by_delta = linear[STIFFNESS, row] + linear[BY_DELTA, row]
        changed = static[row] + dissipative[row] + linear[BY_RATE, row] * motion.rate[row]
        right[row, 0] = changed + force_by_delta * by[row, size]
    solve_in_place(matrix, right)
    force = right[:, 0].copy()
    static_difference = np.empty(size)
    for row in range(size):
        deeper = by[row, size]
        for column in range(size):
            deeper -= by[row, column] * force[column]
        static_difference[row] = static[row] + linear[STIFFNESS, row] * deeper
    return force, static_difference


@compiled
def propagate(
    bases: Bases, bodies: Bodies, laws: Contacts, weights: Vector, solved: Solved, difference: State
) -> tuple[State, Matrix]:
    """Return the difference of the state at the end of stretches of one contact, and of the contact
    force at their nodes [N] (P, N).

    Parameters
    ----------
    bases : Bases
        The Radau rule under the three maps of time.
    bodies : Bodies
        The linear system without gravity and gap.
    laws : Contacts
        The law, and laws with the closing speed or the memory varied (1 + v).
    weights : array, shape (v,)
        By what the change of the force of each varied law counts.
    solved : Solved
        The stretches, one after the other.
    difference : State
        Difference of the state at their start between a neighbouring motion and that one, to first
        order.
    """
    number, points = solved.delta.shape
    nodes = points - 1
    forces = np.empty((number, nodes))
    linear = np.empty((7, nodes))
    varied = np.empty((7, nodes))
    for stretch in range(number):
        basis = basis_of(bases, solved.time_map[stretch])
        length = solved.length[stretch]
        delta = solved.delta[stretch, 1:]
        rate = solved.rate[stretch, 1:]
        linearise_contact(laws, 0, delta, rate, linear)
        # another closing speed or memory changes the forces of the law and its approach at fixed
        # indentations and rates
        change = np.zeros((3, nodes))
        for variation in range(len(weights)):
            linearise_contact(laws, 1 + variation, delta, rate, varied)
            change += weights[variation] * (varied[:3] - linear[:3])
        start = surface_start(bodies.system, bodies.surfaces, bodies.coordinates, difference)
        of_modes = modal_weights(bodies.surfaces, start)
        motion = surface_motion(basis, bodies.surfaces, of_modes, start, length)
        force, static = force_differences(motion, linear, change[2], change[0], change[1])
        path = stretch_path(
            basis, bodies.surfaces, bodies.coordinates, difference, length, force, static, False
        )
        difference = State(path.displacement, path.speed, path.local)
        forces[stretch] = force
    return difference, forces
