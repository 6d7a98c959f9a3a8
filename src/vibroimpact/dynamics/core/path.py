"""Motion of all coordinates through a stretch, from the contact forces at its nodes, and its balance of energy."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.receptance import add_at_nodes, to_eigenbasis
from vibroimpact.dynamics.core.records import Basis, Coordinates, Path, Surfaces


@compiled(lambda t: t.of(Path)(t.of(Basis), t.of(Surfaces), t.of(Coordinates), t.vector, t.vector, t.vector, t.real, t.vector, t.vector))
def stretch_path(
    basis: Basis,
    surfaces: Surfaces,
    coordinates: Coordinates,
    displacement: Floats,
    velocity: Floats,
    local: Floats,
    length: float,
    force: Floats,
    static: Floats,
) -> Path:
    """Return the motion of all coordinates through a stretch.

    Parameters
    ----------
    displacement, velocity, local : array, shape (n,), (n,), (k,)
        State at the start.
    length : float
        Length of the stretch [s].
    force, static : array, shape (c N,)
        Contact forces at the nodes of all contacts, and their static parts [N].
    """
    parts, contacts, modes = surfaces.shapes.shape
    nodes = len(basis.time)
    number = len(displacement)
    rigid = number - modes
    pairs = basis.eigenvalues.shape[1]
    elements = len(local)

    pushed = np.empty((parts, pairs, contacts), dtype=np.complex128)
    for k in range(pairs):
        to_eigenbasis(basis.forward, force, k, pushed[0, k])
        if parts == 2:
            to_eigenbasis(basis.forward, static, k, pushed[1, k])

    acceleration = np.zeros((number, nodes))
    for coordinate in range(rigid):
        for node in range(nodes):
            value = coordinates.load[coordinate]
            for contact in range(contacts):
                value -= coordinates.rigid_shapes[contact, coordinate] * force[contact * nodes + node]
            acceleration[coordinate, node] = value
    for mode in range(modes):
        coordinate = rigid + mode
        frequency_squared = surfaces.frequency_squared[mode]
        damping = surfaces.damping[mode]
        spring = damping * velocity[coordinate] + frequency_squared * displacement[coordinate]
        spring_rate = frequency_squared * velocity[coordinate] * length
        for k in range(pairs):
            real = spring * basis.one[0, k] + spring_rate * basis.clock[0, k]
            imaginary = spring * basis.one[1, k] + spring_rate * basis.clock[1, k]
            for part in range(parts):
                for contact in range(contacts):
                    shape = surfaces.shapes[part, contact, mode]
                    real += shape * pushed[part, k, contact].real
                    imaginary += shape * pushed[part, k, contact].imag
            sigma = length * basis.eigenvalues[0, k]
            sigma_imaginary = length * basis.eigenvalues[1, k]
            square = sigma * sigma - sigma_imaginary * sigma_imaginary
            square_imaginary = 2.0 * sigma * sigma_imaginary
            impedance = 1.0 + damping * sigma + frequency_squared * square
            impedance_imaginary = damping * sigma_imaginary + frequency_squared * square_imaginary
            inverse = -1.0 / (impedance * impedance + impedance_imaginary * impedance_imaginary)
            of_mode = (real * impedance + imaginary * impedance_imaginary) * inverse
            of_mode_imaginary = (imaginary * impedance - real * impedance_imaginary) * inverse
            for node in range(nodes):
                change = basis.backward[2 * k, node] * of_mode + basis.backward[2 * k + 1, node] * of_mode_imaginary
                acceleration[coordinate, node] += change

    massless = np.zeros((elements, nodes))
    local_end = local.copy()
    for element in range(elements):
        for k in range(pairs):
            sigma = length * complex(basis.eigenvalues[0, k], basis.eigenvalues[1, k])
            yielding = coordinates.rate[element] * local[element] * complex(basis.one[0, k], basis.one[1, k])
            for contact in range(contacts):
                yielding += surfaces.mobility[contact, element] * pushed[0, k, contact]
            add_at_nodes(basis.backward, k, -yielding / (1.0 + coordinates.rate[element] * sigma), massless[element])
        for node in range(nodes):
            local_end[element] += length * basis.integral[nodes - 1, node] * massless[element, node]

    speeds = np.empty((number, nodes))
    displacement_end = displacement.copy()
    lost = np.zeros(number + 1)
    for coordinate in range(number):
        for node in range(nodes):
            gained = 0.0
            for other in range(nodes):
                gained += basis.integral[node, other] * acceleration[coordinate, other]
            speeds[coordinate, node] = velocity[coordinate] + length * gained
        moved = 0.0
        squares = 0.0
        for node in range(nodes):
            weight = basis.integral[nodes - 1, node]
            moved += weight * speeds[coordinate, node]
            squares += weight * speeds[coordinate, node] * speeds[coordinate, node]
        displacement_end[coordinate] += length * moved
        lost[coordinate] = coordinates.damping[coordinate] * squares * length
    for element in range(elements):
        for node in range(nodes):
            power = massless[element, node] * massless[element, node] / coordinates.mobility[element]
            lost[number] += length * basis.integral[nodes - 1, node] * power

    # as differences of squares, so that motion that the contact does not change causes no rounding error
    gain = 0.0
    rounding = 0.0
    driven = coordinates.driven_shapes.shape[1]
    for coordinate in range(number - driven):
        faster = speeds[coordinate, nodes - 1] - velocity[coordinate]
        further = displacement_end[coordinate] - displacement[coordinate]
        spring = 0.5 * coordinates.frequency[coordinate] * coordinates.frequency[coordinate]
        gain += 0.5 * faster * (speeds[coordinate, nodes - 1] + velocity[coordinate])
        gain += further * (spring * (displacement_end[coordinate] + displacement[coordinate]) - coordinates.load[coordinate])
        held = spring * displacement[coordinate] * displacement[coordinate]
        rounding += coordinates.rounding[coordinate] * (0.5 * velocity[coordinate] * velocity[coordinate] + held)
    for element in range(elements):
        stiffness = coordinates.rate[element] / coordinates.mobility[element]
        gain += 0.5 * (local_end[element] - local[element]) * (local_end[element] + local[element]) * stiffness
    for number_driven in range(driven):  # the energy of a driven coordinate is not counted, but the work of its drive
        coordinate = number - driven + number_driven
        work = 0.0
        for node in range(nodes):
            push = 0.0
            for contact in range(contacts):
                push += coordinates.driven_shapes[contact, number_driven] * force[contact * nodes + node]
            work += basis.integral[nodes - 1, node] * push * speeds[coordinate, node]
        lost[coordinate] = -length * work
    end_speed = speeds[:, nodes - 1].copy()
    energies = np.array([gain, rounding])
    return Path(acceleration, speeds, massless, displacement_end, end_speed, local_end, lost, energies)
