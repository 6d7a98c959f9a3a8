"""What the core follows systems of several bodies with, in named tuples.

The annotations name the types of compiled code.
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Bools, Integers, Matrix, Vector
from vibroimpact.dynamics.core.contact_records import Bodies
from vibroimpact.dynamics.core.records import (
    Contacts,
)


class ContactPoints(NamedTuple):
    """C contacts of a system, and the coordinates that move each of them.

    Those of contact c are first[c] to first[c + 1] - 1 of the lists (Z,), its rigid motions first:
    coordinate, their numbers in the system; frequency [rad/s], ratio, damping [1/s], load [kg^1/2
    m/s^2] and shape [kg^-1/2], as in `System`. Of each contact (C,): rigid, how many are rigid
    motions; offset [m], gravity [m/s^2], mass [kg], compliance [m/N] and flexibility [s^2], as in
    `System`; contact_end, a number of `events`; keeps_memory: does the next impact meet the surface
    as this one leaves it?
    """

    first: Integers
    coordinate: Integers
    frequency: Vector
    ratio: Vector
    damping: Vector
    load: Vector
    shape: Vector
    rigid: Integers
    offset: Vector
    gravity: Vector
    mass: Vector
    compliance: Vector
    flexibility: Vector
    contact_end: Integers
    keeps_memory: Bools


class Group(NamedTuple):
    """Contacts that push at the same time, with the coordinates that move them.

    contacts (c,), coordinates (m,): their numbers in the system, rigid motions first. place (n,):
    where each coordinate of the system is among them, -1 where it is not. bodies: these coordinates
    with these contacts.
    """

    contacts: Integers
    coordinates: Integers
    place: Integers
    bodies: Bodies


APART, PUSHING, RECOILING = range(3)
"""How a contact is: apart; its law acts; its surfaces overlap, but its law has stopped pushing."""

DELTA, FORCE, TREND, RATE, MOTION_SPEED, SPAN, LARGEST_FORCE, DEEPEST = range(8)
"""Numbers of a contact. At the end of its last stretch: indentation of its law [m], force [N], its
rate of change [N/s], and the rate of its approach [m/s]. Speed of its motion [m/s], approximate
duration [s]; largest force [N] and approach [m] at a node so far.
"""

NOW, NEXT_LENGTH, PLASTIC, SLACK = range(4)
"""Numbers of a march: the time [s], the length of the next stretch [s], plastic work so far [J],
and an overlap that was no touch in the last stretch [m].
"""

STRETCHES = 0
"""Place of `SystemMarch.counts`: stretches and flights tried so far."""


class SystemMarch(NamedTuple):
    """A system on its way through its contacts, which is changed as it goes.

    counts (1,), numbers (4,): the places above. displacement, velocity (n,): now. lost (n + 1,):
    energy lost in each coordinate, and in the contacts [J]. Of each contact (C,): phase, as above;
    is_fresh: is no stretch of its impact solved yet? impact: the row of that. of_contact (C, 8):
    the numbers above.

    Laws of the contacts: acting, of the impacts under way; upcoming, of the next impacts; dents,
    of the last impacts where the next one meets undeformed surfaces, while surfaces may still
    overlap the dent, has_dent. acting_law, upcoming_law, dent_law (C,): their numbers, of
    `SystemParts`.
    """

    counts: Integers
    numbers: Vector
    displacement: Vector
    velocity: Vector
    lost: Vector
    phase: Integers
    is_fresh: Bools
    impact: Integers
    of_contact: Matrix
    acting: Contacts
    upcoming: Contacts
    dents: Contacts
    has_dent: Bools
    acting_law: Integers
    upcoming_law: Integers
    dent_law: Integers


PARTS, ROWS, LAWS, IMPACTS = range(4)
"""Places of `SystemParts.written`."""

CONTACT, START, END, CLOSING, PEAK_FORCE, TIME_OF_FORCE, PEAK_DEPTH, TIME_OF_DEPTH, IMPULSE = range(
    9
)
"""Columns of an impact: the number of its contact, its start and end [s], the latter NaN until
then; closing speed [m/s]; largest force [N] and indentation [m], and their times [s]; impulse [N
s].
"""

IMPACT_NUMBERS = 9


class SystemParts(NamedTuple):
    """Room for P parts of the motion of a system, R rows of contacts in them, L laws and I impacts.

    written (4,): how many of these are there. Of a part (P,): kind, `FLIGHT` or `STRETCH`;
    time_map, of `MAPS`; start and length [s]; displacement and velocity at the start (P, n);
    roughness, as in `Histories`; first_row, contacts: its rows. These are the contacts that push in
    a stretch, and those that recoil in a flight.

    Of a row (R,): contact, and the number of its law. In a stretch, as in `Nodes`, `Histories` and
    `Balance`: static, force (R, N), approach, rate, closing, delta (R, N + 1), work, dissipated;
    separation_loss, stored energy that is lost at the end [J].

    A law belongs to a contact, of_contact (L,). It is another one, origin (L,), or `OF_IMPACT`, the
    law of the contact as it is stated; at a closing speed (L,) [m/s]. It remembers the indentation
    compressed (L,) [m]; this is NaN where it changes no memory. impacts (I, 9): the columns above.
    """

    written: Integers
    kind: Integers
    time_map: Integers
    start: Vector
    length: Vector
    displacement: Matrix
    velocity: Matrix
    roughness: Vector
    first_row: Integers
    contacts: Integers
    contact: Integers
    law: Integers
    static: Matrix
    force: Matrix
    approach: Matrix
    rate: Matrix
    closing: Matrix
    delta: Matrix
    work: Vector
    dissipated: Vector
    separation_loss: Vector
    of_contact: Integers
    origin: Integers
    closing_speed: Vector
    compressed: Vector
    impacts: Matrix


class MarchManner(NamedTuple):
    """What stays the same through a march.

    tolerance: relative error allowed at the end of each stretch. until: its end [s]. pause: after
    how many stretches and flights it pauses.
    """

    tolerance: float
    until: float
    pause: int


class OtherEvent(NamedTuple):
    """An event of a contact that is not part of a stretch: its kind, of `system_events`, the
    contact and x, where it lies in the stretch.
    """

    kind: int
    contact: int
    x: float
