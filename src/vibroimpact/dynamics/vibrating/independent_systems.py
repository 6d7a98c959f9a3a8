"""Systems of bodies that fall into parts which no contact joins: each is marched on its own.

A body that is held joins nothing, since nothing moves it. So balls that fall on one floor are as
many systems, and none has to wait for the contacts of the others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.dynamics.core.system_records import CONTACT, START
from vibroimpact.dynamics.motion.progress import of_several
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.marched_system import (
    ContactDefinition,
    MarchedSystem,
    MotionPart,
    march_system,
)
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch


@dataclass(frozen=True, eq=False)
class JoinedBodies:
    """Bodies that contacts join: their coordinates and contacts in the whole system, and how they
    were marched.
    """

    coordinates: Indices
    contacts: Indices
    marched: MarchedSystem

    def parts_at(self, times: Floats) -> Iterator[tuple[MotionPart, Bools, Floats]]:
        """Yield each part of the motion with a mask of the times within it, and these times.

        The latter are since its start [s].
        """
        starts = self.marched.starts
        part_of_time = np.maximum(np.searchsorted(starts, times, side="right") - 1, 0)
        for number in np.unique(part_of_time).tolist():
            part = self.marched.part(number)
            inside = part_of_time == number
            yield part, inside, np.minimum(times[inside] - part.start, part.motion.length)


@dataclass(frozen=True, eq=False)
class IndependentSystems:
    """A system of bodies marched through its contacts up to a time.

    Parameters
    ----------
    system : LinearSystem
        All bodies.
    start : State
        State at the start.
    joined : sequence of JoinedBodies
        What contacts join; all other coordinates move freely.
    """

    system: LinearSystem
    start: State
    joined: Sequence[JoinedBodies]

    def states(self, times: Floats) -> State:
        """Return the states at times since the start [s] (T,)."""
        free = FreeMotion(self.system, self.start).state(times)
        displacement = free.displacement
        velocity = free.velocity
        for bodies in self.joined:
            for part, inside, elapsed in bodies.parts_at(times):
                state = part.motion.state(elapsed)
                at = np.ix_(inside, bodies.coordinates)
                displacement[at] = state.displacement
                velocity[at] = state.velocity
        return State(displacement, velocity, np.zeros((len(times), 0)))

    def forces(self, times: Floats) -> Floats:
        """Return the contact forces at times since the start [N] (T, contacts)."""
        forces = np.zeros((len(times), len(self.system.offset)))
        for bodies in self.joined:
            for part, inside, elapsed in bodies.parts_at(times):
                if isinstance(part.motion, VibratingStretch):
                    x = part.motion.rule.unmap_time(elapsed / part.motion.length)
                    for contact in part.motion.contacts:
                        forces[inside, bodies.contacts[contact.number]] = contact.force_at(x)
        return forces

    def impacts(self) -> Floats:
        """Return the impacts in the order in which they begin, as in `core.system_records`."""
        impacts = []
        for bodies in self.joined:
            of_bodies = bodies.marched.impacts().copy()
            of_bodies[:, CONTACT] = bodies.contacts[of_bodies[:, CONTACT].astype(int)]
            impacts.append(of_bodies)
        together = np.concatenate(impacts)
        return together[np.argsort(together[:, START], kind="stable")]

    def end(self, time: float) -> State:
        """Return the state at the end [s]."""
        state = FreeMotion(self.system, self.start).state_after(time)
        for bodies in self.joined:
            state.displacement[bodies.coordinates] = bodies.marched.state.displacement
            state.velocity[bodies.coordinates] = bodies.marched.state.velocity
        return state

    def lost(self, end: State) -> tuple[float, float]:
        """Return the energy lost in the modes and in the contacts until the end [J]."""
        by_coordinate = FreeMotion(self.system, self.start).lost_at(end)[:-1]
        in_contacts = 0.0
        for bodies in self.joined:
            by_coordinate[bodies.coordinates] = bodies.marched.lost[:-1]
            in_contacts += float(bodies.marched.lost[-1])
        return float(by_coordinate.sum()), in_contacts

    @property
    def stored(self) -> float:
        """Energy that is stored in the contacts at the end [J]."""
        return sum(bodies.marched.stored for bodies in self.joined)

    @property
    def plastic(self) -> float:
        """Plastic work in the contacts [J]."""
        return sum(bodies.marched.plastic for bodies in self.joined)


def march_independent(
    system: LinearSystem,
    definitions: Sequence[ContactDefinition],
    start: State,
    tolerance: float,
    end: float,
    progress: Callable[[float], None] | None = None,
) -> IndependentSystems:
    """March each part of a system that contacts join until a time; as `march_system`."""
    groups = joined_contacts(system)
    joined = []
    for number, contacts in enumerate(groups):
        coordinates = np.flatnonzero(system.shape[contacts].any(axis=0))
        marched = march_system(
            system.part(coordinates, contacts),
            [definitions[contact] for contact in contacts],
            start.part(coordinates),
            tolerance,
            end,
            of_several(progress, number, len(groups)),
        )
        joined.append(JoinedBodies(coordinates, contacts, marched))
    return IndependentSystems(system, start, joined)


def joined_contacts(system: LinearSystem) -> list[Indices]:
    """Return the contacts of a system in groups that have no coordinate in common."""
    moved = csr_array(system.shape != 0.0).astype(np.int64)
    count, group = connected_components(moved @ moved.T, directed=False)
    return [np.flatnonzero(group == number) for number in range(count)]
