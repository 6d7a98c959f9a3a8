"""One contact, followed by the core, and its parts read back."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.dynamics.core import contact as core
from vibroimpact.dynamics.core.contact_records import Manner, Parts, Progress
from vibroimpact.dynamics.core.events import ENDS, TENSIONS
from vibroimpact.dynamics.core.records import MAPS
from vibroimpact.dynamics.core.surface_friction_records import NUMBERS, SlidingSphere
from vibroimpact.dynamics.vibrating.active_contact import ActiveContact, record_peaks
from vibroimpact.dynamics.vibrating.contact_history import ContactHistory
from vibroimpact.dynamics.vibrating.contact_view import contact_view
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.radau_eigenbasis import (
    NODES_PER_STRETCH,
    RadauEigenbasis,
    bases_of,
    radau_eigenbasis,
)
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.stretch_end import with_separation_loss
from vibroimpact.dynamics.vibrating.surface_friction import SlidingState, SlidingStretch
from vibroimpact.dynamics.vibrating.time_marching import MotionPart, TimeMarching

_PARTS = 64
"""Parts of the motion that the core writes before they are read."""


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
            sphere=sphere,
        )
        self.state = march.state.record
        self.parts = _empty_parts(march.system.number, len(march.system.rate), sphere.directions)
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
        """Append the parts that were written to the history of the march, and record the peaks."""
        march = self.march
        late_loss = float(self.parts.late_loss[0])
        if late_loss:  # at the end of the last part that was read
            last = march.parts[-1]
            assert isinstance(last.motion, VibratingStretch)
            march.parts[-1] = replace(last, motion=with_separation_loss(last.motion, 0, late_loss))
        self._update_memories()
        parts = Parts._make(values[:count].copy() for values in self.parts)
        largest_force = parts.force.max(axis=1).tolist()
        starts = [
            State(parts.displacement[part], parts.velocity[part], parts.local[part])
            for part in range(count)
        ]
        ends = [*starts[1:], State(*self.state)]
        for part in range(count):
            local = self.locals[parts.memories[part]]
            time = float(parts.start[part])
            if parts.kind[part] == 0:
                free = FreeMotion(march.system, starts[part])
                recoil = FreePhase(free, float(parts.length[part]), ((0, local),))
                march.parts.append(MotionPart(time, recoil))
                continue
            stretch = self._stretch(parts, part, local, starts[part])
            march.parts.append(MotionPart(time, stretch))
            record_peaks(
                self.active.impact, stretch, 0, time, largest_force[part], parts.indentation[part]
            )
            stretch.__dict__["end"] = ends[part]  # which it would compute anew

    def _update_memories(self) -> None:
        """Add the contacts after the turns that the core has met since the last reading."""
        turns = self.progress.memories + 1 - len(self.locals)
        for indentation in self.parts.turned_at[:turns].tolist():
            local = self.locals[-1]
            self.march.plastic += float(local.law.plastic_work(indentation))
            self.locals.append(local.after_indentation(indentation))

    def _stretch(
        self, parts: Parts, part: int, local: LocalContact, start: State
    ) -> VibratingStretch:
        """Return a stretch of contact from one of the parts."""
        basis = radau_eigenbasis(MAPS[parts.time_map[part]], self.root)
        static = parts.static[part]
        history = ContactHistory(
            number=0,
            local=local,
            rule=basis.rule,
            static=static,
            dissipative=parts.force[part] - static,
            approach=parts.approach[part],
            rate=parts.rate[part],
            closing=parts.closing[part],
            delta=parts.delta[part],
            work=float(parts.work[part]),
            dissipated=float(parts.dissipated[part]),
            separation_loss=float(parts.separation_loss[part]),
        )
        length = float(parts.length[part])
        return VibratingStretch(
            view=self.view,
            basis=basis,
            length=length,
            start=start,
            contacts=(history,),
            roughness=float(parts.roughness[part]),
            sliding=self._sliding(parts, part, basis, length),
        )

    def _sliding(
        self, parts: Parts, part: int, basis: RadauEigenbasis, length: float
    ) -> SlidingStretch | None:
        """Return the friction through one of the parts; None without friction."""
        sphere = self.progress.sphere
        if not sphere.directions:
            return None
        start, end = (SlidingState.of(numbers) for numbers in parts.sphere[part])
        return SlidingStretch(
            basis.rule, length, sphere, start, end, parts.friction[part], parts.slip[part]
        )


def _empty_parts(number: int, elements: int, directions: int) -> Parts:
    """Return arrays for the parts of the motion of a system.

    `number`: of its coordinates. `elements`: of massless elements. `directions`: of friction.
    """
    nodes = NODES_PER_STRETCH
    return Parts(
        kind=np.zeros(_PARTS, dtype=np.int64),
        time_map=np.zeros(_PARTS, dtype=np.int64),
        start=np.empty(_PARTS),
        length=np.empty(_PARTS),
        displacement=np.empty((_PARTS, number)),
        velocity=np.empty((_PARTS, number)),
        local=np.empty((_PARTS, elements)),
        memories=np.zeros(_PARTS, dtype=np.int64),
        static=np.empty((_PARTS, nodes)),
        force=np.empty((_PARTS, nodes)),
        approach=np.empty((_PARTS, nodes + 1)),
        rate=np.empty((_PARTS, nodes + 1)),
        closing=np.empty((_PARTS, nodes + 1)),
        delta=np.empty((_PARTS, nodes + 1)),
        work=np.empty(_PARTS),
        dissipated=np.empty(_PARTS),
        roughness=np.empty(_PARTS),
        separation_loss=np.empty(_PARTS),
        indentation=np.empty((_PARTS, nodes + 1)),
        turned_at=np.empty(_PARTS + 1),
        late_loss=np.zeros(1),
        friction=np.empty((_PARTS, directions, nodes)),
        slip=np.empty((_PARTS, directions, nodes)),
        sphere=np.empty((_PARTS, 2, NUMBERS)),
    )
