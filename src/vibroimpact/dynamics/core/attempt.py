"""One attempt at a stretch of contact: solved, read back, searched for events, and its
error measured.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Vector
from vibroimpact.compiled import compiled, force_at
from vibroimpact.dynamics.core.contact_records import Attempt, Balance, Beginning, Bodies, Manner
from vibroimpact.dynamics.core.events import (
    BREAKPOINT,
    NO_EVENT,
    NO_PUSH,
    PARTED,
    TURN,
    first_event,
)
from vibroimpact.dynamics.core.flight import approach_of
from vibroimpact.dynamics.core.histories import contact_histories
from vibroimpact.dynamics.core.law import contacts_of, law_of, static_work
from vibroimpact.dynamics.core.path import stretch_path
from vibroimpact.dynamics.core.records import (
    Bases,
    Basis,
    Contacts,
    Coordinates,
    End,
    Event,
    Law,
    Nodes,
    Start,
    State,
    Surfaces,
    System,
)
from vibroimpact.dynamics.core.stretch import (
    AT_LEVEL,
    AT_NO_FORCE,
    AT_TURN,
    GIVEN_LENGTH,
    begun_indentations,
    first_guess,
    solve_stretch,
)
from vibroimpact.dynamics.core.surface_friction import (
    first_friction,
    free_motions,
    sliding_part,
    under_friction,
    weights_across_and_along,
)
from vibroimpact.dynamics.core.surface_friction_records import SlidingSphere, SlidStretch

_TINY = 1e-300
_MOST_ATTEMPTS = 4  # solutions per stretch, until no earlier event is found
_BEFORE_END = 0.98  # in x: an event beyond is the one at the end
_AT_END = 1e-12  # relative: an event may lie so far beyond the end of the first solution
_IMBALANCE = 0.06  # tolerances: error of the balance of energy, over that of the motion
_ROUGHNESS = 0.1  # tolerances: square of the last Legendre coefficients over the largest


@compiled
def time_at(basis: Basis, x: float) -> float:
    """Return the time at x as a part of the length of a stretch."""
    if basis.time_map == 0:
        return float(x**basis.root)
    if basis.time_map == 2:
        return float(1.0 - (1.0 - x) ** basis.root)
    return x


@compiled
def place_at(basis: Basis, time: float) -> float:
    """Return the x of a time, both as parts of the length of a stretch."""
    time = min(max(time, 0.0), 1.0)
    if basis.time_map == 0:
        return float(time ** (1.0 / basis.root))
    if basis.time_map == 2:
        return float(1.0 - (1.0 - time) ** (1.0 / basis.root))
    return time


@compiled
def weights_at(basis: Basis, x: float, weights: Vector) -> None:
    """Write the weights of the start and the nodes in the interpolated value at x."""
    # barycentric form of Lagrange's interpolation
    total = 0.0
    for node in range(len(weights)):
        distance = x - basis.places[node]
        if distance == 0.0:
            distance = _TINY  # at a point itself, its weight dominates all others
        weights[node] = basis.barycentric[node] / distance
        total += weights[node]
    for node in range(len(weights)):
        weights[node] /= total


@compiled
def surface_start(
    system: System, surfaces: Surfaces, coordinates: Coordinates, state: State
) -> Start:
    """Return the state of the surfaces in a state of a system with one contact, and with
    directions of friction as further contacts.
    """
    parts, contacts, modes = surfaces.shapes.shape
    displacement = state.displacement[system.rigid :].copy()
    velocity = state.velocity[system.rigid :].copy()
    approach = np.zeros(contacts)
    outer_rate = np.zeros(contacts)
    inner_rate = np.zeros(contacts)
    for contact in range(contacts):
        for coordinate in range(system.rigid):
            shape = coordinates.rigid_shapes[contact, coordinate]
            approach[contact] += shape * state.displacement[coordinate]
            outer_rate[contact] += shape * state.velocity[coordinate]
        for mode in range(modes):
            shape = surfaces.shapes[0, contact, mode]
            approach[contact] += shape * displacement[mode]
            outer_rate[contact] += shape * velocity[mode]
            if parts == 2:
                inner_rate[contact] += surfaces.shapes[1, contact, mode] * velocity[mode]
    # with the modes inside the contact, massless elements and the gap
    approach[0], _ = approach_of(system, state)
    return Start(displacement, velocity, state.local, approach, outer_rate, inner_rate)


@compiled
def beginning_of(
    bodies: Bodies,
    law: Law,
    manner: Manner,
    state: State,
    sphere: SlidingSphere,
    delta: float,
) -> Beginning:
    """Return what a stretch of one contact begins with; `delta`: about the indentation of
    the law [m].
    """
    start = surface_start(bodies.system, bodies.surfaces, bodies.coordinates, state)
    along = start
    if sphere.directions:
        along = surface_start(
            bodies.system, bodies.rubbed_surfaces, bodies.rubbed_coordinates, state
        )
    contacts = contacts_of(law, manner.tension)
    sliding = SlidStretch(bodies.rubbed_surfaces, along, sphere)
    return Beginning(
        state, start, contacts, begun_indentations(contacts, start, np.array([delta])), sliding
    )


@compiled
def attempt(
    basis: Basis,
    bodies: Bodies,
    manner: Manner,
    beginning: Beginning,
    guess: Nodes,
    trend: Vector,
    guessed: bool,
    event: Event,
) -> Attempt:
    """Return a stretch solved up to an event, or of the length that `event.x` gives [s] where there
    is none.

    `guess`: forces and indentations to begin with, if `guessed`; else they are extrapolated by the
    `trend` of the forces [N/s] (c,).
    """
    surfaces = bodies.surfaces
    start = beginning.start
    contacts = beginning.contacts
    begun = beginning.delta
    sliding = beginning.sliding
    length = event.x
    weights, weights_along = weights_across_and_along(surfaces, start, sliding)
    motions = free_motions(basis, surfaces, start, sliding, weights, weights_along, length)
    friction = first_friction(sliding.sphere, len(basis.time))
    if not guessed:
        motion = under_friction(motions, friction.force)
        guess = first_guess(basis, surfaces, contacts, start, motion, begun, trend, length)
    ends = GIVEN_LENGTH
    if event.kind == PARTED or event.kind == BREAKPOINT:
        ends = AT_LEVEL
    elif event.kind == NO_PUSH:
        ends = AT_NO_FORCE
    elif event.kind == TURN:
        ends = AT_TURN
    end = End(ends, event.level, event.contact)
    nodes, motions, friction, length, solved = solve_stretch(
        basis, surfaces, contacts, start, sliding, guess, motions, friction, length, end
    )
    motion = under_friction(motions, friction.force)
    part = sliding_part(basis, motions, sliding.sphere, length, nodes.force, friction)
    contact = contact_histories(basis, surfaces, contacts, start, begun, nodes, motion, length)
    seen = Event(NO_EVENT, 0.0, np.inf, 0)
    if solved:
        seen = first_event(
            basis, surfaces, contacts, contact, nodes, manner.motion_speed, manner.span
        )
    return Attempt(nodes, contact, part, length, solved, seen)


@compiled
def balance_of(
    basis: Basis, bodies: Bodies, manner: Manner, beginning: Beginning, tried: Attempt
) -> Balance:
    """Return the motion of all coordinates through a stretch, and whether it is resolved
    by two measures of its error.
    """
    histories = tried.contact
    nodes = tried.nodes
    directions, number = tried.sliding.force.shape
    size = len(nodes.force)
    force = np.zeros(size + directions * number)
    static = np.zeros(size + directions * number)
    for node in range(size):
        force[node] = nodes.force[node]
        static[node] = nodes.static[node]
    for direction in range(directions):
        for node in range(number):
            force[size + direction * number + node] = tried.sliding.force[direction, node]
    surfaces = bodies.surfaces
    coordinates = bodies.coordinates
    if directions:
        surfaces = bodies.rubbed_surfaces
        coordinates = bodies.rubbed_coordinates
    path = stretch_path(
        basis, surfaces, coordinates, beginning.state, tried.length, force, static, False
    )
    work = np.zeros(len(histories.dissipated))
    imbalance = path.energies[0] - tried.sliding.surface_work
    for contact in range(len(work)):
        if tried.solved:
            law = law_of(beginning.contacts, contact)
            work[contact] = static_work(law, histories.delta[contact, number]) - static_work(
                law, histories.delta[contact, 0]
            )
        imbalance += work[contact] + histories.dissipated[contact]
    for coordinate in range(len(path.lost)):
        imbalance += path.lost[coordinate]
    allowed = _IMBALANCE * manner.tolerance * manner.energy
    smooth = histories.roughness * histories.roughness <= _ROUGHNESS * manner.tolerance
    balanced = abs(imbalance) <= allowed + path.energies[1] and tried.sliding.imbalance <= allowed
    return Balance(path, work, tried.solved and smooth and balanced)


@compiled
def guess_from(
    basis: Basis, other: Basis, contacts: Contacts, solved: Attempt, share: float
) -> Nodes:
    """Return forces and indentations at the nodes of another rule, over a share of the
    time of a solved stretch.
    """
    number = len(basis.time)
    size = len(contacts.numbers) * number
    force = np.empty(size)
    delta = np.empty(size)
    weights = np.empty(number + 1)
    for contact in range(len(contacts.numbers)):
        law = law_of(contacts, contact)
        force_of = force_at(law.addresses[0])
        for node in range(number):
            weights_at(basis, place_at(basis, share * other.time[node]), weights)
            reached = 0.0
            rate = 0.0
            for point in range(number + 1):
                reached += weights[point] * solved.contact.delta[contact, point]
                rate += weights[point] * solved.contact.rate[contact, point]
            static, dissipative = force_of(
                max(reached, law.release), rate, law.speed, law.coefficients
            )
            delta[contact * number + node] = reached
            force[contact * number + node] = static + dissipative
    return Nodes(np.zeros(size), force, delta)


@compiled
def basis_of(bases: Bases, time_map: int) -> Basis:
    """Return the rule under a map of time, by its number in `MAPS`."""
    if time_map == 0:
        return bases.touch
    if time_map == 1:
        return bases.inside
    return bases.release


@compiled
def up_to_event(
    bases: Bases,
    bodies: Bodies,
    manner: Manner,
    beginning: Beginning,
    tried: Attempt,
    time_map: int,
) -> tuple[bool, Attempt, int, Event]:
    """Return whether it succeeds to solve a stretch again up to its first event, the solution, its
    map of time, and the event.

    An event of a solution that is not resolved may be spurious, or preceded by another one.
    """
    seen = tried.event
    ended = tried
    no_trend = np.zeros(len(beginning.delta))
    for _ in range(_MOST_ATTEMPTS):
        source = ended
        source_basis = basis_of(bases, time_map)
        # a stretch from touch keeps its map; another has that of release if the force ends with it
        if time_map != 0:
            ends_contact = seen.kind == PARTED or seen.kind == NO_PUSH
            time_map = 2 if ends_contact else 1
        basis = basis_of(bases, time_map)
        share = time_at(source_basis, seen.x)
        guess = guess_from(source_basis, basis, beginning.contacts, source, share)
        aim = Event(seen.kind, seen.level, share * source.length, seen.contact)
        ended = attempt(basis, bodies, manner, beginning, guess, no_trend, True, aim)
        if not ended.solved or not 0.0 < ended.length <= (1.0 + _AT_END) * source.length:
            break
        if ended.event.kind == NO_EVENT or ended.event.x > _BEFORE_END:
            return True, ended, time_map, seen
        seen = ended.event
    return False, ended, time_map, seen
