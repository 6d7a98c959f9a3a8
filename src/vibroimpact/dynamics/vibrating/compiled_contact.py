"""One contact, followed by the core, and its parts read back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.dynamics.core import contact as core
from vibroimpact.dynamics.core.contact_records import Manner, Peaks, Progress
from vibroimpact.dynamics.core.events import ENDS, TENSIONS
from vibroimpact.dynamics.core.surface_friction_records import SlidingSphere
from vibroimpact.dynamics.vibrating.active_contact import ActiveContact
from vibroimpact.dynamics.vibrating.contact_view import contact_view
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.radau_eigenbasis import bases_of
from vibroimpact.dynamics.vibrating.recorded_contact import RecordedContact, copied
from vibroimpact.dynamics.vibrating.time_marching import TimeMarching


@dataclass(frozen=True)
class Limits:
    """When a contact is left.

    `until`: time if the sphere rides [s]. `longest`: largest length of a stretch [s]. `most_steps`:
    largest number of stretches.
    """

    until: float
    longest: float
    most_steps: int


class CompiledContact:
    """The contact of a march with one contact, from touch on; `sphere`: friction at touch."""

    def __init__(
        self,
        march: TimeMarching,
        active: ActiveContact,
        limits: Limits,
        sphere: SlidingSphere,
    ) -> None:
        self.march = march
        self.active = active
        self.recorded: list[RecordedContact] = []
        law = active.local.law
        self.view = contact_view(march.system, (0,))
        self.root = law.root
        self.manner = Manner(
            tension=TENSIONS.index(law.tension),
            contact_end=ENDS.index(law.contact_end),
            motion_speed=active.speed,
            energy=active.energy,
            span=active.span,
            tolerance=march.tolerance,
            begun=march.time,
            until=limits.until,
            longest=limits.longest,
            most_steps=limits.most_steps,
        )
        self.law = active.local.with_levels
        self.progress = Progress(
            time=march.time,
            next_length=march.next_length,
            delta=active.delta,
            force=np.inf,
            trend=0.0,
            closing=np.inf,
            fresh=True,
            pushes=True,
            steps=0,
            memories=0,
            largest_force=0.0,
            deepest=0.0,
            peaks=Peaks(0.0, 0.0, 0.0, 0.0),
            sphere=sphere,
        )
        self.state = march.state.record
        self.parts = self.view.room
        self.locals = [active.local]

    @property
    def steps(self) -> int:
        """Stretches that were tried."""
        return self.progress.steps

    def follow(self) -> int:
        """Follow the contact until something is to be decided; return its outcome.

        The march is brought up to there.
        """
        march = self.march
        outcome = core.FULL
        while outcome == core.FULL:
            outcome, count, self.progress, self.state, self.law = core.follow_contact(
                bases_of(self.root),
                self.view.bodies,
                self.manner,
                self.law,
                self.state,
                self.progress,
                march.lost,
                self.parts,
            )
            self._read(count)
        progress = self.progress
        march.state = State(*self.state)
        march.time = progress.time
        march.next_length = progress.next_length
        active = self.active
        active.local = self.locals[-1]
        active.delta = progress.delta
        active.force = progress.force
        active.trend = progress.trend
        active.fresh = progress.fresh
        active.pushes = progress.pushes
        return outcome

    def _read(self, count: int) -> None:
        """Keep the parts that were written."""
        late_loss = float(self.parts.late_loss[0])
        if late_loss:  # at the end of the last part that was kept
            self.recorded[-1].lose_at_end(late_loss)
        self._update_memories()
        if count:
            self.recorded.append(
                RecordedContact(
                    self.view,
                    copied(self.parts, count),
                    tuple(self.locals),
                    self.progress.sphere,
                    State(*self.state),
                )
            )

    def _update_memories(self) -> None:
        """Add the contacts after the turns that the core has met since the last reading."""
        turns = self.progress.memories + 1 - len(self.locals)
        for indentation in self.parts.turned_at[:turns].tolist():
            local = self.locals[-1]
            self.march.plastic += float(local.law.plastic_work(indentation))
            self.locals.append(local.after_indentation(indentation))
