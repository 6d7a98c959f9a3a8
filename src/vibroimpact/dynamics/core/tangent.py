"""Small differences of the motion through a stretch of contact, by the linearised equations at its nodes."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.linear import product, solve_in_place
from vibroimpact.dynamics.core.records import Motion
from vibroimpact.dynamics.core.stretch import indentations_by, write_force_jacobian


@compiled(lambda t: t.tuple(t.vector, t.vector)(t.of(Motion), t.matrix, t.vector, t.vector, t.vector))
def force_differences(motion: Motion, linear: Floats, approach: Floats, static: Floats, dissipative: Floats) -> tuple[Floats, Floats]:
    """Return the differences of the contact forces and of their static parts at the nodes [N] (M,).

    Parameters
    ----------
    motion : Motion
        Motion of the surfaces from the difference of the state at the start.
    linear : array, shape (7, M)
        The laws at the nodes, as `linearise` gives them.
    approach, static, dissipative : array, shape (M,)
        What a varied law changes, at fixed indentations and rates: the approach [m], and the parts of the force [N].
    """
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
        force_by_delta = linear[4, row] + linear[5, row]
        changed = static[row] + dissipative[row] + linear[6, row] * motion.rate[row]
        right[row, 0] = changed + force_by_delta * by[row, size]
    solve_in_place(matrix, right)
    force = right[:, 0].copy()
    static_difference = np.empty(size)
    for row in range(size):
        deeper = by[row, size]
        for column in range(size):
            deeper -= by[row, column] * force[column]
        static_difference[row] = static[row] + linear[4, row] * deeper
    return force, static_difference
