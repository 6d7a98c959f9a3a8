"""A stretch of contact, stated from the bodies and laws, solved by the core, and read back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.collocation import Map
from vibroimpact.dynamics.core.histories import contact_histories
from vibroimpact.dynamics.core.receptance import surface_motion
from vibroimpact.dynamics.core.records import Contacts, Motion, Nodes, Start
from vibroimpact.dynamics.core.stretch import (
    AT_LEVEL,
    AT_NO_FORCE,
    AT_TURN,
    GIVEN_LENGTH,
    MOST_ITERATIONS,
    begun_indentations,
    first_guess,
    force_scale,
    improved,
    is_converged,
    solve_stretch,
)
from vibroimpact.dynamics.vibrating.contact_history import ContactHistory
from vibroimpact.dynamics.vibrating.contact_view import ContactView
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.local import LocalContact, contacts_of
from vibroimpact.dynamics.vibrating.radau_eigenbasis import RadauEigenbasis, radau_eigenbasis
from vibroimpact.dynamics.vibrating.rubbing import Friction, Rubbing
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

_END = {"parted": AT_LEVEL, "breakpoint": AT_LEVEL, "no push": AT_NO_FORCE, "turn": AT_TURN}


@dataclass(frozen=True)
class EndCondition:
    """Condition at the end of a stretch whose length is unknown.

    "parted", where the surfaces separate, and "breakpoint": the law's indentation comes to a `level` [m]; "no push": zero force; "turn":
    zero rate of the approach. `contact`: index among the contacts that push.
    """

    name: Literal["parted", "no push", "breakpoint", "turn"]
    level: float = 0.0
    contact: int = 0

    @property
    def event(self) -> tuple[int, float, int]:
        """What ends the stretch, at which level, and at which contact, as the core takes it."""
        return _END[self.name], self.level, self.contact


_NO_EVENT = (GIVEN_LENGTH, 0.0, 0)


@dataclass(frozen=True)
class StretchProblem:
    """A stretch of contact to be solved.

    Parameters
    ----------
    view : ContactView
        The system, reduced to the contacts that push.
    contacts : sequence of LocalContact
        The law of each, and the compliance in series with it.
    time_map : {"touch", "inside", "release"}
        Time map in which the forces are smooth.
    length : float
        Length of the stretch [s]; with an end condition, its initial guess.
    start : State
        State at the start.
    begun : sequence of float
        Indentations of the laws at the start [m], approximately.
    trend : sequence of float
        Approximate rates of change of the forces at the start [N/s], used where there is no guess.
    guess : tuple of two arrays, shape (c, N), optional
        Initial guess of the indentations of the laws [m] and of the forces [N] at the nodes.
    end_condition : EndCondition, optional
        Condition at the end, from which the length is found.
    rubbing : Rubbing, optional
        Friction at the start, of a drop that has any.
    """

    view: ContactView
    contacts: Sequence[LocalContact]
    time_map: Map
    length: float
    start: State
    begun: Sequence[float]
    trend: Sequence[float] = ()
    guess: tuple[Floats, Floats] | None = None
    end_condition: EndCondition | None = None
    rubbing: Rubbing | None = None

    def solve(self) -> VibratingStretch:
        """Return the solved stretch."""
        basis = radau_eigenbasis(self.time_map, max(local.law.root for local in self.contacts))
        surfaces = self.view.surfaces
        start = self.view.start(self.start)
        contacts = contacts_of(self.contacts)
        begun = begun_indentations(contacts, start, np.array(self.begun, dtype=float))
        motion = surface_motion(basis.basis, surfaces, start, self.length)
        friction = None
        if self.rubbing is not None:
            friction = Friction(self.view, self.start, self.rubbing, basis)
            friction.set_length(self.length)
        moved = motion if friction is None else friction.moving(motion)
        if self.guess is None:
            trend = np.array(self.trend, dtype=float)
            guess = first_guess(basis.basis, surfaces, contacts, start, moved, begun, trend, self.length)
        else:
            delta, force = (np.ascontiguousarray(part).ravel() for part in self.guess)
            guess = Nodes(np.zeros_like(force), force, delta)
        event = _NO_EVENT if self.end_condition is None else self.end_condition.event
        if friction is None:
            nodes, motion, length, solved = solve_stretch(basis.basis, surfaces, contacts, start, guess, motion, self.length, *event)
        else:
            nodes, motion, length, solved = _solve_under_friction(basis, self, contacts, start, guess, motion, friction, event)
        return self._read(basis, contacts, start, begun, nodes, motion, length, solved, friction)

    def _read(
        self,
        basis: RadauEigenbasis,
        contacts: Contacts,
        start: Start,
        begun: Floats,
        nodes: Nodes,
        motion: Motion,
        length: float,
        solved: bool,
        friction: Friction | None,
    ) -> VibratingStretch:
        """Return the stretch from its indentations and forces at the nodes."""
        found = contact_histories(basis.basis, self.view.surfaces, contacts, start, begun, nodes, motion, length)
        static = nodes.static.reshape(len(begun), -1)
        dissipative = nodes.force.reshape(len(begun), -1) - static
        histories = tuple(
            ContactHistory(
                self.view.contacts[place],
                local,
                basis.rule,
                static[place],
                dissipative[place],
                found.approach[place],
                found.rate[place],
                found.closing[place],
                found.delta[place],
                work=float(np.subtract(*local.work_at_indentation(found.delta[place, [-1, 0]]))),
                dissipated=float(found.dissipated[place]),
            )
            for place, local in enumerate(self.contacts)
        )
        rubbed = None if friction is None else friction.stretch(nodes.force)
        return VibratingStretch(self.view, basis, length, self.start, histories, solved, found.roughness, rubbed)


def _solve_under_friction(
    basis: RadauEigenbasis,
    problem: StretchProblem,
    contacts: Contacts,
    start: Start,
    guess: Nodes,
    motion: Motion,
    friction: Friction,
    event: tuple[int, float, int],
) -> tuple[Nodes, Motion, float, bool]:
    """Return what `solve_stretch` does, with friction followed beside Newton's method; the motion is that under friction."""
    surfaces = problem.view.surfaces
    length = problem.length
    moved = friction.moving(motion)
    scale = force_scale(surfaces, moved, length)
    now, size = guess, np.inf
    for _ in range(MOST_ITERATIONS):
        last_size = size
        now, length, size, well_posed = improved(basis.basis, surfaces, contacts, start, moved, now, length, scale, *event)
        if not (well_posed and np.isfinite(size)):
            break
        if event[0] != GIVEN_LENGTH:
            motion = surface_motion(basis.basis, surfaces, start, length)
            friction.set_length(length)
        changed = friction.follow(now.force)
        size = max(size, changed / (scale + float(np.abs(now.force).max())))
        moved = friction.moving(motion)
        if is_converged(size, last_size):
            return now, moved, length, True
    return now, moved, length, False
