"""One stretch of contact: Newton's method for the forces at its nodes, and for its length where an
event ends it.

The unknowns are the contact forces and the indentations of the laws at the nodes and, where an
event ends the stretch, its length. All other quantities are linear in the forces (`receptance`).
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled, force_at
from vibroimpact.dynamics.core.law import (
    APPROACH,
    BY_DELTA,
    BY_RATE,
    DISSIPATIVE,
    SLOPE,
    STATIC,
    STIFFNESS,
    indentation_at,
    is_in_series,
    linearise,
)
from vibroimpact.dynamics.core.linear import (
    largest_magnitude_of,
    least_of,
    less_product,
    product,
    solve_in_place,
)
from vibroimpact.dynamics.core.receptance import motion_by_length
from vibroimpact.dynamics.core.records import (
    RELEASE,
    RELEASE_LEVEL,
    SPEED,
    Basis,
    Contacts,
    End,
    Motion,
    Nodes,
    Start,
    Surfaces,
)
from vibroimpact.dynamics.core.surface_friction import follow_friction, free_motions, under_friction
from vibroimpact.dynamics.core.surface_friction_records import FrictionAtNodes, Motions, SlidStretch

GIVEN_LENGTH, AT_LEVEL, AT_NO_FORCE, AT_TURN = 0, 1, 2, 3
"""What ends a stretch: a given length; an indentation of a law; no force of a law; no
rate of an approach.
"""

MOST_ITERATIONS = 25
# one iteration lengthens by no more than this times the length, to four times it, or shortens to a
# quarter
_LENGTH_FACTOR = 3.0
_CONVERGED = 1e-13
_STALLED = 1e-11
# of a Newton step: least size of the next one, as the derivatives are finite differences
_INEXACT = 1e-6
_SLOWING = 0.3  # of the last step: a step that is no smaller is rounding
_TINY = 1e-300


@compiled
def linearise_contact(
    contacts: Contacts, contact: int, delta: Vector, rate: Vector, linear: Matrix
) -> None:
    """Write forces, approach and derivatives of the law of one contact at N nodes into
    `linear` (7, N), as `law.linearise` does.
    """
    linearise(
        contacts.addresses[4 * contact],
        contacts.coefficients[contact],
        contacts.numbers[contact, SPEED],
        contacts.numbers[contact, RELEASE],
        contacts.series[contact],
        delta,
        rate,
        linear,
    )


@compiled
def begun_rate(surfaces: Surfaces, start: Start, contact: int) -> float:
    """Return the rate at the dashpot of a contact law at the start without contact force [m/s]."""
    rate = start.outer_rate[contact]
    for element in range(len(surfaces.rate)):
        rate -= surfaces.incidence[contact, element] * surfaces.rate[element] * start.local[element]
    return float(rate)


@compiled
def begun_indentations(contacts: Contacts, start: Start, estimates: Vector) -> Vector:
    """Return the indentations of the laws at the start [m] (c,) by one Newton step from
    close estimates.
    """
    # without a rate, as approach and static force do not depend on it
    found = np.empty(len(estimates))
    linear = np.empty((7, 1))
    still = np.zeros(1)
    for contact in range(len(found)):
        approach = max(start.approach[contact], contacts.numbers[contact, RELEASE_LEVEL])
        found[contact] = approach
        if is_in_series(contacts.series[contact]):
            linearise_contact(contacts, contact, estimates[contact : contact + 1], still, linear)
            nearer = estimates[contact] + (approach - linear[APPROACH, 0]) / linear[SLOPE, 0]
            found[contact] = max(nearer, contacts.numbers[contact, RELEASE])
    return found


@compiled
def first_guess(
    basis: Basis,
    surfaces: Surfaces,
    contacts: Contacts,
    start: Start,
    motion: Motion,
    begun: Vector,
    trend: Vector,
    length: float,
) -> Nodes:
    """Return a guess of forces and indentations at the nodes, from the forces at the
    start extrapolated linearly by their `trend` [N/s].
    """
    nodes = len(basis.time)
    size = len(motion.approach)
    static = np.empty(size)
    force = np.empty(size)
    for contact in range(len(begun)):
        rate = begun_rate(surfaces, start, contact)
        reached = max(begun[contact], contacts.numbers[contact, RELEASE])
        law = force_at(contacts.addresses[4 * contact])
        begun_static, begun_dissipative = law(
            reached, rate, contacts.numbers[contact, SPEED], contacts.coefficients[contact]
        )
        for node in range(nodes):
            later = trend[contact] * length * basis.time[node]
            static[contact * nodes + node] = begun_static + later
            force[contact * nodes + node] = begun_static + begun_dissipative + later
    approach = less_product(motion.approach, motion.approach_by_force, force)
    rates = less_product(motion.rate, motion.rate_by_force, force)
    if len(motion.approach_by_static):
        approach = less_product(approach, motion.approach_by_static, static)
    delta = np.empty(size)
    for contact in range(len(begun)):
        for node in range(nodes):
            row = contact * nodes + node
            delta[row] = indentation_at(
                contacts.addresses[4 * contact],
                contacts.coefficients[contact],
                contacts.numbers[contact, SPEED],
                contacts.numbers[contact, RELEASE],
                contacts.series[contact],
                max(approach[row], contacts.numbers[contact, RELEASE_LEVEL]),
            )
            reached = max(delta[row], contacts.numbers[contact, RELEASE])
            law = force_at(contacts.addresses[4 * contact])
            of_law, dissipative = law(
                reached,
                rates[row],
                contacts.numbers[contact, SPEED],
                contacts.coefficients[contact],
            )
            static[row] = 0.0  # Newton's method takes it from the indentation
            force[row] = of_law + dissipative
    return Nodes(static, force, delta)


@compiled
def force_scale(surfaces: Surfaces, motion: Motion, length: float) -> float:
    """Return a scale of the forces [N], for motions that change their rate within the stretch."""
    scale = 0.0
    nodes = len(motion.rate) // len(surfaces.mass)
    for contact in range(len(surfaces.mass)):
        fastest = 0.0
        for node in range(nodes):
            fastest = max(fastest, abs(motion.rate[contact * nodes + node]))
        scale = max(
            scale, surfaces.mass[contact] * (fastest / length + abs(surfaces.gravity[contact]))
        )
    return scale


@compiled
def linearised_laws(contacts: Contacts, motion: Motion, now: Nodes) -> Matrix:
    """Return forces, approach and derivatives of all laws at the nodes (7, M), as
    `law.linearise` gives them.
    """
    rate = less_product(motion.rate, motion.rate_by_force, now.force)
    size = len(rate)
    nodes = size // len(contacts.numbers)
    linear = np.empty((7, size))
    of_contact = np.empty((7, nodes))
    for contact in range(len(contacts.numbers)):
        first = contact * nodes
        linearise_contact(
            contacts,
            contact,
            now.delta[first : first + nodes],
            rate[first : first + nodes],
            of_contact,
        )
        for row in range(7):
            for node in range(nodes):
                linear[row, first + node] = of_contact[row, node]
    return linear


@compiled
def indentations_by(linear: Matrix, motion: Motion, columns: Matrix) -> Matrix:
    """Return the changes of the indentations (M, r) for changes of the approach that
    forces do not cause [m] (M, r).
    """
    size = len(columns)
    found = columns.copy()
    if not len(motion.approach_by_static):
        for row in range(size):
            for column in range(columns.shape[1]):
                found[row, column] /= linear[SLOPE, row]
        return found
    # static forces move the surface within the contacts: (y' + G_s k) d delta = dy
    matrix = np.empty((size, size))
    for row in range(size):
        for column in range(size):
            matrix[row, column] = motion.approach_by_static[row, column] * linear[STIFFNESS, column]
        matrix[row, row] += linear[SLOPE, row]
    solve_in_place(matrix, found)
    return found


@compiled
def write_force_jacobian(linear: Matrix, motion: Motion, by: Matrix, matrix: Matrix) -> None:
    """Write the Jacobian of the equations in the forces, without the indentations, into the first
    rows and columns of `matrix`.

    `by`: derivatives of the indentations by the approach that the forces cause, in its first
    columns, as `indentations_by` gives them.
    """
    # from F = F_law(delta, rate): a force moves its law by d delta/dF = -B and d rate/dF = -R
    size = len(motion.rate)
    for row in range(size):
        force_by_delta = linear[STIFFNESS, row] + linear[BY_DELTA, row]
        for column in range(size):
            matrix[row, column] = (
                linear[BY_RATE, row] * motion.rate_by_force[row, column]
                + force_by_delta * by[row, column]
            )
        matrix[row, row] += 1.0


@compiled
def write_end_equation(
    motion: Motion,
    linear: Matrix,
    now: Nodes,
    by: Matrix,
    by_length: Matrix,
    length: float,
    end: End,
    last: int,
    matrix: Matrix,
    right: Matrix,
) -> None:
    """Write the linearised equation of what ends a stretch into the last rows of `matrix` and
    `right`, divided by its largest coefficient.

    The first arguments, and `by`, are those of `newton_step`; `by_length`: derivatives of approach,
    rate and closing rate by the length (3, M); `last`: the node at which the stretch ends.
    """
    size = len(now.force)
    unit = _TINY
    slope = 0.0
    residual = 0.0
    for column in range(size):
        matrix[size, column] = 0.0
    if end.kind == AT_NO_FORCE:  # F = 0
        matrix[size, last] = 1.0
        unit = 1.0
        residual = now.force[last]
    elif end.kind == AT_TURN:  # the closing rate, less R F and what static forces take within
        slope = by_length[2, last]
        residual = motion.closing[last]
        for column in range(size):
            by_rate = motion.rate_by_force[last, column]
            matrix[size, column] = -by_rate
            residual -= by_rate * now.force[column]
            unit = max(unit, abs(by_rate))
        if len(motion.approach_by_static):
            for node in range(size):
                by_static = motion.closing_by_static[last, node]
                within = by_static * linear[STIFFNESS, node]
                for column in range(size):
                    matrix[size, column] += within * by[node, column]
                slope += within * by[node, size + 1]
                residual += within * by[node, size] - by_static * linear[STATIC, node]
    else:  # delta = level, of which the step is that of the eliminated indentation
        slope = -by[last, size + 1]
        residual = now.delta[last] - end.level - by[last, size]
        for column in range(size):
            matrix[size, column] = -by[last, column]
            unit = max(unit, abs(by[last, column]))
    for column in range(size):
        matrix[size, column] /= unit
    matrix[size, size] = slope / unit * length
    right[size, 0] = residual / unit


@compiled
def newton_step(
    basis: Basis,
    surfaces: Surfaces,
    start: Start,
    motion: Motion,
    linear: Matrix,
    now: Nodes,
    length: float,
    end: End,
) -> tuple[Vector, Vector, float]:
    r"""Return the Newton steps of the indentations, the forces (M,) and the length, to be
    subtracted.

    With the approach y that belongs to an indentation, the equations are :math:`y(\delta) = y_0(h)
    - G(h) F - G_s(h) F_s(\delta)` and
    :math:`F = F_{law}(\delta, \dot y_0(h) - R(h) F)`. The indentations are eliminated from the
    linearised equations.
    """
    size = len(now.force)
    nodes = len(basis.time)
    # approach by forces, residual of the approach, and minus the approach by the length, each
    # divided by that of the indentations
    columns = np.empty((size, size + 2))
    caused = product(motion.approach_by_force, now.force)
    caused_within = np.zeros(size)
    if len(motion.approach_by_static):
        caused_within = product(motion.approach_by_static, linear[STATIC])
    missing = np.empty(size)
    for row in range(size):
        excess = linear[APPROACH, row] - motion.approach[row]
        missing[row] = excess + caused[row] + caused_within[row]
    by_length = np.zeros((3, size))
    if end.kind != GIVEN_LENGTH:
        by_length = motion_by_length(
            basis, surfaces, start, motion, length, now.force, linear[STATIC]
        )
    for row in range(size):
        for column in range(size):
            columns[row, column] = motion.approach_by_force[row, column]
        columns[row, size] = missing[row]
        columns[row, size + 1] = -by_length[0, row]
    by = indentations_by(linear, motion, columns)

    # the last one is the relative change of the length
    unknowns = size if end.kind == GIVEN_LENGTH else size + 1
    matrix = np.empty((unknowns, unknowns))
    right = np.empty((unknowns, 1))
    write_force_jacobian(linear, motion, by, matrix)
    for row in range(size):
        of_law = linear[STATIC, row] + linear[DISSIPATIVE, row]
        force_by_delta = linear[STIFFNESS, row] + linear[BY_DELTA, row]
        right[row, 0] = now.force[row] - of_law + force_by_delta * by[row, size]
        if end.kind != GIVEN_LENGTH:
            matrix[row, size] = (
                force_by_delta * by[row, size + 1] - linear[BY_RATE, row] * by_length[1, row]
            ) * length
    if end.kind != GIVEN_LENGTH:
        last = (end.contact + 1) * nodes - 1  # the node at the end of the stretch
        write_end_equation(motion, linear, now, by, by_length, length, end, last, matrix, right)
    solve_in_place(matrix, right)

    force_step = right[:size, 0].copy()
    length_step = 0.0
    if end.kind != GIVEN_LENGTH:
        length_step = right[size, 0] * length
    # back substitution into the eliminated equations
    delta_step = np.empty(size)
    for row in range(size):
        change = by[row, size] - by[row, size + 1] * length_step
        for column in range(size):
            change -= by[row, column] * force_step[column]
        delta_step[row] = change
    return delta_step, force_step, length_step


@compiled
def improved(
    basis: Basis,
    surfaces: Surfaces,
    contacts: Contacts,
    start: Start,
    motion: Motion,
    now: Nodes,
    length: float,
    scale: float,
    end: End,
) -> tuple[Nodes, float, float, bool]:
    """Return the next iterate of the nodes and of the length [s], the relative size of
    the step, and whether the problem is well posed.
    """
    linear = linearised_laws(contacts, motion, now)
    # a negative compliance in series that exceeds that of the law makes the problem ill-posed
    if not least_of(linear[SLOPE]) > 0.0:
        return now, length, np.inf, False
    delta_step, force_step, length_step = newton_step(
        basis, surfaces, start, motion, linear, now, length, end
    )
    size = len(now.force)
    static = np.empty(size)
    force = np.empty(size)
    delta = np.empty(size)
    largest_step = 0.0
    largest_force = 0.0
    for row in range(size):
        by_static = linear[STIFFNESS, row] * delta_step[row]
        static[row] = linear[STATIC, row] - by_static
        delta[row] = now.delta[row] - delta_step[row]
        force[row] = now.force[row] - force_step[row]
        largest_step = max(largest_step, max(abs(force_step[row]), abs(by_static)))
        largest_force = max(largest_force, abs(force[row]))
    step_size = largest_step / (scale + largest_force)
    if end.kind != GIVEN_LENGTH:
        longest_growth = -_LENGTH_FACTOR * length
        longest_shrinking = _LENGTH_FACTOR / (1.0 + _LENGTH_FACTOR) * length
        length_step = min(max(length_step, longest_growth), longest_shrinking)
        length -= length_step
        step_size = max(step_size, abs(length_step) / length)
    return Nodes(static, force, delta), length, step_size, largest_magnitude_of(force) < np.inf


@compiled
def largest_change(now: Matrix, before: Matrix) -> float:
    """Return the largest change of the forces and moments of friction [N, N m]."""
    largest = 0.0
    for direction in range(len(now)):
        for node in range(now.shape[1]):
            largest = max(largest, abs(now[direction, node] - before[direction, node]))
    return largest


@compiled
def is_converged(size: float, last_size: float) -> bool:
    """Is the next step of Newton's method below rounding, after two relative steps?
    Convergence is quadratic, but for the derivatives.
    """
    next_size = size * min(max((size / last_size) ** 2, _INEXACT), 1.0)
    return next_size < _CONVERGED or (size < _STALLED and size > _SLOWING * last_size)


@compiled
def solve_stretch(
    basis: Basis,
    surfaces: Surfaces,
    contacts: Contacts,
    start: Start,
    sliding: SlidStretch,
    guess: Nodes,
    motions: Motions,
    friction: FrictionAtNodes,
    length: float,
    end: End,
) -> tuple[Nodes, Motions, FrictionAtNodes, float, bool]:
    """Return forces and indentations at the nodes, motion of the surfaces, friction, length [s],
    and whether the method converged.

    Parameters
    ----------
    guess, friction : Nodes, FrictionAtNodes
        Where the iteration begins.
    motions : Motions
        The motion of the surfaces through the given length.
    length : float
        Length of the stretch [s]; with an event, its first guess.
    end : End
        What ends the stretch.
    """
    now = guess
    motion = under_friction(motions, friction.force)
    scale = force_scale(surfaces, motion, length)
    size = np.inf
    for _ in range(MOST_ITERATIONS):
        last_size = size
        now, length, size, well_posed = improved(
            basis, surfaces, contacts, start, motion, now, length, scale, end
        )
        if not (well_posed and np.isfinite(size)):
            break
        if end.kind != GIVEN_LENGTH:
            motions = free_motions(
                basis,
                surfaces,
                start,
                sliding,
                motions.across.weights,
                motions.along.weights,
                length,
            )
            motion = motions.across
        if sliding.sphere.directions:
            before = friction
            friction = follow_friction(basis, motions, sliding, length, now.force, before)
            size = max(
                size,
                largest_change(friction.force, before.force)
                / (scale + largest_magnitude_of(now.force)),
            )
            motion = under_friction(motions, friction.force)
        if is_converged(size, last_size):
            return now, motions, friction, length, True
    return now, motions, friction, length, False
