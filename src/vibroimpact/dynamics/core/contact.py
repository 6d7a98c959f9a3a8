"""One contact from touch to release, where bodies vibrate: stretches of contact, the events that end them, and recoil.

Each stretch is searched for its first event: separation, zero force of a law that may not pull, a breakpoint of the law, a turn of the
approach at which the law's memory changes. It is then solved again so that it ends there. Once the law has stopped pushing while the
surfaces still overlap, they recoil without a force until they separate or it pushes again.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import compiled, force_at
from vibroimpact.dynamics.core.events import (
    BREAKPOINT,
    NO_EVENT,
    NO_PUSH,
    PARTED,
    TENSION_CUT,
    TURN,
    first_event,
)
from vibroimpact.dynamics.core.flight import (
    approach_of,
    dashpot_rate,
    energy_of_approach,
    lost_in_flight,
    state_after,
    time_to_separation,
)
from vibroimpact.dynamics.core.law import law_after, law_indentation, static_work, stored_energy
from vibroimpact.dynamics.core.path import stretch_path
from vibroimpact.dynamics.core.receptance import surface_motion
from vibroimpact.dynamics.core.records import (
    Attempt,
    Basis,
    Contacts,
    Coordinates,
    Event,
    Law,
    Manner,
    Nodes,
    Parts,
    Progress,
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
    contact_histories,
    first_guess,
    solve_stretch,
)

RELEASED, CAPTURED, RIDES, TOO_STIFF, NEAR_REST, FULL = 0, 1, 2, 3, 4, 5
"""How a contact goes on: released; too little energy to leave; in contact at the end of the time or of the steps; not to be integrated; near
equilibrium, which is to be looked at; no room for a further part.
"""

ENDS_AT_NO_FORCE = 1

_ROUNDING = 1e-14  # of the deepest indentation
_TIME_ROUNDING = 1e-11  # of the duration of a contact
_NO_FORCE = 1e-10  # of the largest force
_ZERO_RATE = 1e-9  # of the speed of the motion
_SHORTEST = 1e-12  # of the duration of a contact
_LONG = 10.0  # in durations of a contact: a sphere in contact for longer rides
_NOTHING = 2e-15  # of the energy of the motion: less is a rounding error
_EASY = 0.01  # target roughness of the next stretch, relative to the root of the tolerance
_MOST_ATTEMPTS = 4  # solutions per stretch, until no earlier event is found
_BEFORE_END = 0.98  # in x: an event beyond is the one at the end
_AT_END = 1e-12  # relative: an event may lie so far beyond the end of the first solution
_REST_MARGIN = 0.5  # of the weight: largest variation of the force at rest
_TINY = 1e-300
_SAMPLES = 64
_MOST_HORIZONS = 100_000


@compiled(lambda t: t.real(t.of(Basis), t.real))
def time_at(basis: Basis, x: float) -> float:
    """Return the time at x as a part of the length of a stretch."""
    if basis.time_map == 0:
        return x**basis.root
    if basis.time_map == 2:
        return 1.0 - (1.0 - x) ** basis.root
    return x


@compiled(lambda t: t.real(t.of(Basis), t.real))
def place_at(basis: Basis, time: float) -> float:
    """Return the x of a time, both as parts of the length of a stretch."""
    time = min(max(time, 0.0), 1.0)
    if basis.time_map == 0:
        return time ** (1.0 / basis.root)
    if basis.time_map == 2:
        return 1.0 - (1.0 - time) ** (1.0 / basis.root)
    return time


@compiled(lambda t: t.void(t.of(Basis), t.real, t.vector))
def weights_at(basis: Basis, x: float, weights: Floats) -> None:
    """Write the weights of the start and the nodes in the interpolated value at x."""
    total = 0.0
    for node in range(len(weights)):
        distance = x - basis.places[node]
        if distance == 0.0:
            distance = _TINY  # at a point itself, its weight dominates all others
        weights[node] = basis.barycentric[node] / distance
        total += weights[node]
    for node in range(len(weights)):
        weights[node] /= total


@compiled(lambda t: t.of(Start)(t.of(System), t.of(Surfaces), t.of(State)))
def surface_start(system: System, surfaces: Surfaces, state: State) -> Start:
    """Return the state of the surfaces of one contact in a state of the system."""
    parts, _, modes = surfaces.shapes.shape
    displacement = state.displacement[system.rigid :].copy()
    velocity = state.velocity[system.rigid :].copy()
    approach, _ = approach_of(system, state)
    outer_rate = 0.0
    for coordinate in range(system.rigid):
        outer_rate += system.shape[coordinate] * state.velocity[coordinate]
    inner_rate = 0.0
    for mode in range(modes):
        outer_rate += surfaces.shapes[0, 0, mode] * velocity[mode]
        if parts == 2:
            inner_rate += surfaces.shapes[1, 0, mode] * velocity[mode]
    return Start(displacement, velocity, state.local, np.array([approach]), np.array([outer_rate]), np.array([inner_rate]))


@compiled(lambda t: t.of(Contacts)(t.of(Law)))
def contacts_of(law: Law) -> Contacts:
    """Return the law of one contact as stretches take it."""
    return Contacts(
        law.addresses[:1].copy(),
        law.coefficients.copy().reshape(1, len(law.coefficients)),
        np.array([law.speed]),
        np.array([law.release]),
        np.array([law.release_level]),
        law.series.copy().reshape(1, len(law.series)),
    )


@compiled(
    lambda t: t.of(Attempt)(
        t.of(Basis),
        t.of(System),
        t.of(Surfaces),
        t.of(Coordinates),
        t.of(Law),
        t.of(Manner),
        t.of(State),
        t.of(Start),
        t.of(Contacts),
        t.vector,
        t.of(Nodes),
        t.real,
        t.boolean,
        t.of(Event),
    )
)
def attempt(
    basis: Basis,
    system: System,
    surfaces: Surfaces,
    coordinates: Coordinates,
    law: Law,
    manner: Manner,
    state: State,
    start: Start,
    contacts: Contacts,
    begun: Floats,
    guess: Nodes,
    trend: float,
    guessed: bool,
    event: Event,
) -> Attempt:
    """Return a stretch solved up to an event, or of the length that `event.x` gives [s] where there is none.

    `guess`: forces and indentations to begin with, if `guessed`; else they are extrapolated by the `trend` of the force [N/s].
    """
    length = event.x
    motion = surface_motion(basis, surfaces, start, length)
    if not guessed:
        guess = first_guess(basis, surfaces, contacts, start, motion, begun, np.array([trend]), length)
    ends = GIVEN_LENGTH
    if event.kind == PARTED or event.kind == BREAKPOINT:
        ends = AT_LEVEL
    elif event.kind == NO_PUSH:
        ends = AT_NO_FORCE
    elif event.kind == TURN:
        ends = AT_TURN
    nodes, motion, length, solved = solve_stretch(basis, surfaces, contacts, start, guess, motion, length, ends, event.level, 0)
    contact = contact_histories(basis, surfaces, contacts, start, begun, nodes, motion, length)
    path = stretch_path(basis, surfaces, coordinates, state.displacement, state.velocity, state.local, length, nodes.force, nodes.static)
    number = len(basis.time)
    closing = contact.rate[0].copy()
    if surfaces.shapes.shape[0] == 2:
        for mode in range(surfaces.shapes.shape[2]):
            shape = surfaces.shapes[1, 0, mode]
            closing[0] += shape * state.velocity[system.rigid + mode]
            for node in range(number):
                closing[node + 1] += shape * path.velocity[system.rigid + mode, node]
    seen = Event(NO_EVENT, 0.0, np.inf)
    resolved = False
    work = 0.0
    if solved:
        seen = first_event(basis, system, law, manner.tension, contact, nodes, closing, manner.motion_speed, manner.span)
        work = static_work(law, contact.delta[0, number]) - static_work(law, contact.delta[0, 0])
        imbalance = path.energies[0] + work + contact.dissipated[0]
        for coordinate in range(len(path.lost)):
            imbalance += path.lost[coordinate]
        energy = 0.5 * system.mass * manner.motion_speed * manner.motion_speed
        smooth = contact.roughness * contact.roughness <= 0.1 * manner.tolerance
        resolved = smooth and abs(imbalance) <= 0.06 * manner.tolerance * energy + path.energies[1]
    return Attempt(nodes, contact, path, closing, length, work, solved, resolved, seen)


@compiled(lambda t: t.of(Nodes)(t.of(Basis), t.of(Basis), t.of(Law), t.of(Attempt), t.real))
def guess_from(basis: Basis, other: Basis, law: Law, solved: Attempt, share: float) -> Nodes:
    """Return forces and indentations at the nodes of another rule, over a share of the time of a solved stretch."""
    number = len(basis.time)
    force = np.empty(number)
    delta = np.empty(number)
    weights = np.empty(number + 1)
    force_of = force_at(law.addresses[0])
    for node in range(number):
        weights_at(basis, place_at(basis, share * other.time[node]), weights)
        reached = 0.0
        rate = 0.0
        for point in range(number + 1):
            reached += weights[point] * solved.contact.delta[0, point]
            rate += weights[point] * solved.contact.rate[0, point]
        static, dissipative = force_of(max(reached, law.release), rate, law.speed, law.coefficients)
        delta[node] = reached
        force[node] = static + dissipative
    return Nodes(np.zeros(number), force, delta)


@compiled(lambda t: t.boolean(t.of(System), t.of(Law), t.of(Manner), t.of(State)))
def separates_at_no_force(system: System, law: Law, manner: Manner, state: State) -> bool:
    """Does a contact end with its force? Its law does, and the surfaces will separate; otherwise they close again."""
    if manner.contact_end != ENDS_AT_NO_FORCE:
        return False
    return bool(np.isfinite(time_to_separation(system, state, law.release_level)))


@compiled(lambda t: t.real(t.of(System), t.of(Law), t.of(Manner), t.real))
def energy_held(system: System, law: Law, manner: Manner, delta: float) -> float:
    """Return the energy that a contact stores at an indentation of its law [J], with rounding errors set to zero."""
    held = stored_energy(law, delta)
    energy = 0.5 * system.mass * manner.motion_speed * manner.motion_speed
    return held if abs(held) > _NOTHING * energy else 0.0


@compiled(lambda t: t.tuple(t.real, t.real)(t.of(System), t.of(Law), t.of(State)))
def recoil_values(system: System, law: Law, state: State) -> tuple[float, float]:
    """Return numbers that are positive where a recoiling contact has separated, and where its law pushes again."""
    approach, _ = approach_of(system, state)
    pushes = -1.0
    if approach > law.release_level:
        delta = law_indentation(law, approach)
        static, dissipative = force_at(law.addresses[0])(delta, dashpot_rate(system, state), law.speed, law.coefficients)
        pushes = static + dissipative
    return law.release_level - approach, pushes


@compiled(lambda t: t.tuple(t.real, t.boolean)(t.of(System), t.of(Law), t.of(Manner), t.of(State)))
def end_of_recoil(system: System, law: Law, manner: Manner, state: State) -> tuple[float, bool]:
    """Return when a recoiling contact separates or pushes again [s from here], and whether it separates."""
    approach, rate = approach_of(system, state)
    above = max(approach - law.release_level, 0.0)
    step = max(above / max(-rate, 1e-3 * manner.motion_speed), 1e-6 * manner.span)
    begun = 0.0
    for _ in range(_MOST_HORIZONS):
        before = begun
        for sample in range(1, _SAMPLES + 1):
            time = begun + step * sample / _SAMPLES
            parted, pushes = recoil_values(system, law, state_after(system, state, time))
            if parted > 0.0 or pushes > 0.0:
                separates = parted > 0.0
                low = before
                high = time
                # by halving and the secant in turn, to the rounding of the time
                low_value = recoil_values(system, law, state_after(system, state, low))[0 if separates else 1]
                high_value = parted if separates else pushes
                for iteration in range(200):
                    if not high - low > 1e-13 * high:
                        break
                    middle = 0.5 * (low + high)
                    if iteration % 3 != 2 and low_value < 0.0:
                        middle = low + (high - low) * min(max(low_value / (low_value - high_value), 1e-3), 1.0 - 1e-3)
                    if not low < middle < high:
                        break
                    value = recoil_values(system, law, state_after(system, state, middle))[0 if separates else 1]
                    if value > 0.0:
                        high = middle
                        high_value = value
                    else:
                        low = middle
                        low_value = value
                return high, separates
            before = time
        begun += step
        step *= 2.0
    return np.inf, True


@compiled(lambda t: t.boolean(t.of(System), t.of(Law), t.of(Manner), t.of(State), t.real))
def is_captured(system: System, law: Law, manner: Manner, state: State, delta: float) -> bool:
    """Is the energy too small to lift the sphere out of its indentation? Never so where a drive brings more."""
    if system.driven > 0:
        return False
    energy = energy_of_approach(system, state) + static_work(law, delta)
    weight = system.mass * system.gravity
    barrier = stored_energy(law, law.release) - weight * law.release_level - 0.5 * system.compliance * weight * weight
    least = 0.5 * system.mass * (manner.tolerance * manner.motion_speed) ** 2
    return energy < barrier + least


@compiled(lambda t: t.boolean(t.of(System), t.of(Law), t.of(State), t.real))
def is_near_rest(system: System, law: Law, state: State, force: float) -> bool:
    """May a riding sphere be at rest? A necessary condition that needs no eigenvalues; where a plate is driven, always.

    The force must be close to the weight, and the speed low: the force decelerates and accelerates the sphere at no lower an angular
    frequency than that from the trace of the flexibility, on a contact with about the stiffness of force over indentation.
    """
    if system.driven > 0:
        return True
    weight = system.mass * system.gravity
    most = _REST_MARGIN * weight
    if weight == 0.0 or abs(force - weight) > most:
        return False
    overlap = max(approach_of(system, state)[0] - law.release_level, 0.0)
    on_springs = system.mass * (overlap / weight / _REST_MARGIN + system.compliance)
    slowest = 1.0 / math.sqrt(on_springs + system.flexibility)
    speed = 0.0
    for coordinate in range(system.rigid):
        speed += system.shape[coordinate] * state.velocity[coordinate]
    return system.mass * abs(speed) * slowest < most


@compiled(lambda t: t.void(t.of(Parts), t.integer, t.real, t.of(State), t.of(Law), t.integer))
def write_part(parts: Parts, part: int, start: float, state: State, law: Law, memories: int) -> None:
    """Write what all parts of a motion have: their start [s], the state then, and the law with the number of its changes of memory."""
    parts.start[part] = start
    parts.displacement[part] = state.displacement
    parts.velocity[part] = state.velocity
    parts.local[part] = state.local
    parts.memories[part] = memories
    parts.separation_loss[part] = 0.0


@compiled(lambda t: t.void(t.of(Parts), t.integer, t.vector, t.real))
def lose_at_end(parts: Parts, part: int, lost: Floats, energy: float) -> None:
    """Add stored energy that is lost at the end of the last part [J]; it may be that of an earlier call."""
    lost[len(lost) - 1] += energy
    if part > 0:
        parts.separation_loss[part - 1] += energy
    else:
        parts.late_loss[0] += energy


@compiled(lambda t: t.void(t.of(Parts), t.integer, t.of(Basis), t.of(System), t.of(Attempt), t.of(State)))
def write_stretch(parts: Parts, part: int, basis: Basis, system: System, solved: Attempt, begun: State) -> None:
    """Write a solved stretch."""
    number = len(basis.time)
    parts.kind[part] = 1
    parts.time_map[part] = basis.time_map
    parts.length[part] = solved.length
    parts.static[part] = solved.nodes.static
    parts.force[part] = solved.nodes.force
    parts.approach[part] = solved.contact.approach[0]
    parts.rate[part] = solved.contact.rate[0]
    parts.delta[part] = solved.contact.delta[0]
    parts.work[part] = solved.work
    parts.dissipated[part] = solved.contact.dissipated[0]
    parts.roughness[part] = solved.contact.roughness
    depth = system.offset
    for coordinate in range(len(begun.displacement)):
        depth += system.indentation_shape[coordinate] * begun.displacement[coordinate]
    parts.indentation[part, 0] = depth
    speeds = np.zeros(number)
    for coordinate in range(len(begun.displacement)):
        shape = system.indentation_shape[coordinate]
        if shape != 0.0:
            for node in range(number):
                speeds[node] += shape * solved.path.velocity[coordinate, node]
    for node in range(number):
        moved = 0.0
        for other in range(number):
            moved += basis.integral[node, other] * speeds[other]
        parts.indentation[part, node + 1] = depth + solved.length * moved


@compiled(
    lambda t: t.tuple(t.integer, t.integer, t.of(Progress), t.of(State), t.of(Law))(
        t.of(Basis),
        t.of(Basis),
        t.of(Basis),
        t.of(System),
        t.of(Surfaces),
        t.of(Coordinates),
        t.of(Manner),
        t.of(Law),
        t.of(State),
        t.of(Progress),
        t.vector,
        t.of(Parts),
    )
)
def follow_contact(
    touch: Basis,
    inside: Basis,
    release: Basis,
    system: System,
    surfaces: Surfaces,
    coordinates: Coordinates,
    manner: Manner,
    law: Law,
    state: State,
    progress: Progress,
    lost: Floats,
    parts: Parts,
) -> tuple[int, int, Progress, State, Law]:
    """Follow a contact until it is released, or until something is to be decided; return how it goes on, and the number of parts written.

    Parameters
    ----------
    touch, inside, release : Basis
        The Radau rule under the three maps of time.
    manner : Manner
        What stays the same through the contact.
    law : Law
        The law, with its memory of the last call.
    state, progress : State, Progress
        Where the last call ended, or the touch.
    lost : array, shape (n + 1,)
        Energy lost in each coordinate, and last in the contact [J], to which is added.
    parts : Parts
        Room for the parts of the motion.
    """
    time = progress.time
    next_length = progress.next_length
    delta = progress.delta
    force = progress.force
    trend = progress.trend
    closing = progress.closing
    fresh = progress.fresh
    pushes = progress.pushes
    steps = progress.steps
    memories = progress.memories
    largest_force = progress.largest_force
    deepest = progress.deepest
    elements = len(lost) - 1
    part = 0
    changes = 0  # of the law's memory, in this call
    outcome = FULL
    parts.late_loss[0] = 0.0
    no_event = Event(NO_EVENT, 0.0, 0.0)
    no_guess = Nodes(np.zeros(0), np.zeros(0), np.zeros(0))
    while part < len(parts.start) and changes < len(parts.turned_at):
        if not pushes:  # recoil
            length, separates = end_of_recoil(system, law, manner, state)
            if not np.isfinite(length):
                outcome = TOO_STIFF
                break
            after = state_after(system, state, length)
            write_part(parts, part, time, state, law, memories)
            parts.kind[part] = 0
            parts.length[part] = length
            part += 1
            gone = lost_in_flight(system, state, after)
            held = stored_energy(law, law_indentation(law, max(approach_of(system, state)[0], law.release_level)))
            left = stored_energy(law, law_indentation(law, max(approach_of(system, after)[0], law.release_level)))
            for coordinate in range(len(lost)):
                lost[coordinate] += gone[coordinate]
            lost[elements] += held - left
            time += length
            state = after
            if separates:
                outcome = RELEASED
                break
            pushes = True
            delta = law_indentation(law, max(approach_of(system, state)[0], law.release_level))
            trend = 0.0
            continue

        steps += 1
        rides = time - manner.begun > _LONG * manner.span
        remaining = manner.until - time
        if steps > manner.most_steps or (rides and remaining <= _TIME_ROUNDING * manner.span):
            outcome = RIDES
            break
        longest = min(remaining if rides else np.inf, manner.longest)
        if not fresh:  # events at the end of the last stretch: it is within rounding of them
            approach, rate = approach_of(system, state)
            overlap = max(approach - law.release_level, 0.0)
            if overlap <= _ROUNDING * deepest and rate < 0.0:
                lose_at_end(parts, part, lost, energy_held(system, law, manner, law.release))
                outcome = RELEASED
                break
            if manner.tension == TENSION_CUT and force <= _NO_FORCE * largest_force and trend < 0.0:
                if separates_at_no_force(system, law, manner, state):
                    lose_at_end(parts, part, lost, energy_held(system, law, manner, delta))
                    outcome = RELEASED
                    break
                pushes = False
                continue
            if closing <= _ZERO_RATE * manner.motion_speed and delta > law.memory_level:
                parts.turned_at[changes] = delta
                changes += 1
                memories += 1
                law = law_after(law, delta)
        if next_length < _SHORTEST * manner.span:
            outcome = TOO_STIFF
            break

        basis = touch if fresh else inside
        start = surface_start(system, surfaces, state)
        contacts = contacts_of(law)
        begun = begun_indentations(contacts, start, np.array([delta]))
        given = Event(NO_EVENT, 0.0, min(next_length, longest))
        tried = attempt(basis, system, surfaces, coordinates, law, manner, state, start, contacts, begun, no_guess, trend, False, given)
        event = no_event
        if tried.event.kind != NO_EVENT:
            # also tried if the stretch is not resolved, as the event may be the only reason
            seen = tried.event
            source = tried
            source_basis = basis
            ended = tried
            ended_basis = basis
            success = False
            for _ in range(_MOST_ATTEMPTS):
                ended_basis = inside
                if source_basis.time_map == 0:
                    ended_basis = touch
                elif seen.kind == PARTED or seen.kind == NO_PUSH:
                    ended_basis = release
                share = time_at(source_basis, seen.x)
                guess = guess_from(source_basis, ended_basis, law, source, share)
                aim = Event(seen.kind, seen.level, share * source.length)
                ended = attempt(
                    ended_basis, system, surfaces, coordinates, law, manner, state, start, contacts, begun, guess, 0.0, True, aim
                )
                if not ended.solved or not 0.0 < ended.length <= (1.0 + _AT_END) * source.length:
                    break
                if ended.event.kind == NO_EVENT or ended.event.x > _BEFORE_END:
                    success = ended.resolved
                    break
                source = ended
                source_basis = ended_basis
                seen = ended.event
            if not success:
                near = max(tried.event.x, 1.0 / (len(basis.grid) - 1)) if tried.resolved else 1.0
                next_length = 0.5 * min(next_length, tried.length * time_at(basis, near))
                continue
            tried = ended
            basis = ended_basis
            event = seen
        elif not tried.resolved:
            next_length *= 0.5
            continue

        # the stretch is accepted
        write_part(parts, part, time, state, law, memories)
        write_stretch(parts, part, basis, system, tried, state)
        part += 1
        number = len(basis.time)
        for coordinate in range(len(lost)):
            lost[coordinate] += tried.path.lost[coordinate]
        lost[elements] += tried.contact.dissipated[0]
        state = State(tried.path.displacement, tried.path.speed, tried.path.local)
        time += tried.length
        delta = tried.contact.delta[0, number]
        force = tried.nodes.force[number - 1]
        closing = tried.closing[number]
        trend = 0.0
        for node in range(number):
            trend += basis.at_end[node] * tried.nodes.force[node] / tried.length
            largest_force = max(largest_force, tried.nodes.force[node])
            deepest = max(deepest, parts.indentation[part - 1, node + 1])
        fresh = False
        if event.kind == NO_EVENT:
            growth = (_EASY * math.sqrt(manner.tolerance) / max(tried.contact.roughness, _TINY)) ** (1.0 / number)
            next_length = tried.length * min(max(growth, 0.7), 4.0)
        elif event.kind == PARTED or (event.kind == NO_PUSH and separates_at_no_force(system, law, manner, state)):
            # stored energy is lost where a sticking contact breaks, or where the surface recovers more slowly than the bodies part
            lose_at_end(parts, part, lost, energy_held(system, law, manner, delta))
            outcome = RELEASED
            break
        elif event.kind == NO_PUSH:
            pushes = False
        elif event.kind == TURN:
            parts.turned_at[changes] = delta
            changes += 1
            memories += 1
            law = law_after(law, delta)
        if pushes:
            if is_captured(system, law, manner, state, delta):
                outcome = CAPTURED
                break
            if is_near_rest(system, law, state, force):
                outcome = NEAR_REST
                break
    now = Progress(time, next_length, delta, force, trend, closing, fresh, pushes, steps, memories, largest_force, deepest)
    return outcome, part, now, state, law
