"""A stretch of contact, stated from the bodies and laws, solved by the core, and read back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.collocation import Map
from vibroimpact.dynamics.core.histories import contact_histories
from vibroimpact.dynamics.core.records import Contacts, End, Motion, Nodes, Start
from vibroimpact.dynamics.core.rubbing import first_friction, free_motions
from vibroimpact.dynamics.core.rubbing_records import Rubbed
from vibroimpact.dynamics.core.stretch import (
    AT_LEVEL,
    AT_NO_FORCE,
    AT_TURN,
    GIVEN_LENGTH,
    begun_indentations,
    first_guess,
    solve_stretch,
)
from vibroimpact.dynamics.vibrating.contact_history import ContactHistory
from vibroimpact.dynamics.vibrating.contact_view import ContactView
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.local import LocalContact, contacts_of
from vibroimpact.dynamics.vibrating.radau_eigenbasis import NODES_PER_STRETCH, RadauEigenbasis, radau_eigenbasis
from vibroimpact.dynamics.vibrating.rubbing import NO_RUBBING
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
    def record(self) -> End:
        """The same as the core takes it."""
        return End(_END[self.name], self.level, self.contact)


_GIVEN_LENGTH = End(GIVEN_LENGTH, 0.0, 0)


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

    def solve(self) -> VibratingStretch:
        """Return the solved stretch."""
        basis = radau_eigenbasis(self.time_map, max(local.law.root for local in self.contacts))
        surfaces = self.view.surfaces
        start = self.view.start(self.start)
        contacts = contacts_of(self.contacts)
        begun = begun_indentations(contacts, start, np.array(self.begun, dtype=float))
        rubbed = Rubbed(surfaces, start, NO_RUBBING)
        motions = free_motions(basis.basis, surfaces, start, rubbed, self.length)
        if self.guess is None:
            trend = np.array(self.trend, dtype=float)
            guess = first_guess(basis.basis, surfaces, contacts, start, motions.across, begun, trend, self.length)
        else:
            delta, force = (np.ascontiguousarray(part).ravel() for part in self.guess)
            guess = Nodes(np.zeros_like(force), force, delta)
        friction = first_friction(NO_RUBBING, NODES_PER_STRETCH)
        end = _GIVEN_LENGTH if self.end_condition is None else self.end_condition.record
        nodes, motions, _, length, solved = solve_stretch(
            basis.basis, surfaces, contacts, start, rubbed, guess, motions, friction, self.length, end
        )
        return self._read(basis, contacts, start, begun, nodes, motions.across, length, solved)

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
        return VibratingStretch(self.view, basis, length, self.start, histories, solved, found.roughness)
