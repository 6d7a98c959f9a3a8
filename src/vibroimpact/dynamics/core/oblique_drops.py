"""The motion along the plate of drops that the core follows: in flights, contacts and impulses, and
over the edges of the plate.
"""

from __future__ import annotations

import math

from vibroimpact.arrays import Floats
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.drop_records import (
    ALONG,
    FRICTION_LOST,
    GROSS_SLIP_LOST,
    MICROSLIP,
    MICROSLIP_LOST,
    RADIUS,
    REBOUND_ANGLE,
    RELEASE_X,
    RELEASE_Y,
    RUBBED,
    SEPARATION,
    TANGENTIAL_RESTITUTION,
    Drop,
    FreeFall,
)
from vibroimpact.dynamics.core.free_fall import next_touch
from vibroimpact.dynamics.core.friction_records import Rubbing
from vibroimpact.dynamics.core.normal_records import NormalPath
from vibroimpact.dynamics.core.rubbing import rub
from vibroimpact.dynamics.core.sphere_contact import struck
from vibroimpact.dynamics.core.sphere_records import (
    SphereState,
    energy_taken,
    flown,
    length_of,
    sphere_of,
    state_of,
    write_state,
)

_DEGREES = 180.0 / math.pi


@compiled(lambda t: t.of(FreeFall)(t.vector, t.vector, t.pair, t.of(FreeFall)))
def over_plate(
    sphere: Floats, along: Floats, half: tuple[float, float], flight: FreeFall
) -> FreeFall:
    """Return a flight that knows whether it ends beside the plate.

    `sphere`, `along`: the members of `RubbedSphere` and `SphereState` at its start. `half`: half
    the sides of the plate [m].
    """
    if flight.touch == math.inf:
        return flight
    there = flown(sphere_of(sphere), state_of(along), flight.touch - flight.start)
    is_beside = abs(there.x) > half[0] or abs(there.y) > half[1]
    return FreeFall(flight.start, flight.top, flight.touch, flight.speed, is_beside)


@compiled(lambda t: t.void(t.vector, t.vector, t.real))
def fly_along(sphere: Floats, along: Floats, elapsed: float) -> None:
    """Move a drop along the plate through a time without contact [s]; see `over_plate`."""
    write_state(along, flown(sphere_of(sphere), state_of(along), elapsed))


@compiled(lambda t: t.void(t.of(Drop), t.real))
def glide_along(drop: Drop, duration: float) -> None:
    """Move a drop along the plate through a contact without friction; `duration`: of it [s]."""
    end_along(drop, flown(sphere_of(drop.sphere), state_of(drop.along), duration), 0.0)


@compiled(lambda t: t.void(t.of(Rubbing), t.of(Drop), t.of(NormalPath)))
def rub_along(rubbing: Rubbing, drop: Drop, normal: NormalPath) -> None:
    """Move a drop along the plate through a contact with friction."""
    sphere = sphere_of(drop.sphere)
    rubbed = rub(rubbing, drop.friction, sphere, state_of(drop.along), normal)
    end_along(drop, rubbed.end, rubbed.microslip)


@compiled(lambda t: t.void(t.of(Rubbing), t.of(Drop), t.real))
def rub_at_once(rubbing: Rubbing, drop: Drop, impulse: float) -> None:
    """Let a normal impulse without duration act on a drop [N s]."""
    sphere = sphere_of(drop.sphere)
    end = struck(rubbing.addresses, drop.friction, sphere, state_of(drop.along), impulse)
    end_along(drop, end, 0.0)


@compiled(lambda t: t.void(t.of(Drop), t.of(SphereState), t.real))
def end_along(drop: Drop, after: SphereState, microslip: float) -> None:
    """Put a drop into its state after a contact, and write the columns of its motion along the
    plate.

    `microslip`: energy that was lost while a part of the contact stuck [J].
    """
    row = drop.row
    before = state_of(drop.along)
    lost = energy_taken(sphere_of(drop.sphere), before, after)
    drop.taken[RUBBED] += lost
    drop.taken[MICROSLIP] += microslip
    write_state(drop.along, after)
    row[ALONG] = before.x
    row[ALONG + 1] = before.y
    row[ALONG + 2] = before.velocity_x
    row[ALONG + 3] = before.velocity_y
    row[ALONG + 4] = after.velocity_x
    row[ALONG + 5] = after.velocity_y
    row[ALONG + 6] = before.spin_x
    row[ALONG + 7] = before.spin_y
    row[ALONG + 8] = before.spin_z
    row[ALONG + 9] = after.spin_x
    row[ALONG + 10] = after.spin_y
    row[ALONG + 11] = after.spin_z
    speed = length_of(before.velocity_x, before.velocity_y)
    onward = length_of(after.velocity_x, after.velocity_y)
    if speed > 0.0:
        onward = before.velocity_x * after.velocity_x + before.velocity_y * after.velocity_y
        onward /= speed
        row[TANGENTIAL_RESTITUTION] = onward / speed
    row[REBOUND_ANGLE] = _DEGREES * math.atan2(onward, row[SEPARATION])
    row[FRICTION_LOST] = lost
    row[MICROSLIP_LOST] = microslip
    row[GROSS_SLIP_LOST] = lost - microslip
    row[RELEASE_X] = after.x
    row[RELEASE_Y] = after.y


@compiled(lambda t: t.boolean(t.of(Drop), t.real))
def leaves_dent(drop: Drop, deepest: float) -> bool:
    """Does a drop touch next beyond the radius of its last contact? `deepest`: indentation of that
    [m].
    """
    flight = next_touch(drop.state, 0.0)
    if flight.touch == math.inf:
        return False
    here = state_of(drop.along)
    there = flown(sphere_of(drop.sphere), here, flight.touch - flight.start)
    distance = length_of(there.x - here.x, there.y - here.y)
    return bool(distance > math.sqrt(drop.state[RADIUS] * deepest))
