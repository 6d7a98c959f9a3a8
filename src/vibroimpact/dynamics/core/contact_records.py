"""What the core follows one contact with, in named tuples.

The annotations name the types of compiled code, in `vibroimpact.compiler.types`.
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Integers
from vibroimpact.dynamics.core.records import (
    Boolean,
    Contacts,
    Coordinates,
    Cube,
    Event,
    Histories,
    Integer,
    Matrix,
    Nodes,
    Path,
    Real,
    Start,
    State,
    Surfaces,
    System,
    Vector,
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
    length: Real
    solved: Boolean
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
    resolved: Boolean


class NextStretch(NamedTuple):
    """A stretch that is accepted, or rejected and to be tried again with a shorter length.

    accepted. tried, balance: the stretch. time_map: its map of time, of `MAPS`. event: the one that
    ends it, if any. event_time: of a rejected stretch with an event that is certain, about its time
    since the start [s], else infinite.
    """

    accepted: Boolean
    tried: Attempt
    balance: Balance
    time_map: Integer
    event: Event
    event_time: Real


class Begun(NamedTuple):
    """What a part of the motion begins with: time [s], the state, the changes of the
    law's memory before, and friction.
    """

    time: Real
    state: State
    memories: Integer
    sphere: SlidingSphere


class StretchEnd(NamedTuple):
    """The end of a stretch of one contact.

    length: of the stretch [s]. state, sphere: then. delta: indentation of the law [m], force [N],
    its rate of change trend [N/s], and closing, the whole rate of the approach [m/s].
    largest_force: at a node [N]. roughness: as in `Histories`.
    """

    length: Real
    state: State
    sphere: SlidingSphere
    delta: Real
    force: Real
    trend: Real
    closing: Real
    largest_force: Real
    roughness: Real


class Manner(NamedTuple):
    """What stays the same through a contact.

    tension, contact_end: numbers of the law's, of `events`. motion_speed: speed of the motion
    [m/s]; energy: that of it [J]. span: approximate duration of a contact [s]. tolerance: relative
    error allowed at the end of each stretch. begun: time of touch [s]. until: end of a ride [s].
    longest: length of a stretch [s]. most_steps: how many stretches are tried.
    """

    tension: Integer
    contact_end: Integer
    motion_speed: Real
    energy: Real
    span: Real
    tolerance: Real
    begun: Real
    until: Real
    longest: Real
    most_steps: Integer


class Peaks(NamedTuple):
    """Largest force [N] and largest indentation [m] of a contact, and their times [s]."""

    force: Real
    time_of_force: Real
    indentation: Real
    time_of_indentation: Real


class Progress(NamedTuple):
    """How far a contact has come.

    time [s]. next_length: of the next stretch [s]. At the end of the last stretch: delta,
    indentation of the law [m], force [N], its rate of change trend [N/s], and closing, the whole
    rate of the approach [m/s]. fresh: no stretch has been solved yet. pushes: the law acts,
    otherwise the contact recoils. steps: stretches tried. memories: changes of the law's memory.
    largest_force [N], deepest [m]: at a node; peaks: also between nodes, at the end of a call.
    sphere: friction.
    """

    time: Real
    next_length: Real
    delta: Real
    force: Real
    trend: Real
    closing: Real
    fresh: Boolean
    pushes: Boolean
    steps: Integer
    memories: Integer
    largest_force: Real
    deepest: Real
    peaks: Peaks
    sphere: SlidingSphere


class Parts(NamedTuple):
    """Room for P parts of the motion through a contact: stretches (kind 1) and recoils (kind 0).

    kind, time_map (P,). start, length [s] (P,). displacement, velocity (P, n), local (P, k): state
    at the start. memories (P,): changes of the law's memory before it. Of stretches, as in `Nodes`,
    `Histories` and `Attempt`: static, force (P, N), approach, rate, closing, delta (P, N + 1),
    work, dissipated, roughness (P,). separation_loss (P,): stored energy that is lost at the end
    [J]. indentation (P, N + 1): of the surface by the centre above [m]. turned_at (P,):
    indentations of the law at the changes of its memory [m]. late_loss (1,): stored energy lost at
    the end of the last part of the call before [J]. Of stretches with friction in F directions:
    friction, slip (P, F, N), as in `SlidingPart`, and sphere (P, 2, 13), the numbers of
    `surface_friction_records` at their starts and ends.
    """

    kind: Integers
    time_map: Integers
    start: Vector
    length: Vector
    displacement: Matrix
    velocity: Matrix
    local: Matrix
    memories: Integers
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
    turned_at: Vector
    late_loss: Vector
    friction: Cube
    slip: Cube
    sphere: Cube
