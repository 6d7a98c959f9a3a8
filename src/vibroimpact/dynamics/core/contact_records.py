"""What the core follows one contact with, in named tuples.

The annotations name the types of compiled code.
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Cube, Integers, Matrix, Vector
from vibroimpact.dynamics.core.records import (
    Contacts,
    Coordinates,
    Event,
    Histories,
    Nodes,
    Path,
    Start,
    State,
    Surfaces,
    System,
)
from vibroimpact.dynamics.core.surface_friction_records import (
    SlidingPart,
    SlidingSphere,
    SlidStretch,
)


class Bodies(NamedTuple):
    """The bodies of one contact: the linear system, what moves its surfaces, and all its
    coordinates.

    rubbed_surfaces, rubbed_coordinates: with the directions of friction as further contacts; the
    same where there is none.
    """

    system: System
    surfaces: Surfaces
    coordinates: Coordinates
    rubbed_surfaces: Surfaces
    rubbed_coordinates: Coordinates


class Beginning(NamedTuple):
    """What a stretch of c contacts begins with: the state, also as that of the surfaces, the laws,
    and their indentations (c,) [m].

    sliding: the surfaces that rub.
    """

    state: State
    start: Start
    contacts: Contacts
    delta: Vector
    sliding: SlidStretch


class Attempt(NamedTuple):
    """A stretch of contacts as Newton's method leaves it.

    nodes, contact: its forces and histories. sliding: what friction does. length [s]. solved: did
    Newton's method converge? event: the first one within it.
    """

    nodes: Nodes
    contact: Histories
    sliding: SlidingPart
    length: float
    solved: bool
    event: Event


class Solved(NamedTuple):
    """Solved stretches of one contact, one after the other.

    time_map (P,): their maps of time, in `MAPS`. length (P,) [s]. At the start and the nodes (P, N
    + 1): delta, indentation of the law [m], and rate of the approach at its dashpot [m/s].
    """

    time_map: Integers
    length: Vector
    delta: Matrix
    rate: Matrix


class Balance(NamedTuple):
    """Motion of all coordinates through a solved stretch of contacts, and its balance of energy.

    work (c,): increase of the energy stored by the laws and of the plastic work [J]. resolved: is
    it solved with an error within the tolerance?
    """

    path: Path
    work: Vector
    resolved: bool


class NextStretch(NamedTuple):
    """A stretch that is accepted, or rejected and to be tried again with a shorter length.

    accepted. tried, balance: the stretch. time_map: its map of time, of `MAPS`. event: the one that
    ends it, if any. event_time: of a rejected stretch with an event that is certain, about its time
    since the start [s], else infinite.
    """

    accepted: bool
    tried: Attempt
    balance: Balance
    time_map: int
    event: Event
    event_time: float


class Begun(NamedTuple):
    """What a part of the motion begins with: time [s], the state, the number of its law, of
    `Parts`, and friction.
    """

    time: float
    state: State
    law: int
    sphere: SlidingSphere


class StretchEnd(NamedTuple):
    """The end of a stretch of one contact.

    length: of the stretch [s]. state, sphere: then. delta: indentation of the law [m], force [N],
    its rate of change trend [N/s], and closing, the whole rate of the approach [m/s].
    largest_force: at a node [N]. roughness: as in `Histories`.
    """

    length: float
    state: State
    sphere: SlidingSphere
    delta: float
    force: float
    trend: float
    closing: float
    largest_force: float
    roughness: float


class Manner(NamedTuple):
    """What stays the same through a contact; times are since the first touch of the impact [s].

    tension, contact_end: numbers of the law's, of `events`. motion_speed: speed of the motion
    [m/s]; energy: that of it [J]. span: approximate duration of a contact [s]. tolerance: relative
    error allowed at the end of each stretch. begun: time of touch. until: end of a ride. longest:
    length of a stretch [s]. most_steps: how many stretches are tried in an impact.
    """

    tension: int
    contact_end: int
    motion_speed: float
    energy: float
    span: float
    tolerance: float
    begun: float
    until: float
    longest: float
    most_steps: int


class Peaks(NamedTuple):
    """Largest force [N] and largest indentation [m] of an impact, and their times since its first
    touch [s].
    """

    force: float
    time_of_force: float
    indentation: float
    time_of_indentation: float


class Progress(NamedTuple):
    """How far an impact has come, and a contact in it.

    time: since the first touch [s]. next_length: of the next stretch [s]. At the end of the last
    stretch: delta, indentation of the law [m], force [N], its rate of change trend [N/s], and
    closing, the whole rate of the approach [m/s]. fresh: no stretch of the contact has been solved
    yet. pushes: the law acts, otherwise the contact recoils. steps: stretches tried in the impact.
    law: its number, of `Parts`. plastic: plastic work of the impact [J]. largest_force [N], deepest
    [m]: of the contact at a node; peaks: of the impact, also between nodes. sphere: friction.
    """

    time: float
    next_length: float
    delta: float
    force: float
    trend: float
    closing: float
    fresh: bool
    pushes: bool
    steps: int
    law: int
    plastic: float
    largest_force: float
    deepest: float
    peaks: Peaks
    sphere: SlidingSphere


RECOIL, STRETCH, APART, FLIGHT = range(4)
"""Kinds of parts of a motion: in contact, without a force and with it; apart, between two contacts
of an impact, and before an impact.
"""

PARTS, LAWS = range(2)
"""Places of `Parts.written`."""

OF_IMPACT = -1
"""Stands for the law with which an impact begins."""


class Parts(NamedTuple):
    """Room for P parts of the motion of a drop, and for the L laws of its contacts.

    written (2,): how many of both are there. kind, time_map (P,). start (P,): since the first touch
    of the impact, of a flight since the start of the run [s]. length (P,) [s]. displacement,
    velocity (P, n), local (P, k): state at the start. law (P,): the number of the law. Of
    stretches, as in `Nodes`, `Histories` and `Attempt`: static, force (P, N), approach, rate,
    closing, delta (P, N + 1), work, dissipated, roughness (P,). separation_loss (P,): stored energy
    that is lost at the end [J]. indentation (P, N + 1): of the surface by the centre above [m]. Of
    stretches with friction in F directions: friction, slip (P, F, N), as in `SlidingPart`, and
    sphere (P, 2, 13), the numbers of `surface_friction_records` at their starts and ends.

    A law is another one, origin (L,), or `OF_IMPACT`, at a closing speed (L,) [m/s], which
    remembers the indentation compressed (L,) [m]; this is NaN where it changes no memory. These are
    its coefficients (L, K).
    """

    written: Integers
    kind: Integers
    time_map: Integers
    start: Vector
    length: Vector
    displacement: Matrix
    velocity: Matrix
    local: Matrix
    law: Integers
    static: Matrix
    force: Matrix
    approach: Matrix
    rate: Matrix
    closing: Matrix
    delta: Matrix
    work: Vector
    dissipated: Vector
    roughness: Vector
    separation_loss: Vector
    indentation: Matrix
    friction: Cube
    slip: Cube
    sphere: Cube
    origin: Integers
    closing_speed: Vector
    compressed: Vector
    coefficients: Matrix
