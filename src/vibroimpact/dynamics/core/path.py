"""Motion of all coordinates through a stretch, from the contact forces at its nodes, and
its balance of energy.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.receptance import add_at_nodes, to_eigenbasis
from vibroimpact.dynamics.core.records import Basis, Coordinates, Path, State, Surfaces


@compiled
def write_springs(
    surfaces: Surfaces,
    displacement: Vector,
    velocity: Vector,
    one: complex,
    clock: complex,
    of_modes: Matrix,
) -> None:
    """Write the accelerations by the springs and dampers of all modes at the start, going
    on at the speeds then, into `of_modes` (2, m).
    """
    # (w^2 q_0 + d v_0) 1 + w^2 v_0 t, as in `receptance.surface_motion`
    for mode in range(len(displacement)):
        frequency_squared = surfaces.frequency_squared[mode]
        spring = surfaces.damping[mode] * velocity[mode] + frequency_squared * displacement[mode]
        spring_rate = frequency_squared * velocity[mode]
        of_modes[0, mode] = spring * one.real + spring_rate * clock.real
        of_modes[1, mode] = spring * one.imag + spring_rate * clock.imag


@compiled
def add_product(shapes: Vector, factor: complex, of_modes: Matrix) -> None:
    """Add the product of real numbers of all modes (m,) and a complex one to `of_modes`,
    real and imaginary parts (2, m).
    """
    for mode in range(len(shapes)):
        of_modes[0, mode] += shapes[mode] * factor.real
        of_modes[1, mode] += shapes[mode] * factor.imag


@compiled
def divide_by_impedances(
    surfaces: Surfaces, sigma: float, sigma_imaginary: float, of_modes: Matrix
) -> None:
    """Divide real and imaginary parts of all modes (2, m) by 1 + d sigma + w^2 sigma^2."""
    square = sigma * sigma - sigma_imaginary * sigma_imaginary
    square_imaginary = 2.0 * sigma * sigma_imaginary
    for mode in range(len(surfaces.damping)):
        impedance = 1.0 + surfaces.damping[mode] * sigma + surfaces.frequency_squared[mode] * square
        impedance_imaginary = (
            surfaces.damping[mode] * sigma_imaginary
            + surfaces.frequency_squared[mode] * square_imaginary
        )
        inverse = 1.0 / (impedance * impedance + impedance_imaginary * impedance_imaginary)
        real = of_modes[0, mode]
        imaginary = of_modes[1, mode]
        of_modes[0, mode] = (real * impedance + imaginary * impedance_imaginary) * inverse
        of_modes[1, mode] = (imaginary * impedance - real * impedance_imaginary) * inverse


@compiled
def subtract_real_part(real: float, imaginary: float, of_modes: Matrix, values: Vector) -> None:
    """Subtract what coefficients in the eigenbasis (2, m) are at a node from `values` (m,)."""
    for mode in range(len(values)):
        values[mode] -= real * of_modes[0, mode] + imaginary * of_modes[1, mode]


@compiled
def stretch_path(
    basis: Basis,
    surfaces: Surfaces,
    coordinates: Coordinates,
    start: State,
    length: float,
    force: Vector,
    static: Vector,
    accelerated: bool,
) -> Path:
    """Return the motion of all coordinates through a stretch.

    Parameters
    ----------
    start : State
        State at the start.
    length : float
        Length of the stretch [s].
    force, static : array, shape (c N,)
        Contact forces at the nodes of all contacts, and their static parts [N].
    accelerated : bool
        Are the accelerations at the nodes asked for as well?
    """
    displacement = start.displacement
    velocity = start.velocity
    local = start.local
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

    speeds = np.empty((nodes, number))
    for node in range(nodes):
        speeds[node] = velocity
    accelerated_nodes = nodes if accelerated else 0
    acceleration = np.zeros((accelerated_nodes, number))
    for coordinate in range(rigid):
        for node in range(nodes):
            value = coordinates.load[coordinate]
            for contact in range(contacts):
                value -= (
                    coordinates.rigid_shapes[contact, coordinate] * force[contact * nodes + node]
                )
            if accelerated:
                acceleration[node, coordinate] = value
            for later in range(nodes):
                speeds[later, coordinate] += length * basis.integral[later, node] * value
    of_modes = np.empty((2, modes))
    for k in range(pairs):
        sigma = length * basis.eigenvalues[0, k]
        sigma_imaginary = length * basis.eigenvalues[1, k]
        one = complex(basis.one[0, k], basis.one[1, k])
        clock = length * complex(basis.clock[0, k], basis.clock[1, k])
        write_springs(surfaces, displacement[rigid:], velocity[rigid:], one, clock, of_modes)
        for part in range(parts):
            for contact in range(contacts):
                add_product(surfaces.shapes[part, contact], pushed[part, k, contact], of_modes)
        divide_by_impedances(surfaces, sigma, sigma_imaginary, of_modes)
        for node in range(nodes):
            real = basis.backward[2 * k, node]
            imaginary = basis.backward[2 * k + 1, node]
            if accelerated:
                subtract_real_part(real, imaginary, of_modes, acceleration[node, rigid:])
            # times sigma, which integrates over time
            integrated = real * sigma + imaginary * sigma_imaginary
            integrated_imaginary = imaginary * sigma - real * sigma_imaginary
            subtract_real_part(integrated, integrated_imaginary, of_modes, speeds[node, rigid:])

    # e' = -(r e_0 1 + m F)/(1 + r sigma) in the eigenbasis
    massless = np.zeros((elements, nodes))
    local_end = local.copy()
    for element in range(elements):
        for k in range(pairs):
            sigma = length * complex(basis.eigenvalues[0, k], basis.eigenvalues[1, k])
            yielding = (
                coordinates.rate[element]
                * local[element]
                * complex(basis.one[0, k], basis.one[1, k])
            )
            for contact in range(contacts):
                yielding += surfaces.mobility[contact, element] * pushed[0, k, contact]
            add_at_nodes(
                basis.backward,
                k,
                -yielding / (1.0 + coordinates.rate[element] * sigma),
                massless[element],
            )
        for node in range(nodes):
            local_end[element] += length * basis.integral[nodes - 1, node] * massless[element, node]

    # last row of the integration matrix: the quadrature over the stretch, of d v^2 for what dampers
    # take
    moved = np.zeros(number)
    lost = np.zeros(number + 1)
    for node in range(nodes):
        weight = length * basis.integral[nodes - 1, node]
        for coordinate in range(number):
            moved[coordinate] += weight * speeds[node, coordinate]
            lost[coordinate] += (
                weight
                * coordinates.damping[coordinate]
                * speeds[node, coordinate]
                * speeds[node, coordinate]
            )
    displacement_end = displacement + moved
    for element in range(elements):
        for node in range(nodes):
            power = (
                massless[element, node] * massless[element, node] / coordinates.mobility[element]
            )
            lost[number] += length * basis.integral[nodes - 1, node] * power

    # as differences of squares, so that vibration that the contact hardly changes causes little
    # rounding error; the energy of rigid motions that no contact moves doesn't change
    gain = 0.0
    rounding = 0.0
    driven = coordinates.driven_shapes.shape[1]
    for coordinate in range(number - driven):
        if coordinates.rounding[coordinate] == 0.0:
            continue
        # v^2/2 + w^2 q^2/2 - load q, per unit modal mass
        faster = speeds[nodes - 1, coordinate] - velocity[coordinate]
        spring = 0.5 * coordinates.frequency[coordinate] * coordinates.frequency[coordinate]
        gain += 0.5 * faster * (speeds[nodes - 1, coordinate] + velocity[coordinate])
        gain += moved[coordinate] * (
            spring * (displacement_end[coordinate] + displacement[coordinate])
            - coordinates.load[coordinate]
        )
        held = spring * displacement[coordinate] * displacement[coordinate]
        rounding += coordinates.rounding[coordinate] * (
            0.5 * velocity[coordinate] * velocity[coordinate] + held
        )
    for element in range(elements):
        stiffness = coordinates.rate[element] / coordinates.mobility[element]
        gain += (
            0.5
            * (local_end[element] - local[element])
            * (local_end[element] + local[element])
            * stiffness
        )
    # the energy of a driven coordinate is not counted, but the work of its drive
    for number_driven in range(driven):
        coordinate = number - driven + number_driven
        work = 0.0
        for node in range(nodes):
            push = 0.0
            for contact in range(contacts):
                push += (
                    coordinates.driven_shapes[contact, number_driven]
                    * force[contact * nodes + node]
                )
            work += basis.integral[nodes - 1, node] * push * speeds[node, coordinate]
        lost[coordinate] = -length * work
    end_speed = speeds[nodes - 1].copy()
    energies = np.array([gain, rounding])
    return Path(
        acceleration, speeds, massless, displacement_end, end_speed, local_end, lost, energies
    )
