r"""Motion of the surfaces at contacts through a stretch, reduced to the nodes of Radau collocation.

Collocation integrates by a matrix Q. In its eigenbasis, with eigenvalues :math:`\lambda`, the modes
enter only through the receptances
between contacts at the complex frequencies :math:`1/\sigma`, :math:`\sigma = h \lambda`,

.. math::

    G_{cd}(\sigma) = \sum_i \frac{\chi_{ci} \chi_{di}}{1 + 2 \zeta_i \omega_i \sigma + \omega_i^2
    \sigma^2}

so that the number of unknowns does not depend on the number of modes. A mode much faster than the
stretch follows the force
quasi-statically, a slower one is integrated with order 2 N - 1. For rigid motions the receptance is
:math:`h^2 Q^2 \sum \chi_c \chi_d`.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Complex, Cube, Matrix, Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.records import Basis, ModalWeights, Motion, Start, Surfaces


@compiled
def with_extents(weights: Matrix) -> ModalWeights:
    """Return weights with the extent of each row: the modes of the other body have none."""
    first = np.zeros(len(weights), dtype=np.int64)
    last = np.zeros(len(weights), dtype=np.int64)
    for row in range(len(weights)):
        last[row] = weights.shape[1]
        while first[row] < last[row] and weights[row, first[row]] == 0.0:
            first[row] += 1
        while first[row] < last[row] and weights[row, last[row] - 1] == 0.0:
            last[row] -= 1
    return ModalWeights(weights, first, last)


@compiled
def modal_weights(surfaces: Surfaces, start: Start) -> ModalWeights:
    """Return the weights of the modes in the sums of `modal_sums`.

    By part (outside and within the contacts): first of the receptance of each two contacts, then of
    the spring and damper accelerations of each contact at the start, and last of the rates of the
    spring accelerations.
    """
    parts, contacts, modes = surfaces.shapes.shape
    weights = np.empty((parts * contacts * (contacts + 2), modes))
    row = 0
    for part in range(parts):
        for contact in range(contacts):
            for other in range(contacts):
                for mode in range(modes):
                    weights[row, mode] = (
                        surfaces.shapes[part, contact, mode] * surfaces.shapes[part, other, mode]
                    )
                row += 1
    for part in range(parts):
        for contact in range(contacts):
            for mode in range(modes):
                # w^2 q_0 + 2 zeta w v_0
                spring = surfaces.frequency_squared[mode] * start.displacement[mode]
                damper = surfaces.damping[mode] * start.velocity[mode]
                weights[row, mode] = surfaces.shapes[part, contact, mode] * (spring + damper)
            row += 1
    for part in range(parts):
        for contact in range(contacts):
            for mode in range(modes):
                spring_rate = surfaces.frequency_squared[mode] * start.velocity[mode]
                weights[row, mode] = surfaces.shapes[part, contact, mode] * spring_rate
            row += 1
    return with_extents(weights)


@compiled
def write_admittances(
    surfaces: Surfaces, sigma: float, sigma_imaginary: float, admittances: Matrix
) -> None:
    """Write 1/(1 + d sigma + w^2 sigma^2) of all modes, as real and imaginary parts (2,
    m), into `admittances`.
    """
    square = sigma * sigma - sigma_imaginary * sigma_imaginary
    square_imaginary = 2.0 * sigma * sigma_imaginary
    for mode in range(len(surfaces.damping)):
        frequency_squared = surfaces.frequency_squared[mode]
        damping = surfaces.damping[mode]
        impedance = 1.0 + damping * sigma + frequency_squared * square
        impedance_imaginary = damping * sigma_imaginary + frequency_squared * square_imaginary
        inverse = 1.0 / (impedance * impedance + impedance_imaginary * impedance_imaginary)
        admittances[0, mode] = impedance * inverse
        admittances[1, mode] = -impedance_imaginary * inverse


@compiled
def write_slopes(
    surfaces: Surfaces, sigma: float, sigma_imaginary: float, admittances: Matrix, slopes: Matrix
) -> None:
    """Write the derivatives of the admittances of `write_admittances` by sigma into
    `slopes` (2, m).
    """
    # dA/d sigma = -(d + 2 w^2 sigma) A^2
    for mode in range(len(surfaces.damping)):
        slope = surfaces.damping[mode] + 2.0 * surfaces.frequency_squared[mode] * sigma
        slope_imaginary = 2.0 * surfaces.frequency_squared[mode] * sigma_imaginary
        squared = (
            admittances[0, mode] * admittances[0, mode]
            - admittances[1, mode] * admittances[1, mode]
        )
        squared_imaginary = 2.0 * admittances[0, mode] * admittances[1, mode]
        slopes[0, mode] = -(slope * squared - slope_imaginary * squared_imaginary)
        slopes[1, mode] = -(slope * squared_imaginary + slope_imaginary * squared)


@compiled
def weighted_sum(weights: Vector, real: Vector, imaginary: Vector) -> tuple[float, float]:
    """Return the sums of real and imaginary parts, times their weights; two sums of each
    side by side wait less for one another.
    """
    pairs = len(weights) // 2 * 2
    total = 0.0
    total_imaginary = 0.0
    other = 0.0
    other_imaginary = 0.0
    for mode in range(0, pairs, 2):
        total += weights[mode] * real[mode]
        total_imaginary += weights[mode] * imaginary[mode]
        other += weights[mode + 1] * real[mode + 1]
        other_imaginary += weights[mode + 1] * imaginary[mode + 1]
    for mode in range(pairs, len(weights)):
        total += weights[mode] * real[mode]
        total_imaginary += weights[mode] * imaginary[mode]
    return total + other, total_imaginary + other_imaginary


@compiled
def write_sums(weights: ModalWeights, values: Matrix, k: int, sums: Cube) -> None:
    """Write the sums of values of all modes (2, m), times their weights, into `sums` (2, W, H) at
    k.
    """
    for row in range(len(weights.values)):
        first = weights.first[row]
        last = weights.last[row]
        real, imaginary = weighted_sum(
            weights.values[row, first:last], values[0, first:last], values[1, first:last]
        )
        sums[0, row, k] = real
        sums[1, row, k] = imaginary


@compiled
def modal_sums(
    surfaces: Surfaces, weights: ModalWeights, eigenvalues: Matrix, length: float
) -> Cube:
    """Return the weighted sums over the modes of 1/(1 + d sigma + w^2 sigma^2) at all
    eigenvalues, as parts (2, W, H).
    """
    number = eigenvalues.shape[1]
    sums = np.empty((2, len(weights.values), number))
    admittances = np.empty((2, len(surfaces.damping)))
    for k in range(number):
        write_admittances(
            surfaces, length * eigenvalues[0, k], length * eigenvalues[1, k], admittances
        )
        write_sums(weights, admittances, k, sums)
    return sums


@compiled
def modal_slopes(
    surfaces: Surfaces, weights: ModalWeights, eigenvalues: Matrix, length: float
) -> Cube:
    """Return the derivatives of the sums of `modal_sums` by sigma (2, W, H)."""
    number = eigenvalues.shape[1]
    sums = np.empty((2, len(weights.values), number))
    admittances = np.empty((2, len(surfaces.damping)))
    slopes = np.empty((2, len(surfaces.damping)))
    for k in range(number):
        sigma = length * eigenvalues[0, k]
        sigma_imaginary = length * eigenvalues[1, k]
        write_admittances(surfaces, sigma, sigma_imaginary, admittances)
        write_slopes(surfaces, sigma, sigma_imaginary, admittances, slopes)
        write_sums(weights, slopes, k, sums)
    return sums


@compiled
def add_at_nodes(backward: Matrix, k: int, coefficient: complex, values: Vector) -> None:
    """Add what a coefficient in the eigenbasis is at the nodes to `values` (N,)."""
    # real part of the coefficient times the eigenvector, or twice it, for both of a conjugate pair
    for node in range(len(values)):
        values[node] += (
            backward[2 * k, node] * coefficient.real + backward[2 * k + 1, node] * coefficient.imag
        )


@compiled
def write_matrix(
    filters: Matrix, operators: Complex, matrix: Matrix, row: int, column: int
) -> None:
    """Write the matrix on the nodes of an operator in the eigenbasis (H,) into the block
    of `matrix` that begins at a row and a column.
    """
    entries = np.zeros(filters.shape[1])
    for k in range(len(operators)):
        real = operators[k].real
        imaginary = operators[k].imag
        for entry in range(len(entries)):
            entries[entry] += filters[2 * k, entry] * real + filters[2 * k + 1, entry] * imaginary
    nodes = int(np.sqrt(len(entries)) + 0.5)
    for node in range(nodes):
        for other in range(nodes):
            matrix[row + node, column + other] = entries[node * nodes + other]


@compiled
def surface_motion(
    basis: Basis, surfaces: Surfaces, weights: ModalWeights, start: Start, length: float
) -> Motion:
    """Return the motion of the surfaces through a stretch of a length [s]."""
    parts, contacts, _ = surfaces.shapes.shape
    nodes = len(basis.time)
    number = basis.eigenvalues.shape[1]
    elements = len(surfaces.rate)
    size = contacts * nodes
    sums = modal_sums(surfaces, weights, basis.eigenvalues, length)

    outer = np.zeros((contacts, nodes))
    inner = np.zeros((contacts, nodes))
    moved = np.zeros((contacts, nodes))
    mobility = np.empty((parts, contacts, contacts, number), dtype=np.complex128)
    receptance = np.empty((parts, contacts, contacts, number), dtype=np.complex128)
    # first rows of `modal_weights` after those of the receptances
    springs = parts * contacts * contacts
    spring_rates = springs + parts * contacts
    # The acceleration a of a mode at the nodes obeys a + d v + w^2 q = -chi F. With q and v as
    # integrals of a, and t for the times of the nodes, it is in the eigenbasis
    #   a = -((w^2 q_0 + d v_0) 1 + w^2 v_0 t + chi F)/(1 + d sigma + w^2 sigma^2)
    # of which v = v_0 + sigma a and q = q_0 + v_0 t + sigma^2 a.
    for k in range(number):
        sigma = length * complex(basis.eigenvalues[0, k], basis.eigenvalues[1, k])
        one = complex(basis.one[0, k], basis.one[1, k])
        clock = length * complex(basis.clock[0, k], basis.clock[1, k])
        for contact in range(contacts):
            rate = 0.0 + 0.0j
            for part in range(parts):
                spring = complex(
                    sums[0, springs + part * contacts + contact, k],
                    sums[1, springs + part * contacts + contact, k],
                )
                row = spring_rates + part * contacts + contact
                spring_rate = complex(sums[0, row, k], sums[1, row, k])
                of_part = -sigma * (one * spring + clock * spring_rate)
                if part == 0:
                    # massless elements: e' = -r e - m F, so e' = -(r e_0 1 + m F)/(1 + r sigma)
                    for element in range(elements):
                        held = (
                            surfaces.incidence[contact, element]
                            * surfaces.rate[element]
                            * start.local[element]
                        )
                        of_part -= one * held / (1.0 + surfaces.rate[element] * sigma)
                    add_at_nodes(basis.backward, k, of_part, outer[contact])
                else:
                    add_at_nodes(basis.backward, k, of_part, inner[contact])
                rate += of_part
            add_at_nodes(basis.backward, k, sigma * rate, moved[contact])
            for part in range(parts):
                for other in range(contacts):
                    pair = (part * contacts + contact) * contacts + other
                    between = sigma * complex(sums[0, pair, k], sums[1, pair, k])
                    if part == 0 and contact == other:
                        for element in range(elements):
                            between += surfaces.mobility[contact, element] / (
                                1.0 + surfaces.rate[element] * sigma
                            )
                    mobility[part, contact, other, k] = between
                    receptance[part, contact, other, k] = sigma * between

    approach_by_force = np.empty((size, size))
    rate_by_force = np.empty((size, size))
    inside = size if parts == 2 else 0
    approach_by_static = np.empty((inside, inside))
    closing_by_static = np.empty((inside, inside))
    for contact in range(contacts):
        for other in range(contacts):
            row = contact * nodes
            column = other * nodes
            write_matrix(
                basis.filters, receptance[0, contact, other], approach_by_force, row, column
            )
            write_matrix(basis.filters, mobility[0, contact, other], rate_by_force, row, column)
            if parts == 2:
                write_matrix(
                    basis.filters, receptance[1, contact, other], approach_by_static, row, column
                )
                write_matrix(
                    basis.filters, mobility[1, contact, other], closing_by_static, row, column
                )

    approach = np.empty(size)
    rate_of_approach = np.empty(size)
    closing = np.empty(size)
    for contact in range(contacts):
        for node in range(nodes):
            row = contact * nodes + node
            time = length * basis.time[node]
            outer_rate = (
                start.outer_rate[contact] + surfaces.gravity[contact] * time + outer[contact, node]
            )
            mean_rate = (
                start.outer_rate[contact]
                + start.inner_rate[contact]
                + 0.5 * surfaces.gravity[contact] * time
            )
            rate_of_approach[row] = outer_rate
            closing[row] = outer_rate + start.inner_rate[contact] + inner[contact, node]
            approach[row] = start.approach[contact] + time * mean_rate + moved[contact, node]
            # rigid motions by the integration matrix itself, which needs no eigenbasis
            for other in range(contacts):
                rigid = surfaces.rigid_pairs[contact, other]
                for force_node in range(nodes):
                    column = other * nodes + force_node
                    approach_by_force[row, column] += (
                        rigid * length * length * basis.integral_twice[node, force_node]
                    )
                    rate_by_force[row, column] += rigid * length * basis.integral[node, force_node]
    return Motion(
        approach,
        rate_of_approach,
        closing,
        approach_by_force,
        rate_by_force,
        approach_by_static,
        closing_by_static,
        weights,
        sums,
    )


@compiled
def to_eigenbasis(forward: Matrix, values: Vector, k: int, coefficients: Complex) -> None:
    """Write the coefficients of an eigenvector in the nodal values (c N,) of each contact
    into `coefficients` (c,).
    """
    nodes = len(forward)
    for contact in range(len(coefficients)):
        real = 0.0
        imaginary = 0.0
        for node in range(nodes):
            value = values[contact * nodes + node]
            real += value * forward[node, 2 * k]
            imaginary += value * forward[node, 2 * k + 1]
        coefficients[contact] = complex(real, imaginary)


@compiled
def motion_by_length(
    basis: Basis,
    surfaces: Surfaces,
    start: Start,
    motion: Motion,
    length: float,
    force: Vector,
    static: Vector,
) -> Matrix:
    """Return the derivatives of approach, rate and closing rate at the nodes by the length of a
    stretch (3, M).

    `motion`: through that length. `force`, `static`: forces and their static parts at the nodes [N]
    (M,).
    """
    parts, contacts, _ = surfaces.shapes.shape
    nodes = len(basis.time)
    number = basis.eigenvalues.shape[1]
    elements = len(surfaces.rate)
    sums = motion.sums
    slopes = modal_slopes(surfaces, motion.weights, basis.eigenvalues, length)

    outer = np.zeros((contacts, nodes))
    inner = np.zeros((contacts, nodes))
    moved = np.zeros((contacts, nodes))
    pushed = np.empty(contacts, dtype=np.complex128)
    pushed_static = np.empty(contacts, dtype=np.complex128)
    springs = parts * contacts * contacts
    spring_rates = springs + parts * contacts
    # the equations of `surface_motion`, differentiated by h at the same forces at the nodes:
    # d sigma/dh is the eigenvalue, and t goes with h
    for k in range(number):
        value = complex(basis.eigenvalues[0, k], basis.eigenvalues[1, k])
        sigma = length * value
        one = complex(basis.one[0, k], basis.one[1, k])
        clock = complex(basis.clock[0, k], basis.clock[1, k])
        to_eigenbasis(basis.forward, force, k, pushed)
        to_eigenbasis(basis.forward, static, k, pushed_static)
        for contact in range(contacts):
            rates = 0.0 + 0.0j
            rate_slopes = 0.0 + 0.0j
            outer_slope = 0.0 + 0.0j
            inner_slope = 0.0 + 0.0j
            for part in range(parts):
                row = springs + part * contacts + contact
                spring = complex(sums[0, row, k], sums[1, row, k])
                spring_slope = complex(slopes[0, row, k], slopes[1, row, k])
                row = spring_rates + part * contacts + contact
                spring_rate = complex(sums[0, row, k], sums[1, row, k])
                spring_rate_slope = complex(slopes[0, row, k], slopes[1, row, k])
                acceleration = -(one * spring + length * clock * spring_rate)
                by_sigma = one * spring_slope + length * clock * spring_rate_slope
                acceleration_slope = -(value * by_sigma + clock * spring_rate)
                rate = sigma * acceleration
                rate_slope = value * acceleration + sigma * acceleration_slope
                if part == 0:
                    for element in range(elements):
                        relaxing = 1.0 / (1.0 + surfaces.rate[element] * sigma)
                        held = (
                            surfaces.incidence[contact, element]
                            * surfaces.rate[element]
                            * start.local[element]
                        )
                        rate -= one * held * relaxing
                        rate_slope += (
                            one * value * held * surfaces.rate[element] * relaxing * relaxing
                        )
                    outer_slope = rate_slope
                else:
                    inner_slope = rate_slope
                rates += rate
                rate_slopes += rate_slope
            # the receptance is sigma times the mobility Y, which is sigma times the sum A of the
            # modes: d(sigma Y)/d sigma = Y + sigma Y', with Y' = A + sigma A'
            by_force = 0.0 + 0.0j
            by_force_slope = 0.0 + 0.0j
            by_static = 0.0 + 0.0j
            by_static_slope = 0.0 + 0.0j
            for other in range(contacts):
                pair = contact * contacts + other
                accelerance = complex(sums[0, pair, k], sums[1, pair, k])
                accelerance_slope = complex(slopes[0, pair, k], slopes[1, pair, k])
                mobility = sigma * accelerance
                mobility_slope = accelerance + sigma * accelerance_slope
                if contact == other:
                    for element in range(elements):
                        relaxing = 1.0 / (1.0 + surfaces.rate[element] * sigma)
                        mobility += surfaces.mobility[contact, element] * relaxing
                        mobility_slope -= (
                            surfaces.mobility[contact, element]
                            * surfaces.rate[element]
                            * relaxing
                            * relaxing
                        )
                by_force += (mobility + sigma * mobility_slope) * pushed[other]
                by_force_slope += mobility_slope * pushed[other]
                if parts == 2:
                    pair += contacts * contacts
                    accelerance = complex(sums[0, pair, k], sums[1, pair, k])
                    accelerance_slope = complex(slopes[0, pair, k], slopes[1, pair, k])
                    by_static += (
                        2.0 * sigma * accelerance + sigma * sigma * accelerance_slope
                    ) * pushed_static[other]
                    by_static_slope += (accelerance + sigma * accelerance_slope) * pushed_static[
                        other
                    ]
            moved_slope = value * rates + sigma * rate_slopes - value * (by_force + by_static)
            add_at_nodes(basis.backward, k, moved_slope, moved[contact])
            add_at_nodes(basis.backward, k, outer_slope - value * by_force_slope, outer[contact])
            add_at_nodes(basis.backward, k, inner_slope - value * by_static_slope, inner[contact])

    found = np.empty((3, contacts * nodes))
    for contact in range(contacts):
        gravity = surfaces.gravity[contact]
        speed = start.outer_rate[contact] + start.inner_rate[contact]
        for node in range(nodes):
            time = basis.time[node]
            slowed = 0.0
            held_back = 0.0
            for other in range(contacts):
                rigid = surfaces.rigid_pairs[contact, other]
                for force_node in range(nodes):
                    push = rigid * force[other * nodes + force_node]
                    slowed += push * basis.integral[node, force_node]
                    held_back += push * basis.integral_twice[node, force_node]
            row = contact * nodes + node
            rate = gravity * time + outer[contact, node] - slowed
            found[0, row] = (
                time * (speed + gravity * length * time)
                + moved[contact, node]
                - 2.0 * length * held_back
            )
            found[1, row] = rate
            found[2, row] = rate + inner[contact, node]
    return found
