"""The contacts of a system one by one, and in groups that push at the same time."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Integers
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.contact_records import Bodies
from vibroimpact.dynamics.core.records import Coordinates, Start, State, Surfaces, System
from vibroimpact.dynamics.core.system_records import ContactPoints, Group, SystemMarch

# relative rounding error of the kinetic energy of rigid motions
_RIGID_ROUNDING = 2e-15
# relative rounding error of the energy of the modes, which may far exceed that of a soft contact
_ROUNDING = 2e-14


@compiled
def system_at(points: ContactPoints, contact: int) -> System:
    """Return the coordinates that move one of the contacts, as a system of its own."""
    begin = points.first[contact]
    end = points.first[contact + 1]
    shape = points.shape[begin:end]
    no_elements = points.shape[begin:begin]
    return System(
        points.frequency[begin:end],
        points.ratio[begin:end],
        points.damping[begin:end],
        points.load[begin:end],
        shape,
        shape,
        shape,
        no_elements,
        no_elements,
        points.offset[contact],
        points.gravity[contact],
        points.mass[contact],
        points.compliance[contact],
        points.flexibility[contact],
        points.rigid[contact],
        0,
    )


@compiled
def state_of(coordinates: Integers, state: State) -> State:
    """Return the state of some coordinates of a system."""
    displacement = np.empty(len(coordinates))
    velocity = np.empty(len(coordinates))
    for index in range(len(coordinates)):
        displacement[index] = state.displacement[coordinates[index]]
        velocity[index] = state.velocity[coordinates[index]]
    return State(displacement, velocity, np.empty(0))


@compiled
def state_at(points: ContactPoints, contact: int, state: State) -> State:
    """Return the state of the coordinates that move one of the contacts."""
    begin = points.first[contact]
    end = points.first[contact + 1]
    return state_of(points.coordinate[begin:end], state)


@compiled
def state_now(march: SystemMarch) -> State:
    """Return the state of a march, which changes with it."""
    return State(march.displacement, march.velocity, np.empty(0))


@compiled
def group_of(points: ContactPoints, contacts: Integers, number: int) -> Group:
    """Return some contacts of a system of `number` coordinates as a group."""
    place = np.full(number, -1)
    size = 0
    rigid = 0
    for is_mode in range(2):  # rigid motions first
        for contact in contacts:
            begin = points.first[contact]
            modes = begin + points.rigid[contact]
            end = points.first[contact + 1]
            first = begin
            last = modes
            if is_mode:
                first = modes
                last = end
            for index in range(first, last):
                if place[points.coordinate[index]] < 0:
                    place[points.coordinate[index]] = size
                    size += 1
        if not is_mode:
            rigid = size
    coordinates = np.empty(size, np.int64)
    for coordinate in range(number):
        if place[coordinate] >= 0:
            coordinates[place[coordinate]] = coordinate

    count = len(contacts)
    frequency = np.zeros(size)
    damping = np.zeros(size)
    load = np.zeros(size)
    rounding = np.full(size, _ROUNDING)
    rounding[:rigid] = _RIGID_ROUNDING
    rigid_shapes = np.zeros((count, rigid))
    shapes = np.zeros((1, count, size - rigid))
    mass = np.empty(count)
    gravity = np.empty(count)
    for row in range(count):
        contact = contacts[row]
        mass[row] = points.mass[contact]
        gravity[row] = points.gravity[contact]
        for index in range(points.first[contact], points.first[contact + 1]):
            at = place[points.coordinate[index]]
            frequency[at] = points.frequency[index]
            damping[at] = points.damping[index]
            load[at] = points.load[index]
            if at < rigid:
                rigid_shapes[row, at] = points.shape[index]
            else:
                shapes[0, row, at - rigid] = points.shape[index]
    rigid_pairs = np.zeros((count, count))
    for row in range(count):
        for other in range(count):
            for at in range(rigid):
                rigid_pairs[row, other] += rigid_shapes[row, at] * rigid_shapes[other, at]
    no_elements = np.zeros(0)
    of_elements = np.zeros((count, 0))
    surfaces = Surfaces(
        frequency[rigid:] * frequency[rigid:],
        damping[rigid:].copy(),
        shapes,
        rigid_pairs,
        mass,
        gravity,
        no_elements,
        of_elements,
        of_elements,
    )
    of_group = Coordinates(
        frequency,
        damping,
        load,
        rigid_shapes,
        of_elements,
        no_elements,
        no_elements,
        rounding,
    )
    bodies = Bodies(system_at(points, contacts[0]), surfaces, of_group, surfaces, of_group)
    return Group(contacts, coordinates, place, bodies)


@compiled
def start_of(points: ContactPoints, group: Group, state: State) -> Start:
    """Return the state of the surfaces of a group; `state`: that of its coordinates."""
    shapes = group.bodies.surfaces.shapes
    rigid_shapes = group.bodies.coordinates.rigid_shapes
    count, rigid = rigid_shapes.shape
    approach = np.empty(count)
    rate = np.zeros(count)
    for row in range(count):
        approach[row] = points.offset[group.contacts[row]]
        for at in range(len(group.coordinates)):
            if at < rigid:
                shape = rigid_shapes[row, at]
            else:
                mode = at - rigid
                shape = shapes[0, row, mode]
            approach[row] += shape * state.displacement[at]
            rate[row] += shape * state.velocity[at]
    return Start(
        state.displacement[rigid:].copy(),
        state.velocity[rigid:].copy(),
        state.local,
        approach,
        rate,
        np.zeros(count),
    )
