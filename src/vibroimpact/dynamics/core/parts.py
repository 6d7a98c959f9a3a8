"""The parts of the motion of a drop and the laws of its contacts, written as they come."""

from __future__ import annotations

from vibroimpact.arrays import Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.attempt import basis_of
from vibroimpact.dynamics.core.contact_records import (
    LAWS,
    PARTS,
    STRETCH,
    Attempt,
    Balance,
    Begun,
    NextStretch,
    Parts,
)
from vibroimpact.dynamics.core.linear import product, write_layer, write_row
from vibroimpact.dynamics.core.records import Bases, Basis, Law, State, System
from vibroimpact.dynamics.core.surface_friction_records import (
    DISPLACEMENT_X,
    FORCE_X,
    MICROSLIP,
    TURNED_WAY_X,
    TURNED_X,
    VELOCITY_X,
    WORK,
    SlidingPart,
    SlidingSphere,
)


@compiled
def has_room(parts: Parts) -> bool:
    """Is there room for what is written before this is asked again?

    That is a stretch and free motion to the next contact, two changes of a law's memory, the law of
    the next contact, and that of a sphere that stays.
    """
    return bool(
        parts.written[PARTS] + 2 <= len(parts.start)
        and parts.written[LAWS] + 4 <= len(parts.origin)
    )


@compiled
def write_law(parts: Parts, origin: int, compressed: float, law: Law) -> int:
    """Write a law, and return its number; `origin`, `compressed`: the columns of `Parts`."""
    number = parts.written[LAWS]
    parts.origin[number] = origin
    parts.closing_speed[number] = law.speed
    parts.compressed[number] = compressed
    write_row(parts.coefficients, number, law.coefficients)
    parts.written[LAWS] = number + 1
    return int(number)


@compiled
def write_free(
    parts: Parts, kind: int, start: float, length: float, state: State, law: int
) -> None:
    """Write a part without contact force, of a kind, start and length [s], from a state on.

    `law`: the number of that of a contact that recoils.
    """
    part = parts.written[PARTS]
    write_part(parts, part, start, state, law)
    parts.kind[part] = kind
    parts.length[part] = length
    parts.written[PARTS] = part + 1


@compiled
def write_part(parts: Parts, part: int, start: float, state: State, law: int) -> None:
    """Write what all parts of a motion have: their start [s], the state then, and the number of
    their law.
    """
    parts.start[part] = start
    write_row(parts.displacement, part, state.displacement)
    write_row(parts.velocity, part, state.velocity)
    write_row(parts.local, part, state.local)
    parts.law[part] = law
    parts.separation_loss[part] = 0.0


@compiled
def lose_at_end(parts: Parts, lost: Vector, energy: float) -> None:
    """Add stored energy that is lost at the end of the last part [J]."""
    lost[len(lost) - 1] += energy
    parts.separation_loss[parts.written[PARTS] - 1] += energy


@compiled
def write_next(
    parts: Parts,
    bases: Bases,
    system: System,
    stretch: NextStretch,
    begun: Begun,
    lost: Vector,
) -> None:
    """Write a stretch that is accepted, and add what is lost in it [J] to `lost` (n +
    1,): by each coordinate, and last in the contact.
    """
    part = parts.written[PARTS]
    write_part(parts, part, begun.time, begun.state, begun.law)
    write_stretch(
        parts,
        part,
        basis_of(bases, stretch.time_map),
        system,
        stretch.tried,
        stretch.balance,
        begun.state,
    )
    write_sliding(parts, part, begun.sphere, stretch.tried.sliding)
    lost_on_path = stretch.balance.path.lost
    for coordinate in range(len(lost)):
        lost[coordinate] += lost_on_path[coordinate]
    lost[len(lost) - 1] += stretch.tried.contact.dissipated[0]
    parts.written[PARTS] = part + 1


@compiled
def write_stretch(
    parts: Parts,
    part: int,
    basis: Basis,
    system: System,
    solved: Attempt,
    balance: Balance,
    begun: State,
) -> None:
    """Write a solved stretch."""
    path = balance.path
    number = len(basis.time)
    parts.kind[part] = STRETCH
    parts.time_map[part] = basis.time_map
    parts.length[part] = solved.length
    write_row(parts.static, part, solved.nodes.static)
    write_row(parts.force, part, solved.nodes.force)
    write_row(parts.approach, part, solved.contact.approach[0])
    write_row(parts.rate, part, solved.contact.rate[0])
    write_row(parts.closing, part, solved.contact.closing[0])
    write_row(parts.delta, part, solved.contact.delta[0])
    parts.work[part] = balance.work[0]
    parts.dissipated[part] = solved.contact.dissipated[0]
    parts.roughness[part] = solved.contact.roughness
    depth = system.offset
    for coordinate in range(len(begun.displacement)):
        depth += system.indentation_shape[coordinate] * begun.displacement[coordinate]
    parts.indentation[part, 0] = depth
    speeds = product(path.velocity, system.indentation_shape)
    for node in range(number):
        moved = 0.0
        for other in range(number):
            moved += basis.integral[node, other] * speeds[other]
        parts.indentation[part, node + 1] = depth + solved.length * moved


@compiled
def write_sliding(parts: Parts, part: int, begun: SlidingSphere, sliding: SlidingPart) -> None:
    """Write what friction does through a stretch that begins in a state."""
    if begun.directions == 0:
        return
    write_layer(parts.friction, part, sliding.force)
    write_layer(parts.slip, part, sliding.slip)
    write_surface_friction(begun, parts.sphere[part, 0])
    write_surface_friction(sliding.end, parts.sphere[part, 1])


@compiled
def write_surface_friction(sphere: SlidingSphere, numbers: Vector) -> None:
    """Write the numbers of `surface_friction_records` that change through a contact."""
    for direction in range(2):
        numbers[VELOCITY_X + direction] = sphere.velocity[direction]
        numbers[DISPLACEMENT_X + direction] = sphere.displacement[direction]
        numbers[FORCE_X + direction] = sphere.force[direction]
        numbers[TURNED_WAY_X + direction] = sphere.turned_way[direction]
    for axis in range(3):
        numbers[TURNED_X + axis] = sphere.turned[axis]
    numbers[WORK] = sphere.work
    numbers[MICROSLIP] = sphere.microslip
