"""A stretch of contact, stated from the bodies and laws, solved by the core, and read back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core import attempt as core
from vibroimpact.dynamics.core.contact_records import Attempt, Balance, Beginning, Manner
from vibroimpact.dynamics.core.events import NO_EVENT
from vibroimpact.dynamics.core.records import MAPS, Event, Nodes
from vibroimpact.dynamics.core.stretch import begun_indentations
from vibroimpact.dynamics.core.surface_friction_records import SlidStretch
from vibroimpact.dynamics.vibrating.contact_history import ContactHistory
from vibroimpact.dynamics.vibrating.contact_view import ContactView
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.local import LocalContact, contacts_of
from vibroimpact.dynamics.vibrating.radau_eigenbasis import bases_of, radau_eigenbasis
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.surface_friction import NO_FRICTION

_NO_GUESS = Nodes(np.zeros(0), np.zeros(0), np.zeros(0))


@dataclass(frozen=True)
class StretchAhead:
    """The next stretch of contacts that push.

    `view`: the system, reduced to the contacts. `contacts`: their laws, and what is in series with
    them. `state`: at the start. `trend`: about the rates of change of the forces then [N/s].
    `manner`, `beginning`: as the core takes them.
    """

    view: ContactView
    contacts: Sequence[LocalContact]
    state: State
    trend: Floats
    manner: Manner
    beginning: Beginning

    @classmethod
    def of(
        cls,
        view: ContactView,
        contacts: Sequence[LocalContact],
        state: State,
        indentations: Floats,
        trend: Floats,
        manner: Manner,
    ) -> StretchAhead:
        """Return the stretch from a state on.

        `indentations`: those of the laws in that state, approximately [m].
        """
        start = view.start(state)
        laws = contacts_of(contacts)
        beginning = Beginning(
            state.record,
            start,
            laws,
            begun_indentations(laws, start, indentations),
            SlidStretch(view.surfaces, start, NO_FRICTION),
        )
        return cls(view, contacts, state, trend, manner, beginning)

    @property
    def root(self) -> int:
        """The power of time in whose root the forces are smooth."""
        return max(local.law.root for local in self.contacts)

    def solve(self, time_map: int, length: float) -> Attempt:
        """Return the stretch of a length [s] under a map of time, of `MAPS`."""
        no_event = Event(NO_EVENT, 0.0, length, 0)
        return core.attempt(
            radau_eigenbasis(MAPS[time_map], self.root).basis,
            self.view.bodies,
            self.manner,
            self.beginning,
            _NO_GUESS,
            self.trend,
            False,
            no_event,
        )

    def up_to_event(self, attempt: Attempt, time_map: int) -> tuple[bool, Attempt, int, Event]:
        """Return the stretch solved again up to its first event.

        It is given as whether that succeeds, the solution, its map of time, and the event.
        """
        return core.up_to_event(
            bases_of(self.root), self.view.bodies, self.manner, self.beginning, attempt, time_map
        )

    def balance(self, attempt: Attempt, time_map: int) -> Balance:
        """Return the motion through a solution, and whether it is resolved."""
        return core.balance_of(
            radau_eigenbasis(MAPS[time_map], self.root).basis,
            self.view.bodies,
            self.manner,
            self.beginning,
            attempt,
        )

    def stretch(self, solved: Attempt, balance: Balance, time_map: int) -> VibratingStretch:
        """Return a solution with its histories."""
        basis = radau_eigenbasis(MAPS[time_map], self.root)
        static = solved.nodes.static.reshape(len(self.contacts), -1)
        force = solved.nodes.force.reshape(len(self.contacts), -1)
        motion = solved.contact
        histories = tuple(
            ContactHistory(
                number=self.view.contacts[index],
                local=local,
                rule=basis.rule,
                static=static[index],
                dissipative=force[index] - static[index],
                approach=motion.approach[index],
                rate=motion.rate[index],
                closing=motion.closing[index],
                delta=motion.delta[index],
                work=float(balance.work[index]),
                dissipated=float(motion.dissipated[index]),
            )
            for index, local in enumerate(self.contacts)
        )
        stretch = VibratingStretch(
            self.view, basis, solved.length, self.state, histories, motion.roughness
        )
        stretch.__dict__["path"] = balance.path  # which it would compute anew
        return stretch
